#include "dynamics/loads.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace glisson {

void Loads::add(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale) {
  if (vertices.empty()) throw std::invalid_argument("load: the vertex set is empty; name at least one vertex");
  for (const std::uint32_t v : vertices) {
    if (v < force_.size()) continue;
    throw std::invalid_argument("load: vertex " + std::to_string(v) + " is outside the mesh, 0 to " +
                                std::to_string(force_.size() - 1));
  }
  if (!std::isfinite(norm(force))) throw std::invalid_argument("load: the force [N] must be finite");
  loads_.push_back(
      {{vertices.begin(), vertices.end()}, force * (1.0 / static_cast<double>(vertices.size())), std::move(scale)});
}

std::span<const Vec3d> Loads::at(double time) {
  if (loads_.empty()) return force_;
  std::fill(force_.begin(), force_.end(), Vec3d{});
  for (const Load& load : loads_) {
    const Vec3d f = load.force_per_vertex * (load.scale ? load.scale(time) : 1.0);
    for (const std::uint32_t v : load.vertices) force_[v] += f;
  }
  return force_;
}

}  // namespace glisson

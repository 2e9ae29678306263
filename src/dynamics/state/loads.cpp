#include "dynamics/state/loads.h"

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
  const std::vector<double> shares(vertices.size(), 1.0 / static_cast<double>(vertices.size()));
  loads_.push_back({{vertices.begin(), vertices.end()}, shares, force, std::move(scale)});
}

void Loads::add_copies(std::span<const std::uint32_t> origins) {
  const auto first = static_cast<std::uint32_t>(force_.size());
  force_.resize(force_.size() + origins.size());
  for (Load& load : loads_) {
    const std::size_t before = load.vertices.size();
    for (std::size_t k = 0; k < before; ++k) {
      const auto copies = std::count(origins.begin(), origins.end(), load.vertices[k]);
      if (copies == 0) continue;
      load.share[k] /= static_cast<double>(copies + 1);
      for (std::uint32_t i = 0; i < origins.size(); ++i) {
        if (origins[i] != load.vertices[k]) continue;
        load.vertices.push_back(first + i);
        load.share.push_back(double(load.share[k]));
      }
    }
  }
}

void Loads::archive(Archive& ar, std::size_t vertices) {
  auto count = static_cast<std::uint64_t>(loads_.size());
  ar(count);
  ar.check(count == loads_.size());
  for (Load& load : loads_) {
    const std::vector<std::uint32_t> here = load.vertices;
    ar.all_below(load.vertices, vertices);
    ar(load.share);
    ar.check(load.share.size() == load.vertices.size() && here.size() <= load.vertices.size());
    ar.check(std::equal(here.begin(), here.end(), load.vertices.begin()));
  }
  force_.resize(vertices);
}

std::span<const Vec3d> Loads::at(double time) {
  if (loads_.empty()) return force_;
  std::fill(force_.begin(), force_.end(), Vec3d{});
  for (const Load& load : loads_) {
    const Vec3d f = load.force * (load.scale ? load.scale(time) : 1.0);
    for (std::size_t k = 0; k < load.vertices.size(); ++k) force_[load.vertices[k]] += f * load.share[k];
  }
  return force_;
}

}  // namespace glisson

#include "instruments/contact_surface.h"

#include <algorithm>
#include <limits>

namespace glisson {
namespace {

constexpr std::size_t kPatchVertices = 12;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void ContactSurface::build(const BodyView& body) {
  TetMesh present;
  present.vertices = body.mesh.vertices;
  for (std::size_t t = 0; t < body.mesh.tets.size(); ++t) {
    if (!body.is_removed(t)) present.tets.push_back(body.mesh.tets[t]);
  }
  triangles_ = boundary_triangles(present);
  vertices_.clear();
  for (const Triangle& t : triangles_) vertices_.insert(vertices_.end(), t.begin(), t.end());
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  find_triangles_at(body.mesh.vertices.size());
  find_patches(body.mesh.vertices);
}

void ContactSurface::find_triangles_at(std::size_t vertex_count) {
  first_.assign(vertex_count + 1, 0);
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
  around_.resize(3 * triangles_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t k = 0; k < triangles_.size(); ++k) {
    for (const std::uint32_t v : triangles_[k]) around_[next[v]++] = k;
  }
}

std::span<const std::uint32_t> ContactSurface::triangles_at(std::uint32_t vertex) const {
  return std::span(around_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
}

/// Grows patches over edges, each from the lowest vertex that is in none yet.
void ContactSurface::find_patches(std::span<const Vec3d> rest) {
  patches_.clear();
  std::vector<std::uint32_t> patch_of(rest.size(), kNone);
  std::vector<double> way(rest.size(), 0.0);
  for (const std::uint32_t seed : vertices_) {
    if (patch_of[seed] != kNone) continue;
    const auto number = static_cast<std::uint32_t>(patches_.size());
    SurfacePatch patch{seed, {seed}, 0.0};
    std::vector<std::uint32_t> rim;
    patch_of[seed] = number, way[seed] = 0.0;
    for (std::size_t k = 0; k < patch.vertices.size(); ++k) {
      const std::uint32_t v = patch.vertices[k];
      for (const std::uint32_t t : triangles_at(v)) {
        for (const std::uint32_t w : triangles_[t]) {
          if (patch_of[w] == number) continue;
          const double length = way[v] + norm(rest[w] - rest[v]);
          patch.radius = std::max(patch.radius, length);
          if (patch_of[w] == kNone && patch.vertices.size() < kPatchVertices) {
            patch_of[w] = number, way[w] = length;
            patch.vertices.push_back(w);
          } else {
            rim.push_back(w);
          }
        }
      }
    }
    patch.vertices.insert(patch.vertices.end(), rim.begin(), rim.end());
    std::sort(patch.vertices.begin(), patch.vertices.end());
    patch.vertices.erase(std::unique(patch.vertices.begin(), patch.vertices.end()), patch.vertices.end());
    patches_.push_back(std::move(patch));
  }
}

}  // namespace glisson

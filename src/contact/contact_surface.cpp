#include "contact/contact_surface.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace glisson {
namespace {

constexpr std::size_t kPatchVertices = 12;
constexpr double kPatchSize = 1.7;  // of the longest edge at its sentinel: no vertex of a patch but its rim is farther
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

/// Grows patches over edges, each from the lowest vertex that is in none yet, nearest vertices first.
void ContactSurface::find_patches(std::span<const Vec3d> rest) {
  patches_.clear();
  std::vector<char> taken(rest.size(), 0);
  std::vector<std::uint32_t> seen(rest.size(), kNone);  // by which patch, last
  for (const std::uint32_t seed : vertices_) {
    if (taken[seed] != 0) continue;
    const auto number = static_cast<std::uint32_t>(patches_.size());
    SurfacePatch patch{seed, {}, 0.0};
    std::vector<std::pair<double, std::uint32_t>> rim{{0.0, seed}};  // by distance from the seed
    seen[seed] = number;
    double limit = 0.0;
    for (std::size_t size = 0; size < kPatchVertices && !rim.empty(); ++size) {
      const auto next = std::min_element(rim.begin(), rim.end(), [&](const auto& a, const auto& b) {
        return std::pair{taken[a.second] != 0, a} < std::pair{taken[b.second] != 0, b};
      });
      const auto [distance, v] = *next;
      if (taken[v] != 0 || (size > 0 && distance > kPatchSize * limit)) break;
      rim.erase(next);
      taken[v] = 1;
      patch.vertices.push_back(v);
      patch.radius = std::max(patch.radius, distance);
      for (const std::uint32_t t : triangles_at(v)) {
        for (const std::uint32_t w : triangles_[t]) {
          if (v == seed) limit = std::max(limit, norm(rest[w] - rest[v]));
          if (seen[w] == number) continue;
          seen[w] = number;
          rim.emplace_back(norm(rest[w] - rest[seed]), w);
        }
      }
    }
    for (const auto& [distance, v] : rim) patch.vertices.push_back(v), patch.radius = std::max(patch.radius, distance);
    std::sort(patch.vertices.begin(), patch.vertices.end());
    patches_.push_back(std::move(patch));
  }
}

}  // namespace glisson

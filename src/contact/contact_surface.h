// contact_surface.h — the surface of a body as contact sees it: triangles, who is around a vertex, and patches.
//
// A patch is a few dozen vertices that hang together over edges of the surface. Its first vertex is its sentinel: where a tool
// comes so near to the sentinel that it might reach any vertex of the patch, the patch is asked for. So a tool that
// touches little keeps few vertices at hand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "glisson/simulation/interaction.h"

namespace glisson {

struct SurfacePatch {
  std::uint32_t sentinel = 0;
  std::vector<std::uint32_t> vertices;  ///< and those around them
  double radius = 0.0;                  ///< farthest of them from the sentinel, at rest [m]
};

class ContactSurface {
 public:
  /// Cost: a sort of the faces, 0.1 µs a tet.
  void build(const BodyView& body);

  std::span<const Triangle> triangles() const { return triangles_; }     ///< outward oriented
  std::span<const std::uint32_t> vertices() const { return vertices_; }  ///< ascending
  std::span<const SurfacePatch> patches() const { return patches_; }
  std::span<const std::uint32_t> triangles_at(std::uint32_t vertex) const;
  std::size_t body_vertices() const { return first_.empty() ? 0 : first_.size() - 1; }

 private:
  void find_triangles_at(std::size_t vertex_count);
  void find_patches(std::span<const Vec3d> rest);

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> vertices_, first_, around_;
  std::vector<SurfacePatch> patches_;
};

}  // namespace glisson

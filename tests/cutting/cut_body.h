// cut_body.h — blades for tests of cuts, and what is seen of a mesh that was cut.
#pragma once

#include <functional>
#include <map>
#include <numeric>

#include "change/changed_body.h"
#include "glisson/instruments/cutting.h"

namespace glisson::test {

/// A plane with two directions in it, right-handed: normal = across × along.
struct CutPlane {
  Vec3d point, along, across;
  Vec3d normal() const { return cross(across, along); }
};

inline CutPlane plane_at(const Vec3d& point, const Vec3d& normal) {
  const Vec3d n = unit(normal);
  const Vec3d along = unit(cross(n, std::abs(n.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
  return {point, along, cross(along, n)};
}

inline CutPlane random_plane(const Vec3d& point, std::mt19937& random) {
  const std::vector<Vec3d> d = random_field(1, 1.0, random);
  return plane_at(point, norm(d[0]) > 0.1 ? d[0] : Vec3d{0, 0, 1});
}

/// The edge of a blade of length 2 `reach` across a plane, `way` along it from its point.
inline BladeEdge edge_on(const CutPlane& plane, double reach, double way) {
  const Vec3d middle = plane.point + plane.along * way;
  return {middle - plane.across * reach, middle + plane.across * reach};
}

inline void add(CutReport& sum, const CutReport& r) {
  sum.area += r.area, sum.faces_area += r.faces_area;
  sum.tets += r.tets, sum.faces += r.faces, sum.new_vertices += r.new_vertices;
  sum.moved_vertices += r.moved_vertices, sum.held_back += r.held_back;
  sum.largest_offset = std::max(sum.largest_offset, r.largest_offset);
}

/// Leads a blade across a plane from −reach to `end` in equal steps.
inline CutReport cut_along(Cutter& cutter, const CutPlane& plane, double reach, double end, int steps) {
  CutReport sum;
  cutter.place(edge_on(plane, reach, -reach));
  for (int i = 1; i <= steps; ++i) add(sum, cutter.advance(edge_on(plane, reach, -reach + (end + reach) * i / steps)));
  return sum;
}

/// Per tet the lowest tet it is connected with by faces.
inline std::vector<std::uint32_t> pieces_of(const TetMesh& mesh) {
  std::vector<std::uint32_t> first(mesh.tets.size());
  std::iota(first.begin(), first.end(), 0U);
  const std::function<std::uint32_t(std::uint32_t)> root = [&](std::uint32_t i) {
    while (first[i] != i) i = first[i] = first[first[i]];
    return i;
  };
  std::map<Triangle, std::uint32_t> seen;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t skip = 0; skip < 4; ++skip) {
      Triangle f{mesh.tets[t][(skip + 1) % 4], mesh.tets[t][(skip + 2) % 4], mesh.tets[t][(skip + 3) % 4]};
      std::sort(f.begin(), f.end());
      const auto [at, fresh] = seen.emplace(f, t);
      if (fresh) continue;
      const auto [low, high] = std::minmax({root(t), root(at->second)});
      first[high] = low;
    }
  }
  for (std::uint32_t& f : first) f = root(f);
  return first;
}

/// Numbers of tets of the pieces, largest first.
inline std::vector<std::size_t> piece_sizes(const TetMesh& mesh) {
  std::map<std::uint32_t, std::size_t> size;
  for (const std::uint32_t f : pieces_of(mesh)) ++size[f];
  std::vector<std::size_t> sizes;
  for (const auto& [first, n] : size) sizes.push_back(n);
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

inline double worst_quality(const TetMesh& mesh) {
  double worst = 1.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) worst = std::min(worst, regular_mean_ratio(mesh, t));
  return worst;
}

/// Edges of the boundary that do not have exactly two triangles.
inline std::size_t loose_edges(const TetMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : boundary_triangles(mesh)) {
    for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(t[i], t[(i + 1) % 3])];
  }
  return static_cast<std::size_t>(std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second != 2; }));
}

}  // namespace glisson::test

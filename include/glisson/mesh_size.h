// mesh_size.h — where a mesh of regions is finer than elsewhere: near a region, its surface, or a line.
//
//   RegionMeshOptions options{.edge = 0.008};
//   options.sizes = {{.edge = 0.002, .near = "tumour", .within = 0.004}};
//
//        edge │        ________ the mesh's          The edge asked for at a point at the distance d from the place:
//             │       /
//             │      /                                 e(d) = min(mesh's edge, edge + growth · max(0, d − within))
//    the size │_____/
//             └─────────────── d                     and the least of all where several sizes are given.
//              within
#pragma once

#include <string>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"

namespace glisson {

/// A point of a line.
struct PathPoint {
  static constexpr std::string_view kName = "path";
  Vec3d at{};  ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("at", &PathPoint::at, "mm", "the point").must());
  }
};

/// A place and the edges there. One of `near`, `surface` and `path` names the place.
struct MeshSize {
  static constexpr std::string_view kName = "size";
  double edge = 0.002;            ///< mean length of the edges there [m]; no effect where the mesh's is shorter
  std::string near{};             ///< a region: in it and around it
  std::string surface{};          ///< a region: on both sides of its surface
  std::vector<PathPoint> path{};  ///< a line through points, or around one point
  double within = 0.0;            ///< the reach of `edge` beyond the region, surface or line [m]
  /// Edges in the radius of curvature of `surface` [-]: the edge at each of its points is that share of the radius there, and no
  /// shorter than `edge`, which creases get. 0: `edge` all over the surface.
  double per_radius = 0.0;

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = MeshSize;
    return take(
        field("edge", &S::edge, "mm", above(0), "mean length of the edges there").must(),
        field("near", &S::near, "name of a region: in it and around it"),
        field("surface", &S::surface, "name of a region: on both sides of its surface"),
        field("path", &S::path, "the points of a line, as that of a needle; one: around a point"),
        field("within", &S::within, "mm", at_least(0), "how far that reaches; beyond it, edges grow by `growth`"),
        field("per_radius", &S::per_radius, "-", between(0, 100),
              "edges in the radius of curvature of `surface`, no shorter than its edge; 0: that edge all over it"));
  }
  Fault check() const;
};

/// What is wrong with sizes of a mesh: a region that is none of these, an edge below a 256th of that of the mesh; nothing where
/// `what` is empty.
struct SizeFault {
  std::string what;
  std::size_t index = 0;
  std::string key;
};
SizeFault check_sizes(const std::vector<MeshSize>& sizes, double mesh_edge, const std::vector<std::string>& regions);

/// Edge over distance at which the edges of a mesh grow away from a size [-].
inline constexpr double kGrowth = 0.3;
inline constexpr Range kGrowthRange = between(0.05, 1.0);

// The fields that say how fine a mesh of regions is, for each struct that has them.

template <class S>
constexpr auto edge_field() {
  return field("edge", &S::edge, "mm", above(0), "mean length of the tets' edges");
}
template <class S>
constexpr auto max_tets_field() {
  return field("max_tets", &S::max_tets, between(1, 1e9), "a finer mesh is refused");
}
template <class S>
constexpr auto sizes_field(std::string_view help = "where edges are shorter") {
  return field("sizes", &S::sizes, help).keyed("size");
}
template <class S>
constexpr auto growth_field() {
  return field("growth", &S::growth, "-", kGrowthRange, "edge over distance at which edges grow away from these");
}

}  // namespace glisson

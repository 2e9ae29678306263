// surface_tree.h — a tree of boxes over the triangles of a surface: the nearest one, and how often the surface winds about a point.
//
//   node   box of its triangles for the distance; their common area vector A = Σ n area, its place c and reach r for the winding number:
//          beyond 2 r a node counts as one dipole,  A·(c − p) / (4π |c − p|³)
#pragma once

#include <array>
#include <vector>

#include "glisson/region_mesh.h"
#include "mesh/topology/faces.h"

namespace glisson::detail {

using Corners = std::array<Vec3d, 3>;

inline Vec3d middle_of(const Corners& t) { return (t[0] + t[1] + t[2]) * (1.0 / 3.0); }
inline double squared(const Vec3d& x) { return dot(x, x); }

class SurfaceTree {
 public:
  /// @param triangles  one or more, all with an area [m]
  explicit SurfaceTree(std::vector<Corners> triangles);

  /// To the nearest triangle, negative where the surface winds about p at least half once [m].
  double distance(const Vec3d& p) const;
  const Bounds& box() const { return nodes_.front().box; }

 private:
  struct Node {
    Bounds box;
    Vec3d area, middle;
    double reach = 0.0;
    std::size_t first = 0, count = 0;  ///< of its triangles; of an inner node all below it
    std::size_t second = 0;            ///< the second node below it, the first follows itself; 0: a leaf
  };

  std::size_t build(std::size_t first, std::size_t count);
  Node node_of(std::size_t first, std::size_t count) const;
  void nearest(std::size_t at, const Vec3d& p, double& best) const;
  double winding(std::size_t at, const Vec3d& p) const;  ///< solid angle of a node's triangles from p [sr]

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace glisson::detail

// curvature_sizes.h — edges by the curvature of a surface: points of it with the edge that each asks for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "glisson/region_mesh.h"

namespace glisson::lattice {

/// A point and the edge asked for there [m].
struct SizePoint {
  Vec3d at{};
  double edge = 0.0;
};

/// Points of a region's surface where its radius of curvature over `per_radius` is below `coarsest`, some half an edge apart.
/// The edges are no shorter than `finest`; creases have that.
/// @throws std::invalid_argument  naming the region, where there are more than two million
std::vector<SizePoint> curvature_sizes(const BodyRegion& region, double per_radius, double finest, double coarsest);

/// The least of  edge + growth · max(0, distance − within)  over many points, found in a tree of boxes.
class SizePoints {
 public:
  SizePoints(std::vector<SizePoint> points, double growth, double within);

  /// That least, or `most` where it is larger [m].
  double at(const Vec3d& p, double most) const;

 private:
  static constexpr std::size_t kLeaf = 8;  ///< points of a box that is not divided
  struct Node {
    Bounds box;
    double edge = 0.0;  ///< the least in it [m]
    std::uint32_t begin = 0, end = 0;
    std::uint32_t second = 0;  ///< the first is the next node; 0: not divided
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t node, const Vec3d& p, double& least) const;
  double grown(double edge, double distance) const;

  std::vector<SizePoint> points_;
  double growth_, within_;
  std::vector<Node> nodes_;
};

}  // namespace glisson::lattice

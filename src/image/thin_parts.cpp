// thin_parts.cpp — see thin_parts.h.
#include "image/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "image/distance_map.h"
#include "image/size_grid.h"

namespace glisson::image {
namespace {

constexpr double kStep =
    1.4142135623730951;             ///< from one edge that is tried to the next: the lattice has no finer grades
constexpr double kShortest = 0.5;   ///< edge in voxels
constexpr double kTolerance = 0.3;  ///< voxels by which a ball may stick out: the grain of a surface is not thin

}  // namespace

std::function<double(const Vec3d&)> thin_part_sizes(const GroupImage& image, double across, double edge,
                                                    double growth) {
  const Vec3d spacing = image.grid.spacing();
  const double voxel = std::min({spacing.x, spacing.y, spacing.z});
  const auto sizes = std::make_shared<SizeGrid>(image.grid, edge);
  std::vector<char> set(image.voxels.size());
  for (std::size_t g = 1; g <= image.groups.size(); ++g) {
    for (std::size_t v = 0; v < set.size(); ++v) set[v] = image.voxels[v] != g;
    const std::vector<float> inner = distance_to(image.grid.size, spacing, set);  // of centres from the first outside
    bool any = true;
    for (double wanted = edge; any && wanted >= kStep * kShortest * voxel; wanted /= kStep) {
      const double radius = 0.5 * across * wanted - kTolerance * voxel;
      if (radius <= 0.5 * voxel) {  // each voxel holds such a ball
        any = false;
        continue;
      }
      for (std::size_t v = 0; v < set.size(); ++v) set[v] = inner[v] - 0.5 * voxel >= radius;
      const std::vector<float> from_balls = distance_to(image.grid.size, spacing, set);
      const auto finer = static_cast<float>(wanted / kStep);
      any = false;
      for (std::size_t v = 0; v < set.size(); ++v) {
        if (image.voxels[v] != g || from_balls[v] <= radius + 0.5 * voxel) continue;
        sizes->sizes()[v] = std::min(sizes->sizes()[v], finer);
        any = true;
      }
    }
  }
  sizes->spread(growth);
  return [sizes, edge](const Vec3d& p) { return whole_grade(edge, sizes->at(p)); };
}

}  // namespace glisson::image

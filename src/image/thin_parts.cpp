// thin_parts.cpp — see thin_parts.h.
#include "image/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "image/distance_map.h"

namespace glisson::image {
namespace {

constexpr double kStep =
    1.4142135623730951;             ///< from one edge that is tried to the next: the lattice has no finer grades
constexpr double kShortest = 0.5;   ///< edge in voxels
constexpr double kTolerance = 0.3;  ///< voxels by which a ball may stick out: the grain of a surface is not thin

/// Sizes at voxels, and between them.
class SizeImage {
 public:
  SizeImage(const ImageGrid& grid, double edge)
      : grid_(grid), to_index_(inverse(grid.axes)), sizes_(grid.voxels(), static_cast<float>(edge)) {}

  std::vector<float>& sizes() { return sizes_; }

  /// size(v) = min over w of size(w) + growth |v − w|, to the 8 % of a distance by steps to neighbours.    [Borgefors1986]
  void spread(double growth) {
    std::array<double, 13> step{};
    std::array<std::array<int, 3>, 13> to{};
    std::size_t n = 0;
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          if (k > 0 || (k == 0 && (j > 0 || (j == 0 && i >= 0)))) continue;
          to[n] = {i, j, k};
          step[n++] =
              growth * norm(grid_.axes * Vec3d{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        }
      }
    }
    const std::size_t count = sizes_.size();
    for (const bool back : {false, true}) {
      for (std::size_t m = 0; m < count; ++m) {
        const std::size_t v = back ? count - 1 - m : m;
        const auto at = grid_.place(v);
        float least = sizes_[v];
        for (std::size_t s = 0; s < 13; ++s) {
          std::array<std::size_t, 3> w{};
          bool inside = true;
          for (std::size_t a = 0; a < 3; ++a) {
            const auto moved = static_cast<std::ptrdiff_t>(at[a]) + (back ? -to[s][a] : to[s][a]);
            inside = inside && moved >= 0 && moved < static_cast<std::ptrdiff_t>(grid_.size[a]);
            w[a] = static_cast<std::size_t>(moved);
          }
          if (inside) least = std::min(least, static_cast<float>(sizes_[grid_.at(w[0], w[1], w[2])] + step[s]));
        }
        sizes_[v] = least;
      }
    }
  }

  double at(const Vec3d& p) const {
    const Vec3d index = to_index_ * (p - grid_.origin);
    std::array<std::size_t, 3> low{}, high{};
    std::array<double, 3> t{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = std::clamp(index[a], 0.0, static_cast<double>(grid_.size[a] - 1));
      low[a] = static_cast<std::size_t>(x);
      high[a] = std::min(low[a] + 1, grid_.size[a] - 1);
      t[a] = x - static_cast<double>(low[a]);
    }
    double sum = 0.0;
    for (std::size_t c = 0; c < 8; ++c) {
      const auto pick = [&](std::size_t a) { return (c >> a) & 1 ? high[a] : low[a]; };
      double w = 1.0;
      for (std::size_t a = 0; a < 3; ++a) w *= (c >> a) & 1 ? t[a] : 1.0 - t[a];
      sum += w * sizes_[grid_.at(pick(0), pick(1), pick(2))];
    }
    return sum;
  }

 private:
  ImageGrid grid_;
  Mat3d to_index_;
  std::vector<float> sizes_;
};

}  // namespace

std::function<double(const Vec3d&)> thin_part_sizes(const GroupImage& image, double across, double edge,
                                                    double growth) {
  const Vec3d spacing = image.grid.spacing();
  const double voxel = std::min({spacing.x, spacing.y, spacing.z});
  const auto sizes = std::make_shared<SizeImage>(image.grid, edge);
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
  // Whole grades: the mesher makes its finest edge exact, and all others by halving, so that `edge` stays that of the rest.
  return [sizes, edge](const Vec3d& p) { return edge * std::exp2(-std::round(std::log2(edge / sizes->at(p)))); };
}

}  // namespace glisson::image

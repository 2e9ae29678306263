// size_grid.cpp — see size_grid.h.
#include "image/size_grid.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/text.h"
#include "glisson/image/read_image.h"

namespace glisson::image {
namespace {

constexpr double kFinest = 256.0;  ///< the mesher's longest edge over its shortest

}  // namespace

void SizeGrid::spread(double growth) {
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

double SizeGrid::at(const Vec3d& p) const {
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

double SizeGrid::beyond(const Vec3d& p) const {
  const Vec3d index = to_index_ * (p - grid_.origin), spacing = grid_.spacing();
  Vec3d out{};
  for (std::size_t a = 0; a < 3; ++a)
    out[a] = spacing[a] * std::max({0.0, -index[a], index[a] - static_cast<double>(grid_.size[a] - 1)});
  return norm(out);
}

double whole_grade(double edge, double size) { return edge * std::exp2(-std::round(std::log2(edge / size))); }

std::function<double(const Vec3d&)> image_sizes(const std::filesystem::path& file, double edge, double growth) {
  const GreyImage image = read_grey_image(file, {.gaps = true});
  const auto sizes = std::make_shared<SizeGrid>(image.grid, edge);
  for (std::size_t v = 0; v < image.voxels.size(); ++v) {
    const double wanted = 1e-3 * image.voxels[v];
    if (!(wanted > 0.0) || wanted >= edge) continue;  // nor does NaN ask for anything
    if (wanted * kFinest < edge) {
      const auto at = image.grid.place(v);
      throw ImageError(file.string() + ": voxel (" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " +
                       std::to_string(at[2]) + ") asks for edges of " + detail::number_text(1e3 * wanted, 4) +
                       " mm; allowed: at least 1/256 of the mesh's " + detail::number_text(1e3 * edge, 4) +
                       " mm, and 0 or less for none");
    }
    sizes->sizes()[v] = static_cast<float>(wanted);
  }
  sizes->spread(growth);
  return [sizes, edge, growth](const Vec3d& p) {
    return whole_grade(edge, std::min(edge, sizes->at(p) + growth * sizes->beyond(p)));
  };
}

}  // namespace glisson::image

// label_fields_test.cpp — smooth functions of labels: they agree at interfaces, keep volumes and voxels; distances and splines are exact.
#include "image/label_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/distance_map.h"
#include "image/label_image.h"

namespace glisson {
namespace label_fields_test {

using test::label_image;

constexpr CleanLabels kUnchanged{.smallest_piece_ml = 0.0, .largest_hole_ml = 0.0};

std::vector<LabelGroup> numbered(int count) {
  std::vector<LabelGroup> groups;
  for (int n = 1; n <= count; ++n) groups.push_back({"label_" + std::to_string(n), {n}});
  return groups;
}

/// The region at a point by precedence, 0 for none.
std::size_t region_at(const image::LabelFields& fields, const Vec3d& p) {
  for (std::size_t g = 0; g < fields.fields.size(); ++g) {
    if (fields.fields[g]->at(p) < 0.0) return g + 1;
  }
  return 0;
}

Vec3d centre(const ImageGrid& grid, std::size_t v) {
  const auto at = grid.place(v);
  return grid.world({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
}

// The distance map is that of a search over all voxels, on a grid of three spacings, to single precision.
TEST(DistanceMap, IsThatOfASearch) {
  const std::array<std::size_t, 3> size{9, 7, 8};
  const Vec3d h{0.7, 1.3, 2.9};
  std::mt19937 random(3);
  std::vector<char> set(9 * 7 * 8);
  for (char& c : set) c = random() % 40 == 0;
  set[100] = 1;
  const std::vector<float> d = image::distance_to(size, h, set);
  ImageGrid grid;
  grid.size = size;
  for (std::size_t v = 0; v < set.size(); ++v) {
    double least = 1e300;
    for (std::size_t w = 0; w < set.size(); ++w) {
      if (!set[w]) continue;
      const auto a = grid.place(v), b = grid.place(w);
      double sum = 0.0;
      for (std::size_t x = 0; x < 3; ++x)
        sum += std::pow(h[x] * (static_cast<double>(a[x]) - static_cast<double>(b[x])), 2);
      least = std::min(least, sum);
    }
    ASSERT_NEAR(d[v], std::sqrt(least), 2e-6 * (1.0 + std::sqrt(least))) << v;
  }
  EXPECT_TRUE(std::isinf(image::distance_to(size, h, std::vector<char>(set.size(), 0))[5]));
}

// A spline takes its values at the voxels, and is a cubic between them: of x³ it is exact away from the ends, where it is mirrored.
TEST(SplineField, InterpolatesAndIsCubic) {
  ImageGrid grid;
  grid.size = {40, 3, 2};
  grid.axes = {{{{0.5, 0.1, 0.0}, {0.0, 0.7, 0.0}, {0.0, 0.0, 2.0}}}};
  grid.origin = {1.0, 2.0, 3.0};
  std::vector<float> values(grid.voxels());
  for (std::size_t v = 0; v < values.size(); ++v)
    values[v] = static_cast<float>(std::pow((static_cast<double>(grid.place(v)[0]) - 20.0) / 20.0, 3));
  const image::SplineField field(grid, values);
  for (std::size_t v = 0; v < values.size(); ++v) ASSERT_NEAR(field.at(centre(grid, v)), values[v], 2e-6);
  for (double i = 12.0; i < 28.0; i += 0.37)
    ASSERT_NEAR(field.at_index({i, 1.3, 0.4}), std::pow((i - 20.0) / 20.0, 3), 2e-6) << i;
  EXPECT_EQ(field.at_index({-5.0, 9.0, -1.0}), field.at_index({0.0, 2.0, 0.0}));
}

// Labels that meet in faces, lines and points: each voxel's centre stays in its region, and every region keeps the volume of its voxels to 1 %
// of it (8 points a voxel on the interfaces).
TEST(LabelFields, KeepVoxelsAndVolumes) {
  const LabelImage image = label_image({28, 26, 24}, 0.003, [](int i, int j, int k) {
    if (std::hypot(i - 13.5, j - 12.5, k - 11.5) > 10.0) return 0;
    if (std::hypot(i - 13.5, j - 12.5) < 3.2) return 3;  // a vessel through both halves
    return i < 14 ? 1 : 2;
  });
  const GroupImage groups = clean_labels(image, numbered(3), kUnchanged);
  for (const int rounds : {0, 2, 10}) {
    const image::LabelFields fields = image::smooth_fields(groups, {.rounds = rounds});
    EXPECT_EQ(fields.changed_voxels, 0u);
    const std::vector<double> volumes = groups.volumes();
    for (std::size_t g = 0; g < 3; ++g)
      EXPECT_NEAR(fields.volumes[g] / volumes[g], 1.0, 0.01) << rounds << " rounds, region " << g + 1;
    for (std::size_t v = 0; v < groups.voxels.size(); ++v)
      ASSERT_EQ(region_at(fields, centre(groups.grid, v)), groups.voxels[v]) << v;
  }
}

// Outside a region its function is no more than the distance to it, so that a mesher may skip that far: of a ball's voxels, compared with
// the ball, to half a voxel.
TEST(LabelFields, NeverExceedTheDistance) {
  const double radius = 8.0, edge = 0.002;
  const LabelImage image = label_image(
      {25, 25, 25}, edge, [&](int i, int j, int k) { return std::hypot(i - 12, j - 12, k - 12) < radius ? 1 : 0; });
  const image::LabelFields fields = image::smooth_fields(clean_labels(image, numbered(1), kUnchanged), {});
  for (double x = 0.0; x < 30.0; x += 0.5) {
    const Vec3d p{edge * (12.0 + x), edge * 12.3, edge * 11.8};
    EXPECT_LE(fields.fields[0]->at(p), edge * (std::abs(x - radius) + 0.5)) << x;
    if (x > 5.0 && x < 11.0) {
      EXPECT_NEAR(fields.fields[0]->at(p), edge * (x - radius), 0.5 * edge) << x;
    }
  }
}

// The surface of a ball of 10 voxels' radius is smooth: its points are on a sphere to 0.45 voxels at most and 0.15 on average, where the
// voxels' own faces are off by up to 0.9 and 0.3.
TEST(LabelFields, AreSmooth) {
  const LabelImage image = label_image(
      {25, 25, 25}, 0.001, [](int i, int j, int k) { return std::hypot(i - 12, j - 12, k - 12) < 10.0 ? 1 : 0; });
  const image::LabelFields fields = image::smooth_fields(clean_labels(image, numbered(1), kUnchanged), {});
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double most = 0.0, sum = 0.0;
  for (int n = 0; n < 500; ++n) {
    const Vec3d direction = unit(Vec3d{normal(random), normal(random), normal(random)});
    double low = 8.0, high = 12.0;
    while (high - low > 1e-3) {
      const double r = 0.5 * (low + high);
      (fields.fields[0]->at((Vec3d{12.0, 12.0, 12.0} + direction * r) * 1e-3) < 0.0 ? low : high) = r;
    }
    most = std::max(most, std::abs(low - 10.0));
    sum += std::abs(low - 10.0);
  }
  EXPECT_LT(most, 0.45);
  EXPECT_LT(sum / 500, 0.15);
}

// A sheet and a thread of one voxel keep all their voxels, and the sheet three quarters of its volume or more.
TEST(LabelFields, KeepSheetsOfOneVoxel) {
  const LabelImage image = label_image({20, 20, 20}, 0.001, [](int i, int j, int k) {
    if (i == 10 && j > 2 && j < 17 && k > 2 && k < 17) return 1;
    return j == 5 && k == 5 && i > 10 && i < 18 ? 2 : 0;
  });
  const GroupImage groups = clean_labels(image, numbered(2), kUnchanged);
  const image::LabelFields fields = image::smooth_fields(groups, {});
  EXPECT_EQ(fields.changed_voxels, 0u);
  EXPECT_NEAR(fields.volumes[0] / groups.volumes()[0], 1.0, 0.25);
}

}  // namespace label_fields_test
}  // namespace glisson

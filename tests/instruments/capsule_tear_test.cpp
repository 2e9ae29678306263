// A capsule tears where its tension over a length reaches its strength, and a hole takes from it what a hole of that size
// takes, both whatever the mesh.
#include <gtest/gtest.h>

#include <numbers>

#include "instruments/capsule/capsule_surface.h"
#include "instruments/capsule_on_block.h"

namespace glisson {
namespace {

constexpr double kWidth = 0.04;
CapsuleOptions sheet_options() {
  CapsuleOptions o;
  o.youngs_modulus = 8e6;
  o.thickness = 1e-4;  // E t = 800 N/m
  o.poisson_ratio = 1.0 / 3.0;
  return o;
}

// The area that a disc shares with triangles adds up to that of the disc where they cover it, and is a triangle's own where
// the disc covers that: rounding.
TEST(CapsuleTear, DiscIsSharedOutExactly) {
  const Sheet s = patch(9, 9, 1.0, 1.0, 0.3);
  for (const double radius : {0.02, 0.2, 0.4}) {
    double sum = 0.0;
    for (const Triangle& t : s.triangles) {
      std::array<std::array<double, 2>, 3> flat{};
      for (std::size_t i = 0; i < 3; ++i) flat[i] = {s.vertices[t[i]].x - 0.47, s.vertices[t[i]].y - 0.53};
      sum += overlap_with_disc(flat, radius);
    }
    EXPECT_NEAR(sum, std::numbers::pi * radius * radius, 1e-14);
  }
  EXPECT_NEAR(overlap_with_disc({{{0.1, 0.0}, {0.0, 0.2}, {-0.1, -0.1}}}, 3.0), 0.025, 1e-15);
}

// The nearest triangle does not depend on where the search begins, also where several are as near: checkpoints do not keep it.
TEST(CapsuleTear, NearestIsTheSameFromAnywhere) {
  const Sheet s = patch(5, 5, 1.0, 1.0, 0.0);
  const std::vector<char> counts(s.triangles.size(), 1);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> grid(-2, 22);
  for (int i = 0; i < 200; ++i) {
    const Vec3d place{grid(random) * 0.05, grid(random) * 0.05, grid(random) * 0.02};
    const PointOnTriangle from_start = nearest_point(s.triangles, s.vertices, counts, place);
    for (std::size_t first = 1; first < s.triangles.size(); ++first) {
      const PointOnTriangle other = nearest_point(s.triangles, s.vertices, counts, place, first);
      ASSERT_EQ(other.triangle, from_start.triangle);
      ASSERT_EQ(other.weights, from_start.weights);
    }
  }
}

/// Loss of stiffness by a hole of 3 mm radius in an evenly stretched sheet over that in an endless one of the same share.
double loss_by_hole(int n) {
  const double radius = 3e-3, area = std::numbers::pi * radius * radius;
  CapsuleOnBlock whole(n, kWidth, sheet_options()), holed(n, kWidth, sheet_options());
  EXPECT_NEAR(holed.capsule->open_at({0.0203, 0.0198, 1e-4}, radius), area, 1e-15);
  EXPECT_NEAR(holed.capsule->open_area(), area, 1e-15);
  return (1.0 - holed.stretch(1.02) / whole.stretch(1.02)) / (3.0 * area / (kWidth * kWidth));
}

// A hole of the share φ of an evenly stretched sheet takes 2φ/(1 − ν) = 3φ of its stiffness, for small φ the exact loss of a
// round hole. Here φ = 1.8 %, the rim of the sheet is held and near, which takes a tenth off the loss: on a mesh of 1 mm it
// is within 15 % of 3φ. On meshes that resolve the hole it is within 5 % of that, and on those whose edges are from its
// diameter to three times its radius within 35 %: never nothing, never the whole triangle.
TEST(CapsuleTear, HoleTakesItsShareOnAnyMesh) {
  const double fine = loss_by_hole(40);
  EXPECT_NEAR(fine, 1.0, 0.15);
  for (const int n : {20, 30}) EXPECT_NEAR(loss_by_hole(n) / fine, 1.0, 0.05) << n;
  for (const int n : {4, 7, 10}) EXPECT_NEAR(loss_by_hole(n) / fine, 1.0, 0.35) << n;
}

// A second hole at the same place adds to the first until nothing is left, and what was stored there is set free.
TEST(CapsuleTear, OpeningSetsEnergyFree) {
  CapsuleOnBlock block(10, kWidth, sheet_options());
  block.stretch(1.1);
  const double stored = block.capsule->energy();
  double area = 0.0;
  for (int i = 0; i < 60; ++i) area += block.capsule->open_at({0.02, 0.02, 0.0}, 3e-3);
  EXPECT_NEAR(block.capsule->energy() + block.capsule->released_energy(), stored, 1e-12 * stored);
  EXPECT_GT(block.capsule->released_energy(), 0.0);
  EXPECT_NEAR(block.capsule->open_area(), area, 1e-15);
  double torn = 0.0;
  for (std::size_t t = 0; t < block.capsule->triangles().size(); ++t) {
    if (!block.capsule->is_torn(t)) continue;
    torn += 0.5 * std::pow(kWidth / 10, 2);
    EXPECT_EQ(block.capsule->tension()[t], 0.0);
  }
  EXPECT_GE(torn, 4.0 * 0.5 * std::pow(kWidth / 10, 2));
  EXPECT_EQ(block.capsule->events().size(), 60u);
}

// Evenly stretched, the sheet bears up to its strength: just below nothing tears, just above one triangle a step does.
TEST(CapsuleTear, TearsAtItsStrength) {
  const double tension = 1.1 * 800.0 * 0.5 * (1.1 * 1.1 - 1.0) / (1.0 - 1.0 / 3.0);
  for (const double factor : {1.001, 0.999}) {
    CapsuleOptions o = sheet_options();
    o.strength = factor * tension;
    CapsuleOnBlock block(8, kWidth, o);
    block.stretch(1.1);
    EXPECT_EQ(block.capsule->events().size(), factor < 1.0 ? 1u : 0u);
    EXPECT_EQ(block.capsule->open_area() > 0.0, factor < 1.0);
  }
}

/// Largest mean tension anywhere on a stretched sheet with a round hole, over that far from it, and the largest of one
/// triangle.
std::pair<double, double> concentration(int n) {
  CapsuleOptions o = sheet_options();
  o.averaging_length = 5e-3;
  CapsuleOnBlock block(n, kWidth, o);
  block.capsule->open_at({0.5 * kWidth, 0.5 * kWidth, 0.0}, 4e-3);
  const double force = block.stretch(1.02);
  double most = 0.0;
  for (const Triangle& t : block.capsule->triangles()) {
    Vec3d centre{};
    for (const std::uint32_t v : t) centre += block.mesh.vertices[v] * (1.0 / 3.0);
    most = std::max(most, block.capsule->tension_at({centre.x * 1.02, centre.y * 1.02, 0.0}));
  }
  return {most * kWidth / force, block.capsule->largest_tension() * kWidth / force};
}

// At a round hole tension piles up over a length; averaged over 5 mm it changes by less than 5 % from mesh to mesh, whose
// edges are 2, 1.33 and 1 mm, while that of single triangles does by more.
TEST(CapsuleTear, MeanTensionAtAHoleIsThatOfAnyMesh) {
  const auto [coarse, one_coarse] = concentration(20);
  const auto [middle, one_middle] = concentration(30);
  const auto [fine, one_fine] = concentration(40);
  RecordProperty("means", std::to_string(coarse) + " " + std::to_string(middle) + " " + std::to_string(fine));
  RecordProperty("single",
                 std::to_string(one_coarse) + " " + std::to_string(one_middle) + " " + std::to_string(one_fine));
  EXPECT_NEAR(coarse / fine, 1.0, 0.05);
  EXPECT_NEAR(middle / fine, 1.0, 0.05);
  EXPECT_GT(fine, 1.1);
  EXPECT_GT(std::max(std::abs(one_coarse / one_fine - 1.0), std::abs(one_middle / one_fine - 1.0)),
            std::max(std::abs(coarse / fine - 1.0), std::abs(middle / fine - 1.0)));
}

/// Mean tension under a round tip of 1.5 mm radius that presses a sheet held at its rim [N/m].
double under_a_tip(int n, double force) {
  CapsuleOptions o = sheet_options();
  o.averaging_length = 5e-3;
  CapsuleOnBlock block(n, kWidth, o);
  std::vector<Vec3d> x = block.mesh.vertices, loads(x.size()), free(x.size(), Vec3d{1, 1, 1});
  const Vec3d tip{0.5 * kWidth, 0.5 * kWidth, 0.0};
  double sum = 0.0;
  for (const std::uint32_t v : block.mesh.vertex_sets.at("z_max")) {
    const Vec3d d = x[v] - tip;
    loads[v].z = -std::exp(-dot(d, d) / (1.5e-3 * 1.5e-3));
    sum += loads[v].z;
    x[v].z = -3e-3 * std::sin(std::numbers::pi * x[v].x / kWidth) * std::sin(std::numbers::pi * x[v].y / kWidth);
    if (block.is_rim(v)) free[v] = {};
  }
  for (Vec3d& f : loads) f = f * (-force / sum);
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (block.mesh.vertices[v].z < -1e-9) free[v] = {};
  }
  block.rest_at(x, loads, free);
  Vec3d deepest = tip;
  deepest.z = -1.0;
  return block.capsule->tension_at(deepest);
}

// The mean tension under a pressing tip, and with it the force at which the capsule tears there, changes by less than 5 %
// between meshes with edges of 2, 1.33 and 1 mm.
TEST(CapsuleTear, TensionUnderATipIsThatOfAnyMesh) {
  const double coarse = under_a_tip(20, 0.5), middle = under_a_tip(30, 0.5), fine = under_a_tip(40, 0.5);
  RecordProperty("tensions", std::to_string(coarse) + " " + std::to_string(middle) + " " + std::to_string(fine));
  EXPECT_NEAR(coarse / fine, 1.0, 0.05);
  EXPECT_NEAR(middle / fine, 1.0, 0.05);
}

TEST(CapsuleTear, RefusesWhatIsNoTriangleOrHole) {
  CapsuleOnBlock block(4, kWidth, sheet_options());
  EXPECT_THROW(block.capsule->tear(32), std::invalid_argument);
  EXPECT_THROW(block.capsule->open_at({}, 0.0), std::invalid_argument);
  EXPECT_THROW(block.capsule->open_at({}, -1e-3), std::invalid_argument);
  block.capsule->tear(31);
  EXPECT_TRUE(block.capsule->is_torn(31));
}

}  // namespace
}  // namespace glisson

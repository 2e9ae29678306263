// indented_layer_test.cpp — a layer under an indenter against closed forms, published factors of thin layers, its own mesh
// and what scales.
#include "lab/indented_layer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glisson::lab::indented_layer_test {
namespace {

constexpr double kMu = 1000.0, kRadius = 1e-3, kDegree = std::numbers::pi / 180.0;
constexpr std::array kPoissons{0.45, 0.49, 0.4999};

HyperelasticLaw neo_hooke(double poisson) {
  return NeoHookean{kMu, 2.0 * kMu * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson))};
}

/// Forces over E/(1 − ν²) times the closed form of a thick layer.
std::vector<double> factors(const Layer& layer, const Indenter& indenter, double poisson,
                            const std::vector<double>& depths, double fineness = 1.0) {
  IndentedLayer body(layer, indenter, neo_hooke(poisson), depths.back(), fineness);
  std::vector<double> list;
  for (const double d : depths)
    list.push_back(body.press(d) / (2.0 * kMu / (1.0 - poisson) * thick_layer_force(indenter, d)));
  return list;
}

// Hertz: a ball on a half-space, 1 % of force while the contact is a tenth of its radius. The mesh is made for the deepest: at a
// sixth of it, four tenths of the contact's radius, it is as good.
TEST(IndentedLayer, SphereOnAHalfSpaceIsHertz) {
  const Indenter ball{.shape = IndenterShape::sphere, .radius = kRadius};
  const double deepest = 0.01 * kRadius;
  for (const double poisson : kPoissons) {
    for (const double f : factors({}, ball, poisson, {deepest / 6.0, deepest / 3.0, deepest}))
      EXPECT_NEAR(f, 1.0, 0.01) << poisson;
  }
}

// Boussinesq and Sneddon: a flat punch on a half-space, 1 %.
TEST(IndentedLayer, FlatPunchOnAHalfSpaceIsBoussinesqs) {
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius};
  for (const double poisson : kPoissons) EXPECT_NEAR(factors({}, punch, poisson, {1e-3 * kRadius}).front(), 1.0, 0.01);
}

/// Force over E* of a punch with a rounded edge, r²/(2ρ) beyond a face of radius b, at a radius a of contact, and its depth
/// [Sneddon1965]: δ = a ∫ f′/√(a² − x²) dx, F = 2 E* ∫ x² f′/√(a² − x²) dx, f′ = (x − b)/ρ from b to a.
struct Rounded {
  double depth, force;
};
Rounded rounded_punch(double a, double b, double rho) {
  const double root = std::sqrt(a * a - b * b), angle = std::acos(b / a);
  return {a / rho * (root - b * angle),
          2.0 / rho * (root * (b * b + 2.0 * a * a) / 3.0 - 0.5 * b * (a * a * angle + b * root))};
}

// A rounded edge: contact begins on the face and spreads over the edge as far as Sneddon's equations say, 1.5 % of force at every
// depth beyond a hundredth of the radius: what three elements over the edge resolve.
TEST(IndentedLayer, RoundedPunchOnAHalfSpaceIsSneddons) {  // long
  const double rho = 0.2 * kRadius, face = kRadius - rho;
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius, .edge_radius = rho};
  IndentedLayer body({}, punch, neo_hooke(0.49), 0.04 * kRadius);
  for (const double contact : {1.03, 1.04, 1.05}) {
    const Rounded exact = rounded_punch(contact * face, face, rho);
    ASSERT_LT(exact.depth, 0.04 * kRadius);
    EXPECT_NEAR(body.press(exact.depth) / (2.0 * kMu / (1.0 - 0.49) * exact.force), 1.0, 0.015) << contact;
  }
}

// A sharp frictionless punch ends at a depth of a quarter of its radius or so; one with an edge of a tenth of it goes to 0.6 of its
// radius in a thick layer, to 0.3 in one as thick as it is wide, 1 % whatever the mesh.
TEST(IndentedLayer, RoundedPunchGoesWhereASharpOneCannot) {  // long
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius, .edge_radius = 0.1 * kRadius};
  for (const Layer& layer : {Layer{}, Layer{.thickness = 2e-3}}) {
    for (const HyperelasticLaw& law :
         std::initializer_list<HyperelasticLaw>{NeoHookean{kMu, 1e6}, Ogden{{kMu}, {-10.0}, 1e6}}) {
      const double deepest = layer.thick() ? 6e-4 : 3e-4;
      IndentedLayer coarse(layer, punch, law, deepest), fine(layer, punch, law, deepest, 1.4);
      for (const double d : {1e-4, 2e-4, deepest})
        EXPECT_NEAR(coarse.press(d) / fine.press(d), 1.0, 0.01) << law_name(law) << " " << layer.thickness << " " << d;
    }
  }
}

// Sneddon: a blunt cone, whose strains of 2° are small at every depth, 1 %.
TEST(IndentedLayer, BluntConeOnAHalfSpaceIsSneddons) {
  const Indenter cone{.shape = IndenterShape::cone, .half_angle = 88.0 * kDegree};
  for (const double poisson : kPoissons) {
    for (const double f : factors({}, cone, poisson, {3e-5, 6e-5, 1e-4})) EXPECT_NEAR(f, 1.0, 0.01) << poisson;
  }
}

// Thin layers bonded to their floor: κ of Hayes et al. [Hayes1972], here by the integral equation to 1e-9, which theirs meet
// within 0.3 %. Nearly incompressible layers half as thick as the punch's radius are nine times as stiff as a half-space, and
// do not lock.
TEST(IndentedLayer, ThinBondedLayersHaveThePublishedFactors) {
  struct Row {
    double ratio, poisson, kappa;
  };
  const std::vector<Row> published{{0.2, 0.30, 1.2066},   {0.2, 0.45, 1.2523},    {0.2, 0.49, 1.2741},
                                   {0.2, 0.4999, 1.2806}, {1.0, 0.30, 2.4835},    {1.0, 0.45, 3.0914},
                                   {1.0, 0.49, 3.4840},   {1.0, 0.49999, 3.6187}, {2.0, 0.30, 4.3532},
                                   {2.0, 0.45, 6.4206},   {2.0, 0.49, 8.3370},    {2.0, 0.49999, 9.1495}};
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius};
  for (const auto& [ratio, poisson, kappa] : published) {
    const Layer layer{.thickness = kRadius / ratio};
    EXPECT_NEAR(factors(layer, punch, poisson, {1e-4 * kRadius}).front() / kappa, 1.0, 0.01) << ratio << " " << poisson;
  }
}

// A ball on a thin layer: with every length and the depth scaled alike forces scale as their square, and with the moduli; a
// half-space and a layer of 400 radii of contact differ by 1.1 a/h of 0.3 %.
TEST(IndentedLayer, ScalesAndJoinsTheHalfSpace) {
  const Indenter ball{.shape = IndenterShape::sphere, .radius = kRadius},
      large{.shape = IndenterShape::sphere, .radius = 7e-3};
  const Ogden law{{1000.0}, {-8.0}, 1e6}, stiff{{3000.0}, {-8.0}, 3e6};
  IndentedLayer one({.thickness = 2e-3}, ball, law, 6e-4), other({.thickness = 14e-3}, large, stiff, 4.2e-3);
  for (const double d : {1e-4, 3e-4, 6e-4}) EXPECT_NEAR(other.press(7.0 * d) / (147.0 * one.press(d)), 1.0, 1e-6);
  const double half = factors({}, ball, 0.45, {1e-5}).front();
  const double thick = factors({.thickness = 400.0 * 1e-4}, ball, 0.45, {1e-5}).front();
  EXPECT_NEAR(thick / half, 1.0, 0.006);
}

// Elements smaller by a third change no force by more than 1.5 % (a sharp punch, 2 %), at 30 % of the thickness (a punch, 20 %) and
// with laws that stiffen forty times.
TEST(IndentedLayer, IsConvergedInItsMesh) {  // long
  const Layer layer{.thickness = 2e-3};
  const std::vector<HyperelasticLaw> laws{NeoHookean{kMu, 1e6}, Ogden{{kMu}, {-10.0}, 1e6}, Yeoh{500, 300, 300, 1e6}};
  const std::vector<Indenter> indenters{{IndenterShape::sphere, kRadius, 0.0, IndenterContact::frictionless},
                                        {IndenterShape::sphere, kRadius, 0.0, IndenterContact::bonded},
                                        {IndenterShape::cone, 0.0, 60.0 * kDegree, IndenterContact::frictionless},
                                        {IndenterShape::flat, kRadius, 0.0, IndenterContact::bonded}};
  for (const HyperelasticLaw& law : laws) {
    for (const Indenter& indenter : indenters) {
      IndentedLayer coarse(layer, indenter, law, 6e-4), fine(layer, indenter, law, 6e-4, 1.5);
      const bool flat = indenter.shape == IndenterShape::flat;
      for (const double d : flat ? std::vector{1e-4, 4e-4} : std::vector{1e-4, 2e-4, 4e-4, 6e-4})
        EXPECT_NEAR(coarse.press(d) / fine.press(d), 1.0, flat ? 0.02 : 0.015)
            << law_name(law) << " " << words_of(indenter) << " " << d;
    }
  }
}

// Every law and kind of contact can be followed to 60 % of the thickness by a ball as large as half of it; sticking resists more.
TEST(IndentedLayer, GoesFar) {
  const Layer layer{.thickness = 2e-3};
  for (const HyperelasticLaw& law : std::initializer_list<HyperelasticLaw>{
           NeoHookean{kMu, 1e6}, Ogden{{kMu}, {-10.0}, 1e6}, Yeoh{500, 300, 300, 1e6}}) {
    IndentedLayer slides(layer, {IndenterShape::sphere, kRadius, 0.0, IndenterContact::frictionless}, law, 1.2e-3);
    IndentedLayer sticks(layer, {IndenterShape::sphere, kRadius, 0.0, IndenterContact::bonded}, law, 1.2e-3);
    double less = 0.0;
    for (const double d : {3e-4, 6e-4, 9e-4, 1.2e-3}) {
      const double force = slides.press(d);
      EXPECT_GT(force, less);
      EXPECT_GT(sticks.press(d), 0.998 * force);
      less = force;
    }
  }
}

// A floor without friction and a free side make a layer softer.
TEST(IndentedLayer, WhatHoldsTheLayerMatters) {
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius};
  const auto at = [&](const Layer& layer) { return factors(layer, punch, 0.49, {1e-4 * kRadius}).front(); };
  const double bonded = at({.thickness = kRadius}), smooth = at({.thickness = kRadius, .bonded_floor = false});
  const double narrow = at({.thickness = kRadius, .radius = 1.5 * kRadius});
  const double wide = at({.thickness = kRadius, .radius = 12.0 * kRadius});
  EXPECT_LT(smooth, 0.8 * bonded);
  EXPECT_LT(narrow, 0.9 * bonded);
  EXPECT_NEAR(wide / bonded, 1.0, 0.002);
}

// The engine's own contact in three dimensions, of a ball of 3 mm radius pressed 1.8 mm into a layer of 6 mm that slides on its
// floor, neo-Hookean with κ = 10 μ: a quarter of a block of 30 × 30 mm, run with
//   glisson run: box of 15 × 15 × 6 mm, instrument "ball", frictionless, volume_change = "average_nodal", 9 mm/s and damping
// carries 6.838 mN on cells of 0.75 mm and 6.460 mN on cells of half the size. Their errors fall with the square of the size: 6.334 mN.
// The cylinder here has the block's area. Half a percent is left.
TEST(IndentedLayer, IsTheEnginesContactInThreeDimensions) {
  const double coarse = 6.838e-3, fine = 6.460e-3, limit = fine - (coarse - fine) / 3.0;
  const double radius = 0.03 / std::sqrt(std::numbers::pi);
  IndentedLayer body({.thickness = 6e-3, .radius = radius, .bonded_floor = false},
                     {.shape = IndenterShape::sphere, .radius = 3e-3}, NeoHookean{1000, 1e4}, 1.8e-3);
  EXPECT_NEAR(0.25 * body.press(1.8e-3), limit, 0.005 * limit);
}

std::string fault(const Layer& layer, const Indenter& indenter, double depth) {
  try {
    IndentedLayer(layer, indenter, NeoHookean{kMu, 1e6}, depth).press(depth);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no fault";
}

// What cannot be followed is told, with the way out.
TEST(IndentedLayer, RefusesWhatItCannotFollow) {
  using ::testing::HasSubstr;
  const Indenter punch{.shape = IndenterShape::flat, .radius = kRadius};
  EXPECT_THAT(fault({.thickness = 2e-3}, punch, 2e-3), HasSubstr("a depth of 2 mm in a layer of 2 mm"));
  EXPECT_THAT(fault({.thickness = 2e-3, .radius = 5e-4}, punch, 1e-4), HasSubstr("is wider than the specimen"));
  EXPECT_THAT(fault({.thickness = 2e-3}, punch, 6e-4),
              HasSubstr("give the edge_radius_mm that a real punch has, or contact = \"bonded\""));
}

}  // namespace
}  // namespace glisson::lab::indented_layer_test

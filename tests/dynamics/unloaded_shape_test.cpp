// Inverse statics: a body that is unloaded and loaded again is where it was; a column against its own equation; where there is no
// unloaded shape, the search says at which load it ends.
#include "glisson/simulation/unloaded_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glisson/instruments/capsule.h"
#include "material/every_tissue.h"
#include "support/bodies.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Setup = std::function<void(Simulation&, double share)>;

/// A body that rests on a set and bears its weight.
struct Heavy {
  TetMesh mesh;
  Tissue tissue;
  Vec3d gravity;
  Setup setup = [](Simulation& s, double) { s.fix("z_min"); };

  Simulation at_rest_in(TetMesh rest, double share, double ramp = 0.0) const {
    SimulationOptions o;
    o.integrator = Integrator::quasi_static;
    o.branches = StaticBranches::relaxed;
    o.gravity = gravity * share;
    o.gravity_ramp = ramp;
    o.implicit.tolerance = 1e-11;
    Simulation s(std::move(rest), {{0, tissue}}, o);
    setup(s, share);
    return s;
  }
  UnloadedShape unloaded() const {
    return find_unloaded_shape(mesh, [this](TetMesh rest, double share) { return at_rest_in(std::move(rest), share); });
  }
  /// Places of the body that was unloaded to `rest` under its weight, which grows in parts.
  std::vector<Vec3d> loaded(const std::vector<Vec3d>& rest) const {
    TetMesh unloaded = mesh;
    unloaded.vertices = rest;
    Simulation s = at_rest_in(unloaded, 1.0, 0.5);
    EXPECT_TRUE(s.advance_to(0.5).made());
    return s.positions();
  }
  double size() const {
    const auto [low, high] = box_of(mesh);
    return norm(high - low);
  }
};

double farthest(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double most = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, norm(a[v] - b[v]));
  return most;
}

TetMesh turned(TetMesh mesh) {
  for (Vec3d& x : mesh.vertices) x = {x.x, 0.8 * x.y - 0.6 * x.z, 0.6 * x.y + 0.8 * x.z};
  return mesh;
}

std::vector<TetMesh> bodies() {
  std::mt19937 random(11);
  return {test::jittered_box({3, 3, 4}, 0.01, 0.25, random),
          turned(box_mesh({.cells = {2, 4, 3}, .size = {0.03, 0.05, 0.02}})),
          test::jittered_box({2, 2, 6}, 0.01, 0.1, random)};
}

/// Stiffness in shear at rest after long times, which its weight is measured by [Pa].
double long_time_modulus(const Tissue& tissue) {
  double left = 1.0;
  for (const MaxwellBranch& branch : tissue.maxwell) left -= branch.share;
  return left * tissue.lame().mu;
}

/// Whether statics has no definite answer: forces jump where another corner of a tet becomes the sharpest, and with the raw mean ratio
/// the energy is not the least at rest, so that one load has several equilibria.
bool is_ambiguous(const Tissue& tissue) {
  return tissue.law_form == LawForm::energy && !tissue.hyperelastic &&
         (tissue.measure == DeformationMeasure::solid_angle ||
          tissue.measure == DeformationMeasure::regular_mean_ratio);
}

// Every law, with fibres, viscosity, branches and shared volumes, on three meshes with weights that press, pull and bend: the unloaded
// body, loaded again in parts, is the given one to 1e-6 of its size. Weights shift vertices by 1 to 20 % of it.
TEST(UnloadedShape, EveryLawGivesTheLoadedShapeBack) {
  const std::vector<TetMesh> meshes = bodies();
  const std::array<Vec3d, 3> down{Vec3d{0.0, 0.0, -1.0}, {0.0, 0.6, 0.8}, {0.3, 0.0, 0.2}};
  const std::array<double, 3> weight{0.3, 0.3, 0.04};
  std::size_t i = 0;
  for (const Tissue& tissue : test::all_tissues()) {
    if (is_ambiguous(tissue)) continue;
    const std::size_t k = i++ % meshes.size();
    Heavy body{meshes[k], tissue, {}};
    body.gravity = down[k] * (weight[k] * long_time_modulus(tissue) / (tissue.density * body.size()));
    SCOPED_TRACE(tissue.name);
    const UnloadedShape found = body.unloaded();
    EXPECT_GT(found.figures.largest_shift, 0.01 * body.size());
    EXPECT_LE(farthest(body.loaded(found.rest), body.mesh.vertices), 1e-6 * body.size());
  }
  EXPECT_GT(i, 100U);
}

/// P of a neo-Hookean solid that is stretched along one axis and held along the others: W = μ/2 (λ^(−⅔) (λ² + 2) − 3) + κ/2 (λ − 1)².
double confined_stress(const NeoHookean& law, double stretch) {
  return law.mu * 2.0 / 3.0 * (std::cbrt(stretch) - std::pow(stretch, -5.0 / 3.0)) + law.bulk_modulus * (stretch - 1.0);
}

/// The stretch at a stress, by bisection.
double confined_stretch(const NeoHookean& law, double stress) {
  double low = 1e-3, high = 10.0;
  for (int i = 0; i < 100; ++i) (confined_stress(law, 0.5 * (low + high)) < stress ? low : high) = 0.5 * (low + high);
  return low;
}

// A neo-Hookean column that cannot widen under its own weight: at a depth D of the unloaded column P(λ) = −ρ g D, and its loaded depth
// is ∫ λ dD. All vertices are where this has them to 0.1 % of what the top moves by.
TEST(UnloadedShape, ColumnUnderItsWeightHasItsOwnEquation) {
  const NeoHookean law{.mu = 1000.0, .bulk_modulus = 4000.0};
  const double height = 0.2, g = 9.81;
  Heavy column{box_mesh({.cells = {1, 1, 60}, .size = {0.01, 0.01, height}}), {}, {0.0, 0.0, -g}};
  column.tissue.hyperelastic = law;
  const double density = column.tissue.density;
  column.setup = [](Simulation& s, double) {
    s.fix("z_min", {false, false, true});
    s.fix(test::all_vertices(s.mesh()), {true, true, false});
  };
  const UnloadedShape found = column.unloaded();

  std::vector<std::pair<double, double>> depths{{0.0, 0.0}};  // loaded, unloaded
  for (const double dD = 1e-5; depths.back().first < height;) {
    const auto [d, D] = depths.back();
    depths.emplace_back(d + dD * confined_stretch(law, -density * g * (D + 0.5 * dD)), D + dD);
  }
  const auto unloaded_depth = [&](double loaded) {
    const auto after = std::lower_bound(depths.begin() + 1, depths.end() - 1, std::pair{loaded, 0.0});
    const auto before = after - 1;
    return std::lerp(before->second, after->second, (loaded - before->first) / (after->first - before->first));
  };
  const double whole = unloaded_depth(height), shift = whole - height;
  EXPECT_GT(shift, 0.03) << "a fifth of the column";
  for (std::size_t v = 0; v < found.rest.size(); ++v) {
    const double expected = whole - unloaded_depth(height - column.mesh.vertices[v].z);
    EXPECT_NEAR(found.rest[v].z, expected, 1e-3 * shift);
  }
}

// A linear column that cannot widen, of modulus M: H unloaded becomes H − ρ g H²/(2 M) under its weight, at most M/(2 ρ g). A taller one
// has no unloaded shape, and the search ends at the share of the weight under which this is its height.
TEST(UnloadedShape, ColumnThatIsTooTallEndsAtItsLoad) {
  const double height = 0.1, share = 0.4;
  Heavy column{box_mesh({.cells = {1, 1, 40}, .size = {0.01, 0.01, height}}), {}, {}};
  const LameParameters lame = column.tissue.lame();
  const double modulus = lame.lambda + 2.0 * lame.mu;
  column.gravity = {0.0, 0.0, -modulus / (2.0 * column.tissue.density * height) / share};
  column.setup = [](Simulation& s, double) {
    s.fix("z_min", {false, false, true});
    s.fix(test::all_vertices(s.mesh()), {true, true, false});
  };
  try {
    column.unloaded();
    FAIL() << "there is no unloaded shape";
  } catch (const NoUnloadedShape& error) {
    EXPECT_LE(error.share(), 1.01 * share);
    EXPECT_GE(error.share(), 0.94 * share);
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("no unloaded shape was found beyond 3"), HasSubstr("% of gravity and loads"),
                      HasSubstr("youngs_modulus_Pa"), HasSubstr("start = \"rest\"")));
  }
}

// Supine to prone and back: the body that hangs the other way is unloaded to the same shape, and laid back it is where it was, to 0.01 mm.
TEST(UnloadedShape, GravityTurnsAndComesBack) {
  Heavy supine{box_mesh({.cells = {5, 4, 3}, .size = {0.12, 0.09, 0.06}}), {}, {0.0, 0.0, -9.81}};
  supine.tissue.youngs_modulus = 5000.0, supine.tissue.poisson_ratio = 0.4;
  supine.tissue.kinematics = Kinematics::corotational;
  supine.setup = [](Simulation& s, double) {
    s.fix("x_min");
    s.add_surface_load("z_min", {.spring_per_area = {2e4, 2e4, 5e4}});
  };
  Heavy prone = supine;
  prone.gravity = -supine.gravity;
  const UnloadedShape rest = supine.unloaded();
  prone.mesh.vertices = prone.loaded(rest.rest);
  EXPECT_GT(farthest(prone.mesh.vertices, supine.mesh.vertices), 5e-3);
  const UnloadedShape again = prone.unloaded();
  EXPECT_LE(farthest(again.rest, rest.rest), 1e-5);
  EXPECT_LE(farthest(supine.loaded(again.rest), supine.mesh.vertices), 1e-5);
}

// What else acts is in the balance: a stretched capsule, a pressure that follows, a traction, springs, a set that is held along one axis.
TEST(UnloadedShape, EverythingThatActsIsInTheBalance) {
  std::mt19937 random(3);
  Heavy body{test::jittered_box({4, 4, 4}, 0.01, 0.2, random), {}, {0.0, 3.0, -9.81}};
  body.tissue.hyperelastic = NeoHookean{.mu = 900.0, .bulk_modulus = 6000.0};
  body.setup = [](Simulation& s, double share) {
    s.fix("z_min", {false, false, true});
    s.add_surface_load("z_min", {.spring_per_area = {1e5, 1e5, 0.0}});
    s.add_surface_load("z_max", {.pressure = 120.0 * share, .follows = true});
    s.add_surface_load("x_max", {.traction = Vec3d{-40.0, 20.0, 0.0} * share});
    s.attach(std::make_shared<Capsule>(CapsuleOptions{.thickness = 1e-4, .youngs_modulus = 1e5, .prestretch = 1.05}));
  };
  const UnloadedShape found = body.unloaded();
  EXPECT_GT(found.figures.largest_shift, 0.03 * body.size());
  EXPECT_NE(found.figures.volume, found.figures.unloaded_volume);
  EXPECT_LE(farthest(body.loaded(found.rest), body.mesh.vertices), 1e-6 * body.size());
}

TEST(UnloadedShape, WhatCannotBeUnloadedIsRefused) {
  Heavy body{test::paper_mesh(), {}, {0.0, 0.0, -9.81}};
  const auto message = [&](auto find) {
    try {
      find();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  body.setup = [](Simulation& s, double) { s.fix("z_min", {true, true, false}); };
  EXPECT_THAT(message([&] { body.unloaded(); }), HasSubstr("along z"));
  const auto explicit_body = [&](TetMesh rest, double) { return Simulation(std::move(rest), {{0, Tissue{}}}); };
  EXPECT_THAT(message([&] { find_unloaded_shape(body.mesh, explicit_body); }), HasSubstr("quasi_static"));
  EXPECT_THAT(message([&] { find_unloaded_shape(body.mesh, explicit_body, {.most_iterations = 0}); }),
              HasSubstr("most_iterations"));
}

}  // namespace
}  // namespace glisson

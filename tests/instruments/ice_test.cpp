// Tissue that freezes keeps its force, meets the stiffness of ice from then on, and goes by its own law again when it has thawed; what
// that does to its energy is in the books.
#include "glisson/instruments/ice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson::ice_test {
namespace {

constexpr double kE = 4000.0, kSide = 0.02, kLength = 0.04;

Tissue bar_tissue() {
  Tissue t;
  t.youngs_modulus = kE, t.poisson_ratio = 0.0;
  return t;
}

std::vector<std::uint32_t> all_tets(const Simulation& s) {
  std::vector<std::uint32_t> tets(s.mesh().tets.size());
  std::iota(tets.begin(), tets.end(), 0U);
  return tets;
}

void freeze(Ice& ice, Simulation& s, double share) {
  const std::vector<std::uint32_t> tets = all_tets(s);
  ice.set_shares(s, tets, std::vector<double>(tets.size(), share));
}

/// A bar along z without lateral contraction, whose end is drawn to strains, one after the other, and held there for a while.
struct Bar {
  Simulation s;
  ConstraintId end;
  std::shared_ptr<Ice> ice;

  /// @param stretches  strains at times 0, 1, 2 … of `unit`, with rests between them
  Bar(Integrator integrator, std::vector<double> strains, const IceOptions& options, double unit = 1.0)
      : s(box_mesh({.cells = {2, 2, 4}, .size = {kSide, kSide, kLength}}), {{0, bar_tissue()}}, simulation(integrator)),
        ice(std::make_shared<Ice>(options)) {
    s.fix("z_min");
    const auto course = [strains, unit](double t) {
      const double at = std::min(t / unit, static_cast<double>(strains.size() - 1));
      const auto k = std::min(static_cast<std::size_t>(at), strains.size() - 2);
      const double x =
          std::clamp(2.0 * (at - static_cast<double>(k)) - 0.5, 0.0, 1.0);  // rests for a quarter at both ends
      return Vec3d{0.0, 0.0, kLength * std::lerp(strains[k], strains[k + 1], x * x * (3.0 - 2.0 * x))};
    };
    std::vector<double> corners;
    for (std::size_t k = 0; k < strains.size(); ++k)
      corners.push_back((static_cast<double>(k) + 0.25) * unit),
          corners.push_back((static_cast<double>(k) + 0.75) * unit);
    end = s.drive("z_max", Motion{course, CornerTimes(corners)});
    s.attach(ice);
  }
  static SimulationOptions simulation(Integrator integrator) {
    SimulationOptions o{.integrator = integrator, .precision = Precision::double_precision, .damping_rate = 150.0};
    o.implicit.tolerance = 1e-11;
    if (integrator == Integrator::quasi_static) o.damping_rate = 0.0;
    return o;
  }
  void to(double time) {
    s.set_step_end(time);
    while (s.time() + 0.5 * s.step_size() < time) test::must_step(s);
  }
  double force() const { return s.force(end).total().z; }
};

/// Of tissue alone, whose law is linear in the displacement gradient [N].
double tissue_force(double strain) { return kE * strain * kSide * kSide; }
/// Of ice that formed at a strain: J_f = 1 + e_f, F_r = (1 + e)/(1 + e_f), σ = E per unit of Green strain.
double ice_force(double amount, double formed, double strain) {
  const double ratio = (1.0 + strain) / (1.0 + formed);
  return amount * kE * kSide * kSide * ratio * 0.5 * (ratio * ratio - 1.0);
}
double ice_energy(double amount, double formed, double strain) {
  const double ratio = (1.0 + strain) / (1.0 + formed), green = 0.5 * (ratio * ratio - 1.0);
  return 0.5 * amount * kE * green * green * (1.0 + formed) * kSide * kSide * kLength;
}

class IceInEach : public testing::TestWithParam<Integrator> {};

// A bar is drawn to 5 %, frozen there, drawn to 5.5 %, thawed by half and in full. Its ends are held in all components and its sides are
// free, with ν = 0: uniaxial strain and a closed form. At rests all motion has gone but for what damping leaves of it.
TEST_P(IceInEach, BarKeepsItsForceAndMeetsTheStiffnessOfIce) {
  constexpr double kFactor = 20.0, kFormed = 0.05, kDrawn = 0.055;
  Bar bar(GetParam(), {0.0, kFormed, kDrawn, kDrawn}, {.factor = kFactor});
  bar.to(1.0);
  const double before = bar.force();
  EXPECT_NEAR(before, tissue_force(kFormed), 1e-6 * before);
  const double step = bar.s.stable_step();
  freeze(*bar.ice, bar.s, 1.0);
  EXPECT_EQ(bar.ice->frozen_tets(), bar.s.mesh().tets.size());
  EXPECT_EQ(bar.ice->changed_energy(), 0.0);
  if (std::isfinite(step)) {
    EXPECT_NEAR(bar.s.stable_step() / step, 1.0 / std::sqrt(kFactor), 0.25 / std::sqrt(kFactor));
  }
  test::must_step(bar.s);
  EXPECT_NEAR(bar.force(), before, 1e-6 * before);
  bar.to(2.0);
  const double drawn = tissue_force(kDrawn) + ice_force(kFactor - 1.0, kFormed, kDrawn);
  EXPECT_NEAR(bar.force(), drawn, 1e-6 * drawn);
  const double stored = ice_energy(kFactor - 1.0, kFormed, kDrawn);
  EXPECT_NEAR(bar.ice->energy(), stored, 1e-6 * stored);
  freeze(*bar.ice, bar.s, 0.5);
  EXPECT_NEAR(bar.ice->changed_energy(), -0.5 * stored, 1e-6 * stored);
  bar.to(2.7);
  const double half = tissue_force(kDrawn) + 0.5 * ice_force(kFactor - 1.0, kFormed, kDrawn);
  EXPECT_NEAR(bar.force(), half, 1e-6 * half);
  freeze(*bar.ice, bar.s, 0.0);
  EXPECT_EQ(bar.ice->frozen_tets(), 0U);
  bar.to(3.0);
  EXPECT_NEAR(bar.force(), tissue_force(kDrawn), 1e-6 * before);
  if (std::isfinite(step)) {
    EXPECT_NEAR(bar.s.stable_step(), step, 1e-9 * step);
  }
  EXPECT_NEAR(bar.ice->changed_energy(), -stored, 1e-6 * stored);
}

// The books close in every scheme, with ice that forms bit by bit while the bar moves, and melts.
TEST_P(IceInEach, BooksClose) {
  Bar bar(GetParam(), {0.0, 0.04, -0.02, 0.03}, {.factor = 30.0, .expansion = 0.02}, 0.2);
  double largest = 0.0;
  for (int k = 1; k <= 60; ++k) {
    bar.to(0.01 * k);
    freeze(*bar.ice, bar.s, 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * k / 30.0));
    const Energies e = bar.s.energies();
    largest = std::max({largest, std::abs(e.elastic), std::abs(e.work_tools), std::abs(e.changed)});
    EXPECT_LT(std::abs(e.imbalance()), 1e-10 * largest) << k;
  }
  EXPECT_NE(bar.s.energies().changed, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, IceInEach, testing::ValuesIn(test::every_integrator()),
                         [](const auto& x) { return std::string(word_of(x.param)); });

// Work of the elastic forces, with what the ice has lost, is what is stored, up to the time integration: second order where
// nothing jumps, so that half the step leaves a quarter. The bar freezes at its start and is drawn.
TEST(Ice, StoredEnergyIsTheWork) {
  const auto drift = [](double step) {
    SimulationOptions o{.step = step, .precision = Precision::double_precision};
    Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, bar_tissue()}}, o);
    s.fix("z_min");
    s.drive("z_max", press({.velocity = 0.02, .depth = 0.004}));
    const auto ice = std::make_shared<Ice>(IceOptions{.factor = 10.0});
    s.attach(ice);
    freeze(*ice, s, 1.0);
    while (s.time() < 0.15 - 0.5 * step) test::must_step(s);
    EXPECT_GT(s.stored_energy().value(), 1e-3);
    return s.energy_drift().value() / s.stored_energy().value();
  };
  const double coarse = drift(2e-4), fine = drift(1e-4);
  EXPECT_LT(std::abs(coarse), 2e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);
}

// A frozen body that turns as a whole has no force of ice, whatever the angle.
TEST(Ice, DoesNotSeeRotations) {
  Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, bar_tissue()}});
  const auto ice = std::make_shared<Ice>();
  s.attach(ice);
  freeze(*ice, s, 1.0);
  std::vector<Vec3d> u;
  for (const Vec3d& x : s.mesh().vertices) u.push_back(Vec3d{-x.y, x.x, x.z} - x + Vec3d{0.3, 0.0, 0.0});
  s.set_state(u, std::vector<Vec3d>(u.size()));
  EXPECT_LT(ice->energy(), 1e-25);
}

// A free cube that freezes bit by bit with an expansion of 9 % grows by nearly that; its tissue holds back the first ice, of little
// stiffness, and 1/100 of the last.
TEST(Ice, GrowsByItsExpansion) {
  Tissue t = bar_tissue();
  t.poisson_ratio = 0.3, t.kinematics = Kinematics::green;
  SimulationOptions o{.integrator = Integrator::quasi_static};
  Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, t}}, o);
  s.fix("x_min", {true, false, false});
  s.fix("y_min", {false, true, false});
  s.fix("z_min", {false, false, true});
  const auto ice = std::make_shared<Ice>(IceOptions{.factor = 100.0, .expansion = 0.09});
  s.attach(ice);
  for (int k = 1; k <= 20; ++k) {
    freeze(*ice, s, 0.05 * k);
    test::must_step(s);
  }
  TetMesh grown = s.mesh();
  grown.vertices = s.positions();
  EXPECT_NEAR(volume(grown) / volume(s.mesh()), 1.0875, 0.0015);
  freeze(*ice, s, 0.0);
  test::must_step(s);
  grown.vertices = s.positions();
  EXPECT_NEAR(volume(grown), volume(s.mesh()), 1e-9 * volume(grown));
}

// Viscosity of ice: a bar that is frozen by half, with 7 times the viscosity, resists an even motion by 1 + ½ 6 times its tissue's force.
TEST(Ice, HasItsViscosity) {
  Tissue t = bar_tissue();
  t.viscosity = 50.0;
  SimulationOptions o{.integrator = Integrator::implicit, .step = 1e-3};
  o.implicit.tolerance = 1e-11;
  const auto force = [&](double viscosity_factor) {
    Simulation s(box_mesh({.cells = {1, 1, 2}, .size = {kSide, kSide, kLength}}), {{0, t}}, o);
    s.fix("z_min");
    const ConstraintId end = s.drive("z_max", [](double time) { return Vec3d{0.0, 0.0, 1e-3 * time}; });
    const auto ice = std::make_shared<Ice>(IceOptions{.factor = 2.0, .viscosity_factor = viscosity_factor});
    s.attach(ice);
    freeze(*ice, s, 0.5);
    for (int k = 0; k < 300; ++k) test::must_step(s);
    EXPECT_LT(std::abs(s.energies().imbalance()), 1e-9 * s.energies().work_tools);
    return s.force(end).viscous.z;
  };
  const double rate = 1e-3 / kLength, plain = 2.0 * t.viscosity * rate * kSide * kSide;  // σ_v = 2 η ε̇
  const double stretch = 1.0 + 0.3 * rate, more = 0.5 * 6.0 * stretch * stretch;         // P = F 2 η Ė, Ė = F Ḟ
  EXPECT_NEAR(force(1.0), plain, 1e-3 * plain);
  EXPECT_NEAR(force(7.0), (1.0 + more) * plain, 1e-3 * plain);
}

// A run goes on from a checkpoint, and from a state in memory, with the same bytes.
TEST(Ice, GoesOnFromAStateWithTheSameBytes) {
  for (const Integrator integrator : test::every_integrator()) {
    const auto make = [&] {
      return Bar(integrator, {0.0, 0.04, 0.06, 0.05}, {.factor = 10.0, .expansion = 0.01}, 0.02);
    };
    const auto half_frozen = [](Bar& bar) {
      const std::vector<std::uint32_t> tets{3, 4, 5, 17, 40};
      bar.ice->set_shares(bar.s, tets, std::vector<double>{1.0, 0.3, 0.5, 0.2, 1.0});
    };
    Bar bar = make();
    bar.to(0.02);
    half_frozen(bar);
    bar.to(0.03);
    std::stringstream file;
    bar.s.save(file);
    const State state = bar.s.save_state();
    const auto finish = [](Bar& b) {
      b.ice->set_shares(b.s, std::vector<std::uint32_t>{4, 60}, std::vector<double>{0.0, 1.0});
      b.to(0.05);
      return std::pair(b.s.state_hash(), b.s.energies().changed);
    };
    const auto end = finish(bar);
    bar.s.load_state(state);
    EXPECT_EQ(finish(bar), end) << word_of(integrator);
    Bar other = make();
    other.s.load(file);
    EXPECT_EQ(other.ice->share(4), 0.3);
    EXPECT_EQ(finish(other), end) << word_of(integrator);
  }
}

// Tets that are removed take their ice with them, and the books know.
TEST(Ice, GoesWithItsTets) {
  for (const Integrator integrator : {Integrator::central_difference, Integrator::quasi_static}) {
    Bar bar(integrator, {0.0, 0.05, 0.06}, {.factor = 10.0}, 0.05);
    bar.to(0.03);
    freeze(*bar.ice, bar.s, 1.0);
    bar.to(0.1);
    bar.s.remove_tets(std::vector<std::uint32_t>{30, 31});
    EXPECT_EQ(bar.ice->share(30), 0.0);
    EXPECT_EQ(bar.ice->frozen_tets(), bar.s.mesh().tets.size() - 2);
    EXPECT_LT(bar.ice->changed_energy(), 0.0);
    bar.to(0.12);
    const Energies e = bar.s.energies();
    EXPECT_LT(std::abs(e.imbalance()), 1e-9 * e.work_tools);
  }
}

// What cannot be is refused, by name, with all as it was.
TEST(Ice, RefusesWhatCannotBe) {
  Simulation s(box_mesh({.cells = {1, 1, 1}, .size = {0.02, 0.02, 0.02}}), {{0, bar_tissue()}});
  const auto says = [](const auto& act, const std::string& what) {
    try {
      act();
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
      return;
    }
    ADD_FAILURE() << what;
  };
  const auto ice = std::make_shared<Ice>();
  const std::vector<std::uint32_t> one{0}, none{99};
  const std::vector<double> whole{1.0}, more{1.5};
  says([&] { ice->set_shares(s, one, whole); }, "not attached");
  s.attach(ice);
  says([&] { ice->set_shares(s, none, whole); }, "tet 99 is outside the mesh, 0 to 5");
  says([&] { ice->set_shares(s, one, more); }, "1.5");
  says([&] { ice->set_shares(s, one, {}); }, "one each");
  says([] { Ice(IceOptions{.factor = 0.5}); }, "factor");
  says([&] { s.attach(std::make_shared<Ice>(IceOptions{.viscosity_factor = 3.0})); }, "implicit");
  SimulationOptions given;
  given.step = 0.9 * s.stable_step();
  Simulation strict(box_mesh({.cells = {1, 1, 1}, .size = {0.02, 0.02, 0.02}}), {{0, bar_tissue()}}, given);
  const auto other = std::make_shared<Ice>();
  strict.attach(other);
  says([&] { other->set_shares(strict, one, whole); }, "implicit");
  EXPECT_EQ(other->frozen_tets(), 0U);
  test::must_step(strict);
}

}  // namespace
}  // namespace glisson::ice_test

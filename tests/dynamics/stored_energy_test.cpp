// What is reported as stored is W(u) of the forces; what the work of the elastic forces differs from it is the time integration's,
// and falls with the square of the step.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "glisson/instruments/capsule.h"
#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace glisson::stored_energy_test {
namespace {

constexpr double kEnd = 0.05;

Tissue soft() {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = 0.4;
  return t;
}
Tissue neo_hookean() {
  Tissue t = soft();
  t.hyperelastic = NeoHookean{.mu = 2000.0, .bulk_modulus = 10000.0};
  return t;
}

/// A block pressed by a third of its height, up to the same time in steps of a size.
struct Pressed {
  explicit Pressed(const Tissue& tissue, double step, Integrator integrator = Integrator::central_difference)
      : body(box_mesh({.cells = {3, 3, 3}, .size = {0.03, 0.03, 0.03}}), {{0, tissue}},
             {.integrator = integrator, .step = step, .precision = Precision::double_precision}) {
    body.fix("z_min");
    body.drive("z_max", press({.velocity = 0.2, .depth = 0.01}));
  }
  Pressed& to(double end) {
    while (body.time() < end - 0.5 * body.step_size()) test::must_step(body);
    return *this;
  }
  Simulation body;
};

/// Of the energy stored at the end.
double drift_share(const Tissue& tissue, double step, Integrator integrator = Integrator::central_difference) {
  Pressed p(tissue, step, integrator);
  p.to(kEnd);
  EXPECT_GT(p.body.stored_energy().value(), 1e-4);
  return p.body.energy_drift().value() / p.body.stored_energy().value();
}

TEST(StoredEnergy, OfLinearTissueIsTheWork) {
  EXPECT_LT(std::abs(drift_share(soft(), 2e-4)), 1e-10);
  Tissue relaxing = soft();
  relaxing.maxwell = {{0.4, 0.02}};
  EXPECT_LT(std::abs(drift_share(relaxing, 2e-4)), 1e-10);
}

TEST(StoredEnergy, DriftFallsWithTheSquareOfTheStep) {
  Tissue turned = soft(), averaged = neo_hookean(), law = soft();
  turned.kinematics = Kinematics::corotational;
  averaged.volume_change = VolumeChange::average_nodal;
  law.law = LinearLaw{20000.0}, law.law_form = LawForm::energy;
  for (const Tissue& tissue : {neo_hookean(), averaged, turned, law}) {
    const double coarse = std::abs(drift_share(tissue, 2e-4)), fine = std::abs(drift_share(tissue, 1e-4));
    EXPECT_LT(coarse, 1e-3);
    EXPECT_NEAR(coarse / fine, 4.0, 0.6) << coarse << " and " << fine;
  }
}

TEST(StoredEnergy, IsThereInImplicitStepsAndAtRest) {
  EXPECT_LT(std::abs(drift_share(neo_hookean(), 1e-3, Integrator::implicit)), 1e-3);
  EXPECT_LT(std::abs(drift_share(neo_hookean(), 1e-3, Integrator::quasi_static)), 1e-3);
}

TEST(StoredEnergy, LawWithoutEnergyHasNone) {
  Tissue secant = soft();
  secant.law = LinearLaw{20000.0};
  const Pressed p(secant, 2e-4);
  EXPECT_FALSE(p.body.stored_energy().has_value());
  EXPECT_FALSE(p.body.energy_drift().has_value());
  Tissue apart = soft();
  apart.mu_law = LinearLaw{20000.0};
  EXPECT_FALSE(Pressed(apart, 2e-4).body.stored_energy().has_value());
  Tissue deviator = soft();  // the deviator of the fibres' stress is no gradient
  deviator.fibres = Fibres{.stiffness = 3000.0}, deviator.maxwell = {{0.4, 0.02}};
  EXPECT_FALSE(Pressed(deviator, 2e-4).body.stored_energy().has_value());
}

// What the branches of large strain leave has an energy, too, and the work done on it is what is stored.
TEST(StoredEnergy, OfRelaxingTissueInLargeStrainIsTheWork) {
  for (const Kinematics kinematics : {Kinematics::corotational, Kinematics::green}) {
    Tissue t = soft();
    t.kinematics = kinematics, t.maxwell = {{0.4, 0.02}};
    EXPECT_LT(std::abs(drift_share(t, 2e-4)), 1e-3);
  }
}

// A tissue that changes brings its own energy; tets that go take theirs with them, to half a step's work.
TEST(StoredEnergy, FollowsChangesOfTheBody) {
  Tissue stiffer = soft();
  stiffer.youngs_modulus = 7000.0;
  const auto drift = [&](double step, bool removes) {
    Pressed p(soft(), step);
    p.to(0.5 * kEnd);
    if (removes) (void)p.body.remove_tets(std::vector<std::uint32_t>{60, 61, 62});
    p.body.set_tissue(0, stiffer);
    p.to(kEnd);
    return std::abs(p.body.energy_drift().value()) / p.body.stored_energy().value();
  };
  EXPECT_LT(drift(2e-4, false), 1e-10);
  EXPECT_LT(drift(2e-4, true), 1e-4);
  EXPECT_LT(drift(1e-4, true), 0.7 * drift(2e-4, true));
}

// A capsule's energy is in the sum; what it stored at first and what a hole released is not taken for drift.
TEST(StoredEnergy, CountsTheCapsule) {
  const auto with = [](double step) {
    Pressed p(soft(), step);
    const auto capsule = std::make_shared<Capsule>(CapsuleOptions{.youngs_modulus = 1e5, .prestretch = 1.1});
    p.body.attach(capsule);
    p.to(0.5 * kEnd);
    EXPECT_GT(capsule->open_at({0.015, 0.0, 0.015}, 0.004), 0.0);
    p.to(kEnd);
    EXPECT_GT(capsule->energy(), 0.0);
    EXPECT_GT(capsule->released_energy(), 0.0);
    const double tissue_alone = p.body.stored_energy().value() - capsule->energy();
    EXPECT_GT(tissue_alone, 0.0);
    return std::abs(p.body.energy_drift().value()) / capsule->energy();
  };
  const double coarse = with(1e-4), fine = with(5e-5);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(fine, 0.7 * coarse);  // the hole opens between two steps
}

}  // namespace
}  // namespace glisson::stored_energy_test

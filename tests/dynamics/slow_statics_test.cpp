// Statics in time (StaticBranches::follow): closed forms of a confined column whose branches relax and whose viscosity resists, at any
// step; order of convergence; automatic steps; the books; agreement with the implicit integrator in slow motion.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "glisson/instruments/motion.h"
#include "material/response.h"
#include "support/bodies.h"
#include "support/column.h"

namespace glisson::slow_statics_test {
namespace {

constexpr double kTau = 2.0, kShare = 0.6, kLength = 0.04, kStrain = 0.01;

SimulationOptions slow(std::optional<double> step) {
  SimulationOptions o;
  o.integrator = Integrator::quasi_static;
  o.branches = StaticBranches::follow;
  o.implicit.tolerance = 1e-11;
  o.step = step;
  return o;
}

Tissue relaxing(MaxwellPart part) {
  Tissue t;
  t.maxwell = {{.share = kShare, .time = kTau}};
  t.maxwell_part = part;
  return t;
}

double column_modulus(const Tissue& t) { return t.lame().lambda + 2.0 * t.lame().mu; }

/// Pressure on the top of a column that is driven by a strain, at every step, against what it has to be; over the largest.
double worst_of_driven(const Tissue& tissue, std::optional<double> step, double end,
                       const std::function<double(double)>& strain, const CornerTimes& corners,
                       const std::function<double(double)>& pressure) {
  test::Column column(tissue, kLength, 4, 1, slow(step));
  const Motion down{[&](double t) { return Vec3d{0.0, 0.0, -kLength * strain(t)}; }, corners};
  const ConstraintId plate = column.simulation.drive(column.top, down, {false, false, true});
  double worst = 0.0, largest = 0.0;
  while (column.simulation.time() < end - 1e-9) {
    EXPECT_EQ(column.simulation.step().status, StepStatus::ok);
    const double t = column.simulation.time(), p = -column.simulation.force(plate).total().z / column.area();
    worst = std::max(worst, std::abs(p - pressure(t)));
    largest = std::max(largest, std::abs(pressure(t)));
  }
  const Energies e = column.simulation.energies();
  EXPECT_LE(std::abs(e.imbalance()), 1e-9 * (std::abs(e.elastic) + std::abs(e.dissipated)));
  return worst / largest;
}

/// The same of the mean strain of a column under a constant pressure that is there at once.
double worst_creep(const Tissue& tissue, std::optional<double> step, double end,
                   const std::function<double(double)>& strain, double from = 0.0) {
  test::Column column(tissue, kLength, 2, 1, slow(step));
  column.add_pressure(30.0);
  double worst = 0.0, largest = 0.0;
  while (column.simulation.time() < end - 1e-9) {
    EXPECT_EQ(column.simulation.step().status, StepStatus::ok);
    const double t = column.simulation.time();
    largest = std::max(largest, strain(t));
    if (t >= from) worst = std::max(worst, std::abs(-column.top_displacement() / kLength - strain(t)));
  }
  const Energies e = column.simulation.energies();
  EXPECT_LE(std::abs(e.imbalance()), 1e-9 * (std::abs(e.elastic) + std::abs(e.dissipated)));
  return worst / largest;
}

// With every component relaxing, a strain that is ramped and held gives M ε̇ [(1 − g) t + g τ (1 − e^(−t/τ))] and its decay, at any
// step: the update is exact for stress that is linear in time. 1e-6 leaves Newton's tolerance and the instant at the start.
TEST(SlowStatics, RampedAndHeldStrainIsExactAtAnyStep) {
  const Tissue tissue = relaxing(MaxwellPart::all);
  const double M = column_modulus(tissue), T = 20.0 * kTau, rate = kStrain / T;
  const auto strain = [&](double t) { return rate * std::min(t, T); };
  const auto pressure = [&](double t) {
    const double r = std::min(t, T), relaxed = kTau * -std::expm1(-r / kTau) * std::exp((r - t) / kTau);
    return M * rate * ((1.0 - kShare) * r + kShare * relaxed);
  };
  for (const double h : {0.1 * kTau, kTau, 10.0 * kTau}) {
    EXPECT_LE(worst_of_driven(tissue, h, 40.0 * kTau, strain, {}, pressure), 1e-6) << h;
  }
  EXPECT_LE(worst_of_driven(tissue, {}, 40.0 * kTau, strain, CornerTimes({T}), pressure), 1e-6) << "automatic";
}

// A strain that is there at once relaxes from the instantaneous modulus, also in steps of ten relaxation times.
TEST(SlowStatics, SuddenStrainRelaxesFromTheInstantaneousModulus) {
  const Tissue tissue = relaxing(MaxwellPart::all);
  const double M = column_modulus(tissue);
  const auto strain = [](double t) { return t > 0.0 ? kStrain : 0.0; };
  const auto pressure = [&](double t) { return M * kStrain * (1.0 - kShare * -std::expm1(-t / kTau)); };
  for (const double h : {0.1 * kTau, 10.0 * kTau}) {
    EXPECT_LE(worst_of_driven(tissue, h, 20.0 * kTau, strain, {}, pressure), 1e-6) << h;
  }
}

/// Holds an error to second order, and to 1e-4 at a tenth of the time constant.
void expect_second_order(const std::function<double(double h)>& error, double time_constant) {
  const double coarse = error(0.1 * time_constant), fine = error(0.05 * time_constant);
  EXPECT_LE(coarse, 1e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4) << coarse << ", " << fine;
}

// Creep of a standard linear solid, ε = σ/M∞ (1 − g e^(−(1 − g) t/τ)), from its sudden start on.
TEST(SlowStatics, CreepIsOfSecondOrder) {
  const Tissue tissue = relaxing(MaxwellPart::all);
  const double left = 1.0 - kShare, final = 30.0 / column_modulus(tissue) / left;
  const auto strain = [&](double t) { return final * (1.0 - kShare * std::exp(-left * t / kTau)); };
  expect_second_order([&](double h) { return worst_creep(tissue, h, 5.0 * kTau, strain); }, kTau);
}

// Where the deviator alone relaxes the column's modulus K + 4/3 μ(t) has the share g · 4/3 μ/M.
TEST(SlowStatics, CreepOfRelaxingDeviatorsIsOfSecondOrder) {
  const Tissue tissue = relaxing(MaxwellPart::deviator);
  const double share = kShare * 4.0 / 3.0 * tissue.lame().mu / column_modulus(tissue), left = 1.0 - share;
  const double final = 30.0 / column_modulus(tissue) / left;
  const auto strain = [&](double t) { return final * (1.0 - share * std::exp(-left * t / kTau)); };
  expect_second_order([&](double h) { return worst_creep(tissue, h, 5.0 * kTau, strain); }, kTau);
}

// Kelvin–Voigt's creep, σ/M (1 − e^(−t M/M_v)): no step of a viscous body is sudden. Long steps end at rest and do not ring.
TEST(SlowStatics, ViscousCreepIsOfSecondOrderAndDoesNotRing) {
  Tissue tissue;
  tissue.viscosity = 1000.0;
  const double M = column_modulus(tissue), theta = 2.0 * tissue.viscosity / M, final = 30.0 / M;
  const auto strain = [&](double t) { return final * -std::expm1(-t / theta); };
  expect_second_order([&](double h) { return worst_creep(tissue, h, 5.0 * theta, strain); }, theta);
  EXPECT_LE(worst_creep(tissue, 100.0 * theta, 400.0 * theta, strain, 250.0 * theta), 1e-6) << "0.08 a stage of γ h";
}

// A viscous column pressed at constant speed, F/A = M v t/L + M_v v/L, is exact from the first step on; when it is held, the second part
// is gone.
TEST(SlowStatics, ViscousRampIsExact) {
  Tissue tissue;
  tissue.viscosity = 1000.0;
  const double M = column_modulus(tissue), M_v = 2.0 * tissue.viscosity, T = 1.0, rate = kStrain / T;
  const auto strain = [&](double t) { return rate * std::min(t, T); };
  const auto pressure = [&](double t) { return M * strain(t) + (t < T + 1e-9 ? M_v * rate : 0.0); };
  EXPECT_LE(worst_of_driven(tissue, 0.25, 2.0, strain, {}, pressure), 1e-6);
  EXPECT_LE(worst_of_driven(tissue, {}, 2.0, strain, CornerTimes({T}), pressure), 1e-6);
}

// A cycled strain, ωτ = 0.7: with q' = (S − q)/τ, q = S₀ [sin ωt − ωτ (cos ωt − e^(−t/τ))]/(1 + ω²τ²).
TEST(SlowStatics, CyclesAreOfSecondOrder) {
  const Tissue tissue = relaxing(MaxwellPart::all);
  const double M = column_modulus(tissue), omega = 0.7 / kTau;
  const auto strain = [&](double t) { return kStrain * std::sin(omega * t); };
  const auto pressure = [&](double t) {
    const double x = omega * kTau;
    const double q = (std::sin(omega * t) - x * (std::cos(omega * t) - std::exp(-t / kTau))) / (1.0 + x * x);
    return M * kStrain * (std::sin(omega * t) - kShare * q);
  };
  expect_second_order(
      [&](double h) { return worst_of_driven(tissue, h, 4.0 * std::numbers::pi * kTau, strain, {}, pressure); }, kTau);
}

/// Pressure of a column whose branch has a time law, by the classical Runge–Kutta method of the branch's own equation.
class TimeLawColumn {
 public:
  TimeLawColumn(const Tissue& tissue, std::function<double(double)> strain, double end)
      : response_(tissue), modulus_(column_modulus(tissue)), strain_(std::move(strain)), step_(end / 40000.0) {
    double q = 0.0;
    for (int i = 0; i <= 40000; ++i) {
      const double t = i * step_;
      relaxed_.push_back(q);
      const double k1 = rate(t, q), k2 = rate(t + 0.5 * step_, q + 0.5 * step_ * k1),
                   k3 = rate(t + 0.5 * step_, q + 0.5 * step_ * k2), k4 = rate(t + step_, q + step_ * k3);
      q += step_ / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
  double pressure(double t) const {
    return modulus_ * strain_(t) - kShare * relaxed_[static_cast<std::size_t>(std::lround(t / step_))];
  }

 private:
  double rate(double t, double q) const {
    Mat3d H{};
    H(2, 2) = -strain_(t);
    return (modulus_ * strain_(t) - q) * response_.paces().at(0, response_.measure(H, ElementShape{}));
  }
  Response response_;
  double modulus_;
  std::function<double(double)> strain_;
  double step_;
  std::vector<double> relaxed_;
};

// A branch whose time falls as the tissue deforms follows its own equation to second order.
TEST(SlowStatics, TimeLawsAreOfSecondOrder) {
  Tissue tissue = relaxing(MaxwellPart::all);
  tissue.maxwell[0].time_law = ExponentialTime{.rate = -20.0};
  const auto strain = [](double t) { return 0.05 * std::pow(std::sin(0.25 * t / kTau), 2); };
  const double end = 8.0 * kTau;
  const TimeLawColumn exact(tissue, strain, end);
  expect_second_order(
      [&](double h) {
        return worst_of_driven(tissue, h, end, strain, {}, [&](double t) { return exact.pressure(t); });
      },
      kTau);
}

// Automatic steps keep 1e-4 of the largest strain of a creeping column, whose load is there at once, and of a viscous one; when all has
// come to rest they are longer than the slowest time.
TEST(SlowStatics, AutomaticStepsKeepTheErrorAndGrow) {
  const Tissue tissue = relaxing(MaxwellPart::deviator);
  const double share = kShare * 4.0 / 3.0 * tissue.lame().mu / column_modulus(tissue), left = 1.0 - share;
  const double final = 30.0 / column_modulus(tissue) / left;
  EXPECT_LE(worst_creep(tissue, {}, 20.0 * kTau,
                        [&](double t) { return final * (1.0 - share * std::exp(-left * t / kTau)); }),
            1e-4);
  Tissue viscous;
  viscous.viscosity = 1000.0;
  const double M = column_modulus(viscous), theta = 2.0 * viscous.viscosity / M;
  EXPECT_LE(worst_creep(viscous, {}, 10.0 * theta, [&](double t) { return 30.0 / M * -std::expm1(-t / theta); }), 1e-4);

  test::Column column(tissue, kLength, 2, 1, slow({}));
  column.add_pressure(30.0);
  while (column.simulation.time() < 60.0 * kTau) ASSERT_EQ(column.simulation.step().status, StepStatus::ok);
  EXPECT_GT(column.simulation.step_size(), 3.0 * kTau);
  EXPECT_LT(column.simulation.steps(), 150u);
}

// Automatic steps after a corner of a function of a program's own, which they are not told of, are made anew until they keep it.
TEST(SlowStatics, AutomaticStepsFindWhatTheyAreNotToldOf) {
  const Tissue tissue = relaxing(MaxwellPart::all);
  const double M = column_modulus(tissue), T = 1.237, rate = kStrain / T;
  const auto strain = [&](double t) { return rate * std::min(t, T); };
  const auto pressure = [&](double t) {
    const double r = std::min(t, T), relaxed = kTau * -std::expm1(-r / kTau) * std::exp((r - t) / kTau);
    return M * rate * ((1.0 - kShare) * r + kShare * relaxed);
  };
  EXPECT_LE(worst_of_driven(tissue, {}, 10.0 * kTau, strain, {}, pressure), 1e-4);
}

/// A press of the paper's block with relaxing deviators at ν = 0.45, deep enough that its field moves while it relaxes.
struct Press {
  TetMesh mesh = test::paper_mesh();
  Simulation simulation;
  ConstraintId base, tool;

  explicit Press(const SimulationOptions& options, double density = 1000.0)
      : simulation(mesh, {{0, tissue(density)}}, options) {
    base = simulation.fix(mesh.vertex_sets.at("z_min"));
    tool = simulation.drive(test::paper_triangle(), press({.velocity = 0.005, .depth = 0.005, .hold = 3.0}));
  }
  static Tissue tissue(double density) {
    Tissue t = relaxing(MaxwellPart::deviator);
    t.kinematics = Kinematics::corotational;
    t.poisson_ratio = 0.45;
    t.density = density;
    return t;
  }
  double force() const { return -simulation.force(tool).total().z; }
};

// In motion so slow that inertia has no part in it the implicit integrator comes to the same forces: here its tissue weighs next to
// nothing, and its steps are the halves of those of statics.
TEST(SlowStatics, AgreesWithTheImplicitIntegratorInSlowMotion) {
  Press follows(slow(0.1));
  SimulationOptions o = slow(0.05);
  o.integrator = Integrator::implicit;
  Press moves(o, 1e-3);
  double largest = 0.0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(follows.simulation.step().status, StepStatus::ok);
    ASSERT_EQ(moves.simulation.step().status, StepStatus::ok);
    ASSERT_EQ(moves.simulation.step().status, StepStatus::ok);
    largest = std::max(largest, moves.force());
    EXPECT_NEAR(follows.force(), moves.force(), 1e-5 * largest) << follows.simulation.time();
  }
  EXPECT_LT(follows.force(), 0.75 * largest) << "it relaxes";
  EXPECT_NEAR(follows.force(), follows.simulation.force(follows.base).total().z, 1e-7 * largest);
  EXPECT_LE(std::abs(follows.simulation.energies().imbalance()), 1e-9 * follows.simulation.energies().elastic);
}

// Without branches and viscosity the word changes nothing but the parts of a step; `relaxed` and no word are the same.
TEST(SlowStatics, AnElasticBodyIsThatOfStatics) {
  const auto force = [](StaticBranches branches, const Tissue& tissue) {
    SimulationOptions o = slow(0.25);
    o.branches = branches;
    test::Column column(tissue, kLength, 3, 1, o);
    const ConstraintId plate =
        column.simulation.drive(column.top, press({.velocity = 0.001, .depth = 0.001}), {false, false, true});
    while (column.simulation.time() < 1.0) EXPECT_TRUE(column.simulation.step().made());
    return column.simulation.force(plate).total().z;
  };
  EXPECT_NEAR(force(StaticBranches::follow, Tissue{}), force(StaticBranches::relaxed, Tissue{}), 1e-9);
  const Tissue tissue = relaxing(MaxwellPart::all);
  EXPECT_EQ(force(StaticBranches::automatic, tissue), force(StaticBranches::relaxed, tissue));
  EXPECT_LT(force(StaticBranches::follow, tissue), 1.1 * force(StaticBranches::relaxed, tissue))
      << "more force, downwards";
}

// A run goes on from its checkpoint to the byte, in automatic steps whose error depends on the largest stress so far.
TEST(SlowStatics, GoesOnFromACheckpoint) {
  SimulationOptions o = slow({});
  Press first(o), second(o);
  while (first.simulation.time() < 1.5) ASSERT_TRUE(first.simulation.step().made());
  std::stringstream file;
  first.simulation.save(file);
  second.simulation.load(file);
  while (first.simulation.time() < 3.0) {
    ASSERT_TRUE(first.simulation.step().made());
    ASSERT_TRUE(second.simulation.step().made());
    ASSERT_EQ(first.simulation.state_hash(), second.simulation.state_hash()) << first.simulation.time();
  }
  SimulationOptions other = o;
  other.branches = StaticBranches::relaxed;
  Press relaxed(other);
  std::stringstream again;
  first.simulation.save(again);
  EXPECT_THROW(relaxed.simulation.load(again), std::runtime_error);
}

// The other integrators follow time in any case: to ask them for relaxed branches is refused.
TEST(SlowStatics, RelaxedBranchesAreForStatics) {
  SimulationOptions o;
  o.branches = StaticBranches::relaxed;
  EXPECT_THROW(Simulation(test::paper_mesh(), {{0, Tissue{}}}, o), std::invalid_argument);
  o.branches = StaticBranches::follow;
  EXPECT_NO_THROW(Simulation(test::paper_mesh(), {{0, Tissue{}}}, o));
}

}  // namespace
}  // namespace glisson::slow_statics_test

// The implicit integrator: order of its time schemes, closed forms of a confined column, balance of energies, the paper's step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "dynamics/columns.h"
#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson::implicit_test {
namespace {

SimulationOptions implicit(TimeScheme scheme, double h) {
  SimulationOptions options;
  options.integrator = Integrator::implicit;
  options.implicit.scheme = scheme;
  options.implicit.tolerance = 1e-10;
  options.step = h;
  return options;
}

/// Largest relative error of the first mode of a held column over two periods, against A cos ωt with the ω of the mesh.
double vibration_error(TimeScheme scheme, int steps_a_period) {
  test::Column probe(Tissue{}, 0.08, 8, 1, implicit(scheme, 1.0));
  const test::ColumnMode mode(probe);
  const double period = 2.0 * std::numbers::pi / mode.frequency, h = period / steps_a_period;
  test::Column column(Tissue{}, 0.08, 8, 1, implicit(scheme, h));
  std::vector<Vec3d> start = mode.shape;
  for (Vec3d& u : start) u.z *= 1e-4;
  column.simulation.set_state(start, std::vector<Vec3d>(start.size()));
  double worst = 0.0;
  for (int i = 1; i <= 2 * steps_a_period; ++i) {
    EXPECT_EQ(column.simulation.step().status, StepStatus::ok);
    const double phase = std::cos(mode.frequency * i * h);
    for (std::size_t k = 0; k < start.size(); ++k) {
      worst = std::max(worst, std::abs(column.simulation.displacement()[k].z - phase * start[k].z) / 1e-4);
    }
  }
  return worst;
}

struct Order {
  const char* name;
  TimeScheme scheme;
  double least, most;
};
void PrintTo(const Order& c, std::ostream* out) { *out << c.name; }

class TimeSchemes : public testing::TestWithParam<Order> {};

// Halving the step halves the error of backward Euler and quarters that of the schemes of second order. The frequency
// exact in time is that of the mesh, so that the error of space does not show.
TEST_P(TimeSchemes, HaveTheirOrder) {
  const double coarse = vibration_error(GetParam().scheme, 160), fine = vibration_error(GetParam().scheme, 320);
  const double order = std::log2(coarse / fine);
  EXPECT_GE(order, GetParam().least) << "errors " << coarse << " " << fine;
  EXPECT_LE(order, GetParam().most) << "errors " << coarse << " " << fine;
}

std::string order_name(const testing::TestParamInfo<Order>& o) { return o.param.name; }

// Backward Euler damps by 1 − O(ωh): its order is seen from below at these steps.
INSTANTIATE_TEST_SUITE_P(All, TimeSchemes,
                         testing::Values(Order{"backward_euler", TimeScheme::backward_euler, 0.9, 1.1},
                                         Order{"newmark", TimeScheme::newmark, 1.9, 2.1},
                                         Order{"generalised_alpha", TimeScheme::generalised_alpha, 1.9, 2.1}),
                         order_name);

// A viscous column pressed at constant speed: F/A = M v t/L + M_v v/L, with the paper's step of 10 ms. Inertia has
// diffused away after a step; the rest is exact for the closed form, which is linear in time.
TEST(Implicit, RampHasTheViscousOverhead) {
  Tissue tissue;
  tissue.viscosity = 1000.0;
  const double M = tissue.lame().lambda + 2.0 * tissue.lame().mu, M_v = 2.0 * tissue.viscosity, v = 0.01;
  test::Column column(tissue, 0.04, 4, 1, implicit(TimeScheme::backward_euler, 0.01));
  const ConstraintId plate = column.simulation.drive(column.top,
                                                     [=](double t) {
                                                       return Vec3d{0.0, 0.0, -v * t};
                                                     },
                                                     {false, false, true});
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(column.simulation.step().status, StepStatus::ok);
    if (i < 3) continue;
    const double pressure = -column.simulation.force(plate).total().z / column.area();
    const double expected = (M * v * column.simulation.force_time() + M_v * v) / column.length;
    EXPECT_NEAR(pressure, expected, 1e-3 * expected) << "at " << column.simulation.time() << " s";
  }
}

// Creep under a constant load: ε = (σ/M)(1 − e^(−t M/M_v)); at 200 steps a time constant backward Euler errs by 0.25 %.
TEST(Implicit, CreepFollowsTheExponential) {
  Tissue tissue;
  tissue.viscosity = 1000.0;
  const double M = tissue.lame().lambda + 2.0 * tissue.lame().mu, M_v = 2.0 * tissue.viscosity, load = 100.0;
  test::Column column(tissue, 0.006, 2, 1, implicit(TimeScheme::backward_euler, M_v / M / 200.0));
  column.add_pressure(load);
  double worst = 0.0;
  for (int i = 0; i < 600; ++i) {
    ASSERT_EQ(column.simulation.step().status, StepStatus::ok);
    const double t = column.simulation.time(), expected = load / M * (1.0 - std::exp(-t * M / M_v));
    if (t > 0.1 * M_v / M) {
      worst = std::max(worst, std::abs(-column.top_displacement() / column.length / expected - 1.0));
    }
  }
  EXPECT_LE(worst, 4e-3);
}

struct Law {
  const char* name;
  Tissue tissue;
};
void PrintTo(const Law& c, std::ostream* out) { *out << c.name; }

Tissue viscous(double eta) {
  Tissue t;
  t.viscosity = eta;
  return t;
}

std::vector<Law> laws() {
  std::vector<Law> all{{"linear", viscous(0.0)},        {"viscous", viscous(1000.0)}, {"secant", viscous(10.0)},
                       {"corotational", viscous(10.0)}, {"green", viscous(10.0)},     {"neo_hookean", viscous(10.0)},
                       {"ogden", viscous(0.0)},         {"maxwell", viscous(0.0)},    {"locking_free", viscous(0.0)}};
  const double mu = Tissue{}.lame().mu, kappa = Tissue{}.lame().lambda + 2.0 / 3.0 * mu;
  all[2].tissue.law = LinearLaw{10.0 * 3600.0};
  all[3].tissue.kinematics = Kinematics::corotational;
  all[4].tissue.kinematics = Kinematics::green;
  all[5].tissue.hyperelastic = NeoHookean{.mu = mu, .bulk_modulus = kappa};
  all[6].tissue.hyperelastic = Ogden{.mu = {mu}, .alpha = {-4.7}, .bulk_modulus = kappa};
  all[7].tissue.kinematics = Kinematics::corotational;
  all[7].tissue.maxwell = {{0.3, 0.2}, {0.2, 2.0}};
  all[8].tissue.kinematics = Kinematics::corotational;
  all[8].tissue.poisson_ratio = 0.49;
  all[8].tissue.volume_change = VolumeChange::average_nodal;
  return all;
}

/// Those without the viscosity that asks the explicit scheme for steps of 10 µs.
std::vector<Law> mild_laws() {
  std::vector<Law> mild = laws();
  std::erase_if(mild, [](const Law& law) { return law.tissue.viscosity > 100.0; });
  return mild;
}

class PaperPress : public testing::TestWithParam<Law> {
 protected:
  TetMesh mesh = test::paper_mesh();
  /// The paper's press to a fifth of the cell below, with everything else switched on.
  void busy(Simulation& s) {
    base = s.fix(mesh.vertex_sets.at("z_min"));
    tool = s.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.005, .ramp = 0.02, .hold = 0.3}));
    s.add_load(mesh.vertex_sets.at("x_max"), {0.02, 0.0, 0.01}, [](double t) { return std::sin(20.0 * t); });
  }
  static SimulationOptions options(TimeScheme scheme, double h) {
    SimulationOptions o = implicit(scheme, h);
    o.damping_rate = 5.0;
    o.gravity = {0.0, 0.0, -9.81};
    o.gravity_ramp = 0.1;
    return o;
  }
  ConstraintId base, tool;
};

// The paper's mesh with physical mass is stable at the paper's step, whatever the law: every force of the balance is
// there, and energy is accounted to the tolerance of Newton's method.
TEST_P(PaperPress, IsStableAndBalancedAtTenMilliseconds) {  // long
  for (const TimeScheme scheme : {TimeScheme::backward_euler, TimeScheme::newmark}) {
    Simulation s(mesh, {{0, GetParam().tissue}}, options(scheme, 0.01));
    busy(s);
    while (s.time() < 0.4) ASSERT_EQ(s.step().status, StepStatus::ok) << s.time();
    const Energies e = s.energies();
    EXPECT_LE(std::abs(e.imbalance()), 1e-8 * (std::abs(e.elastic) + std::abs(e.dissipated))) << "of " << e.elastic;
    EXPECT_LT(e.kinetic, 0.2 * e.elastic);
    if (scheme == TimeScheme::backward_euler) {
      EXPECT_GT(e.numerical, 0.0);
    }
    double size = 0.0;
    for (const Vec3d& u : s.displacement()) size = std::max(size, norm(u));
    EXPECT_LT(size, 0.02) << "gravity bends it by some mm, nothing has blown up";
  }
}

using MildPaperPress = PaperPress;

// Small steps of the implicit schemes end where the explicit scheme does: the same equations, two ways.
TEST_P(MildPaperPress, FollowsTheExplicitScheme) {  // long
  SimulationOptions o = options(TimeScheme::newmark, 2.5e-4);
  Simulation implicit_run(mesh, {{0, GetParam().tissue}}, o);
  busy(implicit_run);
  o.integrator = Integrator::central_difference;
  o.precision = Precision::double_precision;
  o.step = 1.25e-4;
  Simulation explicit_run(mesh, {{0, GetParam().tissue}}, o);
  busy(explicit_run);
  const double end = 0.05;
  for (int i = 0; i < 200; ++i) ASSERT_EQ(implicit_run.step().status, StepStatus::ok);
  for (int i = 0; i < 400; ++i) ASSERT_EQ(explicit_run.step().status, StepStatus::ok);
  ASSERT_NEAR(implicit_run.time(), end, 1e-9);
  // both of second order in ωh = 0.2 for the stiffest modes, which hardly move here
  EXPECT_LE(test::relative_difference(implicit_run.displacement(), explicit_run.displacement()), 2e-3);
}

std::string law_name_of(const testing::TestParamInfo<Law>& law) { return law.param.name; }
INSTANTIATE_TEST_SUITE_P(Laws, PaperPress, testing::ValuesIn(laws()), law_name_of);
INSTANTIATE_TEST_SUITE_P(Laws, MildPaperPress, testing::ValuesIn(mild_laws()), law_name_of);

// A body without supports falls as a whole: u = ½ g t² of Newmark, exactly, and no force inside.
TEST(Implicit, FreeFallIsExact) {
  SimulationOptions o = implicit(TimeScheme::newmark, 0.01);
  o.gravity = {0.0, 0.0, -10.0};
  Simulation s(test::paper_mesh(), {{0, Tissue{}}}, o);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
  for (const Vec3d& u : s.displacement()) EXPECT_NEAR(u.z, -0.5 * 10.0 * 0.04, 1e-9);
}

// Tets may be removed and faces split between steps; supports carry what is left.
TEST(Implicit, FollowsChangesOfTheMesh) {
  const TetMesh mesh = test::paper_mesh();
  SimulationOptions o = implicit(TimeScheme::backward_euler, 0.05);
  o.gravity = {0.0, 0.0, -9.81};
  Simulation s(mesh, {{0, viscous(100.0)}}, o);
  const ConstraintId base = s.fix(mesh.vertex_sets.at("z_min"));
  for (int i = 0; i < 5; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
  std::vector<std::uint32_t> upper;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0.0;
    for (const std::uint32_t v : mesh.tets[t]) z += 0.25 * mesh.vertices[v].z;
    if (z > 0.06) upper.push_back(t);
  }
  s.remove_tets(upper);
  for (int i = 0; i < 200; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
  double mass = 0.0;
  for (const double m : s.masses()) mass += m;
  EXPECT_NEAR(s.force(base).total().z, 9.81 * mass, 1e-3 * 9.81 * mass);
  EXPECT_NEAR(mass, 0.75 * 1000.0 * volume(mesh), 1e-9);
}

// Bad options are refused by name.
TEST(Implicit, RefusesBadOptions) {
  const auto refused = [](auto change, const std::string& fragment) {
    SimulationOptions o;
    o.integrator = Integrator::implicit;
    change(o);
    try {
      Simulation(test::paper_mesh(), {{0, Tissue{}}}, o);
      ADD_FAILURE() << "accepted, expected: " << fragment;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
    }
  };
  refused([](auto& o) { o.step = 0.0; }, "step [s] = 0");
  refused([](auto& o) { o.implicit.spectral_radius = 1.5; }, "spectral_radius = 1.5");
  refused([](auto& o) { o.implicit.tolerance = 0.0; }, "tolerance = 0");
  refused([](auto& o) { o.implicit.largest_step = -1.0; }, "largest_step [s] = -1");
  refused([](auto& o) { o.implicit.most_iterations = 0; }, "most_iterations = 0");
  refused([](auto& o) { o.implicit.most_cuts = 41; }, "most_cuts = 41");
}

}  // namespace
}  // namespace glisson::implicit_test

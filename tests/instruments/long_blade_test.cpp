// A blade in the long steps of `implicit` and `quasi_static`, and of `semi_implicit` in viscous tissue: the explicit scheme's force and
// work, tissue that is carried along, balances, checkpoints, and cuts by chance.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/tool_motion.h"
#include "instruments/contact_scenes.h"
#include "support/bodies.h"

namespace glisson::long_blade_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kCell = 0.005, kWidth = 8 * kCell, kAbove = 5e-4;

struct Cut {
  Integrator integrator = Integrator::implicit;
  double h = 0.01, viscosity = 0.0;                      ///< h = 0: a step of the integrator's own
  double toughness = 5.0, velocity = 0.05, depth = 0.0;  ///< depth at which it stops; 0: it goes on
  int threads = 1;
  bool is_explicit() const { return integrator == Integrator::central_difference; }
};

/// A block whose bottom is held, and a blade wider than the block that comes down into it from 0.5 mm above.
struct Downstroke {
  Simulation body;
  std::shared_ptr<Blade> blade;
  ConstraintId bottom;

  explicit Downstroke(const Cut& o) : body(mesh(), {{0, tissue(o.viscosity)}}, options(o)), bottom(body.fix("z_min")) {
    const Pose start{{0.0213, 0.5 * kWidth, kWidth + kAbove}};
    blade = std::make_shared<Blade>(
        BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .toughness = o.toughness, .cut_every = 0.0},
        std::make_shared<PathDriver>(start, path(o)));
    body.attach(blade);
  }
  static TetMesh mesh() {
    std::mt19937 random(2);
    return test::jittered_box({8, 8, 8}, kCell, 0.1, random);
  }
  static Tissue tissue(double viscosity) {
    Tissue t;
    t.viscosity = viscosity;
    return t;
  }
  static ToolPath path(const Cut& o) {
    if (!(o.depth > 0.0)) return steady_path({.velocity = o.velocity});
    return stroke_path({.start = 0.0, .strokes = {{.to = {0.0, 0.0, -o.depth}, .velocity = o.velocity, .ramp = 0.04}}});
  }
  static SimulationOptions options(const Cut& o) {
    SimulationOptions s;
    s.integrator = o.integrator, s.threads = o.threads, s.damping_rate = 30.0;
    if (o.is_explicit()) s.precision = Precision::double_precision;
    if (o.h > 0.0) s.step = o.h;
    return s;
  }
  /// Steps until the blade is as deep. @return mean force against its path, from another depth on
  double cut(double from, double to) {
    double sum = 0.0, time = 0.0, before = body.force_time();
    while (blade->force_depth() < to - 1e-9) {
      const StepResult r = body.step();
      if (!r.made()) {
        ADD_FAILURE() << "at " << body.time() << " s: " << r.message;
        break;
      }
      const double h = body.force_time() - before;
      before += h;
      if (blade->force_depth() <= from) continue;
      sum += -blade->forces().cutting.z * h, time += h;
    }
    return sum / time;
  }
};

struct Run {
  const char* name;
  Cut own;
};

class LongBlade : public testing::TestWithParam<Run> {};

// Through cells of 5 mm, in steps in which the edge passes 0.05 to 2 mm: the mean force of the cut is the explicit scheme's within 1 %,
// and so is G times the width within 3 %; the work of the cut is G times its area, and the ledger closes.
TEST_P(LongBlade, CutsAsInTheExplicitScheme) {  // long: Semi*, *1ms, *5ms, *Viscous*, Static10ms, Implicit40ms
  const Cut& o = GetParam().own;
  Cut short_steps = o;
  short_steps.integrator = Integrator::central_difference, short_steps.h = 0.0;
  Downstroke reference(short_steps), own(o);
  const double exact = reference.cut(0.010, 0.030), found = own.cut(0.010, 0.030);
  EXPECT_NEAR(found, exact, 0.01 * exact);
  EXPECT_NEAR(found, o.toughness * kWidth, 0.03 * o.toughness * kWidth);
  EXPECT_NEAR(own.blade->area(), reference.blade->area(), 0.02 * reference.blade->area());
  const Energies e = own.body.energies(), f = reference.body.energies();
  EXPECT_NEAR(e.fracture, f.fracture, 0.02 * f.fracture);
  EXPECT_NEAR(e.work_tools, f.work_tools, 0.03 * f.work_tools);
  EXPECT_NEAR(e.fracture, own.blade->work_of_cut(), 0.06 * own.blade->work_of_cut());
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools);
  EXPECT_EQ(e.contact, 0.0);
  RecordProperty("force_percent", std::to_string(100.0 * (found / exact - 1.0)));
  RecordProperty("work_percent", std::to_string(100.0 * (e.work_tools / f.work_tools - 1.0)));
  RecordProperty("fracture_percent", std::to_string(100.0 * (e.fracture / f.fracture - 1.0)));
  RecordProperty("area_percent", std::to_string(100.0 * (own.blade->area() / reference.blade->area() - 1.0)));
  RecordProperty("explicit_fracture_of_G_A", std::to_string(f.fracture / reference.blade->work_of_cut()));
  RecordProperty("fracture_of_G_A", std::to_string(e.fracture / own.blade->work_of_cut()));
}

INSTANTIATE_TEST_SUITE_P(
    Steps, LongBlade,
    testing::Values(Run{"Implicit1ms", {.h = 0.001}}, Run{"Implicit5ms", {.h = 0.005}}, Run{"Implicit10ms", {}},
                    Run{"Implicit40ms", {.h = 0.04}}, Run{"Implicit100ms", {.h = 0.1}},
                    Run{"Static10ms", {.integrator = Integrator::quasi_static}},
                    Run{"Static40ms", {.integrator = Integrator::quasi_static, .h = 0.04}},
                    Run{"ImplicitViscous10ms", {.viscosity = 10.0}},
                    Run{"SemiImplicit1ms", {.integrator = Integrator::semi_implicit, .h = 0.001, .viscosity = 10.0}},
                    Run{"SemiImplicit", {.integrator = Integrator::semi_implicit, .h = 0.0, .viscosity = 10.0}}),
    [](const auto& p) { return std::string(p.param.name); });

// Tissue that yields to less than G l is carried along and not cut: at rest the force is the explicit scheme's, nothing has gone to
// fracture, and it stays so.
TEST(LongBladeForce, CarriesWhatItDoesNotCut) {  // long
  Cut o{.integrator = Integrator::central_difference, .h = 0.0, .toughness = 1e3, .depth = 0.006};
  const auto at_rest = [](Downstroke& run, double time) {
    while (run.body.time() < time - 1e-9) {
      const StepResult r = run.body.step();
      ASSERT_TRUE(r.made()) << r.message;
    }
  };
  Downstroke reference(o);
  at_rest(reference, 0.5);
  const double exact = -reference.blade->forces().cutting.z;
  EXPECT_GT(exact, 0.3);
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static, Integrator::semi_implicit}) {
    const bool semi = integrator == Integrator::semi_implicit;
    o.integrator = integrator, o.h = semi ? 1e-3 : 0.01, o.viscosity = semi ? 1.0 : 0.0;
    Downstroke own(o);
    at_rest(own, 0.5);
    const double found = -own.blade->forces().cutting.z;
    EXPECT_NEAR(found, exact, 0.02 * exact) << word_of(integrator);
    EXPECT_EQ(own.blade->area(), 0.0);
    const Energies e = own.body.energies();
    EXPECT_NEAR(e.fracture, 0.0, (semi ? 1e-2 : 2e-3) * e.work_tools);  // where the blade slows down, by a step's
    at_rest(own, 1.0);
    EXPECT_NEAR(-own.blade->forces().cutting.z, found, 1e-3 * found);
    EXPECT_NEAR(own.body.energies().fracture, e.fracture, 1e-4 * e.work_tools);
    EXPECT_NEAR(own.body.energies().imbalance(), 0.0, 1e-6 * e.work_tools);
    const std::string word(word_of(integrator));
    RecordProperty(word + "_percent", std::to_string(100.0 * (found / exact - 1.0)));
    RecordProperty(word + "_fracture_of_work", std::to_string(e.fracture / e.work_tools));
    RecordProperty(word + "_creep_ppm", std::to_string(1e6 * (-own.blade->forces().cutting.z / found - 1.0)));
  }
}

// A free body that is cut by a blade which turns: its momentum changes by the force, its angular momentum by the torque.
TEST(LongBladeForce, ForceAndTorqueAreChangesOfMomentum) {
  Tissue turning;
  turning.kinematics = Kinematics::corotational;
  SimulationOptions o = test::in_steps_of(Integrator::implicit, 2e-3);
  o.implicit.tolerance = 1e-10;
  Simulation s(box_mesh({.cells = {5, 5, 5}, .size = {0.04, 0.04, 0.04}, .origin = {-0.02, -0.02, -0.04}}),
               {{0, turning}}, o);
  const auto blade = std::make_shared<Blade>(
      BladeOptions{.edge_from = {-0.015, 0, 0}, .edge_to = {0.03, 0, 0}, .toughness = 3.0, .cutting = {.snap = false}},
      std::make_shared<test::GivenPath>([](double time) {
        return Pose{{0.003 + 0.1 * time, 0.004, -2e-3 - 0.4 * time}, test::rotation({0.0, 0.6, 0.8}, 3.0 * time)};
      }));
  s.attach(blade);
  Vec3d p = test::momentum(s), L = test::angular_momentum(s);
  double largest = 0.0, torque = 0.0;
  for (int k = 0; k < 30; ++k) {
    const std::vector<Vec3d> before(s.velocity().begin(), s.velocity().end()), start = s.positions();
    const std::vector<double> masses(s.masses().begin(), s.masses().end());
    const StepResult r = s.step();
    ASSERT_TRUE(r.made()) << r.message;
    const double h = s.step_size();
    const Vec3d force = blade->forces().cutting,
                about_zero = blade->forces().torque + cross(blade->pose().position, force);
    const Vec3d p_after = test::momentum(s), L_after = test::angular_momentum(s);
    EXPECT_NEAR(norm((p_after - p) * (1.0 / h) - force), 0.0, 1e-6 * (norm(force) + 0.1));
    // x⁺ × m v⁺ − x × m v = x⁺ × m (v⁺ − v) + h m v⁺ × v, with x⁺ = x + h v⁺; vertices that the step has split have one v⁺
    Vec3d twist;
    for (std::size_t i = 0; i < before.size(); ++i) twist += cross(s.velocity()[i], before[i]) * masses[i];
    EXPECT_NEAR(norm((L_after - L) * (1.0 / h) - twist - about_zero), 0.0, 1e-5 * (norm(about_zero) + 1e-3));
    L = L_after, p = p_after;
    largest = std::max(largest, norm(force)), torque = std::max(torque, norm(about_zero));
  }
  EXPECT_GT(blade->area(), 1e-4);
  EXPECT_GT(largest, 0.05);
  EXPECT_GT(torque, 1e-4);
  EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-6 * s.energies().work_tools);
}

// In statics the support takes what the blade exerts, at every step.
TEST(LongBladeForce, SupportTakesTheForceInStatics) {
  Downstroke own({.integrator = Integrator::quasi_static});
  for (int k = 0; k < 60; ++k) {
    ASSERT_TRUE(own.body.step().made());
    const Vec3d force = own.blade->forces().cutting;
    EXPECT_NEAR(norm(own.body.force(own.bottom).total() + force), 0.0, 1e-5 * (norm(force) + 1e-3)) << k;
  }
  EXPECT_GT(own.blade->area(), 1e-4);
}

/// Vertices that tets on both sides of a plane across x share.
std::size_t shared_across(const TetMesh& mesh, double x) {
  std::vector<int> sides(mesh.vertices.size(), 0);
  for (const Tet& t : mesh.tets) {
    double middle = 0.0;
    for (const std::uint32_t v : t) middle += 0.25 * mesh.vertices[v].x;
    for (const std::uint32_t v : t) sides[v] |= middle < x ? 1 : 2;
  }
  return static_cast<std::size_t>(std::count(sides.begin(), sides.end(), 3));
}

// All the way through: two pieces, no force any more, and G times the area is the block's cross section times G.
TEST(LongBladeForce, CutsThrough) {
  const Cut o{.toughness = 2.0, .velocity = 0.2};
  Downstroke own(o);
  own.cut(0.0, kWidth + 2.0 * kAbove + 0.004);
  EXPECT_EQ(shared_across(own.body.present_mesh(), 0.0213), 0U);
  EXPECT_EQ(own.blade->length_in_tissue(), 0.0);
  EXPECT_EQ(norm(own.blade->forces().cutting), 0.0);
  EXPECT_NEAR(own.blade->area(), kWidth * kWidth, 1e-3 * kWidth * kWidth);
  const Energies e = own.body.energies();
  EXPECT_NEAR(e.fracture, own.blade->work_of_cut(), 0.03 * own.blade->work_of_cut());
  EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools);
  RecordProperty("fracture_of_G_A", std::to_string(e.fracture / own.blade->work_of_cut()));
}

const std::vector<Cut> kEach{{},
                             {.integrator = Integrator::quasi_static},
                             {.integrator = Integrator::semi_implicit, .h = 0.0, .viscosity = 10.0}};

// A run that was saved in the middle of a cut goes on with the same bytes.
TEST(LongBladeCheckpoint, GoesOn) {  // long
  for (const Cut& o : kEach) {
    Downstroke a(o), b(o);
    a.cut(0.0, 0.012);
    EXPECT_GT(a.blade->area(), 1e-5);
    std::stringstream file;
    a.body.save(file);
    b.body.load(file);
    a.cut(0.0, 0.020), b.cut(0.0, 0.020);
    EXPECT_EQ(a.body.mesh(), b.body.mesh());
    EXPECT_EQ(a.body.state_hash(), b.body.state_hash()) << word_of(o.integrator);
    EXPECT_EQ(a.blade->forces().cutting, b.blade->forces().cutting);
    EXPECT_EQ(a.blade->forces().torque, b.blade->forces().torque);
    EXPECT_EQ(a.blade->area(), b.blade->area());
    EXPECT_EQ(a.body.energies().fracture, b.body.energies().fracture);
  }
}

// The same bytes on one thread and on two.
TEST(LongBladeThreads, GiveTheSameBytes) {  // long
  Cut o = kEach.back();
  Downstroke one(o);
  o.threads = 2;
  Downstroke two(o);
  one.cut(0.0, 0.012), two.cut(0.0, 0.012);
  EXPECT_GT(one.blade->area(), 1e-5);
  EXPECT_EQ(one.body.state_hash(), two.body.state_hash());
  EXPECT_EQ(one.blade->forces().cutting, two.blade->forces().cutting);
}

// A blade that is pushed: less than G times the width presses it in, more cuts. It is as deep as under the explicit scheme, within 2 %.
TEST(LongBladePushed, GoesAsDeepAsInTheExplicitScheme) {  // long
  for (const double force : {0.15, 0.25}) {
    const auto depth = [&](const Cut& o) {
      Simulation s(Downstroke::mesh(), {{0, Downstroke::tissue(o.viscosity)}}, Downstroke::options(o));
      s.fix("z_min");
      PushMotion push;
      push.force = [force](double t) { return force * std::clamp(t / 0.2, 0.0, 1.0); };
      push.mass = 0.02, push.damping = 5.0;
      const auto blade = std::make_shared<Blade>(
          BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .toughness = 5.0, .cut_every = 0.0},
          std::make_shared<PushDriver>(Pose{{0.0213, 0.5 * kWidth, kWidth + kAbove}}, push));
      s.attach(blade);
      while (s.time() < 1.0 - 1e-9) {
        const StepResult r = s.step();
        if (!r.made()) {
          ADD_FAILURE() << r.message;
          break;
        }
      }
      EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-6 * s.energies().work_tools);
      return blade->force_depth();
    };
    const double exact = depth({.integrator = Integrator::central_difference, .h = 0.0});
    for (const Cut& o : kEach) {
      if (o.integrator == Integrator::semi_implicit) continue;
      const double found = depth(o);
      EXPECT_NEAR(found, exact, 0.02 * exact) << word_of(o.integrator) << " " << force;
      RecordProperty(std::string(word_of(o.integrator)) + (force < 0.2 ? "_pressed" : "_cut") + "_percent",
                     std::to_string(100.0 * (found / exact - 1.0)));
    }
  }
}

/// A blade by chance, turning on a path by chance through tissue by chance.
struct RandomCut {
  Cut o;
  Tissue tissue;
  BladeOptions blade;
  Vec3d start, way, axis;
  double turns, seconds;
  explicit RandomCut(unsigned seed) {
    std::mt19937 random(seed);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    o.integrator = kEach[seed % 3].integrator;
    const bool semi = o.integrator == Integrator::semi_implicit;
    o.h = semi ? 0.0 : std::pow(10.0, between(-3.0, -1.3));
    const auto law = random() % 4;
    if (law == 0) tissue.kinematics = Kinematics::corotational;
    if (law == 1) tissue.hyperelastic = NeoHookean{.mu = 2000.0, .bulk_modulus = between(4e3, 2e4)};
    if (law == 2) tissue.law = ExponentialLaw{.amplitude = 800.0, .rate = 5.0};
    if (semi || random() % 2 == 0) tissue.viscosity = between(1.0, 50.0);
    blade.toughness = random() % 8 == 0 ? 0.0 : std::pow(10.0, between(-1.0, 2.0));
    blade.edge_from = {between(-0.02, 0.0), between(-0.03, -0.005), between(-0.005, 0.005)};
    blade.edge_to = {between(0.0, 0.02), between(0.0, 0.03), between(-0.005, 0.015)};
    blade.cut_every = random() % 2 == 0 ? 0.0 : between(0.0, 3e-3);
    blade.cutting.snap = random() % 4 != 0;
    start = {between(0.01, 0.03), between(0.01, 0.03), between(0.03, 0.05)};
    way = {between(-0.02, 0.02), between(-0.02, 0.02), -between(0.005, 0.04)};
    axis = unit(Vec3d{between(-1.0, 1.0), between(-1.0, 1.0), 1.1});
    turns = between(-1.5, 1.5), seconds = semi ? between(0.03, 0.1) : 15.0 * o.h;
  }
  /// In and half of the way back.
  Pose pose(double time) const {
    const double s = std::min(time / seconds, 2.0 - time / seconds);
    return {start + way * s, test::rotation(axis, turns * s)};
  }
};

class RandomLongBlade : public testing::TestWithParam<unsigned> {};

// Sixty cuts, turning, in and half of the way back: every number is finite, a step that is not made says why, and the ledger closes.
TEST_P(RandomLongBlade, SaysWhatItDoesNotDo) {  // long: 1, 2, 3
  int refused = 0;
  double cut = 0.0;
  for (unsigned seed = 15 * GetParam(); seed < 15 * (GetParam() + 1); ++seed) {
    const RandomCut c(seed);
    std::mt19937 random(seed);
    SimulationOptions options = Downstroke::options(c.o);
    options.implicit.most_cuts = 9;
    Simulation s(test::jittered_box({4, 4, 4}, 0.01, 0.1, random), {{0, c.tissue}}, options);
    if (seed % 4 == 1) {  // vertices that are held in part
      s.fix("z_min", {false, false, true}), s.fix("y_max", {false, true, false}), s.fix("x_min", {true, false, false});
    } else {
      s.fix("z_min");
    }
    const auto blade =
        std::make_shared<Blade>(c.blade, std::make_shared<test::GivenPath>([&c](double t) { return c.pose(t); }));
    s.attach(blade);
    if (seed % 2 == 0) {
      ContactOptions ball;
      ball.shape = Ball{0.005};
      s.attach(std::make_shared<ContactTool>(ball, std::make_shared<test::GivenPath>([&c](double t) {
                                               return Pose{{0.02, 0.02, 0.0401 - 0.003 * std::min(1.0, t / c.seconds)}};
                                             })));
    }
    StepResult r;
    while (r.made() && s.time() < 1.5 * c.seconds) r = s.step();
    if (!r.made()) {
      ++refused;
      EXPECT_THAT(std::string(r.message), testing::AnyOf(HasSubstr("Ways out"), HasSubstr("rigid body"))) << seed;
    }
    for (const Vec3d& x : s.positions()) ASSERT_TRUE(std::isfinite(norm(x))) << seed;
    ASSERT_TRUE(std::isfinite(norm(blade->forces().cutting)) && std::isfinite(norm(blade->forces().torque))) << seed;
    EXPECT_LE(norm(blade->forces().cutting), c.blade.toughness * 0.2) << seed;
    const Energies e = s.energies();
    EXPECT_NEAR(e.imbalance(), 0.0, 1e-5 * (std::abs(e.work_tools) + e.elastic + std::abs(e.removed) + 1e-12)) << seed;
    cut += blade->area();
  }
  RecordProperty("refused", refused);
  RecordProperty("area_mm2", std::to_string(1e6 * cut));
  EXPECT_LE(refused, 2);
  EXPECT_GT(cut, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Cuts, RandomLongBlade, testing::Range(0U, 4U));

}  // namespace
}  // namespace glisson::long_blade_test

// Contact in the long steps of `implicit` and `quasi_static`: against the explicit scheme, and by balances.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "glisson/instruments/tool_motion.h"
#include "instruments/contact_scenes.h"
#include "instruments/pressed_layer.h"

namespace glisson::long_contact_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Tissue tissue() {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = 0.3;
  return t;
}

/// A slab of 4 × 4 × 2 cm whose bottom is held, its top at z = 0, under a tool on a path.
struct Pressed {
  Simulation body;
  std::shared_ptr<ContactTool> tool;
  ConstraintId bottom;

  Pressed(Integrator integrator, double h, const Tissue& t, const Shape& shape, double friction,
          std::function<Vec3d(double)> path, int cells = 8, bool bonded = false)
      : body(
            box_mesh({.cells = {cells, cells, cells / 2}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}}),
            {{0, t}}, damped(test::in_steps_of(integrator, h))),
        bottom(body.fix("z_min")) {
    ContactOptions o;
    o.shape = shape, o.friction = friction, o.bonded = bonded;
    tool = std::make_shared<ContactTool>(
        o, std::make_shared<test::GivenPath>([path](double time) { return Pose{path(time)}; }));
    body.attach(tool);
  }
  static SimulationOptions damped(SimulationOptions o) {
    o.damping_rate = 50.0;
    return o;
  }
  Vec3d force() const { return tool->forces().total(); }
};

/// Smooth way from 0 to 1 between two times.
double smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

std::function<Vec3d(double)> down(double depth, double seconds) {
  return [=](double t) { return Vec3d{0.0, 0.0, -depth * smooth(t, 0.0, seconds)}; };
}

/// Force on the tissue over time, at the times of the list.
std::vector<Vec3d> forces_at(Pressed& p, const std::vector<double>& times) {
  std::vector<Vec3d> forces;
  double before = 0.0;
  Vec3d last{};
  for (const double t : times) {
    while (p.body.force_time() < t - 1e-9) {
      before = p.body.force_time(), last = p.force();
      const StepResult r = p.body.step();
      if (!r.made()) {
        ADD_FAILURE() << r.message;
        return forces;
      }
    }
    const double at = p.body.force_time(), share = at > before ? (t - before) / (at - before) : 1.0;
    forces.push_back(last + (p.force() - last) * share);
  }
  return forces;
}

std::vector<double> steps_up_to(double end, double h) {
  std::vector<double> times;
  for (double t = h; t < end + 1e-9; t += h) times.push_back(t);
  return times;
}

struct Compared {
  double error, peak;
};
Compared compared(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  Compared c{0.0, 0.0};
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    c.error = std::max(c.error, norm(a[i] - b[i])), c.peak = std::max(c.peak, norm(b[i]));
  }
  return c;
}

struct Press {
  const char* name;
  Shape shape;
  double depth, friction;
  bool hyperelastic;
  int cells;  ///< along the slab
};

void PrintTo(const Press& p, std::ostream* out) { *out << p.name; }

class LongPress : public testing::TestWithParam<Press> {};

// By 0.3 of the slab's height: the force of a tool that has come to rest under the explicit scheme in short steps, in 25 steps of `implicit`
// and in 12 of statics, and of the explicit scheme in its own step, within 1 %; held at one point a triangle, an edge of a fifth of a cell
// was 7 to 18 % too soft. Under the block sweeps do not end: it took 295 s in the place of 39 while its forces went on changing. The ledger closes, contact takes no more than 5 % of the tools' work, and in statics the support takes
// what the tool exerts.
TEST_P(LongPress, HasTheForceOfTheExplicitScheme) {  // long; verify: *BallOnRubber, *BlockOnRubber
  const Press& c = GetParam();
  Tissue t = tissue();
  if (c.hyperelastic) t.hyperelastic = NeoHookean{.mu = 2000.0, .bulk_modulus = 8000.0};
  const auto path = down(c.depth, 0.5);
  Pressed explicitly(Integrator::central_difference, test::kShortStep, t, c.shape, c.friction, path, c.cells);
  test::advance_to(explicitly.body, 0.65);
  const Vec3d reference = test::mean_up_to(0.75, explicitly.body, [&] { return explicitly.force(); });
  EXPECT_LT(reference.z, -0.1);
  Pressed own(Integrator::central_difference, 0.0, t, c.shape, c.friction, path, c.cells);
  test::advance_to(own.body, 0.65);
  const Vec3d in_own_steps = test::mean_up_to(0.75, own.body, [&] { return own.force(); });
  EXPECT_LT(std::abs(in_own_steps.z / reference.z - 1.0), 0.01);
  RecordProperty("own_step_percent", std::to_string(100.0 * (in_own_steps.z / reference.z - 1.0)));
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pressed p(integrator, integrator == Integrator::implicit ? 0.04 : 0.05, t, c.shape, c.friction, path, c.cells);
    const double end = integrator == Integrator::implicit ? 1.0 : 0.6;
    while (p.body.time() < end - 1e-9) {
      const StepResult r = p.body.step();
      ASSERT_TRUE(r.made()) << r.message;
    }
    const double error = p.force().z / reference.z - 1.0;
    EXPECT_LT(std::abs(error), 0.01) << word_of(integrator);
    RecordProperty(std::string(word_of(integrator)) + "_percent", std::to_string(100.0 * error));
    const Energies e = p.body.energies();
    EXPECT_GT(e.work_tools, 0.0);
    EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * e.work_tools) << word_of(integrator);
    EXPECT_NEAR(e.contact, 0.0, 0.05 * e.work_tools) << word_of(integrator);
    RecordProperty(std::string(word_of(integrator)) + "_contact_percent",
                   std::to_string(100.0 * e.contact / e.work_tools));
    if (integrator == Integrator::quasi_static) {
      EXPECT_NEAR(norm(p.body.force(p.bottom).total() + p.force()), 0.0, 1e-6 * norm(reference));
      EXPECT_NEAR(p.body.stored_energy().value(), e.elastic, 0.02 * e.elastic);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Tools, LongPress,
    testing::Values(Press{"Punch", FlatPunch{.radius = 0.008, .edge_radius = 0.002}, 0.006, 0.0, false, 8},
                    Press{"Edge", FlatPunch{.radius = 0.006, .edge_radius = 0.001}, 0.006, 0.0, false, 8},
                    Press{"Ball", Ball{0.01}, 0.007, 0.0, false, 12},
                    Press{"BallOnRubber", Ball{0.01}, 0.007, 0.0, true, 12},
                    Press{"BlockOnRubber", Block{.size = {0.015, 0.015, 0.02}, .edge_radius = 0.003}, 0.006, 0.0, true,
                          12},
                    Press{"RubbingBall", Ball{0.01}, 0.007, 0.3, false, 12},
                    Press{"RubbingPunch", FlatPunch{.radius = 0.008, .edge_radius = 0.002}, 0.006, 0.3, false, 12},
                    Press{"PlateOnRubber", Plate{}, 0.006, 0.2, true, 8}),
    [](const auto& tested) { return std::string(tested.param.name); });

// Nearly incompressible tissue whose vertices share their volume changes: the force of the explicit scheme at rest, within 1 %. On cells
// of 5 mm the two kinds of step are 4 % apart, implicit and quasi_static 0.05 %.
TEST(LongContact, PressesTissueOfAveragedVolumeChanges) {  // long
  Tissue t = tissue();
  t.poisson_ratio = 0.49, t.volume_change = VolumeChange::average_nodal;
  const auto path = down(0.004, 0.2);
  Pressed explicitly(Integrator::central_difference, 0.0, t, Ball{0.01}, 0.0, path, 12);
  test::advance_to(explicitly.body, 0.5);
  EXPECT_LT(explicitly.force().z, -0.1);
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pressed p(integrator, 0.04, t, Ball{0.01}, 0.0, path, 12);
    while (p.body.time() < 0.5) {
      const StepResult r = p.body.step();
      ASSERT_TRUE(r.made()) << r.message;
    }
    EXPECT_NEAR(p.force().z, explicitly.force().z, 0.01 * norm(explicitly.force())) << word_of(integrator);
    EXPECT_NEAR(p.body.energies().imbalance(), 0.0, 1e-6 * p.body.energies().work_tools) << word_of(integrator);
  }
}

// A punch that stands brings no energy in, however many steps it stands: triangles that come to bear in turn are not pushed out.
// They were, and contact had given 1.1 times the tools' work after 50 steps of 10 ms.
TEST(LongContact, CreatesNoEnergyAtRest) {
  Pressed p(Integrator::implicit, 0.01, tissue(), FlatPunch{.radius = 0.008, .edge_radius = 0.002}, 0.0,
            down(0.006, 0.5));
  double pressed = 0.0;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(p.body.step().made());
    if (k == 49) pressed = p.body.energies().contact;
  }
  const Energies e = p.body.energies();
  EXPECT_NEAR(e.contact, pressed, 0.01 * e.work_tools);
}

// A plate presses, goes sideways and back: it sticks, slips and sticks again. Its force is the explicit one within 2 % of the peak
// at all times, and so is what friction has taken. Statics knows no rate: half the steps, twice as fast, the same force.
TEST(LongContact, SticksAndSlipsAsTheExplicitScheme) {
  const auto path = [](double time) {
    return Vec3d{0.006 * (smooth(time, 0.5, 1.5) - smooth(time, 1.5, 2.5)), 0.0, -0.003 * smooth(time, 0.0, 0.5)};
  };
  const std::vector<double> times = steps_up_to(2.5, 0.05);
  Pressed explicitly(Integrator::central_difference, 0.0, tissue(), Plate{}, 0.3, path, 4);
  const std::vector<Vec3d> reference = forces_at(explicitly, times);
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pressed p(integrator, 0.01, tissue(), Plate{}, 0.3, path, 4);
    const auto [error, peak] = compared(forces_at(p, times), reference);
    double across = 0.0;
    for (const Vec3d& f : reference) across = std::max(across, std::abs(f.x));
    EXPECT_NEAR(across, 0.3 * peak, 0.03 * peak);  // all of it slips
    EXPECT_LT(error, 0.02 * peak) << word_of(integrator) << " peak " << peak << " across " << across;
    RecordProperty(std::string(word_of(integrator)) + "_percent", std::to_string(100.0 * error / peak));
    const double rubbed = explicitly.body.energies().friction;
    EXPECT_NEAR(p.body.energies().friction, rubbed, 0.02 * rubbed);
    EXPECT_NEAR(p.body.energies().imbalance(), 0.0, 1e-6 * p.body.energies().work_tools);
  }
  std::vector<Vec3d> slow, fast;
  for (const double rate : {1.0, 2.0}) {
    Pressed p(
        Integrator::quasi_static, 0.02 / rate, tissue(), Plate{}, 0.3, [&](double t) { return path(rate * t); }, 4);
    for (std::vector<Vec3d>& list = rate == 1.0 ? slow : fast; p.body.time() < 2.5 / rate - 1e-9;) {
      ASSERT_TRUE(p.body.step().made());
      list.push_back(p.force());
    }
  }
  ASSERT_EQ(slow.size(), fast.size());
  EXPECT_LT(compared(slow, fast).error, 1e-4 * compared(slow, fast).peak);
}

// A punch bonded to what it touches, pressed in, pulled up and aside: where only bonds act (from 0.7 s on) its force is the explicit
// scheme's within 1 % of the peak at any time and 1e-4 at rest; the ledger closes, and a run that was saved goes on with the same bytes.
TEST(LongContact, PullsWhatIsBondedToIt) {  // long
  const auto path = [](double time) {
    return Vec3d{0.003 * smooth(time, 0.3, 0.9), 0.0, 0.004 * smooth(time, 0.3, 0.9) - 0.002 * smooth(time, 0.0, 0.3)};
  };
  const Shape punch = FlatPunch{.radius = 0.009};
  Tissue turning = tissue();
  turning.kinematics = Kinematics::corotational;
  const auto pulled = [&](Integrator integrator) {
    return Pressed(integrator, 0.02, turning, punch, 0.0, path, 8, true);
  };
  std::vector<double> times;
  for (double t = 0.72; t < 1.2; t += 0.02) times.push_back(t);
  Pressed explicitly = pulled(Integrator::central_difference);
  const std::vector<Vec3d> reference = forces_at(explicitly, times);
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pressed p = pulled(integrator), loaded = pulled(integrator);
    const std::vector<Vec3d> forces = forces_at(p, times);
    const auto [error, peak] = compared(forces, reference);
    EXPECT_GT(reference.back().z, 0.1) << "pulled";
    EXPECT_LT(error, 0.01 * peak) << word_of(integrator);
    EXPECT_LT(norm(forces.back() - reference.back()), 1e-4 * peak) << word_of(integrator);
    RecordProperty(std::string(word_of(integrator)) + "_percent", std::to_string(100.0 * error / peak));
    const Energies e = p.body.energies();
    EXPECT_NEAR(e.imbalance(), 0.0, 1e-6 * (std::abs(e.work_tools) + e.elastic)) << word_of(integrator);
    std::stringstream file;
    p.body.save(file);
    loaded.body.load(file);
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(p.body.step().made() && loaded.body.step().made());
    EXPECT_EQ(p.body.state_hash(), loaded.body.state_hash()) << word_of(integrator);
    EXPECT_EQ(p.force(), loaded.force());
  }
}

// A ball that rubs is dragged over the slab and back: within 5 % of the largest force in steps of 20 ms. It rests on few triangles; against
// the explicit scheme in steps of 0.1 ms the error is 3.3 %, in its own 3.7 %.
TEST(LongContact, RubsAsTheExplicitScheme) {  // long
  const auto path = [](double time) {
    return Vec3d{0.006 * (smooth(time, 0.5, 1.2) - smooth(time, 1.2, 1.9)), 0.0, -0.003 * smooth(time, 0.0, 0.5)};
  };
  const std::vector<double> times = steps_up_to(1.9, 0.05);
  Pressed explicitly(Integrator::central_difference, 0.0, tissue(), Ball{0.01}, 0.3, path, 12);
  const std::vector<Vec3d> reference = forces_at(explicitly, times);
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    Pressed p(integrator, 0.02, tissue(), Ball{0.01}, 0.3, path, 12);
    const auto [error, peak] = compared(forces_at(p, times), reference);
    double across = 0.0;
    for (const Vec3d& f : reference) across = std::max(across, std::abs(f.x));
    EXPECT_GT(across, 0.25 * peak);
    EXPECT_LT(error, 0.05 * peak) << word_of(integrator);
    RecordProperty(std::string(word_of(integrator)) + "_percent", std::to_string(100.0 * error / peak));
    const double rubbed = explicitly.body.energies().friction;
    EXPECT_NEAR(p.body.energies().friction, rubbed, 0.03 * rubbed);
    EXPECT_NEAR(p.body.energies().imbalance(), 0.0, 1e-6 * p.body.energies().work_tools);
  }
}

// A free body that is struck: its momentum changes by the tool's force, its angular momentum by the torque.
TEST(LongContact, ForceAndTorqueAreChangesOfMomentum) {
  Tissue turning = tissue();
  turning.kinematics = Kinematics::corotational;
  SimulationOptions o = test::in_steps_of(Integrator::implicit, 2e-3);
  o.implicit.tolerance = 1e-10;
  Simulation s(box_mesh({.cells = {4, 4, 2}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}}),
               {{0, turning}}, o);
  ContactOptions c;
  c.shape = Block{.size = {0.01, 0.015, 0.02}};
  const auto tool = std::make_shared<ContactTool>(
      c, std::make_shared<test::GivenPath>([](double time) {
        return Pose{{0.006 + 0.1 * time, 0.003, 1e-3 - 0.1 * time}, test::rotation({0.6, 0.0, 0.8}, 2.0 * time)};
      }));
  s.attach(tool);
  Vec3d p = test::momentum(s), L = test::angular_momentum(s);
  double largest = 0.0, torque = 0.0;
  for (int k = 0; k < 60; ++k) {
    const std::vector<Vec3d> before(s.velocity().begin(), s.velocity().end());
    const StepResult r = s.step();
    ASSERT_TRUE(r.made()) << r.message;
    const double h = s.step_size();
    const Vec3d force = tool->forces().total(),
                about_zero = tool->forces().torque + cross(tool->pose().position, force);
    const Vec3d p_after = test::momentum(s), L_after = test::angular_momentum(s);
    EXPECT_NEAR(norm((p_after - p) * (1.0 / h) - force), 0.0, 1e-6 * (norm(force) + 0.1));
    // x⁺ = x + h v⁺: x⁺ × m v⁺ − x × m v = x⁺ × m (v⁺ − v) + h m v⁺ × v, and the first is the torque about 0 over h
    Vec3d twist;
    for (std::size_t i = 0; i < before.size(); ++i) twist += cross(s.velocity()[i], before[i]) * s.masses()[i];
    EXPECT_NEAR(norm((L_after - L) * (1.0 / h) - twist - about_zero), 0.0, 1e-5 * (norm(about_zero) + 1e-3));
    L = L_after, p = p_after;
    largest = std::max(largest, norm(force)), torque = std::max(torque, norm(about_zero));
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_GT(torque, 1e-5);
  EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-6 * s.energies().work_tools);
}

// Where the tool ends up nothing is inside it but what a triangle may be between its corners.
TEST(LongContact, LeavesNothingInside) {
  Pressed p(Integrator::quasi_static, 0.1, tissue(), Ball{0.006}, 0.0, down(0.005, 0.5));
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(p.body.step().made());
  double deepest_vertex = 0.0, deepest_middle = 0.0;
  const std::vector<Vec3d> x = p.body.positions();
  const auto phi = [&](const Vec3d& at) { return distance_to(Ball{0.006}, at - p.tool->pose().position).distance; };
  for (const Triangle& f : boundary_triangles(p.body.mesh())) {
    for (const std::uint32_t v : f) deepest_vertex = std::min(deepest_vertex, phi(x[v]));
    deepest_middle = std::min(deepest_middle, phi((x[f[0]] + x[f[1]] + x[f[2]]) * (1.0 / 3.0)));
  }
  EXPECT_GT(deepest_vertex, -1e-7);
  EXPECT_GT(deepest_middle, -0.1 * 0.012);
}

// A run that was saved goes on with the same bytes.
TEST(LongContact, ContinuesFromACheckpoint) {
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    const auto made = [&] { return Pressed(integrator, 0.05, tissue(), Ball{0.01}, 0.0, down(0.005, 0.5), 4); };
    Pressed a = made(), b = made();
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(a.body.step().made());
    std::stringstream file;
    a.body.save(file);
    b.body.load(file);
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(a.body.step().made() && b.body.step().made());
    EXPECT_EQ(a.body.state_hash(), b.body.state_hash()) << word_of(integrator);
    EXPECT_EQ(a.force(), b.force());
    EXPECT_EQ(a.tool->events().size(), 1U);
    EXPECT_EQ(b.tool->events().size(), 1U);
  }
}

// What does not act in long steps is refused by name, with the way out.
TEST(LongContact, RefusesWhatItDoesNotDo) {
  const auto attached = [](SimulationOptions o, const ContactOptions& c, std::shared_ptr<ToolDriver> driver) {
    Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.01, 0.01, 0.01}}), {{0, tissue()}}, o);
    s.attach(std::make_shared<ContactTool>(c, std::move(driver)));
  };
  const SimulationOptions o = test::in_steps_of(Integrator::implicit, 0.01);
  ContactOptions ball{.name = "probe", .shape = Ball{0.003}};
  const Pose above{{0.005, 0.005, 0.0101}}, inside{{0.005, 0.005, 0.008}};
  EXPECT_NO_THROW(attached(o, ball, test::standing(above)));
  EXPECT_THAT([&] { attached(o, ball, test::standing(inside)); },
              ThrowsMessage<std::invalid_argument>(::testing::AllOf(
                  HasSubstr("\"probe\""), HasSubstr("starts inside the body, 2 mm deep"), HasSubstr("(0, 0, 2) mm"))));
  EXPECT_THAT(
      [&] { attached(o, ball, std::make_shared<test::YieldsInShortSteps>(above)); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("\"probe\", which is moved by a force in short steps only")));
  SimulationOptions newmark = o;
  newmark.implicit.scheme = TimeScheme::newmark;
  EXPECT_THAT([&] { attached(newmark, ball, test::standing(above)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("needs scheme = backward_euler")));
}

/// A random tool on a random path over a random tissue.
struct RandomPress {
  Shape shape;
  std::map<int, Tissue> tissues{{0, tissue()}};
  double friction = 0.0, h = 0.0;
  Vec3d start, way;
  bool bonded = false, pushed = false;  ///< pushed: by a force in the place of the way
  explicit RandomPress(unsigned seed) {
    std::mt19937 random(seed);
    Tissue& t = tissues.at(0);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    const auto kind = random() % 5;
    const double r = between(0.002, 0.012);
    shape = kind == 0   ? Shape(Ball{r})
            : kind == 1 ? Shape(FlatPunch{.radius = r, .edge_radius = 0.3 * r})
            : kind == 2 ? Shape(Block{.size = {2 * r, r, 0.02}, .edge_radius = between(0.0, 0.4) * r})
            : kind == 3 ? Shape(Plate{})
                        : Shape(NeedleShape{.diameter = r, .length = 0.05, .tip = TipForm::blunt});
    const auto law = random() % 3;
    if (law == 0) t.kinematics = Kinematics::corotational;
    if (law == 1) t.hyperelastic = NeoHookean{.mu = 2000.0, .bulk_modulus = between(4e3, 4e4)};
    if (random() % 2 == 0) t.viscosity = between(1.0, 50.0);
    const double choice = between(0.0, 1.0);
    friction = choice < 0.3 ? 0.0 : choice < 0.9 ? choice : std::numeric_limits<double>::infinity();
    h = std::pow(10.0, between(-3.0, -1.3));
    start = {between(-0.02, 0.02), between(-0.02, 0.02), between(0.0, 0.003)};
    way = {between(-0.01, 0.01), between(-0.01, 0.01), -between(0.002, 0.012)};
    bonded = random() % 4 == 0, pushed = random() % 3 == 0;
  }
};

class RandomLongContact : public testing::TestWithParam<unsigned> {};

// A hundred scenes, half of them in statics: every number is finite, steps that are not made say why, and the ledger closes.
TEST_P(RandomLongContact, SaysWhatItDoesNotDo) {  // long: 1, 2, 3
  int refused = 0;
  for (unsigned seed = 25 * GetParam(); seed < 25 * (GetParam() + 1); ++seed) {
    const RandomPress c(seed);
    const Integrator integrator = seed % 2 == 0 ? Integrator::implicit : Integrator::quasi_static;
    const auto path = [&](double time) { return c.start + c.way * smooth(time, 0.0, 12.0 * c.h); };
    SimulationOptions o = test::in_steps_of(integrator, c.h);
    o.implicit.most_cuts = 3;
    Simulation s(box_mesh({.cells = {4, 4, 2}, .size = {0.04, 0.04, 0.02}, .origin = {-0.02, -0.02, -0.02}}), c.tissues,
                 o);
    s.fix("z_min");
    ContactOptions options;
    options.shape = c.shape, options.friction = c.friction, options.bonded = c.bonded;
    std::shared_ptr<ToolDriver> driver =
        std::make_shared<test::GivenPath>([&](double time) { return Pose{path(time)}; });
    if (c.pushed) {
      PushMotion push;
      push.direction = c.way, push.guided = seed % 3 == 0;
      push.force = [&](double time) { return 50.0 * norm(path(time) - c.start); };
      driver = std::make_shared<PushDriver>(Pose{c.start}, push);
    }
    const auto tool = std::make_shared<ContactTool>(options, driver);
    s.attach(tool);
    StepResult r;
    for (int k = 0; k < 8 && r.made(); ++k) r = s.step();
    if (!r.made()) {
      ++refused;
      EXPECT_THAT(std::string(r.message), HasSubstr("Ways out")) << seed;
    }
    for (const Vec3d& x : s.positions()) ASSERT_TRUE(std::isfinite(norm(x))) << seed;
    ASSERT_TRUE(std::isfinite(norm(tool->forces().total()))) << seed;
    const Energies e = s.energies();
    EXPECT_NEAR(e.imbalance(), 0.0, 1e-5 * (std::abs(e.work_tools) + e.elastic + 1e-12)) << seed;
  }
  RecordProperty("refused", refused);
  EXPECT_LE(refused, 3);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RandomLongContact, testing::Range(0U, 4U));

}  // namespace
}  // namespace glisson::long_contact_test

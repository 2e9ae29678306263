// Tools that act on the same vertices: after each step none has undone another, and the order in which they were attached does not
// matter, to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/container.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "instruments/contact_scenes.h"
#include "support/bodies.h"

namespace glisson::together_test {
namespace {

constexpr double kCell = 0.005;
constexpr std::array<int, 3> kCells{6, 6, 4};
const Vec3d kSize{kCells[0] * kCell, kCells[1] * kCell, kCells[2] * kCell};

using Tools = std::vector<std::shared_ptr<Interaction>>;

/// A block on its bottom, with tools.
struct Together {
  std::string name;
  std::function<Tools()> tools;
  double end = 0.05;      ///< [s]
  bool fixed = true;      ///< its bottom is
  bool collides = false;  ///< tools meet each other, so that not all can be met
  friend std::ostream& operator<<(std::ostream& out, const Together& x) { return out << x.name; }
};

std::shared_ptr<PathDriver> along(const Pose& start, const Vec3d& velocity) {
  const double speed = norm(velocity);
  return std::make_shared<PathDriver>(start, steady_path({.direction = velocity * (1.0 / speed), .velocity = speed}));
}

/// Turns a tool so that it presses along d: its own z points against d.
Mat3d pressing(const Vec3d& d) {
  const Vec3d z = d * -1.0, x = unit(cross(std::abs(d.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0}, z)), y = cross(z, x);
  Mat3d axes{};
  for (std::size_t i = 0; i < 3; ++i) axes(i, 0) = x[i], axes(i, 1) = y[i], axes(i, 2) = z[i];
  return axes;
}

std::shared_ptr<ContactTool> solid(const std::string& name, const Shape& shape, const Vec3d& at, const Vec3d& velocity,
                                   double friction = 0.0, bool bonded = false) {
  const Vec3d d = unit(velocity);
  return std::make_shared<ContactTool>(
      ContactOptions{.name = name, .shape = shape, .friction = friction, .bonded = bonded, .direction = d},
      along({at, pressing(d)}, velocity));
}

std::shared_ptr<Needle> needle(const std::string& name, const Vec3d& at, const Vec3d& velocity, double friction = 3.0) {
  NeedleOptions o;
  o.name = name, o.direction = unit(velocity), o.length = 0.06;
  o.zone = 6e-3, o.spacing = 2e-3;
  o.rupture.force = 0.05, o.tip.cutting = 0.03;
  o.friction.static_in = o.friction.static_out = friction,
  o.friction.dynamic_in = o.friction.dynamic_out = 0.6 * friction;
  o.friction.viscous_in = o.friction.viscous_out = 10.0 * friction;
  return std::make_shared<Needle>(o, along({at}, velocity));
}

const Vec3d kMiddle{0.5 * kSize.x, 0.5 * kSize.y, kSize.z};

std::vector<Together> scenes() {
  return {
      {.name = "ball_above_and_plate_beside_an_edge",
       .tools =
           [] {
             return Tools{solid("ball", Ball{.radius = 0.008}, kMiddle + Vec3d{0.5 * kSize.x - 0.003, 0, 1e-4},
                                {0, 0, -0.05}, 0.3),
                          solid("plate", Plate{}, {kSize.x + 1e-4, kMiddle.y, 0.0}, {-0.04, 0, 0}, 0.2)};
           }},
      {.name = "needle_under_a_pressing_plate",
       .tools =
           [] {
             return Tools{needle("needle", kMiddle + Vec3d{0.001, 0.0007, 1e-4}, {0, 0, -0.15}),
                          solid("plate", Plate{}, kMiddle + Vec3d{0, 0, 2e-4}, {0, 0, -0.05})};
           }},
      {.name = "blade_beside_a_bonded_tool",
       .tools =
           [] {
             BladeOptions o;
             o.name = "blade", o.edge_from = {0, -0.03, 0}, o.edge_to = {0, 0.03, 0}, o.toughness = 5.0,
             o.cut_every = 0.0;
             auto blade = std::make_shared<Blade>(o, along({kMiddle + Vec3d{0.0013, 0, 1e-4}}, {0, 0, -0.1}));
             return Tools{
                 solid("bonded", FlatPunch{.radius = 0.006}, kMiddle + Vec3d{-0.005, 0, 0}, {0, 0, -0.02}, 0.0, true),
                 blade};
           }},
      {.name = "corner_of_a_rough_container",
       .tools =
           [] {
             ContainerOptions c;
             c.vessel = BoxVessel{.width = kSize.x, .length = kSize.y, .height = 2.0 * kSize.z};
             c.pose.position = {kMiddle.x, kMiddle.y, 0.0};
             c.friction = 0.3;
             return Tools{std::make_shared<Container>(c),
                          solid("ball", Ball{.radius = 0.01}, {0.004, 0.004, kSize.z + 1e-4}, {0, 0, -0.1}, 0.2)};
           },
       .fixed = false},
      {.name = "bonded_patch_under_a_ball",
       .tools =
           [] {
             return Tools{solid("patch", FlatPunch{.radius = 0.006}, kMiddle, {0, 0.02, 0}, 0.0, true),
                          solid("ball", Ball{.radius = 0.012}, kMiddle + Vec3d{0.004, 0, 1e-4}, {0, 0, -0.05}, 0.4)};
           },
       .end = 0.03,
       .collides = true},
      {.name = "two_needles_whose_zones_overlap",
       .tools =
           [] {
             return Tools{needle("first", kMiddle + Vec3d{0.001, 0.0007, 1e-4}, {0, 0, -0.15}),
                          needle("second", kMiddle + Vec3d{0.004, 0.0021, 2e-4}, {0.01, 0, -0.15})};
           }},
      {.name = "three_balls_on_a_corner",
       .tools =
           [] {
             return Tools{solid("x", Ball{.radius = 0.01}, {kSize.x + 1e-4, kSize.y - 0.002, kSize.z - 0.002},
                                {-0.04, 0, 0}, 0.5),
                          solid("y", Ball{.radius = 0.01}, {kSize.x - 0.002, kSize.y + 1e-4, kSize.z - 0.002},
                                {0, -0.04, 0}, 0.5),
                          solid("z", Ball{.radius = 0.01}, {kSize.x - 0.002, kSize.y - 0.002, kSize.z + 1e-4},
                                {0, 0, -0.04}, 0.5)};
           }},
  };
}

struct Scene {
  Simulation body;
  Tools tools;
  std::vector<Tools::value_type> attached;

  Scene(const Together& o, bool turned, const SimulationOptions& how = options())
      : body(mesh(), {{0, tissue()}}, how), tools(o.tools()) {
    if (o.fixed) body.fix("z_min");
    Tools order = tools;
    if (turned) std::reverse(order.begin(), order.end());
    for (const auto& tool : order) body.attach(tool);
  }
  static TetMesh mesh() { return box_mesh({.cells = kCells, .size = kSize}); }
  static Tissue tissue() {
    Tissue t;
    t.viscosity = 2.0;
    return t;
  }
  static SimulationOptions options() {
    SimulationOptions o;
    o.precision = Precision::double_precision, o.damping_rate = 30.0, o.gravity = {0, 0, -9.81};
    return o;
  }
  /// Overlap of a solid and vertices that can move [m].
  double overlap(const ContactTool& tool) const {
    double most = 0.0;
    const std::vector<Vec3d> x = body.positions();
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (body.mesh().vertices[v].z == 0.0) continue;
      most = std::max(most, -distance_to(tool.options().shape, tool.pose().to_own(x[v])).distance);
    }
    return most;
  }
};

std::string hash(const Simulation& s) { return std::to_string(s.state_hash()); }

class TogetherTest : public ::testing::TestWithParam<Together> {};

// Attached the other way round the run has the same bytes, and so have the tools' forces and the energy ledger.
TEST_P(TogetherTest, TheOrderOfAttachmentDoesNotMatter) {
  Scene a(GetParam(), false), b(GetParam(), true);
  double largest = 0.0;
  while (a.body.time() < GetParam().end) {
    ASSERT_TRUE(a.body.step().made());
    ASSERT_TRUE(b.body.step().made());
    ASSERT_EQ(hash(a.body), hash(b.body)) << a.body.time();
  }
  for (std::size_t k = 0; k < a.tools.size(); ++k) {
    const auto *x = dynamic_cast<const Instrument*>(a.tools[k].get()),
               *y = dynamic_cast<const Instrument*>(b.tools[k].get());
    if (x == nullptr) continue;
    EXPECT_EQ(norm(x->force() - y->force()), 0.0) << x->name();
    largest = std::max(largest, norm(x->force()));
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_EQ(a.body.energies().imbalance(), b.body.energies().imbalance());
  EXPECT_EQ(a.body.energies().friction, b.body.energies().friction);
}

// Two needles that go into the same tissue share what it bears: once both are inside, their forces are the same to the mesh's lack of
// symmetry, and the rows of all steps are met. One after the other the last one attached had what the first had not.
TEST(TogetherNeedles, ShareTheForceOnTissueThatBothHold) {
  const double aside = 7e-4;
  const Together pair{.name = "pair", .tools = [aside] {
                        return Tools{needle("left", kMiddle + Vec3d{-aside, 0, 1e-4}, {0, 0, -0.1}, 18.0),
                                     needle("right", kMiddle + Vec3d{aside, 0, 1e-4}, {0, 0, -0.1}, 18.0)};
                      }};
  const auto force = [](const Scene& s, std::size_t k) { return dynamic_cast<const Needle&>(*s.tools[k]).force().z; };
  Scene s(pair, false);
  double left = 0.0, right = 0.0;
  while (s.body.time() < 0.12) {
    const StepResult step = s.body.step();
    ASSERT_TRUE(step.made());
    EXPECT_TRUE(step.contact_met) << s.body.time();
    if (s.body.time() > 0.08) left += force(s, 0), right += force(s, 1);
  }
  EXPECT_LT(left, 0.0);
  EXPECT_NEAR(left, right, 0.02 * std::abs(left));
}

/// A scene in long steps.
struct LongTogether {
  Together scene;
  Integrator integrator = Integrator::implicit;
  double h = 2e-3;  ///< [s]
  SimulationOptions options() const {
    SimulationOptions o = Scene::options();
    o.integrator = integrator, o.step = h;
    return o;
  }
  friend std::ostream& operator<<(std::ostream& out, const LongTogether& x) { return out << x.scene; }
};

/// A patch bonded from above that is taken aside, and a ball that presses beside it and on it: not both can have what they want.
Together patch_from_above() {
  return {.name = "patch_from_above_and_a_ball",
          .tools =
              [] {
                auto patch = std::make_shared<ContactTool>(
                    ContactOptions{.name = "patch", .shape = FlatPunch{.radius = 0.006}, .bonded = true},
                    along({kMiddle, pressing({0, 0, -1})}, {0, 0.02, 0}));
                return Tools{patch,
                             solid("ball", Ball{.radius = 0.012}, kMiddle + Vec3d{0.004, 0, 1e-4}, {0, 0, -0.05}, 0.4)};
              },
          .end = 0.03,
          .collides = true};
}

/// All but a patch that is bonded from inside, which long steps do not take.
std::vector<LongTogether> long_scenes() {
  std::vector<LongTogether> all;
  std::vector<Together> taken = scenes();
  std::erase_if(taken, [](const Together& one) { return one.collides; });
  taken.push_back(patch_from_above());
  for (const Together& scene : taken) {
    all.push_back({scene, Integrator::implicit});
    if (scene.fixed && !scene.collides) all.push_back({scene, Integrator::quasi_static});
    all.push_back({scene, Integrator::semi_implicit, 2e-4});
  }
  return all;
}

std::string name_of(const testing::TestParamInfo<LongTogether>& one) {
  return std::string(word_of(one.param.integrator)) + "_" + one.param.scene.name;
}

class TogetherInLongSteps : public ::testing::TestWithParam<LongTogether> {};

// So it is in long steps: the same bytes in either order, and forces of both.
TEST_P(TogetherInLongSteps, TheOrderOfAttachmentDoesNotMatter) {
  const LongTogether& p = GetParam();
  Scene a(p.scene, false, p.options()), b(p.scene, true, p.options());
  while (a.body.time() < 0.6 * p.scene.end) {
    const StepResult one = a.body.step(), other = b.body.step();
    ASSERT_TRUE(one.made() && other.made()) << one.message << other.message;
    ASSERT_EQ(hash(a.body), hash(b.body)) << a.body.time();
    ASSERT_EQ(one.contact_met, other.contact_met);
  }
  EXPECT_EQ(a.body.energies().imbalance(), b.body.energies().imbalance());
}

// After each long step, too, no vertex is deeper in a solid than a millionth of a centimetre, as long as all can be met.
TEST_P(TogetherInLongSteps, NoToolUndoesAnother) {
  const LongTogether& p = GetParam();
  Scene s(p.scene, false, p.options());
  bool met = true;
  while (s.body.time() < 0.6 * p.scene.end) {
    const StepResult step = s.body.step();
    ASSERT_TRUE(step.made()) << step.message;
    met = met && step.contact_met;
    for (const auto& tool : s.tools) {
      const auto* x = dynamic_cast<const ContactTool*>(tool.get());
      if (x == nullptr || x->options().bonded || !met) continue;
      ASSERT_LE(s.overlap(*x), 1e-8) << x->name() << " at " << s.body.time();
    }
  }
  EXPECT_EQ(met, !p.scene.collides);
}

// After each step no vertex is deeper in a solid than a millionth of a centimetre; a bonded patch that is pulled up against a ball
// cannot do that, says so, and what is inside then comes out later.
TEST_P(TogetherTest, NoToolUndoesAnother) {
  Scene s(GetParam(), false);
  bool met = true;
  while (s.body.time() < GetParam().end) {
    const StepResult step = s.body.step();
    ASSERT_TRUE(step.made());
    met = met && step.contact_met;
    for (const auto& tool : s.tools) {
      const auto* x = dynamic_cast<const ContactTool*>(tool.get());
      if (x == nullptr || x->options().bonded || !met) continue;
      ASSERT_LE(s.overlap(*x), 1e-8) << x->name() << " at " << s.body.time();
    }
  }
  EXPECT_EQ(met, !GetParam().collides);
}

// Two blocks close on the apex of a tet, 0.1 mm beyond each other in the end. It cannot be outside both: it is as deep in the one as
// in the other, and the step says that contact was not met, from the moment on at which they would overlap.
TEST(TogetherBlocks, CloseOnAVertexWithTheLeastViolation) {
  TetMesh mesh;
  mesh.vertices = {{-0.005, -0.005, 0}, {0.005, -0.005, 0}, {0, 0.008, 0}, {0, 0, 0.01}};
  mesh.tets = {{0, 1, 2, 3}};
  SimulationOptions options = Scene::options();
  options.gravity = {};
  Simulation body(mesh, {{0, Scene::tissue()}}, options);
  body.fix(std::vector<std::uint32_t>{0, 1, 2});
  const Block block{.size = {0.004, 0.004, 0.004}};
  const auto left = solid("left", block, {-1e-4, 0, 0.0119}, {0.02, 0, 0}),
             right = solid("right", block, {1e-4, 0, 0.0119}, {-0.02, 0, 0});
  body.attach(left), body.attach(right);
  const auto depth = [&](const ContactTool& tool) {
    return -distance_to(tool.options().shape, tool.pose().to_own(body.positions()[3])).distance;
  };
  while (body.time() < 0.0075 - 1e-9) {
    const StepResult step = body.step();
    ASSERT_TRUE(step.made());
    ASSERT_EQ(step.contact_met, body.time() <= 0.005) << body.time();
  }
  EXPECT_NEAR(depth(*left), 0.02 * body.time() - 1e-4, 1e-8);
  EXPECT_NEAR(depth(*left), depth(*right), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Scenes, TogetherInLongSteps, ::testing::ValuesIn(long_scenes()), name_of);
INSTANTIATE_TEST_SUITE_P(Scenes, TogetherTest, ::testing::ValuesIn(scenes()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace glisson::together_test

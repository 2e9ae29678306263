// Contact never creates energy: what a tool at rest does on a body that is thrown against it is never above zero, and the
// body never has more energy than it was thrown with.
#include <random>

#include "instruments/contact_scenes.h"

namespace glisson {
namespace {

using test::random_field;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3d direction(std::mt19937& random) {
  std::normal_distribution<double> n;
  const Vec3d v{n(random), n(random), n(random)};
  return v * (1.0 / norm(v));
}

Shape any_shape(std::mt19937& random) {
  const double r = uniform(random, 2e-3, 10e-3);
  switch (std::uniform_int_distribution<int>(0, 6)(random)) {
    case 0:
      return FlatPunch{.radius = r, .edge_radius = 0.0, .length = 0.03};
    case 1:
      return FlatPunch{.radius = r, .edge_radius = 0.3 * r, .length = 0.03};
    case 2:
      return Ball{.radius = r};
    case 3:
      return NeedleShape{.diameter = r, .length = 0.05, .tip = TipForm::conical, .tip_angle = 0.8};
    case 4:
      return NeedleShape{.diameter = r, .length = 0.05, .tip = TipForm::blunt};
    case 5:
      return Block{.size = {r, 2.0 * r, r}, .edge_radius = 0.1 * r};
    default:
      return Plate{};
  }
}

/// A block of jittered tets, 2 cm a side, 2 mm above the tip of a tool, turned at random and thrown at it.
struct Throw {
  Simulation body;
  std::shared_ptr<ContactTool> tool;
  std::shared_ptr<bool> away = std::make_shared<bool>(false);
  double thrown = 0.0;  // kinetic energy at first [J]

  static TetMesh block(std::mt19937& random) {
    TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.2, random);
    const Mat3d turned = test::rotation(direction(random), uniform(random, 0.0, 3.0));
    double lowest = 1.0;
    for (Vec3d& x : mesh.vertices) x = turned * (x - Vec3d{0.01, 0.01, 0.01}), lowest = std::min(lowest, x.z);
    for (Vec3d& x : mesh.vertices) x.z += 2e-3 - lowest;
    return mesh;
  }
  static Tissue tissue(std::mt19937& random) {
    Tissue t;
    t.kinematics = Kinematics::corotational;
    t.youngs_modulus = uniform(random, 1e4, 5e4), t.poisson_ratio = uniform(random, 0.1, 0.45);
    return t;
  }
  explicit Throw(std::mt19937& random) : body(block(random), {{0, tissue(random)}}, test::in_double()) {
    ContactOptions o;
    o.shape = any_shape(random);
    const double friction[] = {0.0, 0.2, 0.7, std::numeric_limits<double>::infinity()};
    o.friction = friction[std::uniform_int_distribution<int>(0, 3)(random)];
    tool = std::make_shared<ContactTool>(o, std::make_shared<test::GivenPath>([gone = away](double) {
                                           return Pose{{0.0, 0.0, *gone ? -0.1 : 0.0}, test::upside_down()};
                                         }));
    const Vec3d spin = direction(random) * uniform(random, 0.0, 30.0);
    const Vec3d way{uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5), uniform(random, -1.0, -0.2)};
    std::vector<Vec3d> v;
    for (const Vec3d& x : body.mesh().vertices) v.push_back(way + cross(spin, x));
    body.attach(tool);
    body.set_state(std::vector<Vec3d>(v.size()), v);
    thrown = body.energies().initial;
  }
};

// A thousand throws against any shape with any friction; after some steps the tool is taken away, so
// that the books, which are kept half a kick behind, are closed. What it has done is not above zero but for rounding.
TEST(ContactEnergy, IsNeverCreated) {  // long
  std::mt19937 random(20261121);
  int touched = 0, corrected = 0, crushed = 0;
  for (int n = 0; n < 1000; ++n) {
    Throw t(random);
    const int steps = std::uniform_int_distribution<int>(20, 120)(random);
    bool ever = false, inverted = false;
    for (int k = 0; k < steps; ++k) {
      const StepStatus status = t.body.step().status;
      ASSERT_TRUE(status == StepStatus::ok || status == StepStatus::inverted);
      inverted = inverted || status == StepStatus::inverted;
      ever = ever || t.tool->touches();
      corrected += t.tool->effort().corrected ? 1 : 0;
    }
    *t.away = true;
    for (int k = 0; k < 2; ++k) ASSERT_NE(t.body.step().status, StepStatus::not_finite);
    ASSERT_FALSE(t.tool->touches());
    const Energies e = t.body.energies();
    ASSERT_GE(e.contact + e.friction, -1e-12 * t.thrown)
        << "throw " << n << ", shape " << t.tool->options().shape.index();
    ASSERT_NEAR(e.work_tools, 0.0, 1e-12 * t.thrown) << "a tool that stands does no work";
    ASSERT_LE(e.kinetic + e.elastic, (1.0 + 1e-9) * t.thrown) << "throw " << n;
    touched += ever ? 1 : 0, crushed += inverted ? 1 : 0;
  }
  EXPECT_GT(touched, 700);
  EXPECT_LT(crushed, 10);  // by an edge or a tip that meets soft tissue at 1 m/s
  RecordProperty("throws_that_touched", touched);
  RecordProperty("steps_solved_twice", corrected);
}

}  // namespace
}  // namespace glisson

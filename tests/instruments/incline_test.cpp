// A block on an inclined plate obeys Coulomb: it stays where tan θ < μ, and slides with g (sin θ − μ cos θ) where tan θ > μ.
#include "instruments/contact_scenes.h"

namespace glisson {
namespace {

constexpr double kGravity = 9.81;

struct Incline {
  double angle, friction;
};

/// A soft block, 3 × 2 × 1 cm, on a plate; both are turned together, so that the plate is no coordinate plane.
struct Slide {
  Mat3d turned;
  Simulation body;
  std::shared_ptr<ContactTool> plate;

  static TetMesh block(const Mat3d& turned) {
    TetMesh mesh = box_mesh({.cells = {6, 4, 2}, .size = {0.03, 0.02, 0.01}});
    for (Vec3d& x : mesh.vertices) x = turned * x;
    return mesh;
  }
  static SimulationOptions options() {
    SimulationOptions o;
    o.gravity = {0.0, 0.0, -kGravity};
    o.gravity_ramp = 0.2;
    return o;
  }
  static Tissue tissue() {
    Tissue t;
    t.youngs_modulus = 5e4, t.poisson_ratio = 0.3, t.viscosity = 10.0;
    return t;
  }
  explicit Slide(const Incline& c)
      : turned(test::rotation({0.0, 1.0, 0.0}, c.angle)), body(block(turned), {{0, tissue()}}, options()) {
    ContactOptions o;
    o.shape = Plate{}, o.friction = c.friction;
    const Mat3d down = test::rotation({0.0, 1.0, 0.0}, std::acos(-1.0) + c.angle);
    plate = std::make_shared<ContactTool>(o, test::standing({{}, down}));
    body.attach(plate);
  }
  Vec3d downhill() const { return turned * Vec3d{1.0, 0.0, 0.0}; }
  double speed() const { return dot(test::momentum(body), downhill()) / test::mass(body); }
};

class CoulombIncline : public testing::TestWithParam<Incline> {};

// Below the angle of friction not a vertex moves once the weight is on; above it the block is as fast as the formula
// says, from the moment the weight is on to half a second later. The block shakes as it slides: 1 % of g.
TEST_P(CoulombIncline, SticksOrSlides) {
  const Incline c = GetParam();
  Slide s(c);
  test::advance_to(s.body, 0.35);
  const double at_first = s.speed(), begin = s.body.time();
  test::advance_to(s.body, 0.65);
  const double acceleration = (s.speed() - at_first) / (s.body.time() - begin);
  const double exact = std::max(0.0, kGravity * (std::sin(c.angle) - c.friction * std::cos(c.angle)));
  EXPECT_NEAR(acceleration, exact, (exact > 0.0 ? 0.01 : 1e-4) * kGravity);
  const double weight = test::mass(s.body) * kGravity;
  EXPECT_NEAR(norm(s.plate->forces().normal), weight * std::cos(c.angle), 0.03 * weight);
  RecordProperty("acceleration_m_s2", std::to_string(acceleration));
}

INSTANTIATE_TEST_SUITE_P(Angles, CoulombIncline,
                         testing::Values(Incline{0.10, 0.3}, Incline{0.28, 0.3}, Incline{0.30, 0.3}, Incline{0.45, 0.3},
                                         Incline{0.50, 0.6}, Incline{0.58, 0.6}, Incline{0.30, 0.0}));

}  // namespace
}  // namespace glisson

// What is reported of a contact is what was computed: area and pressure meet closed forms, traction on the surface sums to the
// tool's force, and an instrument's record has its pose, its torques and its vectors.
#include <cmath>
#include <numbers>

#include "glisson/instruments/container.h"
#include "glisson/instruments/needle.h"
#include "instruments/pressed_layer.h"
#include "support/must_step.h"

namespace glisson::contact_record_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Cells of width `first` that grow by a ratio, to fill a length.
int cells(double length, double first, double growth) {
  int n = 0;
  for (double sum = 0.0, width = first; sum < length; width *= growth, ++n) sum += width;
  return n;
}

/// A quarter of a bonded layer under a tool at rest; cells under the tool, and just beyond, are a/inside wide.
test::PressedLayer pressed(const Shape& shape, double a, double depth, int inside) {
  test::LayerOptions o;
  o.a = a, o.h = 6.0 * a, o.R = 6.0 * a, o.inside = inside, o.around = 6;
  o.edge = o.top = a / inside;
  o.outside = cells(o.R - o.a, o.edge, 1.25), o.layers = cells(o.h, o.top, 1.35);
  Tissue t;
  t.poisson_ratio = 0.3, t.volume_change = VolumeChange::average_nodal;
  test::PressedLayer p(o, t, shape, 0.0, depth, 0.04, 250.0, 1e-4);
  test::advance_to(p.body, 0.1);
  return p;
}

// Hertz: area π a² = π (3FR/4E*)^⅔ and the largest pressure 3F/(2π a²), by the force that was found [Johnson1985, ch. 4]. A triangle
// that is held out at the edge of contact loads its corner beyond it, too, so the radius is too large by up to a cell and a half,
// here 0.15 a; the pressure is flat at its top: 8 % off is the mesh's, to a millionth in each instruction set, and the bar 10 %.
TEST(ContactRecord, BallMeetsHertz) {
  const double R = 20e-3, a0 = 2e-3;
  const test::PressedLayer p = pressed(Ball{R}, a0, a0 * a0 / R, 10);
  Tissue t;
  const double E = t.youngs_modulus / (1.0 - 0.3 * 0.3), F = p.force(), a = std::cbrt(0.75 * F * R / E);
  EXPECT_GT(F, 0.0);
  EXPECT_GT(4.0 * p.tool->contact_area(), 0.9 * kPi * a * a);
  EXPECT_LT(4.0 * p.tool->contact_area(), 1.15 * 1.15 * kPi * a * a);
  EXPECT_NEAR(p.tool->largest_pressure(), 1.5 * F / (kPi * a * a), 0.1 * 1.5 * F / (kPi * a * a));
  EXPECT_EQ(p.tool->read("contact_area_m2"), p.tool->contact_area());
  EXPECT_EQ(p.tool->read("contact_pressure_most_Pa"), p.tool->largest_pressure());
}

// The area under a flat punch comes closer with the mesh: its radius is too large by up to a cell and a half.
TEST(ContactRecord, PunchHasItsArea) {
  const double a = 0.01;
  for (const int inside : {5, 10}) {
    const double edge = 1.0 + 1.5 / inside;
    const test::PressedLayer p =
        pressed(FlatPunch{.radius = (1.0 + 0.1 / inside) * a, .length = 0.05}, a, 1e-5, inside);
    EXPECT_GT(4.0 * p.tool->contact_area(), 0.99 * kPi * a * a);
    EXPECT_LT(4.0 * p.tool->contact_area(), edge * edge * kPi * a * a);
  }
}

/// Sum of traction times nodal area over the present surface, and of pressure times area.
std::pair<Vec3d, double> summed(const Simulation& body) {
  const ContactFields f = body.contact_fields();
  const std::vector<Vec3d> x = body.positions();
  Vec3d force;
  double pressing = 0.0;
  for (const Triangle& t : boundary_triangles(body.mesh())) {
    const double third = norm(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]])) / 6.0;
    for (const std::uint32_t v : t) force += f.traction[v] * third, pressing += f.pressure[v] * third;
  }
  return {force, pressing};
}

TetMesh block() { return box_mesh({.cells = {8, 8, 4}, .size = {0.04, 0.04, 0.02}}); }

std::shared_ptr<ContactTool> dragged_ball() {
  return std::make_shared<ContactTool>(
      ContactOptions{.shape = Ball{.radius = 8e-3}, .friction = 0.4}, std::make_shared<test::GivenPath>([](double t) {
        return Pose{{0.015 + 0.1 * std::max(0.0, t - 0.04), 0.021, 0.0201 - 0.003 * std::min(1.0, t / 0.04)}};
      }));
}

// Friction in it: traction is not along the normals, and its sum is the whole force, to rounding.
TEST(ContactRecord, TractionSumsToTheForce) {
  Simulation body(block(), {{0, Tissue{}}});
  body.fix("z_min");
  EXPECT_TRUE(body.contact_fields().traction.empty()) << "nothing touches it";
  const auto tool = dragged_ball();
  body.attach(tool);
  while (body.time() < 0.07) test::must_step(body);
  const auto [force, pressing] = summed(body);
  const Vec3d& rubs = tool->forces().friction;
  EXPECT_GT(norm(rubs), 0.1 * norm(tool->force()));
  EXPECT_LT(norm(force - tool->force()), 1e-12 * norm(tool->force()));
  EXPECT_GE(pressing, norm(tool->forces().normal) * (1.0 - 1e-12));  // normals of a ball fan out
  double most = 0.0;
  for (const double p : body.contact_fields().pressure) most = std::max(most, p);
  EXPECT_NEAR(most, tool->largest_pressure(), 0.01 * most);
}

// With a container it is the sum of both.
TEST(ContactRecord, TractionHasTheContainer) {
  SimulationOptions options;
  options.gravity = {0.0, 0.0, -9.81}, options.damping_rate = 50.0;
  Simulation body(block(), {{0, Tissue{}}}, options);
  const auto vessel = std::make_shared<Container>(ContainerOptions{
      .vessel = BoxVessel{.width = 0.0404, .length = 0.0404}, .pose = {.position = {0.02, 0.02, 0.0}}});
  body.attach(vessel);
  const auto tool = dragged_ball();
  body.attach(tool);
  while (body.time() < 0.07) test::must_step(body);
  const Vec3d all = tool->force() - vessel->sensor_loads().total();
  EXPECT_GT(vessel->sensor_loads().total().z, -1.0);
  EXPECT_LT(vessel->sensor_loads().bottom.z, 0.0);
  EXPECT_LT(norm(summed(body).first - all), 1e-12 * norm(vessel->sensor_loads().total()));
}

// A ball that slides sideways: friction along its depth is a small part of the friction it reports as a vector.
TEST(ContactRecord, FrictionIsAVector) {
  Simulation body(block(), {{0, Tissue{}}});
  body.fix("z_min");
  const auto tool = dragged_ball();
  body.attach(tool);
  while (body.time() < 0.07) test::must_step(body);
  const Vec3d f{tool->read("friction_x_N"), tool->read("friction_y_N"), tool->read("friction_z_N")};
  EXPECT_EQ(f, tool->forces().friction);
  EXPECT_EQ(tool->read("friction_size_N"), norm(f));
  EXPECT_GT(f.x, 0.0);  // the tissue is dragged along
  EXPECT_GT(norm(f), 3.0 * std::abs(tool->read("friction_N")));
  EXPECT_EQ(tool->read("position_x_m"), tool->force_pose().position.x);
  EXPECT_NEAR(tool->read("position_x_m"), 0.015 + 0.1 * (body.force_time() - 0.04), 1e-12);
}

// The quaternion is that of the pose at the time of the force; the torque about the handle is that of the tip moved there.
TEST(ContactRecord, HasRotationAndTorques) {
  const Vec3d axis = unit(Vec3d{1.0, -2.0, 0.5});
  for (const double angle : {0.0, 0.3, 1.9, 3.1}) {
    ContactTool tool({.shape = FlatPunch{}}, test::standing({{0.1, 0.2, 0.3}, test::rotation(axis, angle)}));
    EXPECT_NEAR(tool.read("rotation_w"), std::cos(0.5 * angle), 1e-12);
    EXPECT_NEAR(tool.read("rotation_x"), axis.x * std::sin(0.5 * angle), 1e-12);
    EXPECT_NEAR(tool.read("rotation_y"), axis.y * std::sin(0.5 * angle), 1e-12);
    EXPECT_NEAR(tool.read("rotation_z"), axis.z * std::sin(0.5 * angle), 1e-12);
  }
  Simulation body(block(), {{0, Tissue{}}});
  body.fix("z_min");
  const double length = 0.05;
  const auto tool = std::make_shared<ContactTool>(
      ContactOptions{.shape = FlatPunch{.radius = 6e-3, .length = length}, .friction = 0.5},
      std::make_shared<test::GivenPath>([](double t) {
        return Pose{{0.02 + 0.05 * t, 0.02, 0.0201 - 0.05 * t}, test::rotation({0, 1, 0}, 0.05)};
      }));
  body.attach(tool);
  while (body.time() < 0.05) test::must_step(body);
  EXPECT_NEAR(norm(tool->handle() - tool->force_pose().position), length, 1e-12);
  const Vec3d moved = tool->forces().torque - cross(tool->handle() - tool->force_pose().position, tool->force());
  EXPECT_GT(norm(moved), 0.0);
  EXPECT_NEAR(tool->read("handle_torque_y_N_m"), moved.y, 1e-15);
  EXPECT_EQ(tool->read("torque_y_N_m"), tool->forces().torque.y);
}

}  // namespace
}  // namespace glisson::contact_record_test

// Tools that turn: the motion is rigid, a twisted bar has the torque of its closed form, tables of poses are followed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "glisson/instruments/contact.h"
#include "glisson/instruments/driven_set.h"
#include "glisson/instruments/rigid_motion.h"
#include "support/bodies.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson {
namespace {

using std::numbers::pi;
using test::must_step;

SimulationOptions with(Integrator integrator) {
  SimulationOptions o;
  o.integrator = integrator;
  o.precision = Precision::double_precision;
  return o;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// A round bar of linear tissue twisted by its ends bears M = G J θ/L, J = π R⁴/2: its mesh is fine along the axis, where the
// error comes from, and the angle small, since small strain takes cos θ − 1 for a strain. The foot bears the same, the work is
// half of torque times angle.
TEST(Rotation, TwistedBarHasItsTorque) {
  const CylinderOptions bar{.radius = 0.01, .height = 0.006, .radial_cells = 10, .axial_cells = 12};
  const TetMesh mesh = cylinder_mesh(bar);
  Tissue tissue;
  tissue.youngs_modulus = 6000.0, tissue.poisson_ratio = 0.3;
  SimulationOptions o = with(Integrator::quasi_static);
  o.step = 1.0;
  Simulation s(mesh, {{0, tissue}}, o);
  const ConstraintId foot = s.fix("bottom");
  const RotationMotion turn{.axis = {0, 0, 2}, .angle_deg = 0.3, .rate_deg_s = 0.3};
  const auto head = std::make_shared<DrivenSet>(
      DrivenSetOptions{.name = "head", .vertices = mesh.vertex_sets.at("top")}, rotation_path(turn), turn);
  s.attach(head);
  must_step(s);
  const double angle = 0.3 * pi / 180.0;
  const double exact = 6000.0 / 2.6 * angle / bar.height * 0.5 * pi * std::pow(bar.radius, 4);
  RecordProperty("torque_over_exact", std::to_string(head->axial_torque() / exact));
  EXPECT_NEAR(head->axial_torque(), exact, 0.01 * exact);
  // Tissue of small strain balances moments about places at rest: about present ones to the square of the angle.
  EXPECT_NEAR(s.torque(foot, {}).z, -head->axial_torque(), angle * angle * exact);
  EXPECT_NEAR(head->angle(), angle, 1e-12);
  EXPECT_EQ(head->read("torque_N_m"), head->axial_torque());
  EXPECT_NEAR(head->read("angle_deg"), 0.3, 1e-9);
  EXPECT_NEAR(s.energies().work_tools, 0.5 * head->axial_torque() * angle, 1e-4 * exact * angle);
}

// Every integrator turns a set as a rigid body, also one that is taken hold of while it moves; a bar turned as a whole bears
// nothing.
TEST(Rotation, MovesAsARigidBody) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const RotationMotion turn{
      .axis = {1, 2, 3}, .center = {0.1, 0.0, 0.0}, .angle_deg = 200.0, .rate_deg_s = 400.0, .ramp = 0.1};
  for (const Integrator integrator : test::every_integrator()) {
    Tissue tissue;
    tissue.kinematics = Kinematics::corotational;
    Simulation s(mesh, {{0, tissue}}, with(integrator));
    const ConstraintId all = s.drive_rigidly(test::all_vertices(mesh), rotation_path(turn).pose);
    ASSERT_TRUE(s.advance_to(0.3).made());
    const Pose pose = rotation_path(turn).pose(s.time());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      EXPECT_LE(norm(mesh.vertices[v] + s.displacement()[v] - pose.to_space(mesh.vertices[v])), 1e-12);
    }
    EXPECT_LE(norm(s.force(all).elastic), 1e-6);
    std::stringstream file;
    s.save(file);
    Simulation later(mesh, {{0, tissue}}, with(integrator));
    later.drive_rigidly(test::all_vertices(mesh), rotation_path(turn).pose);
    later.load(file);
    must_step(s), must_step(later);
    EXPECT_EQ(s.state_hash(), later.state_hash());
  }
  Simulation falls(mesh, {{0, Tissue{}}}, [] {
    SimulationOptions o = with(Integrator::central_difference);
    o.gravity = {0, 0, -9.81};
    return o;
  }());
  falls.drive_rigidly("z_max", rotation_path(turn).pose, {}, 0.05);
  ASSERT_TRUE(falls.advance_to(0.05).made());
  std::vector<Vec3d> from = falls.positions();
  const Pose before = rotation_path(turn).pose(falls.time());
  ASSERT_TRUE(falls.advance_to(0.2).made());
  const Pose now = rotation_path(turn).pose(falls.time());
  for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
    const Vec3d there = mesh.vertices[v] + falls.displacement()[v];
    EXPECT_LE(norm(there - now.to_space(before.to_own(from[v]))), 2e-5)
        << "from where it was when it was taken hold of";
  }
}

// Angles of a table are met; a rotation and the same one as poses are the same motion, whatever the signs of the quaternions.
TEST(Rotation, TablesAreFollowed) {
  const RotationMotion table{.axis = {0, 1, 0}, .times = {0.0, 1.0, 3.0}, .angles_deg = {0.0, 90.0, 30.0}};
  EXPECT_DOUBLE_EQ(rotation_angle(table, 1.0), 0.5 * pi);
  EXPECT_DOUBLE_EQ(rotation_angle(table, 5.0), pi / 6.0);
  EXPECT_EQ(rotation_path(table).end, 3.0);
  const double c = std::cos(0.125 * pi), s = std::sin(0.125 * pi);
  PosesMotion poses{
      .times = {2.0, 3.0, 4.0},
      .positions = {{0.1, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0.05}},
      .quaternions = {{{1, 0, 0, 0}}, {{-2 * c, 0, 0, -2 * s}}, {{std::cos(0.25 * pi), 0, 0, std::sin(0.25 * pi)}}},
      .start = 0.5};
  const RigidPath path = poses_path(poses);
  EXPECT_DOUBLE_EQ(*path.end, 2.5);
  EXPECT_LE(norm(path.pose(0.2).to_space({1, 2, 3}) - Vec3d{1, 2, 3}), 1e-15) << "before the start";
  const auto about = [](double angle, const Vec3d& x) {
    return Vec3d{std::cos(angle) * x.x - std::sin(angle) * x.y, std::sin(angle) * x.x + std::cos(angle) * x.y, x.z};
  };
  const Vec3d x{0.3, 0.2, 0.1}, tip{0.1, 0, 0};
  EXPECT_LE(norm(path.pose(1.0).to_space(x) - tip - about(0.125 * pi, x - tip)), 1e-15) << "half of an eighth turn";
  EXPECT_LE(norm(path.pose(9.0).to_space(x) - tip - Vec3d{0, 0, 0.05} - about(0.5 * pi, x - tip)), 1e-15);
}

// A contact tool turns with its driver: the pose at the end is the rotated start.
TEST(Rotation, TurnsAnInstrument) {
  const RotationMotion turn{.axis = {0, 0, 1}, .center = {0.01, 0.01, 0}, .angle_deg = 90.0, .rate_deg_s = 900.0};
  Simulation s(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}}), {{0, Tissue{}}});
  s.fix("z_min");
  const auto driver = std::make_shared<RigidDriver>(Pose{.position = {0.02, 0.01, 0.03}}, rotation_path(turn));
  EXPECT_NEAR(*driver->end(), 0.1, 1e-12);
  ContactOptions options;
  options.shape = Ball{.radius = 0.002};
  const auto ball = std::make_shared<ContactTool>(options, driver);
  s.attach(ball);
  ASSERT_TRUE(s.advance_to(0.15).made());
  EXPECT_LE(norm(ball->pose().position - Vec3d{0.01, 0.02, 0.03}), 1e-12);
  EXPECT_LE(norm(ball->pose().axes * Vec3d{1, 0, 0} - Vec3d{0, 1, 0}), 1e-12);
}

// Mistakes are named.
TEST(Rotation, RefusesWhatIsNoMotion) {
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(refusal([] { rotation_path({}); }), "axis"));
  EXPECT_TRUE(has(refusal([] { rotation_path({.axis = {0, 0, 1}, .rate_deg_s = 0.0}); }), "rate_deg_s"));
  EXPECT_TRUE(has(refusal([] {
                    rotation_path({.axis = {0, 0, 1}, .times = {0, 1}, .angles_deg = {1}});
                  }),
                  "2 times and 1 angles"));
  EXPECT_TRUE(has(refusal([] {
                    rotation_path({.axis = {0, 0, 1}, .times = {0, 0}, .angles_deg = {1, 2}});
                  }),
                  "not later"));
  EXPECT_TRUE(
      has(refusal([] {
            poses_path({.times = {0, 1}, .positions = {{}, {}}, .quaternions = {{{1, 0, 0, 0}}, {{0, 0, 0, 0}}}});
          }),
          "quaternion of length 0"));
  Simulation s(test::paper_mesh(), {{0, Tissue{}}});
  EXPECT_TRUE(has(refusal([&] { s.drive_rigidly("z_max", {}); }), "no motion"));
}

}  // namespace
}  // namespace glisson

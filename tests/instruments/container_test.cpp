// A container holds tissue as its walls would, from free to bonded, and feels what the tissue exerts on it: in slow motion the
// load on bottom and sides is what the tool pushes with.
#include "glisson/instruments/container.h"

#include <sstream>

#include "instruments/contact_scenes.h"
#include "instruments/container_kinds.h"
#include "support/must_step.h"

namespace glisson::container_test {
namespace {

Tissue tissue(double nu = 0.4) {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = nu;
  return t;
}

SimulationOptions damped(double rate, const Vec3d& gravity = {}) {
  SimulationOptions o;
  o.damping_rate = rate, o.gravity = gravity;
  return o;
}

std::shared_ptr<Container> vessel(double radius, double friction = 0.0) {
  ContainerOptions o;
  o.vessel = CylinderVessel{.radius = radius};
  o.friction = friction;
  return std::make_shared<Container>(o);
}

std::shared_ptr<ContactTool> pressing(const Shape& shape, double top, double depth, double speed) {
  ContactOptions o;
  o.shape = shape;
  return std::make_shared<ContactTool>(o, std::make_shared<test::GivenPath>([=](double t) {
                                         return Pose{{0.0, 0.0, top - std::min(depth, speed * t)}};
                                       }));
}

/// A cylinder of tissue, 4 cm wide and 3 cm high, with a punch of 8 mm pressed 3 mm into it.
struct Experiment {
  Simulation body;
  std::shared_ptr<Container> container;
  std::shared_ptr<ContactTool> tool;

  explicit Experiment(const ContainerOptions& o, double depth = 3e-3, double speed = 0.01, double rate = 150.0)
      : body(cylinder_mesh({.radius = 0.02, .height = 0.03, .radial_cells = 6, .axial_cells = 6, .grading = 2.0}),
             {{0, tissue()}}, damped(rate)),
        container(std::make_shared<Container>(o)), tool(pressing(FlatPunch{.radius = 4e-3}, 0.03, depth, speed)) {
    body.attach(container);
    body.attach(tool);
  }
  /// All axial forces on the tissue [N].
  double out_of_balance() const { return tool->forces().total().z - container->sensor_loads().total().z; }
};

class StaticBalance : public testing::TestWithParam<ContainerOptions> {};

// Pressing on at 2 mm/s, damping and inertia keep what is out of balance within 1 % of the tool's force; at rest, when what
// swings has died down by e^(−15/s · 0.4 s), a tenth of that.
TEST_P(StaticBalance, ToolBottomAndSides) {
  ContainerOptions o = GetParam();
  o.vessel = CylinderVessel{.radius = 0.02};
  Experiment e(o, 1.2e-3, 2e-3, 30.0);
  double worst = 0.0;
  while (e.body.time() < 0.6) {
    ASSERT_EQ(e.body.step().status, StepStatus::ok);
    if (e.body.time() > 0.3) worst = std::max(worst, std::abs(e.out_of_balance() / e.tool->forces().total().z));
  }
  EXPECT_LT(worst, 0.01);
  test::advance_to(e.body, 1.0);
  const double force = -e.tool->forces().total().z;
  EXPECT_GT(force, 0.05);
  EXPECT_NEAR(e.out_of_balance(), 0.0, 1e-3 * force);
  EXPECT_LT(e.container->sensor_loads().bottom.z, 0.0);
  // by symmetry nothing is left sideways, but for the mesh, whose six sectors are split alike
  EXPECT_LT(std::hypot(e.container->sensor_loads().side.x, e.container->sensor_loads().side.y), 0.05 * force);
  RecordProperty("out_of_balance_percent_moving", std::to_string(100.0 * worst));
  RecordProperty("side_share", std::to_string(-e.container->sensor_loads().side.z / force));
}

INSTANTIATE_TEST_SUITE_P(FreeToBonded, StaticBalance, testing::ValuesIn(test::container_kinds()), test::kind_of);

// The wall bears none of the axial load without friction, the more the more friction, most when bonded; the tool's force
// grows in the same order, and tissue presses outward.
TEST(ContainerFriction, GoesFromFreeToBonded) {
  double side = -1e-9, force = 0.0;
  for (ContainerOptions o :
       {test::with(0.0, false, false), test::with(0.2, false, false), test::with(0.0, false, true)}) {
    o.vessel = CylinderVessel{.radius = 0.02};
    Experiment e(o);
    test::advance_to(e.body, 0.6);
    EXPECT_GT(-e.container->sensor_loads().side.z, side);
    EXPECT_GT(-e.tool->forces().total().z, force);
    EXPECT_GT(e.container->sensor_loads().side_radial, 0.0);
    if (o.friction == 0.0 && !o.bonded) {
      EXPECT_NEAR(e.container->sensor_loads().side.z, 0.0, 1e-12);
    }
    side = -e.container->sensor_loads().side.z + 1e-4, force = -e.tool->forces().total().z;
  }
}

// Bonded is what supports do that hold the same vertices: the same motion, and their forces.
TEST(Container, BondedIsAsFixed) {
  ContainerOptions o = test::with(0.0, false, true);
  o.vessel = CylinderVessel{.radius = 0.02};
  Experiment a(o, 1e-3);
  Experiment b(o, 1e-3);
  Simulation fixed(b.body.mesh(), {{0, tissue()}}, damped(150.0));
  std::vector<std::uint32_t> held = fixed.mesh().vertex_sets.at("bottom");
  const std::size_t on_floor = held.size();
  for (const std::uint32_t v : fixed.mesh().vertex_sets.at("wall")) {
    if (std::find(held.begin(), held.begin() + static_cast<std::ptrdiff_t>(on_floor), v) ==
        held.begin() + static_cast<std::ptrdiff_t>(on_floor)) {
      held.push_back(v);
    }
  }
  const ConstraintId floor = fixed.fix(std::span(held).first(on_floor));
  const ConstraintId wall = fixed.fix(std::span(held).subspan(on_floor));
  const auto tool = pressing(FlatPunch{.radius = 4e-3}, 0.03, 1e-3, 0.01);
  fixed.attach(tool);
  test::advance_to(a.body, 0.1);
  test::advance_to(fixed, 0.1);
  EXPECT_EQ(test::relative_difference(a.body.displacement(), fixed.displacement()), 0.0);
  const double force = norm(tool->forces().total());
  EXPECT_NEAR(norm(a.container->sensor_loads().bottom + fixed.force(floor).total()), 0.0, 1e-9 * force);
  EXPECT_NEAR(norm(a.container->sensor_loads().side + fixed.force(wall).total()), 0.0, 1e-9 * force);
}

// A confined column: without friction and under its own weight the floor bears all of it, and the wall ν/(1 − ν) ρ g z at
// depth z below the top, over the wall 2πR · ν/(1 − ν) ρ g H²/2. The wall has corners, not curves:
// 36 of them are 0.5 % smaller round. 0.9949 of it was measured: 1 %.
TEST(Container, BearsWeightAsAFluidWould) {
  const double R = 0.02, H = 0.03, g = 9.81, nu = 0.4;
  Simulation body(cylinder_mesh({.radius = R, .height = H, .radial_cells = 6, .axial_cells = 12}), {{0, tissue(nu)}},
                  damped(60.0, {0.0, 0.0, -g}));
  const auto container = vessel(R);
  body.attach(container);
  test::advance_to(body, 0.8);
  const double weight = test::mass(body) * g, pi = std::acos(-1.0);
  EXPECT_NEAR(container->sensor_loads().bottom.z, -weight, 1e-3 * weight);
  const double exact = 2.0 * pi * R * nu / (1.0 - nu) * 1000.0 * g * H * H / 2.0;
  EXPECT_NEAR(container->sensor_loads().side_radial, exact, 0.01 * exact);
  EXPECT_NEAR(norm(container->sensor_loads().side), 0.0, 1e-3 * weight);
}

// A vessel that is turned feels the same, turned; a box does as a cylinder.
TEST(Container, BoxBearsWeightTurned) {
  const double g = 9.81;
  const Mat3d turned = test::rotation({0.6, 0.8, 0.0}, 0.7);
  TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {0.03, 0.02, 0.02}});
  const Pose pose{{0.1, -0.2, 0.05}, turned};
  for (Vec3d& x : mesh.vertices) x = pose.position + turned * (x - Vec3d{0.015, 0.01, 0.0});
  Simulation body(mesh, {{0, tissue()}}, damped(60.0, turned * Vec3d{0.0, 0.0, -g}));
  ContainerOptions o;
  o.vessel = BoxVessel{.width = 0.03, .length = 0.02};
  o.pose = pose;
  const auto container = std::make_shared<Container>(o);
  body.attach(container);
  test::advance_to(body, 0.8);
  const double weight = test::mass(body) * g;
  EXPECT_NEAR(norm(container->sensor_loads().bottom + container->up() * weight), 0.0, 2e-3 * weight);
  EXPECT_NEAR(norm(container->sensor_loads().side), 0.0, 2e-3 * weight);
  EXPECT_GT(container->sensor_loads().side_radial, 0.1 * weight);
}

// Tissue pulled upward leaves a floor that does not hold it, and stays on one that does, sliding freely.
TEST(Container, HoldsTheFloorIfTold) {
  for (const bool holds : {false, true}) {
    Simulation body(box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}, .origin = {-0.01, -0.01, 0.0}}),
                    {{0, tissue()}}, damped(20.0, {0.5, 0.0, 2.0}));
    ContainerOptions o;
    o.vessel = CylinderVessel{.radius = 1.0};
    o.holds_floor = holds;
    const auto container = std::make_shared<Container>(o);
    body.attach(container);
    test::advance_to(body, 0.6);
    const Vec3d at = body.displacement()[0];
    EXPECT_EQ(at.z > 1e-3, !holds);
    EXPECT_GT(at.x, 1e-3);
    const double pull = 2.0 * test::mass(body);
    EXPECT_NEAR(container->sensor_loads().bottom.z, holds ? pull : 0.0, 0.02 * pull);
  }
}

// A run goes on from a checkpoint with the same bytes, whatever the walls do.
TEST(Container, CheckpointGoesOn) {
  for (ContainerOptions o :
       {test::with(0.3, false, false), test::with(0.0, true, false), test::with(0.0, false, true)}) {
    o.vessel = CylinderVessel{.radius = 0.02};
    Experiment a(o), b(o);
    test::advance_to(a.body, 0.05);
    std::stringstream file;
    a.body.save(file);
    test::advance_to(a.body, 0.1);
    b.body.load(file);
    test::advance_to(b.body, 0.1);
    EXPECT_EQ(a.body.state_hash(), b.body.state_hash());
  }
}

/// Acts on nothing, and has all vertices at hand: none may rest.
class NamesAll : public Interaction {
 public:
  void attached(const BodyView& body, double) override {
    for (std::uint32_t v = 0; v < body.mesh.vertices.size(); ++v) all_.push_back(v);
  }
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double, double) override { return all_; }

 private:
  std::vector<std::uint32_t> all_;
};

// What is bonded rests and bears the same as where impulses stop it, weight and viscosity included; tissue that is set elsewhere is
// pulled back to its place.
TEST(Container, BondsThatRestBearTheSame) {
  const TetMesh mesh = cylinder_mesh({.radius = 0.02, .height = 0.03, .radial_cells = 4, .axial_cells = 5});
  ContainerOptions o = test::with(0.0, false, true);
  o.vessel = CylinderVessel{.radius = 0.02};
  Tissue viscous = tissue();
  viscous.viscosity = 5.0;
  ContainerLoads loads[2];
  double force[2] = {};
  for (const int stages : {1, 2}) {
    for (const std::size_t named : {0U, 1U}) {
      SimulationOptions options = damped(20.0, {0.0, 0.0, -9.81});
      options.drag_stages = stages;
      Simulation body(mesh, {{0, viscous}}, options);
      const auto container = std::make_shared<Container>(o);
      const auto tool = pressing(FlatPunch{.radius = 4e-3}, 0.03, 2e-3, 0.02);
      body.attach(container);
      body.attach(tool);
      if (named == 1) body.attach(std::make_shared<NamesAll>());
      test::advance_to(body, 0.1);
      loads[named] = container->sensor_loads(), force[named] = tool->forces().total().z;
      if (named == 1) continue;
      std::vector<Vec3d> u(body.displacement().begin(), body.displacement().end());
      const std::uint32_t bonded = mesh.vertex_sets.at("bottom").front();
      u[bonded] += Vec3d{0.0, 0.0, 1e-4};
      body.set_state(u, std::vector<Vec3d>(u.size()));
      for (int i = 0; i < 5; ++i) test::must_step(body);
      EXPECT_LE(norm(body.displacement()[bonded]), 1e-9);
    }
    EXPECT_GT(norm(loads[0].total()), 0.05);
    EXPECT_LE(norm(loads[0].total() - loads[1].total()), 1e-5 * norm(loads[1].total())) << stages << " stages";
    EXPECT_LE(norm(loads[0].side - loads[1].side), 1e-5 * norm(loads[1].total()));
    EXPECT_NEAR(force[0], force[1], 1e-5 * std::abs(force[1]));
  }
}

// A wall as high as the body holds the body's upper edge wherever the two stand: that both are of 30 mm does not hang on the last digit
// of a coordinate. Against the same at the origin, in which nothing is rounded.
TEST(Container, HoldsWhatIsLevelWithItsRim) {
  const auto force = [](double z) {
    TetMesh mesh = cylinder_mesh({.radius = 0.02, .height = 0.03, .radial_cells = 3, .axial_cells = 3});
    for (Vec3d& x : mesh.vertices) x.z = (z + 0.03) - (0.03 - x.z);
    SimulationOptions o{.integrator = Integrator::quasi_static, .step = 0.1};
    Simulation body(mesh, {{0, tissue()}}, o);
    ContainerOptions bonded = test::with(0.0, false, true);
    bonded.pose.position.z = z;
    bonded.vessel = CylinderVessel{.radius = 0.02, .height = 0.03};
    const auto container = std::make_shared<Container>(bonded);
    body.attach(container);
    body.add_surface_load("top", {.pressure = 100.0});
    test::must_step(body);
    return container->sensor_loads().side.z;
  };
  const double there = force(0.0);
  EXPECT_LT(there, -0.01);
  for (int k = 1; k < 40; ++k) EXPECT_NEAR(force(0.0013 * k), there, 1e-6 * std::abs(there)) << k;
}

// A body that is wider than its vessel is a mistake, and the message says by how much.
TEST(Container, RefusesABodyThatStandsOut) {
  const TetMesh mesh = cylinder_mesh({.radius = 0.02, .height = 0.02, .radial_cells = 3, .axial_cells = 2});
  Simulation body(mesh, {{0, Tissue{}}});
  ContainerOptions narrow;
  narrow.vessel = CylinderVessel{.radius = 0.015};
  try {
    body.attach(std::make_shared<Container>(narrow));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("stands out of it by 5 mm"), std::string::npos) << error.what();
  }
}

TEST(Container, RefusesBadOptions) {
  const auto refused = [](auto change) {
    ContainerOptions o;
    change(o);
    EXPECT_THROW(Container{o}, std::invalid_argument);
  };
  refused([](ContainerOptions& o) { o.friction = -0.1; });
  refused([](ContainerOptions& o) { o.friction = std::nan(""); });
  refused([](ContainerOptions& o) { o.vessel = CylinderVessel{.radius = 0.0}; });
  refused([](ContainerOptions& o) { o.vessel = BoxVessel{.width = test::kInfinite}; });
  refused([](ContainerOptions& o) { o.vessel = CylinderVessel{.height = -1.0}; });
  refused([](ContainerOptions& o) { o.pose.axes(0, 0) = 2.0; });
  refused([](ContainerOptions& o) { o.push_out_speed = 0.0; });
}

}  // namespace
}  // namespace glisson::container_test

// A container in the long steps of `implicit` and `quasi_static`: the explicit scheme's loads, balance with the tool, bonds as supports.
#include "glisson/instruments/container.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "instruments/contact_scenes.h"
#include "instruments/container_kinds.h"

namespace glisson::long_container_test {
namespace {

Tissue tissue() {
  Tissue t;
  t.youngs_modulus = 5000.0, t.poisson_ratio = 0.4;
  return t;
}

SimulationOptions options(Integrator integrator, double h) {
  SimulationOptions o = test::in_steps_of(integrator, h);
  o.damping_rate = 150.0;
  return o;
}

/// A cylinder of tissue, 4 cm wide and 3 cm high, in a container, with a punch of 8 mm pressed 2 mm into it within 0.2 s.
struct Experiment {
  Simulation body;
  std::shared_ptr<Container> container;
  std::shared_ptr<ContactTool> tool;

  Experiment(Integrator integrator, double h, ContainerOptions o, double radius = 0.02)
      : body(cylinder_mesh({.radius = 0.02, .height = 0.03, .radial_cells = 5, .axial_cells = 6, .grading = 2.0}),
             {{0, tissue()}}, options(integrator, h)) {
    o.vessel = CylinderVessel{.radius = radius};
    container = std::make_shared<Container>(o);
    ContactOptions punch;
    punch.shape = FlatPunch{.radius = 5e-3, .edge_radius = 1e-3};
    tool = std::make_shared<ContactTool>(punch, std::make_shared<test::GivenPath>([](double t) {
                                           const double s = std::clamp(t / 0.2, 0.0, 1.0);
                                           return Pose{{0.0, 0.0, 0.03 - 0.002 * s * s * (3.0 - 2.0 * s)}};
                                         }));
    body.attach(container);
    body.attach(tool);
  }
  void run_to(double end) {
    while (body.time() < end - 1e-9) {
      const StepResult r = body.step();
      ASSERT_TRUE(r.made()) << r.message;
    }
  }
  double force() const { return tool->forces().total().z; }
  const ContainerLoads& loads() const { return container->sensor_loads(); }
};

class LongContainer : public testing::TestWithParam<ContainerOptions> {};

// At rest, after 20 steps of 20 ms: the tool's force and the loads on bottom and side are the explicit scheme's in short steps within 1.5 % of
// the force, and balance within 0.1 %. The ledger closes.
TEST_P(LongContainer, BearsAsInTheExplicitScheme) {  // long; verify: rough, friction
  Experiment reference(Integrator::central_difference, test::kShortStep, GetParam());
  reference.run_to(0.4);
  const double force = -reference.force();
  EXPECT_GT(force, 0.1);
  Experiment e(Integrator::implicit, 0.02, GetParam());
  e.run_to(0.4);
  EXPECT_NEAR(e.force(), -force, 0.015 * force);
  EXPECT_NEAR(e.loads().bottom.z, reference.loads().bottom.z, 0.015 * force);
  EXPECT_NEAR(e.loads().side.z, reference.loads().side.z, 0.015 * force);
  EXPECT_NEAR(e.loads().side_radial, reference.loads().side_radial, 0.02 * std::abs(reference.loads().side_radial));
  EXPECT_NEAR(e.force(), e.loads().total().z, 1e-3 * force);
  EXPECT_NEAR(e.body.energies().imbalance(), 0.0, 1e-6 * e.body.energies().work_tools);
  RecordProperty("force_percent", std::to_string(100.0 * (-e.force() / force - 1.0)));
  RecordProperty("bottom_percent", std::to_string(100.0 * (e.loads().bottom.z - reference.loads().bottom.z) / force));
  RecordProperty("side_percent", std::to_string(100.0 * (e.loads().side.z - reference.loads().side.z) / force));
}

INSTANTIATE_TEST_SUITE_P(FreeToBonded, LongContainer, testing::ValuesIn(test::container_kinds()), test::kind_of);

// Bonded tissue is held as by supports: the same displacements to the bit, and the loads are the supports' forces. In statics
// it needs no others.
TEST(LongContainerBonds, AreSupports) {
  for (const Integrator integrator : {Integrator::implicit, Integrator::quasi_static}) {
    ContainerOptions o = test::with(0.0, false, true);
    Experiment bonded(integrator, 0.02, o);
    const TetMesh& mesh = bonded.body.mesh();
    std::vector<std::uint32_t> bottom = mesh.vertex_sets.at("bottom"), wall;
    for (const std::uint32_t v : mesh.vertex_sets.at("wall")) {
      if (mesh.vertices[v].z > 1e-9) wall.push_back(v);
    }
    Simulation fixed(mesh, {{0, tissue()}}, options(integrator, 0.02));
    const ConstraintId on_bottom = fixed.fix(bottom), on_wall = fixed.fix(wall);
    const auto tool =
        std::make_shared<ContactTool>(bonded.tool->options(), std::make_shared<test::GivenPath>([](double t) {
                                        const double s = std::clamp(t / 0.2, 0.0, 1.0);
                                        return Pose{{0.0, 0.0, 0.03 - 0.002 * s * s * (3.0 - 2.0 * s)}};
                                      }));
    fixed.attach(tool);
    for (int k = 0; k < 12; ++k) ASSERT_TRUE(bonded.body.step().made() && fixed.step().made());
    double apart = 0.0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      apart = std::max(apart, norm(bonded.body.displacement()[v] - fixed.displacement()[v]));
    }
    EXPECT_LT(apart, 1e-9) << word_of(integrator);
    const double force = std::abs(bonded.force());
    EXPECT_NEAR(norm(bonded.loads().bottom + fixed.force(on_bottom).total()), 0.0, 1e-6 * force);
    EXPECT_NEAR(norm(bonded.loads().side + fixed.force(on_wall).total()), 0.0, 1e-6 * force);
  }
}

// A column settles under its weight between walls that it slides on: the wall bears 2πR ν/(1 − ν) ρ g H²/2, the floor the
// weight; within 1 % on these cells.
TEST(LongContainerWeight, IsOnFloorAndWall) {
  SimulationOptions o = options(Integrator::implicit, 0.05);
  o.gravity = {0.0, 0.0, -9.81};
  Tissue t = tissue();
  t.poisson_ratio = 0.3;
  Simulation s(cylinder_mesh({.radius = 0.01, .height = 0.02, .radial_cells = 4, .axial_cells = 8}), {{0, t}}, o);
  ContainerOptions c;
  c.vessel = CylinderVessel{.radius = 0.01};
  const auto container = std::make_shared<Container>(c);
  s.attach(container);
  for (int k = 0; k < 40; ++k) {
    const StepResult r = s.step();
    ASSERT_TRUE(r.made()) << r.message;
  }
  const double weight = test::mass(s) * 9.81;
  EXPECT_NEAR(container->sensor_loads().bottom.z, -weight, 1e-3 * weight);
  EXPECT_NEAR(container->sensor_loads().side.z, 0.0, 1e-6 * weight);
  const double exact = 2.0 * std::acos(-1.0) * 0.01 * (0.3 / 0.7) * t.density * 9.81 * 0.02 * 0.02 / 2.0;
  EXPECT_NEAR(container->sensor_loads().side_radial / exact, 1.0, 0.03);
  RecordProperty("side_radial", std::to_string(container->sensor_loads().side_radial / exact));
}

// A run that was saved goes on with the same bytes; tissue that bulges against a wall that bonds stays there, and is held from then on.
TEST(LongContainerCheckpoint, GoesOn) {  // long
  for (const bool bonded : {false, true}) {
    const auto made = [&] {
      return Experiment(Integrator::implicit, 0.02, test::with(0.0, false, bonded), bonded ? 0.02002 : 0.02);
    };
    Experiment a = made(), b = made();
    a.run_to(bonded ? 0.2 : 0.08);
    std::stringstream file;
    a.body.save(file);
    b.body.load(file);
    for (int k = 0; k < 4; ++k) ASSERT_TRUE(a.body.step().made() && b.body.step().made());
    EXPECT_EQ(a.body.state_hash(), b.body.state_hash()) << bonded;
    EXPECT_EQ(a.force(), b.force());
    EXPECT_EQ(a.loads().bottom, b.loads().bottom);
    EXPECT_EQ(a.loads().side, b.loads().side);
    EXPECT_GT(a.loads().side_radial, 0.0);
    if (!bonded) continue;  // it still moves
    EXPECT_NEAR(a.force(), a.loads().total().z, 5e-3 * std::abs(a.force()));
  }
}

}  // namespace
}  // namespace glisson::long_container_test

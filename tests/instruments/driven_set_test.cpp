// A driven set of vertices is an instrument: with any integrator its depth, force and columns are those of its constraint.
#include "glisson/instruments/driven_set.h"

#include <gtest/gtest.h>

#include <optional>

#include "glisson/simulation/simulation.h"
#include "support/integrators.h"

namespace glisson::driven_set_test {
namespace {

class DrivenSets : public testing::TestWithParam<Integrator> {
 protected:
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  std::optional<Simulation> body{std::in_place, mesh, std::map<int, Tissue>{{0, Tissue{}}},
                                 SimulationOptions{.integrator = GetParam(), .gravity = {0, 0, -9.81}}};
  PressMotion press{.direction = {0, 0, -2}, .velocity = 0.02, .depth = 0.01};
  std::shared_ptr<DrivenSet> tool = std::make_shared<DrivenSet>(
      DrivenSetOptions{.name = "plate", .vertices = mesh.vertex_sets.at("z_max"), .direction = press.direction},
      press_path(press));

  void SetUp() override {
    body->fix(mesh.vertex_sets.at("z_min"));
    body->attach(tool);
  }
};

TEST_P(DrivenSets, ReadAsTheirConstraint) {
  EXPECT_EQ(tool->force(), Vec3d{}) << "before the first step";
  while (body->time() < 0.05) ASSERT_TRUE(body->step().made());
  const ForceParts parts = body->force(tool->constraint());
  EXPECT_LT(parts.elastic.z, 0.0) << "it presses the tissue down";
  EXPECT_EQ(tool->force(), parts.total());
  EXPECT_EQ(tool->sensor_force(), -(parts.total() - parts.inertial - parts.gravity));
  EXPECT_EQ(tool->read("force_N"), -parts.total().z);
  EXPECT_EQ(tool->read("elastic_N"), -parts.elastic.z);
  EXPECT_DOUBLE_EQ(tool->force_depth(), press_depth(press, body->force_time()));
  EXPECT_DOUBLE_EQ(tool->pose().position.z, -press_depth(press, body->time()));
  EXPECT_NEAR(body->displacement()[mesh.vertex_sets.at("z_max").front()].z, tool->pose().position.z, 1e-12);
  EXPECT_THROW(tool->read("normal_N"), std::out_of_range) << "it is fixed to the tissue";
}

TEST_P(DrivenSets, BelongToOneBody) {
  Simulation other(mesh, {{0, Tissue{}}});
  EXPECT_THROW(other.attach(tool), std::invalid_argument);
  const auto second =
      std::make_shared<DrivenSet>(DrivenSetOptions{.vertices = {mesh.vertex_sets.at("z_max")}}, press_path(press));
  EXPECT_THROW(body->attach(second), std::invalid_argument) << "those vertices are driven already";
  EXPECT_NO_THROW(other.attach(second)) << "a refused one is still free";
  ASSERT_TRUE(body->step().made());
  body.reset();
  EXPECT_EQ(tool->force(), Vec3d{}) << "the body is no more";
  EXPECT_EQ(tool->force_depth(), 0.0);
}

// The middle of a set that turns, whose place its pose tells, is that of its vertices in tets: it goes as
// the rotation takes it, whatever vertices in no tet the set has.
TEST(DrivenSet, ItsMiddleIsThatOfItsVerticesInTets) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  std::vector<std::uint32_t> top = mesh.vertex_sets.at("z_max");
  top.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
  mesh.vertices.push_back({0.5, 0.5, 0.5});
  Simulation body(mesh, {{0, Tissue{}}}, {.integrator = Integrator::quasi_static, .step = 0.01});
  body.fix("z_min");
  const RotationMotion turn{.axis = {0.0, 0.0, 1.0}, .times = {0.0, 0.01}, .angles_deg = {0.0, 2.0}};
  const auto tool = std::make_shared<DrivenSet>(DrivenSetOptions{.vertices = top}, rotation_path(turn));
  body.attach(tool);
  ASSERT_TRUE(body.step().made());
  const Vec3d middle{0.01, 0.01, 0.02};
  EXPECT_LE(norm(tool->pose().position - (rotation_path(turn).pose(body.time()).to_space(middle) - middle)), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(All, DrivenSets, testing::ValuesIn(test::every_integrator()));

}  // namespace
}  // namespace glisson::driven_set_test

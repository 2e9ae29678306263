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

INSTANTIATE_TEST_SUITE_P(All, DrivenSets, testing::ValuesIn(test::every_integrator()));

}  // namespace
}  // namespace glisson::driven_set_test

// Directions of fibres from the mesh: each tet has its own, and one that is missing is told.
#include <gtest/gtest.h>

#include "element/element_shape.h"
#include "element/tissue_operator.h"

namespace glisson {
namespace {

Tissue fibrous() {
  Tissue tissue;
  tissue.name = "muscle";
  tissue.fibres = Fibres{.direction = {0.0, 0.0, 1.0}, .stiffness = 5000.0};
  return tissue;
}

// Stretching a box along x by 1 % strains the fibres of tets that lie along x only: energy ½ c ε² V of those tets more.
TEST(FibreField, OfTheMeshWinsOverTheTissues) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  mesh.fibres.assign(mesh.tets.size(), {0.0, 3.0, 0.0});
  double along = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); t += 3) {
    mesh.fibres[t] = {2.0, 0.0, 0.0};
    along += six_rest_volume(mesh, t) / 6.0;
  }
  std::vector<Vec3d> u;
  for (const Vec3d& x : mesh.vertices) u.push_back({0.01 * x.x, 0.0, 0.0});
  const Body with = build_body(mesh, {{0, fibrous()}}), without = build_body(mesh, {{0, Tissue{}}});
  const double more = TissueOperator(with).energy(u) - TissueOperator(without).energy(u);
  EXPECT_NEAR(more, 0.5 * 5000.0 * 1e-4 * along, 1e-12 * more + 1e-18);
}

// A direction without length is allowed where there are no fibres, and told by tet and tissue where there are.
TEST(FibreField, ADirectionWithoutLengthIsTold) {
  TetMesh mesh = box_mesh({.cells = {1, 1, 1}, .size = {0.01, 0.01, 0.01}});
  mesh.fibres.assign(mesh.tets.size(), {1.0, 0.0, 0.0});
  mesh.fibres[4] = {};
  EXPECT_NO_THROW(build_body(mesh, {{0, Tissue{}}}));
  try {
    build_body(mesh, {{0, fibrous()}});
    FAIL() << "not refused";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("tet 4 of tissue \"muscle\""), std::string::npos) << e.what();
  }
  mesh.fibres.pop_back();
  EXPECT_THROW(build_body(mesh, {{0, Tissue{}}}), std::invalid_argument);
}

}  // namespace
}  // namespace glisson

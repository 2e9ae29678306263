// A point of the rest mesh is found in the tet that holds it, and only there.
#include "mesh/inspect/tet_locator.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "../support/random.h"

namespace glisson::detail {
namespace {

Vec3d point_of(const TetMesh& mesh, const LocatedPoint& p) {
  Vec3d x;
  for (std::size_t a = 0; a < 4; ++a) x += mesh.vertices[mesh.tets[p.tet][a]] * p.weights[a];
  return x;
}

const TetMesh& cylinder() {
  static const TetMesh mesh = cylinder_mesh({.radius = 0.03, .height = 0.05, .radial_cells = 6, .grading = 4.0});
  return mesh;
}

// The weights give the point back: to rounding of coordinates of some cm.
RC_GTEST_PROP(TetLocator, WeightsGiveThePointBack, ()) {
  const TetMesh& mesh = cylinder();
  static const TetLocator locator(mesh, {});
  const auto t = static_cast<std::size_t>(test::integer(0, static_cast<int>(mesh.tets.size())));
  std::array<double, 4> w;
  double sum = 0.0;
  for (double& a : w) sum += a = test::number(0.01, 1.0);
  Vec3d x;
  for (std::size_t a = 0; a < 4; ++a) x += mesh.vertices[mesh.tets[t][a]] * (w[a] / sum);
  const auto found = locator.locate(x);
  RC_ASSERT(found.has_value());
  RC_ASSERT(found->tet == t);
  RC_ASSERT(norm(point_of(mesh, *found) - x) < 1e-15);
}

// Whatever tet is guessed, the answer is the same to the byte, on faces, edges and corners, too.
RC_GTEST_PROP(TetLocator, GuessesDoNotChangeTheAnswer, ()) {
  const TetMesh& mesh = cylinder();
  static const TetLocator locator(mesh, {});
  const Tet& t = mesh.tets[static_cast<std::size_t>(test::integer(0, static_cast<int>(mesh.tets.size())))];
  std::array<double, 4> w;
  double sum = 0.0;
  for (double& a : w) sum += a = test::integer(0, 3) == 0 ? 0.0 : test::number(0.0, 1.0);
  Vec3d x = mesh.vertices[t[0]];
  for (std::size_t a = 0; a < 4 && sum > 0.0; ++a) x += (mesh.vertices[t[a]] - mesh.vertices[t[0]]) * (w[a] / sum);
  const auto found = locator.locate(x);
  for (std::uint32_t guess = 0; guess < mesh.tets.size(); ++guess) {
    const auto guessed = locator.locate(x, guess);
    RC_ASSERT(guessed.has_value() == found.has_value());
    if (found) RC_ASSERT(guessed->tet == found->tet && guessed->weights == found->weights);
  }
}

TEST(TetLocator, PointsOutsideAreNowhere) {
  const TetLocator locator(cylinder(), {});
  for (const Vec3d& x : {Vec3d{0, 0, -1e-6}, Vec3d{0, 0, 0.05001}, Vec3d{0.0301, 0, 0.02}, Vec3d{1, 1, 1},
                         Vec3d{0.0299, 0.0299, 0.02}, Vec3d{std::nan(""), 0, 0}}) {
    EXPECT_FALSE(locator.locate(x)) << x.x << ' ' << x.y << ' ' << x.z;
    EXPECT_FALSE(locator.locate(x, 7)) << x.x << ' ' << x.y << ' ' << x.z;
  }
}

TEST(TetLocator, FacesEdgesAndCornersBelongToTheBody) {
  const TetLocator locator(cylinder(), {});
  for (const Vec3d& x : cylinder().vertices) EXPECT_TRUE(locator.locate(x));
}

TEST(TetLocator, RemovedTetsHoldNothing) {
  const TetMesh& mesh = cylinder();
  std::vector<char> removed(mesh.tets.size(), 0);
  const Vec3d x = point_of(mesh, {7, {0.25, 0.25, 0.25, 0.25}});
  removed[7] = 1;
  EXPECT_TRUE(TetLocator(mesh, {}).locate(x));
  EXPECT_FALSE(TetLocator(mesh, removed).locate(x));
  EXPECT_FALSE(TetLocator(mesh, std::vector<char>(mesh.tets.size(), 1)).locate(x));
}

}  // namespace
}  // namespace glisson::detail

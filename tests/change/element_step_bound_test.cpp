// The bound of the step from shares of masses lies between that of the single tets and h*, and following changes of a body
// stays near what finding it anew gives.
#include "dynamics/step/element_step_bound.h"
#include "change/changed_body.h"
#include "change/faces.h"
#include "dynamics/step/stable_step.h"
#include "element/body_change.h"

namespace glisson::test::element_step_bound_test {
namespace {

constexpr double kCell = 0.01;

// Through removals, splits and moves, of tissue with and without viscosity, and of two tissues side by side.
TEST(ElementStepBounds, LieBelowTheStableStepAndFollowChanges) {
  Tissue stiff = linear_tissue();
  stiff.youngs_modulus *= 20.0;
  for (const Tissue& tissue : {linear_tissue(), viscous_tissue()}) {
    std::mt19937 random(12);
    TetMesh mesh = jittered_box({4, 4, 5}, kCell, 0.2, random);
    mesh.regions.assign(mesh.tets.size(), 0);
    for (const std::uint32_t t : tets_where(mesh, [](const Vec3d& x) { return x.z > 0.03; })) mesh.regions[t] = 1;
    Body body = build_body(mesh, {{0, tissue}, {1, stiff}});
    const std::vector<double> one(body.blocks.size(), 1.0), none(body.vertex_count, 0.0);
    BodyChanger changer(body);
    ElementStepBound bound(body, changer.stars(), one);
    for (int i = 0; i < 6; ++i) {
      BodyChange change;
      if (i % 2 == 0) {
        change = changer.remove(changer.living_elements(choose(40, mesh.tets.size(), random)));
      } else {
        const std::uint32_t v = 62;  // within
        const VertexMove move{v, body.rest_positions[v] + random_field(1, 0.05 * kCell, random)[0]};
        change = changer.cut({}, {&move, 1}, [](std::uint32_t) { return std::pair<Vec3d, Vec3d>{}; });
      }
      bound.change(change);
      const std::vector<double> gamma(body.vertex_count, 0.0);
      // shares are allowed for from 1 to 1.05/0.8 of what a new bound would, and the step goes with the root at most
      const double anew = ElementStepBound(body, changer.stars(), one).step();
      EXPECT_GE(bound.step(), anew * std::sqrt(0.8 / 1.05)) << i;
      EXPECT_LE(bound.step(), anew * std::sqrt(1.05 / 0.8)) << i;
      EXPECT_LE(bound.step(), stable_step(body, one, gamma).step * (1.0 + 1e-9)) << i;
      EXPECT_GE(bound.step(), element_bound_step(body, one) * (1.0 - 1e-9)) << i;
    }
  }
}

// It is worth its while: a flat tet among good ones costs less than it would alone.
TEST(ElementStepBounds, AreHigherWhereFlatTetsHaveGoodNeighbours) {
  std::mt19937 random(3);
  const TetMesh mesh = jittered_box({5, 5, 5}, kCell, 0.2, random);
  Body body = build_body(mesh, {{0, linear_tissue()}});
  const BodyChanger changer(body);
  const std::vector<double> one(1, 1.0);
  EXPECT_GE(ElementStepBound(body, changer.stars(), one).step(), 1.3 * element_bound_step(body, one));
}

}  // namespace
}  // namespace glisson::test::element_step_bound_test

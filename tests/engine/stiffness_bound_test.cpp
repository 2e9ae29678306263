// What the lanes say of the tangent is safe: never below the exact bound of any tet, and never far above it.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "element/force_operator.h"
#include "engine/engine_run.h"
#include "support/samples.h"

namespace glisson {
namespace {

using test::Sample;

/// The bound of element/local_stiffness.h per tissue block: the largest over its tets, in double.
std::vector<double> exact_stiffening(const Body& body, const Sample& s) {
  std::vector<Vec3d> elastic(body.vertex_count), viscous(body.vertex_count);
  ElementWatch watch;
  make_element_operator(body)->evaluate(s.u, s.v, elastic, viscous, watch);
  return watch.stiffening;
}

/// A block at a time, in every instruction set.
void require_bounds(const Sample& s, const std::function<void(double seen, double exact)>& require) {
  const Body body = build_body(s.mesh, s.tissues);
  const std::vector<double> exact = exact_stiffening(body, s);
  for (const engine::Kernels* kernels : test::every_kernels()) {
    const test::EngineForces f = test::engine_forces(body, s.u, s.v, {.threads = 1, .kernels = kernels});
    RC_ASSERT(f.advance.stiffening.size() == exact.size());
    for (std::size_t b = 0; b < exact.size(); ++b) require(f.advance.stiffening[b], exact[b]);
  }
}

// The lanes keep the largest stiffness f and the largest slope g apart, so the tets they come from may differ: the
// exact bound of one tet is f + g/2 … f + g, and each of f and g/2 is at most the largest of those. Lanes without a
// tet count as tets at rest.
RC_GTEST_PROP(StiffnessBound, HoldsOverABody, ()) {
  require_bounds(Sample(), [](double seen, double exact) {
    RC_ASSERT(seen >= exact * (1.0 - 2e-5));  // rounding of the law's argument, as in forces_test.cpp
    RC_ASSERT(seen <= std::max(exact, 1.0) * 3.0 * (1.0 + 2e-5));
  });
}

// Where all tets are alike, in an affine field, the only excess is the two halves taken at the larger one: twice.
RC_GTEST_PROP(StiffnessBound, IsWithinTwiceForATet, ()) {
  Sample s;
  for (auto& [region, tissue] : s.tissues) {
    if (tissue.measure == DeformationMeasure::regular_mean_ratio)
      tissue.measure = DeformationMeasure::equivalent_shear_strain;
  }
  Mat3d H;
  for (auto& row : H.m) {
    for (double& h : row) h = test::number(-0.1, 0.1);
  }
  for (std::size_t i = 0; i < s.u.size(); ++i) s.u[i] = H * s.mesh.vertices[i];
  require_bounds(s, [](double seen, double exact) {
    RC_ASSERT(seen >= exact * (1.0 - 2e-5));
    RC_ASSERT(seen <= std::max(exact, 1.0) * 2.0 * (1.0 + 2e-5));
  });
}

// At rest and for a linear tissue in any state the tangent is that of rest.
TEST(StiffnessBound, IsOneForALinearTissue) {
  std::mt19937 random(3);
  const TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.2, random);
  const std::vector<Vec3d> rest(mesh.vertices.size()), far = test::random_field(rest.size(), 0.02, random);
  Tissue stiffening;
  stiffening.law = LinearLaw{20000.0};
  for (const engine::Kernels* kernels : test::every_kernels()) {
    const Body linear = build_body(mesh, {{0, Tissue{}}}), law = build_body(mesh, {{0, stiffening}});
    const engine::SubmeshOptions options{.threads = 1, .kernels = kernels};
    EXPECT_EQ(test::engine_forces(linear, far, rest, options).advance.stiffening, std::vector<double>{1.0});
    EXPECT_EQ(test::engine_forces(law, rest, rest, options).advance.stiffening, std::vector<double>{1.0});
  }
}

// The raw mean ratio falls as a tet is deformed, so a law that stiffens falls with it. Lanes without a tet have a
// ratio of 0 and must not pass for the most deformed tet of all.
TEST(StiffnessBound, LeavesOutLanesWithoutATet) {
  Tissue tissue;
  tissue.measure = DeformationMeasure::regular_mean_ratio;
  tissue.law = TableLaw{{0.1, 0.3}, {100.0 * tissue.youngs_modulus, tissue.youngs_modulus}};
  const TetMesh mesh = box_mesh({.cells = {1, 1, 1}, .size = {0.01, 0.01, 0.01}});
  const Body body = build_body(mesh, {{0, tissue}});
  const std::vector<Vec3d> rest(mesh.vertices.size());
  for (const engine::Kernels* kernels : test::every_kernels()) {
    const test::EngineForces f = test::engine_forces(body, rest, rest, {.threads = 1, .kernels = kernels});
    EXPECT_EQ(f.advance.stiffening, std::vector<double>{1.0}) << kernels->instruction_set;
  }
}

}  // namespace
}  // namespace glisson

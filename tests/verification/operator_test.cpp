// The production operator equals the paper's tensors, and obeys the laws any internal force obeys.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "element/force_operator.h"
#include "element/tet_fields.h"
#include "glisson/material/shape_measure.h"
#include "material/reference/reference.h"
#include "support/samples.h"

namespace glisson {
namespace {

using test::integer;
using test::number;
using test::random_tissue;
using test::Sample;

struct Forces {
  std::vector<Vec3d> elastic, viscous;
  ElementWatch watch;
};

Forces evaluate(const Sample& s) {
  const Body body = build_body(s.mesh, s.tissues);
  Forces f{std::vector<Vec3d>(s.u.size()), std::vector<Vec3d>(s.u.size()), {}};
  make_element_operator(body)->evaluate(s.u, s.v, f.elastic, f.viscous, f.watch);
  return f;
}

reference::Corners corners_of(const Tet& tet, const std::vector<Vec3d>& values) {
  reference::Corners corners;
  for (std::size_t a = 0; a < 4; ++a) corners[a] = {values[tet[a]].x, values[tet[a]].y, values[tet[a]].z};
  return corners;
}

// The largest relative change of the moduli for a relative change of the measure [-]: what a law makes of a rounding of it.
double steepness(const Sample& s) {
  constexpr double kStep = 1e-6;
  double largest = 0.0;
  for (std::size_t t = 0; t < s.mesh.tets.size(); ++t) {
    const Tissue& tissue = s.tissues.at(s.mesh.region_of(t));
    const double x =
        reference::measure(tissue, corners_of(s.mesh.tets[t], s.mesh.vertices), corners_of(s.mesh.tets[t], s.u));
    const LameParameters at = lame_at(tissue, x), beside = lame_at(tissue, x * (1.0 + kStep));
    const double change = std::abs(beside.lambda - at.lambda) + 2.0 * std::abs(beside.mu - at.mu);
    largest = std::max(largest, change / (kStep * (std::abs(at.lambda) + 2.0 * at.mu)));
  }
  return largest;
}

// The deformation-gradient form is the tensor form of eq. 6 and 7 to rounding.
RC_GTEST_PROP(ElementOperator, EqualsTensors, ()) {
  const Sample s;
  const Forces fast = evaluate(s);
  const reference::MeshForces slow = reference::mesh_forces(s.mesh, s.tissues, s.u, s.v);
  // the tolerance: some tens of roundings per element, and the measure's own as far as the law magnifies it
  RC_ASSERT(test::relative_difference(fast.elastic, slow.elastic) <= 1e-12 * (1.0 + steepness(s)));
  RC_ASSERT(test::relative_difference(fast.viscous, slow.viscous) <= 1e-12);
}

// The assembled vertex and edge tensors of eq. 2 give the force of eq. 1 for a linear tissue.
RC_GTEST_PROP(ElementOperator, EqualsEdgeTensors, ()) {
  Sample s;
  for (auto& [region, tissue] : s.tissues) tissue.law = ConstantLaw{}, tissue.lambda_law.reset(), tissue.mu_law.reset();
  const std::vector<Vec3d> edges = reference::edge_forces(reference::assemble_edges(s.mesh, s.tissues), s.u);
  RC_ASSERT(test::relative_difference(evaluate(s).elastic, edges) <= 1e-12);
}

// Newton's third law: internal forces sum to zero, elastic and viscous apart.
RC_GTEST_PROP(ElementOperator, ForcesSumToZero, ()) {
  const Sample s;
  const Forces f = evaluate(s);
  for (const auto* field : {&f.elastic, &f.viscous}) {
    Vec3d sum{};
    double size = 0.0;
    for (const Vec3d& force : *field) sum += force, size += norm(force);
    RC_ASSERT(norm(sum) <= 1e-13 * size);
  }
}

// A common translation and a common velocity change nothing.
RC_GTEST_PROP(ElementOperator, IsTranslationInvariant, ()) {
  Sample s;
  const Forces before = evaluate(s);
  for (Vec3d& u : s.u) u += Vec3d{0.5, -0.25, 1.0};
  for (Vec3d& v : s.v) v += Vec3d{-2.0, 1.0, 0.5};
  const Forces after = evaluate(s);
  // differences of displacements keep 1e-16 of the translation, which is 1e-12 of the strain at worst
  RC_ASSERT(test::relative_difference(after.elastic, before.elastic) <= 1e-8);
  RC_ASSERT(test::relative_difference(after.viscous, before.viscous) <= 1e-8);
}

// Patch test: an affine displacement leaves no force on inner vertices, and the energy is V (½ λ tr² + μ ε:ε).
RC_GTEST_PROP(ElementOperator, PassesThePatchTest, ()) {
  std::mt19937 random(static_cast<unsigned>(integer(1, 1000000)));
  const TetMesh mesh = test::jittered_box({3, 3, 3}, 0.01, 0.2, random);
  Tissue tissue = random_tissue();
  tissue.measure = DeformationMeasure::equivalent_shear_strain;  // the raw measure differs from tet to tet
  Mat3d H;
  for (auto& row : H.m) {
    for (double& h : row) h = number(-0.1, 0.1);
  }
  std::vector<Vec3d> u;
  for (const Vec3d& x : mesh.vertices) u.push_back(H * x);

  const Body body = build_body(mesh, {{0, tissue}});
  std::vector<Vec3d> elastic(u.size()), viscous(u.size());
  ElementWatch watch;
  make_element_operator(body)->evaluate(u, u, elastic, viscous, watch);
  double inner = 0.0, outer = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3d& x = mesh.vertices[i];
    const bool inside = std::min({x.x, x.y, x.z}) > 1e-9 && std::max({x.x, x.y, x.z}) < 0.03 - 1e-9;
    (inside ? inner : outer) = std::max(inside ? inner : outer, norm(elastic[i]) + norm(viscous[i]));
  }
  RC_ASSERT(inner <= 1e-11 * outer);

  const LameParameters lame = lame_at(tissue, intensity_of(one_minus_q(H)));
  const double t = trace(H);
  double squares = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) squares += 0.25 * (H(i, j) + H(j, i)) * (H(i, j) + H(j, i));
  }
  const double expected = volume(mesh) * (0.5 * lame.lambda * t * t + lame.mu * squares);
  RC_ASSERT(std::abs(secant_energy(body, u) - expected) <= 1e-11 * std::abs(expected));
}

// The small-strain tensors mistake a rotation θ for the strain cos θ − 1: known, and no smaller than that.
TEST(ElementOperator, RotationGivesTheKnownSpuriousStress) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const Tissue tissue;
  Simulation simulation(mesh, {{0, tissue}}, test::in_double());
  const double angle = 0.3, c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec3d> u;
  for (const Vec3d& x : mesh.vertices) u.push_back({c * x.x - s * x.y - x.x, s * x.x + c * x.y - x.y, 0.0});
  simulation.set_state(u, std::vector<Vec3d>(u.size()));
  const auto fields = simulation.tet_fields();
  const LameParameters lame = tissue.lame();
  const double expected = 2.0 * (lame.lambda + lame.mu) * (c - 1.0);
  EXPECT_NEAR(fields.stress[0], expected, 1e-9 * std::abs(expected)) << "sigma_xx [Pa]";
  EXPECT_NEAR(fields.stress[2], 2.0 * lame.lambda * (c - 1.0), 1e-9 * std::abs(expected)) << "sigma_zz [Pa]";
  EXPECT_LE(fields.s[0], 1e-7) << "the measure itself does not see the rotation";
}

}  // namespace
}  // namespace glisson

// Does the choice of the shape measure matter? The paper says it does not.
//
// Figure 2's press, quasi-static, tissue 2: E grows linearly with a measure. The slope is fitted for each measure so
// that the force at 10 mm is the same; what is left is the shape of the curve on the way.
#include <gtest/gtest.h>

#include "element/element_shape.h"
#include "support/bodies.h"
#include "support/statics.h"

namespace glisson::measure_choice_test {
namespace {

constexpr double kDepth = 0.010;  // [m]
constexpr int kPoints = 5;

/// Tissue 2 of a slope in the measure [Pa].
Tissue tissue(DeformationMeasure measure, double slope) {
  Tissue t;
  t.measure = measure;
  t.law = LinearLaw{slope};
  return t;
}

/// Stiffness of each element over that at rest, from the stress it has: a law on E scales all of it.
std::vector<double> stiffening(const Body& body, const Tissue& t, std::span<const Vec3d> u) {
  const Response response(t);
  const auto [lambda, mu] = lame_from_young(3600.0, t.poisson_ratio);
  std::vector<double> scale;
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    const Mat3d H = element_gradient(body, e, u), P = response.elastic(H, element_shape(body, t, e));
    const Mat3d rest = full(isotropic_stress(H, lambda, mu));
    scale.push_back(std::sqrt(squared_norm(P) / squared_norm(rest)));
  }
  return scale;
}

/// Force at 2, 4 … 10 mm [N]. The stiffness of each element follows the displacement and the displacement it, a third
/// of the way at a time: a secant law's tangent is not symmetric.
std::vector<double> press(const Tissue& t, BoxSplit split) {
  const TetMesh mesh = box_mesh({.split = split});
  Tissue linear;
  const Body body = build_body(mesh, {{0, linear}});
  const TissueOperator op(body);
  const test::VertexSet triangle = test::paper_triangle();
  test::Field u(mesh.vertices.size()), step;
  TissueTangent rest;
  op.linearise({u, u, 0.0}, 0.0, false, rest);
  std::vector<double> force, scale(body.elements.size(), 1.0);
  for (int n = 1; n <= kPoints; ++n) {
    test::Supports supports(mesh.vertices.size());
    for (const std::uint32_t v : mesh.vertex_sets.at("z_min")) supports.hold_all(v);
    for (const std::uint32_t v : triangle) supports.hold_all(v, {0.0, 0.0, -kDepth * n / kPoints});
    double change = 1.0;
    TissueTangent K;
    for (int k = 0; k < 150 && change > 1e-4; ++k) {
      K = rest;
      for (std::size_t e = 0; e < scale.size(); ++e) K.local[e] *= scale[e];
      test::Field jump(u.size()), pull(u.size());
      supports.apply(jump);
      op.apply(K, jump, pull);
      for (Vec3d& f : pull) f = -f;
      EXPECT_TRUE(test::solve(op, K, supports, pull, 1e-9, step));
      u = step;
      test::add(u, jump, 1.0);
      const std::vector<double> now = stiffening(body, t, u);
      change = 0.0;
      for (std::size_t e = 0; e < scale.size(); ++e) {
        change = std::max(change, std::abs(now[e] - scale[e]) / scale[e]);
        scale[e] += 0.3 * (now[e] - scale[e]);
      }
    }
    EXPECT_LE(change, 1e-3);
    test::Field f(u.size());
    op.apply(K, u, f);
    double sum = 0.0;
    for (const std::uint32_t v : triangle) sum -= f[v].z;
    force.push_back(sum);
  }
  return force;
}

/// The curve of a measure whose slope makes the last force `last`, by the secant method.
std::vector<double> fitted(DeformationMeasure measure, double last, BoxSplit split) {
  double a = 10000.0, b = 20000.0;
  std::vector<double> curve = press(tissue(measure, a), split);
  double fa = curve.back() - last;
  for (int n = 0; n < 12; ++n) {
    curve = press(tissue(measure, b), split);
    const double fb = curve.back() - last;
    if (std::abs(fb) < 1e-4 * last) break;
    const double next = b - fb * (b - a) / (fb - fa);
    a = b, fa = fb, b = next;
  }
  return curve;
}

/// Largest difference of two curves over the last force.
double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]) / b.back());
  return most;
}

struct Choice {
  DeformationMeasure measure;
  BoxSplit split;
};

class MeasureChoice : public testing::TestWithParam<Choice> {};

double difference_from_intensity(const Choice& c) {
  const std::vector<double> reference = press(tissue(DeformationMeasure::equivalent_shear_strain, 36000.0), c.split);
  const std::vector<double> curve = fitted(c.measure, reference.back(), c.split);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    testing::Test::RecordProperty("mm_" + std::to_string(2 * (i + 1)),
                                  std::to_string(curve[i]) + " against " + std::to_string(reference[i]));
  }
  return apart(curve, reference);
}

// Measures that are of first order in strain give one curve: 0.01 to 0.17 % of the last force apart.
TEST_P(MeasureChoice, OfFirstOrderDoesNotMatter) { EXPECT_LT(difference_from_intensity(GetParam()), 4e-3); }

INSTANTIATE_TEST_SUITE_P(Figure2, MeasureChoice,  // long
                         testing::Values(Choice{DeformationMeasure::radius_ratio, BoxSplit::kuhn},
                                         Choice{DeformationMeasure::solid_angle, BoxSplit::kuhn},
                                         Choice{DeformationMeasure::radius_ratio, BoxSplit::alternating},
                                         Choice{DeformationMeasure::solid_angle, BoxSplit::alternating}));

class MeasureOrder : public testing::TestWithParam<Choice> {};

// One of second order gives another: 7.6 % apart. What matters is the order. (The raw mean ratio rises in
// some tetrahedra until a law that falls with it leaves them no stiffness, and no equilibrium is found.)
TEST_P(MeasureOrder, Matters) {
  const double difference = difference_from_intensity(GetParam());
  EXPECT_GT(difference, 0.05);
  EXPECT_LT(difference, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Figure2, MeasureOrder,  // long
                         testing::Values(Choice{DeformationMeasure::one_minus_q, BoxSplit::kuhn},
                                         Choice{DeformationMeasure::one_minus_q, BoxSplit::alternating}));

}  // namespace
}  // namespace glisson::measure_choice_test

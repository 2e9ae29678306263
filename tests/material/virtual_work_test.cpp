// What is reported as stress is what makes the forces: Σ V P:∇w = −f·w for any w, whatever the tissue, its past and the
// precision of the body.
#include <gtest/gtest.h>

#include "dynamics/state/make_body.h"
#include "element/tet_fields.h"
#include "engine/moving_body.h"
#include "material/every_tissue.h"
#include "support/bodies.h"

namespace glisson::virtual_work_test {
namespace {

constexpr double kEdge = 0.03;   // of the cube [m]
constexpr double kStep = 2e-3;   // long enough for branches to relax [s]
constexpr double kSpeed = 0.01;  // a tenth of the deformation each step [m/s]

/// A cube of one tissue, driven in all its vertices through some steps from a random state.
struct Driven {
  std::mt19937 random{37};
  TetMesh mesh = test::jittered_box({3, 3, 3}, kEdge / 3.0, 0.15, random);
  Body body;
  std::vector<double> damping;
  EngineInfo info;
  std::unique_ptr<MovingBody> moving;
  std::vector<Vec3d> u, v, force;

  Driven(const Tissue& tissue, Precision precision)
      : body(build_body(mesh, {{0, tissue}})), damping(body.vertex_count, 0.0) {
    moving = make_moving_body(body, damping, {.precision = precision}, info);
    u = test::random_field(body.vertex_count, 5e-4, random);
    v = test::random_field(body.vertex_count, kSpeed, random);
    std::vector<std::uint32_t> all(body.vertex_count);
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    moving->watch(all, all);
    moving->set_state(u, v);
    for (int step = 0; step < 3; ++step) {
      moving->advance(kStep, {}, false);
      for (ActiveVertex& w : moving->active()) w.displacement += w.velocity * kStep;
      moving->place_active();
    }
    moving->read_state(u, v);
    moving->advance(0.0, {}, false);
    for (const ActiveVertex& w : moving->active()) force.push_back(w.elastic + w.viscous);
  }

  TetFields fields() const { return tet_fields(body, u, v, std::vector{moving->branch_memory(0)}); }
};

/// |Σ V P:∇w + f·w| over Σ V |P| |∇w|, the largest of some random w.
double gap(Driven& x) {
  const TetFields fields = x.fields();
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const std::vector<Vec3d> w = test::random_field(x.body.vertex_count, 1.0, x.random);
    double work = 0.0, scale = 0.0;
    for (std::size_t e = 0; e < x.body.elements.size(); ++e) {
      const Mat3d gradient = element_gradient(x.body, e, w);
      Mat3d P;
      for (std::size_t i = 0; i < 9; ++i) P(i / 3, i % 3) = fields.piola[9 * x.body.mesh_tet[e] + i];
      work += x.body.rest[e].volume * test::inner(P, gradient);
      scale += x.body.rest[e].volume * test::size_of(P) * test::size_of(gradient);
    }
    for (std::size_t i = 0; i < w.size(); ++i) work += dot(x.force[i], w[i]);
    largest = std::max(largest, std::abs(work) / scale);
  }
  return largest;
}

// In double nothing but the order of the sums is different: 1e-12 of the work's parts.
TEST(VirtualWork, OfTheStressIsThatOfTheForcesInDouble) {
  for (const Tissue& tissue : test::all_tissues()) {
    Driven x(tissue, Precision::double_precision);
    EXPECT_LE(gap(x), 1e-12) << tissue.name;
  }
}

// Submeshes work in float: 24 bits, and strains of a tenth.
TEST(VirtualWork, OfTheStressIsThatOfTheForcesInFloat) {
  for (const Tissue& tissue : test::all_tissues()) {
    Driven x(tissue, Precision::single_precision);
    EXPECT_LE(gap(x), 1e-5) << tissue.name;
  }
}

// Cauchy's stress is P Fᵀ/J of the same P, and symmetric with it: moments of the inner forces are balanced.
TEST(VirtualWork, CauchysStressFollowsFromThatP) {
  for (const Tissue& tissue : test::all_tissues()) {
    if (test::is_small(tissue)) continue;
    const Driven x(tissue, Precision::double_precision);
    const TetFields fields = x.fields();
    for (std::size_t e = 0; e < x.body.elements.size(); ++e) {
      const std::size_t t = x.body.mesh_tet[e];
      const Mat3d F = deformation_gradient(element_gradient(x.body, e, x.u));
      Mat3d P;
      for (std::size_t i = 0; i < 9; ++i) P(i / 3, i % 3) = fields.piola[9 * t + i];
      const Mat3d sigma = scaled(product(P, test::transposed(F)), 1.0 / fields.jacobian[t]);
      const double* s = &fields.stress[6 * t];
      const Mat3d told{{{{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}}}};
      ASSERT_LE(test::apart(told, sigma), 1e-10) << tissue.name << ", tet " << t;
    }
  }
}

// Asking for the stress changes no byte of what comes after.
TEST(VirtualWork, IsAskedForWithoutATrace) {
  for (const Tissue& tissue : test::maxwell_tissues()) {
    for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
      Driven asked(tissue, precision), left(tissue, precision);
      asked.fields();
      Archive a, b;
      asked.moving->archive_past(a), left.moving->archive_past(b);
      EXPECT_EQ(a.bytes(), b.bytes()) << tissue.name;
    }
  }
}

}  // namespace
}  // namespace glisson::virtual_work_test

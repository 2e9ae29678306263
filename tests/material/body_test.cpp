// What holds of one tetrahedron holds of a body: TissueOperator sums stresses, energies and tangents rightly.
#include <gtest/gtest.h>

#include <functional>

#include "element/tissue_operator.h"
#include "material/every_tissue.h"
#include "support/bodies.h"

namespace glisson {
namespace {

using Field = std::vector<Vec3d>;

constexpr double kEdge = 0.03;       // of the cube [m]
constexpr double kInverting = 12.0;  // times the displacements of 10 % strain

/// A jittered cube of one tissue in a random state of some 10 % strain.
struct Cube {
  std::mt19937 random{31};
  TetMesh mesh = test::jittered_box({3, 3, 3}, kEdge / 3.0, 0.15, random);
  Body body;
  TissueOperator op;
  Field u, v;

  explicit Cube(const Tissue& tissue)
      : body(build_body(mesh, {{0, tissue}})), op(body), u(test::random_field(body.vertex_count, 7e-4, random)),
        v(test::random_field(body.vertex_count, 0.01, random)) {}

  struct Forces {
    Field elastic, viscous;
    Field sum() const {
      Field f = elastic;
      for (std::size_t i = 0; i < f.size(); ++i) f[i] += viscous[i];
      return f;
    }
  };
  Forces forces(const Field& at, const Field& rate, double since = 0.0) const {
    Forces f{Field(at.size()), Field(at.size())};
    ElementWatch watch;
    op.forces({at, rate, since}, f.elastic, f.viscous, watch);
    return f;
  }
  std::size_t inverted() const {
    Forces f{Field(u.size()), Field(u.size())};
    ElementWatch watch;
    op.forces({u, v, 0.0}, f.elastic, f.viscous, watch);
    return watch.inverted.size();
  }
  Field direction() { return test::random_field(body.vertex_count, 1.0, random); }
};

Field plus(const Field& a, const Field& b, double h) {
  Field r = a;
  for (std::size_t i = 0; i < r.size(); ++i) r[i] += b[i] * h;
  return r;
}
double inner(const Field& a, const Field& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}
double size_of(const Field& a) { return std::sqrt(inner(a, a)); }

/// A measure of a tetrahedron's own directions differs from tet to tet, and with it the modulus: no state but rest is uniform.
bool is_uniform(const Tissue& t) { return !test::has_directions(t); }

Field affine(const TetMesh& mesh, const Mat3d& H) {
  Field u;
  for (const Vec3d& x : mesh.vertices) u.push_back(H * x);
  return u;
}
bool is_inside(const Vec3d& x) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (x[a] < 1e-9 || x[a] > kEdge - 1e-9) return false;
  }
  return true;
}

// Patch test: an affine displacement leaves no force inside, and stores V W.
TEST(TissueBody, PatchTest) {
  for (const Tissue& t : test::all_tissues()) {
    if (!is_uniform(t)) continue;
    SCOPED_TRACE(t.name);
    const Cube cube(t);
    const Mat3d H{{{{0.1, 0.03, -0.02}, {-0.05, -0.08, 0.04}, {0.02, 0.01, 0.06}}}};
    const Field f = cube.forces(affine(cube.mesh, H), Field(cube.body.vertex_count)).sum();
    double inside = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (is_inside(cube.mesh.vertices[i])) inside = std::max(inside, norm(f[i]));
    }
    EXPECT_LT(inside, 1e-12 * size_of(f));
    if (t.maxwell.empty() && test::is_conservative(t)) {
      const double W = test::Specimen(t).response.energy(H, test::Specimen(t).shape);
      EXPECT_NEAR(cube.op.energy(affine(cube.mesh, H)), kEdge * kEdge * kEdge * W, 1e-12 * kEdge * kEdge * W);
    }
  }
}

// Shared or not, the volume change of an affine field is the same number in every tet, and so are the forces.
TEST(TissueBody, SharedVolumeLeavesAffineFieldsAlone) {
  for (Tissue t : test::nodal_tissues()) {
    SCOPED_TRACE(t.name);
    const Cube shared(t);
    t.volume_change = VolumeChange::element;
    const Cube own(t);
    const Field u = affine(own.mesh, test::Draw(32).tensor(0.05));
    const Field none(u.size());
    EXPECT_LT(test::relative_difference(shared.forces(u, none).sum(), own.forces(u, none).sum()), 1e-12);
    EXPECT_GT(test::relative_difference(shared.forces(shared.u, none).sum(), own.forces(own.u, none).sum()), 1e-2);
  }
}

constexpr double kStep = 1e-7;  // [m]: 1e-5 of strain

// Newton's third law, for forces and moments; with a small strain moments only see the rest shape.
TEST(TissueBody, ForcesAndMomentsSumToZero) {
  for (const Tissue& t : test::all_tissues()) {
    SCOPED_TRACE(t.name);
    const Cube cube(t);
    const Field f = cube.forces(cube.u, cube.v).sum();
    Vec3d force, moment;
    for (std::size_t i = 0; i < f.size(); ++i) {
      force += f[i];
      moment += cross(test::is_small(t) ? cube.mesh.vertices[i] : cube.mesh.vertices[i] + cube.u[i], f[i]);
    }
    EXPECT_LT(norm(force), 1e-13 * size_of(f));
    const bool leans = test::is_small(t) && t.law_form == LawForm::energy && test::is_conservative(t);
    if (!leans) {
      EXPECT_LT(norm(moment), 1e-12 * kEdge * size_of(f));
    }
  }
}

/// Whether energy() is that of the elastic forces, not only to first order.
bool has_exact_energy(const Tissue& t) {
  if (!test::is_conservative(t)) return false;
  const bool leans = test::is_small(t) && t.law_form == LawForm::energy;  // P is not symmetric, what relaxes is
  if (t.maxwell.empty() || (t.maxwell_part == MaxwellPart::all && !leans)) return true;
  return t.hyperelastic && !t.fibres;
}

// f = −∂E/∂u, with shared volume changes too. Differences of E lose 1e-16 E/(2 h): 1e-7 of the force.
TEST(TissueBody, ForcesAreTheGradientOfEnergy) {
  for (const Tissue& t : test::all_tissues()) {
    if (!has_exact_energy(t)) continue;
    SCOPED_TRACE(t.name);
    Cube cube(t);
    const Field f = cube.forces(cube.u, Field(cube.u.size())).elastic, d = cube.direction();
    const double slope =
        (cube.op.energy(plus(cube.u, d, kStep)) - cube.op.energy(plus(cube.u, d, -kStep))) / (2.0 * kStep);
    EXPECT_NEAR(slope, -inner(f, d), 1e-6 * size_of(f) * size_of(d) / std::sqrt(1.0 * d.size()));
  }
}

/// K d against −df/dh.
double tangent_error(Cube& cube, double rate, double since) {
  const Field d = cube.direction();
  TissueTangent K;
  cube.op.linearise({cube.u, cube.v, since}, rate, false, K);
  Field Kd(d.size());
  cube.op.apply(K, d, Kd);
  const auto at = [&](double h) { return cube.forces(plus(cube.u, d, h), plus(cube.v, d, rate * h), since).sum(); };
  const Field ahead = at(kStep), behind = at(-kStep);
  Field difference;
  for (std::size_t i = 0; i < d.size(); ++i) difference.push_back((behind[i] - ahead[i]) * (0.5 / kStep));
  return test::relative_difference(Kd, difference);
}

// So it is in a cube of which a tenth and more of the tets are inside out, volume changes shared or not.
TEST(TissueBody, InvertedTetsHaveAnEnergyToo) {
  for (Tissue t : test::hyperelastic_tissues()) {
    for (const VolumeChange volume : {VolumeChange::element, VolumeChange::average_nodal}) {
      t.volume_change = volume;
      SCOPED_TRACE(t.name + (volume == VolumeChange::average_nodal ? " nodal" : ""));
      Cube cube(t);
      cube.u = plus(Field(cube.u.size()), cube.u, kInverting);
      ASSERT_GT(cube.inverted(), 16U);
      const Field f = cube.forces(cube.u, Field(cube.u.size())).elastic, d = cube.direction();
      const double slope =
          (cube.op.energy(plus(cube.u, d, kStep)) - cube.op.energy(plus(cube.u, d, -kStep))) / (2.0 * kStep);
      EXPECT_NEAR(slope, -inner(f, d), 1e-6 * size_of(f) * size_of(d) / std::sqrt(1.0 * d.size()));
      EXPECT_LT(tangent_error(cube, 0.0, 0.0), 1e-5);
    }
  }
}

/// K d against −df/dh at a state with a past.
double tangent_error(const Tissue& t, double rate, double since) {
  Cube cube(t);
  if (!t.maxwell.empty()) {
    cube.op.advance_memory({plus(cube.u, cube.u, -0.4), cube.v, 0.0});
    cube.op.advance_memory({plus(cube.u, cube.u, -0.2), cube.v, 0.3});
  }
  return tangent_error(cube, rate, since);
}

// The tangent of the body is the derivative of its forces, in displacement and, with a rate, in velocity.
TEST(TissueBody, TangentIsTheDerivativeOfForces) {
  for (const Tissue& t : test::all_tissues()) {
    SCOPED_TRACE(t.name);
    EXPECT_LT(tangent_error(t, 0.0, 0.05), 1e-6);
    EXPECT_LT(tangent_error(t, 20.0, 0.05), 1e-6);
  }
}

// K is symmetric where there is an energy.
TEST(TissueBody, TangentIsSymmetricWhereThereIsAnEnergy) {
  for (const Tissue& t : test::all_tissues()) {
    if (!has_exact_energy(t)) continue;
    SCOPED_TRACE(t.name);
    Cube cube(t);
    TissueTangent K;
    cube.op.linearise({cube.u, Field(cube.u.size()), 0.0}, 0.0, false, K);
    const Field a = cube.direction(), b = cube.direction();
    Field Ka(a.size()), Kb(b.size());
    cube.op.apply(K, a, Ka), cube.op.apply(K, b, Kb);
    EXPECT_NEAR(inner(a, Kb), inner(b, Ka), 1e-12 * size_of(a) * size_of(Kb));
  }
}

}  // namespace
}  // namespace glisson

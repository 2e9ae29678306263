// Bodies in states that no press makes: all vertices at random places, tets flat or inside out; and a press by 60 %. They
// come back under the implicit integrator, or end in an equilibrium that is said to be one.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson::torture_test {
namespace {

struct Law {
  const char* name;
  Tissue tissue;
};
void PrintTo(const Law& c, std::ostream* out) { *out << c.name; }

Tissue hyperelastic(const HyperelasticLaw& law) {
  Tissue t;
  t.hyperelastic = law;
  return t;
}

double kappa() { return Tissue{}.lame().lambda + 2.0 / 3.0 * Tissue{}.lame().mu; }
double mu() { return Tissue{}.lame().mu; }

Tissue with(Kinematics kinematics) {
  Tissue t;
  t.kinematics = kinematics;
  return t;
}

/// What became of a body after up to 200 steps of up to 0.2 s.
struct Outcome {
  double largest = 0.0;  ///< displacement left [m]
  std::size_t inverted_at_start = 0, inverted = 0;
  StepStatus status = StepStatus::ok;
};

/// The paper's block, held at its base, with displacements chosen by `place` for every other vertex.
template <class Place>
Simulation placed(const Tissue& tissue, unsigned seed, const Place& place) {
  const TetMesh mesh = test::paper_mesh();
  SimulationOptions o;
  o.integrator = Integrator::implicit;
  o.implicit.largest_step = 0.2;
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Vec3d> u(mesh.vertices.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3d r{unit(random), unit(random), unit(random)};
    if (mesh.vertices[i].z > 1e-9) u[i] = place(r, mesh.vertices[i]);
  }
  s.set_state(u, std::vector<Vec3d>(u.size()));
  return s;
}

double largest_displacement(const Simulation& s) {
  double largest = 0.0;
  for (const Vec3d& x : s.displacement()) largest = std::max(largest, norm(x));
  return largest;
}

Outcome let_go(Simulation& s) {
  Outcome end;
  for (const double J : s.tet_fields().jacobian) end.inverted_at_start += J <= 0.0 ? 1 : 0;
  for (int i = 0; i < 200; ++i) {
    const StepResult r = s.step();
    end.status = r.status;
    end.inverted = r.inverted_tets.size();
    end.largest = largest_displacement(s);
    if (r.status > StepStatus::inverted || end.largest < 1e-8) break;
  }
  return end;
}

template <class Place>
Outcome let_go(const Tissue& tissue, unsigned seed, const Place& place) {
  Simulation s = placed(tissue, seed, place);
  return let_go(s);
}

Vec3d anywhere(const Vec3d& r, const Vec3d& rest) { return Vec3d{0.04 * r.x, 0.04 * r.y, 0.08 * r.z} - rest; }
/// Mirrored in the plane of the base: F = diag(1, 1, −1) everywhere.
Vec3d mirrored(const Vec3d&, const Vec3d& rest) { return {0.0, 0.0, -2.0 * rest.z}; }
/// Up to a cell away along each axis.
Vec3d nearby(const Vec3d& r, const Vec3d&) { return (r * 2.0 - Vec3d{1.0, 1.0, 1.0}) * 0.01; }

class Scrambled : public testing::TestWithParam<Law> {};

// Every vertex anywhere in the block: half of the tets are inside out. Back at rest to 1e-6 of its size.
TEST_P(Scrambled, RecoversFromAnywhere) {  // long
  const Outcome end = let_go(GetParam().tissue, 7, anywhere);
  EXPECT_GT(end.inverted_at_start, 250U);
  EXPECT_EQ(end.status, StepStatus::ok);
  EXPECT_LE(end.largest, 1e-6 * 0.08);
}

class Jumbled : public testing::TestWithParam<Law> {};

// Every vertex up to a cell away from where it belongs: the same for the laws of large strain.
TEST_P(Jumbled, RecoversFromACellAway) {
  const Outcome end = let_go(GetParam().tissue, 1, nearby);
  EXPECT_GT(end.inverted_at_start, 150U);
  EXPECT_EQ(end.status, StepStatus::ok);
  EXPECT_LE(end.largest, 1e-6 * 0.08);
}

// A hyperelastic body comes back from anywhere as a rule, and not always: a fold of tets that all have J > 0 can be an
// equilibrium of the true energy. Of 20 seeds 19 or 20 come back (docs/integrators.md); of these three, two at least.
TEST(Hyperelastic, RecoversFromAnywhereAsARule) {  // long
  for (const Law& law : {Law{"neo_hookean", hyperelastic(NeoHookean{.mu = mu(), .bulk_modulus = kappa()})},
                         Law{"ogden", hyperelastic(Ogden{.mu = {mu()}, .alpha = {-4.7}, .bulk_modulus = kappa()})}}) {
    int back = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Outcome end = let_go(law.tissue, seed, anywhere);
      EXPECT_GT(end.inverted_at_start, 250U);
      back += end.largest <= 1e-6 * 0.08 ? 1 : 0;
    }
    EXPECT_GE(back, 2) << law.name;
  }
}

Tissue nearly_incompressible() {
  Tissue t = hyperelastic(NeoHookean{.mu = mu(), .bulk_modulus = 50.0 * mu()});
  t.volume_change = VolumeChange::average_nodal;
  return t;
}
Tissue fung() { return hyperelastic(Fung{.mu = mu(), .b = 1.0, .bulk_modulus = kappa()}); }

// Fung's exponent is some hundreds at the start. Its limit keeps the sums of forces their digits: no seed ends without a
// balance, where 6 of 18 did with a limit of 60, and most come back: 15 of 20, of these 4.
TEST(Fung, ComesBackFromAnywhereMoreOftenThanNot) {  // long
  int back = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Outcome end = let_go(fung(), seed, anywhere);
    EXPECT_LE(end.status, StepStatus::inverted) << "seed " << seed;
    back += end.largest <= 1e-6 * 0.08 ? 1 : 0;
  }
  EXPECT_GE(back, 3);
}

// The energy of St Venant-Kirchhoff sees FᵀF alone, which a mirror leaves the identity: a body that is wholly inside out
// stores nothing, meets no force and stays. Corotational strain is U − I with λ₃ = −1 there: W = 2 (λ + 2 μ).
TEST(Green, IsAtRestInTheMirror) {
  Simulation s = placed(with(Kinematics::green), 1, mirrored);
  EXPECT_LT(s.energies().elastic, 1e-20);
  const std::vector<Vec3d> u(s.displacement().begin(), s.displacement().end());
  for (int i = 0; i < 10; ++i) {
    const StepResult r = s.step();
    ASSERT_EQ(r.status, StepStatus::inverted);
    EXPECT_EQ(r.inverted_tets.size(), 768U);
  }
  EXPECT_LT(test::relative_difference(s.displacement(), u), 1e-12);
  const Simulation other = placed(with(Kinematics::corotational), 1, mirrored);
  const double modulus = Tissue{}.lame().lambda + 2.0 * mu();
  EXPECT_NEAR(other.energies().elastic, 2.0 * modulus * 0.04 * 0.04 * 0.08, 1e-9);
}

// What has no way back by itself has one with a stand-in: let go as corotational tissue, which comes back from anywhere, and
// given its own when at rest. Rest is rest to every law.
TEST(StandIn, BringsBackWhatHasNoWayBack) {  // verify
  for (const Tissue& tissue : {with(Kinematics::green), nearly_incompressible(), fung()}) {
    for (unsigned seed = 7; seed <= 8; ++seed) {
      Simulation s = placed(with(Kinematics::corotational), seed, anywhere);
      EXPECT_LE(let_go(s).largest, 1e-6 * 0.08);
      s.set_tissue(0, tissue);
      for (int i = 0; i < 5; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
      EXPECT_LE(largest_displacement(s), 1e-6 * 0.08);
    }
  }
}

// St Venant-Kirchhoff comes to rest with most tets inside out, and nearly incompressible tissue stays folded: equilibria of
// their energies. Steps are made, nothing flies off, and inverted tets are reported.
TEST(Folded, GreenAndStiffBulkEndInAnEquilibrium) {  // long
  for (const Tissue& tissue : {nearly_incompressible(), with(Kinematics::green)}) {
    const Outcome end = let_go(tissue, 7, anywhere);
    EXPECT_LE(end.status, StepStatus::inverted);
    EXPECT_EQ(end.status == StepStatus::inverted, end.inverted > 0);
    EXPECT_LT(end.largest, 0.2);
  }
}

std::string law_name_of(const testing::TestParamInfo<Law>& law) { return law.param.name; }
INSTANTIATE_TEST_SUITE_P(Laws, Scrambled,
                         testing::Values(Law{"small", Tissue{}}, Law{"corotational", with(Kinematics::corotational)}),
                         law_name_of);
INSTANTIATE_TEST_SUITE_P(
    Laws, Jumbled,
    testing::Values(Law{"corotational", with(Kinematics::corotational)},
                    Law{"neo_hookean", hyperelastic(NeoHookean{.mu = mu(), .bulk_modulus = kappa()})},
                    Law{"nodal", nearly_incompressible()},
                    Law{"ogden", hyperelastic(Ogden{.mu = {mu()}, .alpha = {-4.7}, .bulk_modulus = kappa()})}),
    law_name_of);

// One tet with its top vertex pushed into the plane of the others, or through it, and let go: it stands up again, under every
// integrator that moves.
TEST(Tet, RecoversFromFlatAndInsideOut) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.003, 0.01}};
  mesh.tets = {{0, 1, 2, 3}};
  const test::VertexSet base{0, 1, 2};
  for (const Integrator integrator :
       {Integrator::central_difference, Integrator::semi_implicit, Integrator::implicit}) {
    for (Tissue tissue :
         {Tissue{}, with(Kinematics::corotational), hyperelastic(NeoHookean{.mu = mu(), .bulk_modulus = kappa()}),
          hyperelastic(Ogden{.mu = {mu()}, .alpha = {-4.7}, .bulk_modulus = kappa()})}) {
      tissue.viscosity = 5.0;
      for (const double height : {0.0, -0.003}) {
        SimulationOptions o;
        o.integrator = integrator;
        o.damping_rate = 100.0;
        Simulation s(mesh, {{0, tissue}}, o);
        s.fix(base);
        std::vector<Vec3d> u(4);
        u[3].z = height - 0.01;
        s.set_state(u, std::vector<Vec3d>(4));
        EXPECT_EQ(s.tet_fields().jacobian[0] <= 0.0, true);
        while (s.time() < 2.0) ASSERT_LE(s.step().status, StepStatus::inverted);
        EXPECT_LT(norm(s.displacement()[3]), 1e-7) << "from " << height << " m, integrator " << int(integrator);
      }
    }
  }
}

Invariants of_second_invariant() {
  Invariants law{.c01 = 0.25 * mu(), .c02 = 0.2 * mu(), .bulk_modulus = kappa()};
  law.a2 = 0.5 * mu(), law.q1 = 0.5 * mu();
  return law;
}

class Barrel : public testing::TestWithParam<Law> {};

/// How the press of a barrel that lies on its side, as a liver does, has ended.
struct Press {
  StepStatus status = StepStatus::ok;
  double end = 0.0, force = 0.0, imbalance = 0.0;  ///< [s], [N], share of the tool's work
};
Press press_barrel(const Tissue& tissue, Integrator integrator) {
  const TetMesh mesh = cylinder_mesh({.radius = 0.05, .height = 0.08, .radial_cells = 4, .axial_cells = 5});
  SimulationOptions o;
  o.integrator = integrator;
  o.damping_rate = 20.0;
  Simulation s(mesh, {{0, tissue}}, o);
  const auto beyond = [&](double x, double side) {
    test::VertexSet set;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
      if (side * mesh.vertices[i].x > x) set.push_back(i);
    }
    return set;
  };
  s.fix(beyond(0.038, -1.0));
  const ConstraintId plate =
      s.drive(beyond(0.038, 1.0), press({.direction = {-1.0, 0.0, 0.0}, .velocity = 0.06, .depth = 0.06, .hold = 0.1}));
  Press out;
  while (s.time() < 1.05 && out.status <= StepStatus::inverted) {
    const StepResult r = s.step();
    out.status = r.status;
    out.force = std::max(out.force, std::abs(s.force(plate).total().x));
    EXPECT_TRUE(r.status <= StepStatus::inverted || !r.message.empty());
  }
  out.end = s.time();
  out.imbalance = std::abs(s.energies().imbalance()) / s.energies().work_tools;
  return out;
}

// A round body pressed to 40 % of its height between two narrow plates ends the press under every law, explicit in
// single precision and implicit, and the energy balance holds: to rounding, and to Newton's tolerance.
TEST_P(Barrel, IsPressedBySixtyPercent) {  // long; verify: gent, veronda*, invariants
  for (const Integrator integrator : {Integrator::central_difference, Integrator::implicit}) {
    SCOPED_TRACE(integrator == Integrator::central_difference ? "explicit" : "implicit");
    const Press end = press_barrel(GetParam().tissue, integrator);
    EXPECT_LE(end.status, StepStatus::inverted);
    EXPECT_GE(end.end, 1.05);
    EXPECT_GT(end.force, 1.0);
    EXPECT_LE(end.imbalance, 1e-6);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Laws, Barrel,
    testing::Values(Law{"corotational", with(Kinematics::corotational)}, Law{"green", with(Kinematics::green)},
                    Law{"neo_hookean", hyperelastic(NeoHookean{.mu = mu(), .bulk_modulus = kappa()})},
                    Law{"ogden", hyperelastic(Ogden{.mu = {mu()}, .alpha = {-4.7}, .bulk_modulus = kappa()})},
                    Law{"veronda_westmann",
                        hyperelastic(VerondaWestmann{.c = 0.5 * mu(), .b = 2.0, .bulk_modulus = kappa()})},
                    Law{"fung", hyperelastic(Fung{.mu = mu(), .b = 3.0, .bulk_modulus = kappa()})},
                    Law{"gent", hyperelastic(Gent{.mu = mu(), .limit = 1.0, .bulk_modulus = kappa()})},
                    Law{"invariants", hyperelastic(of_second_invariant())}),
    law_name_of);

}  // namespace
}  // namespace glisson::torture_test

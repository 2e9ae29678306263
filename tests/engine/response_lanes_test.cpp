// Tissues of large deformation in lanes are those of material/response.h, in every instruction set: forces, what the stable
// step is told, tets that are flat or inverted, and the memory of Maxwell branches over many steps.
#include <gtest/gtest.h>

#include "element/tissue_operator.h"
#include "engine/element_body.h"
#include "engine/engine_run.h"
#include "material/every_tissue.h"

namespace glisson {
namespace {

/// Every tissue that lanes evaluate and that is more than the paper's; each with volume changes of its own and shared.
std::vector<Tissue> large_tissues() {
  std::vector<Tissue> all = test::every_tissue();
  for (std::size_t i = 0, n = all.size(); i < n; ++i) {
    if (all[i].law_form == LawForm::energy && !all[i].hyperelastic) continue;
    all.push_back(all[i]);
    all.back().volume_change = VolumeChange::average_nodal;
    all.back().name += " nodal";
  }
  std::erase_if(all, [](const Tissue& t) { return t.is_tensor_mass() || !engine::has_lanes(t); });
  return all;
}

struct Case {
  TetMesh mesh;
  Body body;
  std::vector<Vec3d> u, v;

  /// Two regions of the same tissue, several submeshes each.
  /// @param strain  size of the displacements over that of a cell
  Case(const Tissue& tissue, double strain) {
    std::mt19937 random(7);
    mesh = test::jittered_box({3, 3, 3}, 0.01, 0.15, random);
    mesh.regions.resize(mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions[t] = t < mesh.tets.size() / 2 ? 0 : 1;
    body = build_body(mesh, {{0, tissue}, {1, tissue}});
    u = test::random_field(mesh.vertices.size(), strain * 0.01, random);
    v = test::random_field(mesh.vertices.size(), 0.02, random);
  }

  struct Forces {
    std::vector<Vec3d> elastic, viscous;
    ElementWatch watch;
  };
  Forces exact() const {
    TissueOperator tissue(body);
    tissue.advance_memory({u, v, std::numeric_limits<double>::infinity()});
    Forces f{std::vector<Vec3d>(u.size()), std::vector<Vec3d>(u.size()), {}};
    tissue.forces({u, v, 0.0}, f.elastic, f.viscous, f.watch);
    return f;
  }
};

// None of the kinds is missing.
TEST(LargeTissues, AreManyKinds) { EXPECT_GE(large_tissues().size(), 25U); }

class ResponseLanes : public testing::TestWithParam<const engine::Kernels*> {};

// Strains from 1e-4 to 20 %. Some thirty roundings of 6e-8 each; the exponential laws multiply that of their argument by
// five or so, and terms of a steep law's energy by its slope.
TEST_P(ResponseLanes, ForcesAreThoseOfTheResponse) {
  for (const Tissue& tissue : large_tissues()) {
    for (const double strain : {1e-4, 0.02, 0.1}) {
      const Case c(tissue, strain);
      const Case::Forces exact = c.exact();
      const test::EngineForces f =
          test::engine_forces(c.body, c.u, c.v, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
      EXPECT_LE(test::relative_difference(f.elastic, exact.elastic), 2e-5) << tissue.name << ", strain " << strain;
      EXPECT_LE(test::relative_difference(f.viscous, exact.viscous), 2e-5) << tissue.name << ", strain " << strain;
    }
  }
}

// The whole body turned by 2 rad on top of strains of 3 %: what is left of the strain has lost as many digits as it is
// smaller than one.
TEST_P(ResponseLanes, ForcesTurnWithTheBody) {
  for (const Tissue& tissue : large_tissues()) {
    if (tissue.kinematics == Kinematics::small && !tissue.hyperelastic) continue;
    Case c(tissue, 0.03);
    const double k = std::cos(2.0), s = std::sin(2.0);
    const auto turned = [&](const Vec3d& x) { return Vec3d{k * x.x - s * x.y, s * x.x + k * x.y, x.z}; };
    for (std::size_t i = 0; i < c.u.size(); ++i) {
      const Vec3d X = c.mesh.vertices[i];
      c.u[i] = turned(X + c.u[i]) - X;
    }
    const test::EngineForces f =
        test::engine_forces(c.body, c.u, c.v, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
    EXPECT_LE(test::relative_difference(f.elastic, c.exact().elastic), 2e-4) << tissue.name;
  }
}

// Displacements as large as cells invert some tets and flatten others: those are answered in double, the others stay as
// they were.
TEST_P(ResponseLanes, FlatAndInvertedTetsAreAnsweredToo) {
  for (const Tissue& tissue : large_tissues()) {
    const Case c(tissue, 0.8);
    const Case::Forces exact = c.exact();
    ASSERT_FALSE(exact.watch.inverted.empty());
    const test::EngineForces f =
        test::engine_forces(c.body, c.u, c.v, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
    EXPECT_TRUE(f.advance.finite) << tissue.name;
    EXPECT_EQ(f.advance.inverted.size(), exact.watch.inverted.size()) << tissue.name;
    EXPECT_LE(test::relative_difference(f.elastic, exact.elastic), 1e-4) << tissue.name;
    EXPECT_LE(test::relative_difference(f.viscous, exact.viscous), 1e-4) << tissue.name;
  }
}

// Chains that end and exponents that are cut off, in many of the tets: forces are finite, and those of the response. Near
// its end Gent's stress multiplies the rounding of Ī₁ by a hundred.
TEST_P(ResponseLanes, StrainsBeyondALawsEndAreAnswered) {
  for (const HyperelasticLaw& law : std::initializer_list<HyperelasticLaw>{
           Gent{.mu = 1300.0, .limit = 0.05, .bulk_modulus = 6000.0},
           Invariants{.a1 = 600.0, .b1 = 200.0, .a2 = 700.0, .b2 = 150.0, .bulk_modulus = 6000.0},
           Invariants{.c10 = 650.0, .q1 = 600.0, .r1 = 1000.0, .q2 = 700.0, .r2 = 1000.0, .bulk_modulus = 6000.0}}) {
    Tissue tissue;
    tissue.hyperelastic = law;
    const Case c(tissue, 0.1);
    const test::EngineForces f =
        test::engine_forces(c.body, c.u, c.v, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
    EXPECT_TRUE(f.advance.finite) << law_name(law);
    EXPECT_LE(test::relative_difference(f.elastic, c.exact().elastic), 1e-4) << law_name(law);
  }
}

// What lanes tell of the tangent is 1 at rest, and close to what the response tells: lanes leave halves of sums out, and
// where volume changes are shared they take the stress that acts, the response that of the tet alone.
TEST_P(ResponseLanes, StiffnessIsWatched) {
  for (const Tissue& tissue : large_tissues()) {
    const Case rest(tissue, 0.0), c(tissue, 0.1);
    const double expected = rest.exact().watch.stiffening[0];
    const engine::SubmeshOptions options{.threads = 1, .kernels = GetParam(), .submesh_tets = 48};
    const double at_rest = test::engine_forces(rest.body, rest.u, rest.v, options).advance.stiffening[0];
    EXPECT_NEAR(at_rest, expected, 2e-3 * expected) << tissue.name;
    const double r = test::engine_forces(c.body, c.u, c.v, options).advance.stiffening[0];
    EXPECT_GE(r, 0.95 * c.exact().watch.stiffening[0]) << tissue.name;
    EXPECT_LE(r, 2.5 * c.exact().watch.stiffening[0]) << tissue.name;
  }
}

// Two hundred steps of a thirtieth of the shortest time constant in float and in double, steps of two sizes: the memory of
// the branches goes on alike.
TEST_P(ResponseLanes, BranchesRememberAlike) {
  for (Tissue tissue : large_tissues()) {
    if (tissue.maxwell.empty()) continue;
    for (MaxwellBranch& b : tissue.maxwell) b.time = std::min(b.time, 0.01) + 0.005 * b.share;
    Case c(tissue, 0.02);
    const std::vector<double> damping(c.body.vertex_count, 0.0);
    engine::SubmeshBody lanes(c.body, damping, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
    engine::ElementBody exact(c.body, damping, Precision::double_precision);
    const std::vector<Vec3d> still(c.u.size());
    for (MovingBody* b : std::initializer_list<MovingBody*>{&lanes, &exact}) b->set_state(c.u, still);
    for (int step = 0; step < 200; ++step) {
      const double h = step % 3 == 0 ? 1e-4 : 5e-5;
      lanes.advance(h, {}, false);
      exact.advance(h, {}, false);
    }
    const test::EngineState a = test::state_of(lanes, c.u.size()), b = test::state_of(exact, c.u.size());
    EXPECT_LE(test::relative_difference(a.u, b.u), 2e-5) << tissue.name;
    EXPECT_LE(test::relative_difference(a.v, b.v), 2e-4) << tissue.name;
  }
}

/// Tissues whose stresses one pass makes (relaxing_small-inl.h), each law and part of it.
std::vector<Tissue> one_pass_tissues() {
  std::vector<Tissue> tissues;
  for (const int laws : {0, 1, 2}) {
    for (const MaxwellPart part : {MaxwellPart::all, MaxwellPart::deviator}) {
      for (const double viscosity : {0.0, 0.3}) {
        Tissue t;
        t.name = std::to_string(laws) + (part == MaxwellPart::all ? " all " : " deviator ") + std::to_string(viscosity);
        if (laws == 1) t.law = LinearLaw{.slope = 40000.0};
        if (laws == 2) t.mu_law = LinearLaw{.slope = 9000.0};
        t.maxwell = {{.share = 0.3, .time = 0.004}, {.share = 0.25, .time = 0.05}};
        t.maxwell_part = part, t.viscosity = viscosity;
        tissues.push_back(t);
      }
    }
  }
  return tissues;
}

// A hundred steps, then elastic and viscous forces one by one, of vertices that ask for them, and their sum at the others; a
// tet that is turned inside out on the way is found.
TEST_P(ResponseLanes, OnePassIsTheResponseInTime) {
  for (const Tissue& tissue : one_pass_tissues()) {
    const Case c(tissue, 0.03);
    const std::vector<double> damping(c.body.vertex_count, 0.0);
    engine::SubmeshBody lanes(c.body, damping, {.threads = 1, .kernels = GetParam(), .submesh_tets = 48});
    engine::ElementBody exact(c.body, damping, Precision::double_precision);
    std::vector<std::uint32_t> all(c.body.vertex_count), some;
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    for (std::uint32_t i = 0; i < all.size() / 8; ++i) some.push_back(i);
    for (MovingBody* b : std::initializer_list<MovingBody*>{&lanes, &exact}) {
      b->watch(all, some);
      b->set_state(c.u, c.v);
      for (int step = 0; step < 100; ++step) {
        b->advance(5e-5, {}, step % 4 == 0);
        for (ActiveVertex& w : b->active()) {
          w.velocity += (w.elastic + w.viscous) * (5e-5 / c.body.masses[w.vertex]);
          w.displacement += w.velocity * 5e-5;
        }
        b->place_active();
      }
    }
    const Advance seen = lanes.advance(0.0, {}, false), known = exact.advance(0.0, {}, false);
    std::vector<Vec3d> elastic[2], viscous[2], sum[2];
    for (const int which : {0, 1}) {
      MovingBody& b = which == 0 ? static_cast<MovingBody&>(lanes) : exact;
      for (const ActiveVertex& w : b.active()) {
        sum[which].push_back(w.elastic + w.viscous);
        if (w.vertex >= some.size()) continue;
        elastic[which].push_back(w.elastic), viscous[which].push_back(w.viscous);
      }
    }
    EXPECT_LE(test::relative_difference(sum[0], sum[1]), 2e-4) << tissue.name;
    EXPECT_LE(test::relative_difference(elastic[0], elastic[1]), 2e-4) << tissue.name;
    EXPECT_LE(test::relative_difference(viscous[0], viscous[1]), 2e-4) << tissue.name;
    EXPECT_GE(seen.stiffening[0], 0.95 * known.stiffening[0]) << tissue.name;
    EXPECT_LE(seen.stiffening[0], 1.2 * known.stiffening[0]) << tissue.name;
    EXPECT_TRUE(seen.inverted.empty());
    ActiveVertex& w = lanes.active()[all.size() / 2];
    w.displacement = w.displacement + Vec3d{0.05, 0.05, 0.05};
    lanes.place_active();
    EXPECT_FALSE(lanes.advance(0.0, {}, false).inverted.empty()) << tissue.name;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryInstructionSet, ResponseLanes, testing::ValuesIn(test::every_kernels()),
                         [](const auto& p) { return std::string(p.param->instruction_set); });

}  // namespace
}  // namespace glisson

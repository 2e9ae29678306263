// A region gets another tissue while the body moves, under every integrator: what is told, kept, saved and refused; and the
// step that follows the tissue.
#include <cmath>
#include <ostream>
#include <sstream>

#include "change/changed_tissues.h"

namespace glisson {
namespace {

using enum Integrator;

struct Way {
  const char* name;
  Integrator integrator = central_difference;
  Precision precision = Precision::single_precision;
  TimeScheme scheme = TimeScheme::backward_euler;
};
void PrintTo(const Way& w, std::ostream* out) { *out << w.name; }

SimulationOptions options_of(const Way& way) {
  SimulationOptions o;
  o.integrator = way.integrator;
  o.precision = way.precision;
  o.implicit.scheme = way.scheme;
  return o;
}

bool newton(const Way& w) { return w.integrator == implicit || w.integrator == quasi_static; }

const std::vector<Way>& ways() {
  static const std::vector<Way> all{
      {"explicit_single"},
      {.name = "explicit_double", .precision = Precision::double_precision},
      {.name = "semi_implicit_single", .integrator = semi_implicit},
      {.name = "semi_implicit_double", .integrator = semi_implicit, .precision = Precision::double_precision},
      {.name = "implicit", .integrator = implicit},
      {.name = "newmark", .integrator = implicit, .scheme = TimeScheme::newmark},
      {.name = "static", .integrator = quasi_static}};
  return all;
}

std::vector<double> told(const Simulation& s) {
  const Energies e = s.energies();
  const Vec3d f = s.force({1}).total();
  return {s.time(),  s.step_size(), s.stable_step(), f.x,          f.y,          f.z,       e.elastic,
          e.kinetic, e.dissipated,  e.numerical,     e.work_tools, e.work_loads, e.removed, double(s.steps())};
}

class TissueChange : public testing::TestWithParam<Way> {};

// Before anything has moved, a body with changed tissues is the body built with them: the run has the same bytes.
TEST_P(TissueChange, AtRestIsTheBodyBuiltAnew) {
  const TetMesh mesh = test::two_regions();
  const std::vector<Tissue> all = test::kinds();
  const bool small_only = GetParam().integrator == semi_implicit;  // a body once viscous watches all vertices there
  for (std::size_t a = 0; a < all.size(); ++a) {
    const std::size_t b = (a + 1) % all.size(), c = (a + 4) % all.size();
    if (small_only && (all[a].viscosity > 0.0 || all[c].viscosity > 0.0) &&
        !(all[b].viscosity > 0.0 || all[c].viscosity > 0.0)) {
      continue;
    }
    Simulation changed = test::held_and_loaded(mesh, {{0, all[a]}, {1, all[c]}}, options_of(GetParam()));
    changed.set_tissue(0, all[b]);
    Simulation anew = test::held_and_loaded(mesh, {{0, all[b]}, {1, all[c]}}, options_of(GetParam()));
    EXPECT_EQ(changed.tissue(0), all[b]);
    EXPECT_EQ(changed.engine_info().flops_per_tet, anew.engine_info().flops_per_tet);
    EXPECT_EQ(changed.engine_info().instruction_set, anew.engine_info().instruction_set);
    const int steps = newton(GetParam()) ? 2 : 40;
    test::run(changed, steps), test::run(anew, steps);
    EXPECT_EQ(told(changed), told(anew)) << "from tissue " << a << " to " << b << " beside " << c;
    EXPECT_EQ(changed.state_hash(), anew.state_hash()) << "from tissue " << a << " to " << b << " beside " << c;
  }
}

// A tissue equal to the one there is changes nothing: the bytes of a run that nobody touched.
TEST_P(TissueChange, ToTheSameLeavesTheBytes) {
  const TetMesh mesh = test::two_regions();
  for (const Tissue& tissue : test::kinds()) {
    Simulation touched = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, options_of(GetParam()));
    Simulation alone = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, options_of(GetParam()));
    test::run(touched, 2), test::run(alone, 2);
    touched.set_tissues({{0, tissue}, {1, tissue}});
    test::run(touched, 2), test::run(alone, 2);
    EXPECT_EQ(told(touched), told(alone));
    EXPECT_EQ(touched.state_hash(), alone.state_hash());
  }
}

// Every kind of tissue into every other while the body moves: state, time and what was removed stay, forces of the last
// step are told as they were, and the energies balance over all of it. Rounding of float forces cancels in the balance,
// which sums works of the same forces; Newton's tolerance of 1e-8 is what implicit steps leave.
TEST_P(TissueChange, KeepsTheStateAndTheBalance) {
  const TetMesh mesh = test::two_regions();
  const std::vector<Tissue> all = test::kinds();
  SimulationOptions o = options_of(GetParam());
  o.gravity = {0.0, 0.0, -9.81};
  Simulation s = test::held_and_loaded(mesh, {{0, all[0]}, {1, all[0]}}, o);
  const int steps = newton(GetParam()) ? 2 : 30;
  test::run(s, steps);
  const std::vector<std::uint32_t> out{700, 701};
  s.remove_tets(out);
  for (const std::size_t k : {1, 2, 3, 4, 5, 6, 7, 8, 0, 5, 8, 5, 2}) {
    const std::vector<Vec3d> u(s.displacement().begin(), s.displacement().end());
    const std::vector<Vec3d> v(s.velocity().begin(), s.velocity().end());
    const Vec3d force = s.force({1}).total();
    const double time = s.time(), density = s.tissue(1).density;
    s.set_tissue(1, all[k]);
    EXPECT_TRUE(std::equal(u.begin(), u.end(), s.displacement().begin()));
    EXPECT_TRUE(std::equal(v.begin(), v.end(), s.velocity().begin()));
    EXPECT_EQ(s.time(), time);
    const bool tells_the_past = !newton(GetParam()) || all[k].density == density;
    EXPECT_TRUE(!tells_the_past || s.force({1}).total() == force);
    EXPECT_TRUE(s.is_removed(701));
    test::run(s, steps);
    const Energies e = s.energies();
    const double size = std::abs(e.work_tools) + std::abs(e.work_loads) + std::abs(e.changed) + e.elastic;
    EXPECT_LT(std::abs(e.imbalance()), (newton(GetParam()) ? 1e-6 : 1e-10) * size) << "after tissue " << k;
  }
  EXPECT_NE(s.energies().changed, 0.0);
}

// A run saved after tissues, mesh and tissues again have changed goes on with the same bytes in one that was made with the
// tissues of the start.
TEST_P(TissueChange, IsInTheCheckpoint) {
  const TetMesh mesh = test::two_regions();
  const std::vector<Tissue> all = test::kinds();
  const auto made = [&] { return test::held_and_loaded(mesh, {{0, all[0]}, {1, all[5]}}, options_of(GetParam())); };
  Simulation whole = made();
  const int steps = newton(GetParam()) ? 2 : 20;
  test::run(whole, steps);
  Tissue stiffer = all[0];
  for (const double E : {6000.0, 7000.0, 8000.0}) {
    stiffer.youngs_modulus = E;
    whole.set_tissue(0, stiffer);
  }
  test::run(whole, steps);
  whole.remove_tets(std::vector<std::uint32_t>{700, 701});
  test::run(whole, steps);
  Tissue slower = all[5];
  slower.maxwell[0].time = 0.1;
  whole.set_tissue(1, slower);
  whole.set_tissue(0, all[2]);
  test::run(whole, steps);
  std::stringstream file;
  whole.save(file);
  Simulation on = made();
  on.load(file);
  EXPECT_EQ(on.tissue(0), all[2]);
  EXPECT_EQ(on.tissue(1), slower);
  EXPECT_EQ(on.state_hash(), whole.state_hash());
  EXPECT_EQ(told(on), told(whole));
  EXPECT_EQ(on.energies().changed, whole.energies().changed);
  test::run(on, steps), test::run(whole, steps);
  EXPECT_EQ(on.state_hash(), whole.state_hash());
  EXPECT_EQ(told(on), told(whole));
}

// What is not valid is refused with the name and the range, and the run goes on to the byte as if nothing had been asked.
TEST_P(TissueChange, RefusedLeavesAllAsItWas) {
  const TetMesh mesh = test::two_regions();
  const std::vector<Tissue> all = test::kinds();
  const auto made = [&] { return test::held_and_loaded(mesh, {{0, all[2]}, {1, all[5]}}, options_of(GetParam())); };
  Simulation asked = made(), alone = made();
  test::run(asked, 3), test::run(alone, 3);
  Tissue bad = all[2];
  bad.youngs_modulus = -1.0;
  const auto refusal = [&](int region, const Tissue& t) -> std::string {
    try {
      asked.set_tissues({{0, all[3]}, {region, t}});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(1, bad).find("1e-06 to 1e+12"), std::string::npos) << refusal(1, bad);
  EXPECT_NE(refusal(7, all[0]).find("region 7"), std::string::npos) << refusal(7, all[0]);
  EXPECT_NE(refusal(7, all[0]).find("0, 1"), std::string::npos) << refusal(7, all[0]);
  EXPECT_EQ(asked.tissue(0), all[2]);
  test::run(asked, 3), test::run(alone, 3);
  EXPECT_EQ(asked.state_hash(), alone.state_hash());
  EXPECT_EQ(told(asked), told(alone));
}

INSTANTIATE_TEST_SUITE_P(Ways, TissueChange, testing::ValuesIn(ways()),
                         [](const auto& way) { return std::string(way.param.name); });

// A step that was given and is above h* of the new tissue is refused with h*, and all is as it was; enforced it is not where
// the user said so.
TEST(TissueChangeStep, RefusesAStepThatIsTooLarge) {
  const TetMesh mesh = test::two_regions();
  Tissue tissue, stiff;
  tissue.maxwell = stiff.maxwell = {{0.3, 0.02}};
  stiff.youngs_modulus = 1000.0 * tissue.youngs_modulus;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SimulationOptions o;
    o.precision = precision;
    o.step = 2e-4;
    Simulation asked = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    Simulation alone = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    test::run(asked, 30), test::run(alone, 30);
    try {
      asked.set_tissue(1, stiff);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("h* = "), std::string::npos) << error.what();
    }
    EXPECT_EQ(asked.tissue(1), tissue);
    EXPECT_EQ(asked.stable_step(), alone.stable_step());
    test::run(asked, 30), test::run(alone, 30);
    EXPECT_EQ(asked.state_hash(), alone.state_hash());
    o.enforce_stability = false;
    Simulation free = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    EXPECT_NO_THROW(free.set_tissue(1, stiff));
  }
}

// An automatic step of a body in motion follows the tissue: up and down, never above h* of the body built anew.
TEST(TissueChangeStep, FollowsATissueUpAndDown) {
  const TetMesh mesh = test::two_regions();
  for (const bool exact : {true, false}) {
    SimulationOptions o;
    o.exact_steps = exact;
    Tissue tissue;
    tissue.viscosity = 1.0;
    Simulation s = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    const double at_first = s.step_size();
    for (const double E : {7200.0, 30000.0, 1000.0, 500000.0, 3600.0}) {
      test::run(s, 10);
      tissue.youngs_modulus = E;
      s.set_tissues({{0, tissue}, {1, tissue}});
      const Simulation anew = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
      EXPECT_LE(s.step_size(), anew.stable_step() * (1.0 + 1e-9)) << E;
      // without a search softer tissue of the same viscosity gets no longer step than viscosity alone would bear
      EXPECT_GT(s.step_size(), (exact ? 0.99 : 0.5) * anew.step_size()) << E;
    }
    // whoever moves a slider back has the step back
    EXPECT_NEAR(s.step_size(), at_first, 1e-4 * at_first);
  }
}

// Without searches a viscosity that comes new to a body is answered by the bound from single elements.
TEST(TissueChangeStep, IsSafeWithoutASearchWhereNothingWasKnown) {
  const TetMesh mesh = test::two_regions();
  SimulationOptions o;
  o.exact_steps = false;
  Tissue tissue, viscous;
  viscous.viscosity = 20.0;
  Simulation s = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
  test::run(s, 10);
  s.set_tissue(1, viscous);
  const Simulation anew = test::held_and_loaded(mesh, {{0, tissue}, {1, viscous}}, o);
  EXPECT_LE(s.step_size(), anew.stable_step());
  EXPECT_GT(s.step_size(), 0.1 * anew.stable_step());
  test::run(s, 200);
}

}  // namespace
}  // namespace glisson

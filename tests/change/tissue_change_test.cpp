// A region gets another tissue while the body moves: what follows is the physics of the new tissue from the state there is,
// and nothing else has changed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

#include "glisson/motion.h"
#include "mechanics/block_response.h"
#include "support/bodies.h"
#include "support/column.h"

namespace glisson {
namespace {

using enum Integrator;

struct Way {
  const char* name;
  Integrator integrator = explicit_;
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

bool newton(const Way& w) { return w.integrator == implicit || w.integrator == static_; }

const std::vector<Way>& ways() {
  static const std::vector<Way> all{
      {"explicit_single"},
      {.name = "explicit_double", .precision = Precision::double_precision},
      {.name = "semi_implicit_single", .integrator = semi_implicit},
      {.name = "semi_implicit_double", .integrator = semi_implicit, .precision = Precision::double_precision},
      {.name = "implicit", .integrator = implicit},
      {.name = "newmark", .integrator = implicit, .scheme = TimeScheme::newmark},
      {.name = "static", .integrator = static_}};
  return all;
}

/// A box in two regions, the second above z = 0.04.
TetMesh two_regions() {
  TetMesh mesh = test::paper_mesh();
  for (const Tet& t : mesh.tets) {
    double z = 0.0;
    for (const std::uint32_t v : t) z += 0.25 * mesh.vertices[v].z;
    mesh.regions.push_back(z < 0.04 ? 0 : 1);
  }
  return mesh;
}

Simulation held_and_loaded(const TetMesh& mesh, const std::map<int, Tissue>& tissues, const SimulationOptions& o) {
  Simulation s(mesh, tissues, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.005, .start = 0.0, .hold = 1.0}));
  s.add_load(mesh.vertex_sets.at("x_max"), {0.05, 0.0, 0.0});
  return s;
}

void run(Simulation& s, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_LE(s.step().status, StepStatus::inverted);
}

std::vector<double> told(const Simulation& s) {
  const Energies e = s.energies();
  const Vec3d f = s.force({1}).total();
  return {s.time(),  s.step_size(), s.stable_step(), f.x,          f.y,          f.z,       e.elastic,
          e.kinetic, e.dissipated,  e.numerical,     e.work_tools, e.work_loads, e.removed, double(s.steps())};
}

/// Tissues of every way in which the engine can hold one.
std::vector<Tissue> kinds() {
  std::vector<Tissue> all(9);
  for (Tissue& t : all) t.youngs_modulus = 5000.0;
  all[1].viscosity = 4.0;
  all[2].law = LinearLaw{40000.0};
  all[3].kinematics = Kinematics::green, all[3].viscosity = 3.0;
  all[4].hyperelastic = NeoHookean{.mu = 1500.0, .bulk_modulus = 8000.0};
  all[5].kinematics = Kinematics::corotational, all[5].maxwell = {{0.3, 0.02}, {0.2, 0.5}};
  all[6].volume_change = VolumeChange::nodal, all[6].density = 1300.0;
  all[7].fibres = Fibres{{1.0, 0.0, 1.0}, 4000.0};
  all[8].measure = DeformationMeasure::solid_angle, all[8].law = LinearLaw{40000.0};  // no lanes: in double
  return all;
}

class TissueChange : public testing::TestWithParam<Way> {};

// Before anything has moved, a body with changed tissues is the body built with them: the run has the same bytes.
TEST_P(TissueChange, AtRestIsTheBodyBuiltAnew) {
  const TetMesh mesh = two_regions();
  const std::vector<Tissue> all = kinds();
  const bool small_only = GetParam().integrator == semi_implicit;  // a body once viscous watches all vertices there
  for (std::size_t a = 0; a < all.size(); ++a) {
    const std::size_t b = (a + 1) % all.size(), c = (a + 4) % all.size();
    if (small_only && (all[a].viscosity > 0.0 || all[c].viscosity > 0.0) &&
        !(all[b].viscosity > 0.0 || all[c].viscosity > 0.0)) {
      continue;
    }
    Simulation changed = held_and_loaded(mesh, {{0, all[a]}, {1, all[c]}}, options_of(GetParam()));
    changed.set_tissue(0, all[b]);
    Simulation anew = held_and_loaded(mesh, {{0, all[b]}, {1, all[c]}}, options_of(GetParam()));
    EXPECT_EQ(changed.tissue(0), all[b]);
    EXPECT_EQ(changed.engine_info().flops_per_tet, anew.engine_info().flops_per_tet);
    EXPECT_EQ(changed.engine_info().instruction_set, anew.engine_info().instruction_set);
    const int steps = newton(GetParam()) ? 2 : 40;
    run(changed, steps), run(anew, steps);
    EXPECT_EQ(told(changed), told(anew)) << "from tissue " << a << " to " << b << " beside " << c;
    EXPECT_EQ(changed.state_hash(), anew.state_hash()) << "from tissue " << a << " to " << b << " beside " << c;
  }
}

// A tissue equal to the one there is changes nothing: the bytes of a run that nobody touched.
TEST_P(TissueChange, ToTheSameLeavesTheBytes) {
  const TetMesh mesh = two_regions();
  for (const Tissue& tissue : kinds()) {
    Simulation touched = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, options_of(GetParam()));
    Simulation alone = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, options_of(GetParam()));
    run(touched, 2), run(alone, 2);
    touched.set_tissues({{0, tissue}, {1, tissue}});
    run(touched, 2), run(alone, 2);
    EXPECT_EQ(told(touched), told(alone));
    EXPECT_EQ(touched.state_hash(), alone.state_hash());
  }
}

// Every kind of tissue into every other while the body moves: state, time and what was removed stay, forces of the last
// step are told as they were, and the energies balance over all of it. Rounding of float forces cancels in the balance,
// which sums works of the same forces; Newton's tolerance of 1e-8 is what implicit steps leave.
TEST_P(TissueChange, KeepsTheStateAndTheBalance) {
  const TetMesh mesh = two_regions();
  const std::vector<Tissue> all = kinds();
  SimulationOptions o = options_of(GetParam());
  o.gravity = {0.0, 0.0, -9.81};
  Simulation s = held_and_loaded(mesh, {{0, all[0]}, {1, all[0]}}, o);
  const int steps = newton(GetParam()) ? 2 : 30;
  run(s, steps);
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
    run(s, steps);
    const Energies e = s.energies();
    const double size = std::abs(e.work_tools) + std::abs(e.work_loads) + std::abs(e.changed) + e.elastic;
    EXPECT_LT(std::abs(e.imbalance()), (newton(GetParam()) ? 1e-6 : 1e-10) * size) << "after tissue " << k;
  }
  EXPECT_NE(s.energies().changed, 0.0);
}

// A run saved after tissues, mesh and tissues again have changed goes on with the same bytes in one that was made with the
// tissues of the start.
TEST_P(TissueChange, IsInTheCheckpoint) {
  const TetMesh mesh = two_regions();
  const std::vector<Tissue> all = kinds();
  const auto made = [&] { return held_and_loaded(mesh, {{0, all[0]}, {1, all[5]}}, options_of(GetParam())); };
  Simulation whole = made();
  const int steps = newton(GetParam()) ? 2 : 20;
  run(whole, steps);
  Tissue stiffer = all[0];
  for (const double E : {6000.0, 7000.0, 8000.0}) {
    stiffer.youngs_modulus = E;
    whole.set_tissue(0, stiffer);
  }
  run(whole, steps);
  whole.remove_tets(std::vector<std::uint32_t>{700, 701});
  run(whole, steps);
  Tissue slower = all[5];
  slower.maxwell[0].time = 0.1;
  whole.set_tissue(1, slower);
  whole.set_tissue(0, all[2]);
  run(whole, steps);
  std::stringstream file;
  whole.save(file);
  Simulation on = made();
  on.load(file);
  EXPECT_EQ(on.tissue(0), all[2]);
  EXPECT_EQ(on.tissue(1), slower);
  EXPECT_EQ(on.state_hash(), whole.state_hash());
  EXPECT_EQ(told(on), told(whole));
  EXPECT_EQ(on.energies().changed, whole.energies().changed);
  run(on, steps), run(whole, steps);
  EXPECT_EQ(on.state_hash(), whole.state_hash());
  EXPECT_EQ(told(on), told(whole));
}

// What is not valid is refused with the name and the range, and the run goes on to the byte as if nothing had been asked.
TEST_P(TissueChange, RefusedLeavesAllAsItWas) {
  const TetMesh mesh = two_regions();
  const std::vector<Tissue> all = kinds();
  const auto made = [&] { return held_and_loaded(mesh, {{0, all[2]}, {1, all[5]}}, options_of(GetParam())); };
  Simulation asked = made(), alone = made();
  run(asked, 3), run(alone, 3);
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
  EXPECT_NE(refusal(1, bad).find("> 0"), std::string::npos) << refusal(1, bad);
  EXPECT_NE(refusal(7, all[0]).find("region 7"), std::string::npos) << refusal(7, all[0]);
  EXPECT_NE(refusal(7, all[0]).find("0, 1"), std::string::npos) << refusal(7, all[0]);
  EXPECT_EQ(asked.tissue(0), all[2]);
  run(asked, 3), run(alone, 3);
  EXPECT_EQ(asked.state_hash(), alone.state_hash());
  EXPECT_EQ(told(asked), told(alone));
}

INSTANTIATE_TEST_SUITE_P(Ways, TissueChange, testing::ValuesIn(ways()),
                         [](const auto& way) { return std::string(way.param.name); });

// ---- physics

// A bar under a dead load, free to bulge: u_z(L) = −p L / E, whose load stays when E and ν change. Constant strain is exact
// for linear tets; what is left is Newton's tolerance.
TEST(TissueChangePhysics, BarFindsItsNewEquilibrium) {
  const double L = 0.08, p = 40.0;
  const TetMesh mesh = box_mesh({.cells = {2, 2, 8}, .size = {0.02, 0.02, L}});
  Tissue tissue;
  SimulationOptions o;
  o.integrator = static_;
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(mesh.vertex_sets.at("x_min"), {true, false, false});
  s.fix(mesh.vertex_sets.at("y_min"), {false, true, false});
  s.fix(mesh.vertex_sets.at("z_min"), {false, false, true});
  for (const Triangle& t : boundary_triangles(mesh)) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (std::min({a.z, b.z, c.z}) > L - 1e-9) s.add_load(t, {0, 0, -p * 0.5 * norm(cross(b - a, c - a))});
  }
  const auto expect_balance = [&](const Tissue& t) {
    ASSERT_EQ(s.step().status, StepStatus::ok);
    for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
      EXPECT_NEAR(s.displacement()[v].z, -p * L / t.youngs_modulus, 1e-6 * p * L / t.youngs_modulus);
    }
    for (const std::uint32_t v : mesh.vertex_sets.at("x_max")) {
      const double bulge = t.poisson_ratio * p / t.youngs_modulus * 0.02;
      EXPECT_NEAR(s.displacement()[v].x, bulge, 1e-6 * bulge);
    }
  };
  expect_balance(tissue);
  tissue.youngs_modulus = 9000.0;
  s.set_tissue(0, tissue);
  expect_balance(tissue);
  tissue.poisson_ratio = 0.2;
  s.set_tissue(0, tissue);
  expect_balance(tissue);
}

/// Mean time between zero crossings of the top over some of them [s], from where the column is.
double half_period(test::Column& column, int crossings) {
  double first = 0.0, last = 0.0;
  int seen = 0;
  for (double before = column.top_displacement(); seen <= crossings;) {
    const double begin = column.simulation.time();
    if (column.simulation.step().status != StepStatus::ok) throw std::runtime_error("a step was not made");
    const double now = column.top_displacement();
    if ((before < 0.0) != (now < 0.0)) {
      last = begin + (column.simulation.time() - begin) * before / (before - now);
      if (seen++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / crossings;
}

// Free vibration of a column: a modulus twice as large gives a frequency √2 times as high. The step is 1/300 of the
// period, whose own error (ωh)²/24 = 2e-5 differs by a factor of two between the two; higher modes, which a change at
// an arbitrary moment does not wake (both tissues have the same modes), are not there.
TEST(TissueChangePhysics, TwiceTheModulusSoundsHigherByRootTwo) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    SimulationOptions o;
    o.precision = precision;
    o.step = 2e-4;
    Tissue tissue;
    test::Column column(tissue, 0.08, 8, 2, o);
    std::vector<Vec3d> u(column.mesh.vertices.size()), v(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i].z = 1e-3 * std::sin(0.5 * std::numbers::pi * column.mesh.vertices[i].z / 0.08);
    }
    column.simulation.set_state(u, v);
    const double before = half_period(column, 8);
    tissue.youngs_modulus *= 2.0;
    column.simulation.set_tissue(0, tissue);
    const double after = half_period(column, 8);
    EXPECT_NEAR(before / after, std::numbers::sqrt2, 2e-3) << "period " << before;
    EXPECT_NEAR(column.simulation.energies().imbalance(), 0.0, 1e-12);
  }
}

// The jump that is booked is that of ½ uᵀKu, and from there on the elastic energy of a linear tissue is the stored one of
// the new modulus to rounding, at whatever moment of a vibration it changed.
TEST(TissueChangePhysics, ElasticEnergyIsThatOfTheNewTissue) {
  SimulationOptions o = test::in_double();
  o.step = 1e-4;
  Tissue tissue;
  test::Column column(tissue, 0.08, 8, 2, o);
  Simulation& s = column.simulation;
  std::vector<Vec3d> u(column.mesh.vertices.size()), v(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i].z = 0.02 * column.mesh.vertices[i].z;
  s.set_state(u, v);
  const double stored = s.energies().elastic;
  tissue.youngs_modulus *= 1.5;
  s.set_tissue(0, tissue);
  EXPECT_NEAR(s.energies().changed, 0.5 * stored, 1e-12 * stored);
  for (const double factor : {0.4, 3.0, 1.2}) {
    run(s, 37);
    tissue.youngs_modulus *= factor;
    s.set_tissue(0, tissue);
    run(s, 3);
    const Body body = build_body(column.mesh, {{0, tissue}});
    const double exact = BlockResponse(body, body.blocks[0]).energy(s.displacement());
    ASSERT_EQ(s.step().status, StepStatus::ok);  // energies are those of the state before
    EXPECT_NEAR(s.energies().elastic, exact, 1e-11 * stored);
    EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-12 * stored);
  }
}

/// A block that is stretched along z, quickly and as a whole, and then held: nothing is left to move.
Simulation stretched(const Tissue& tissue, const SimulationOptions& o) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  Simulation s(mesh, {{0, tissue}}, o);
  for (const double z : {0.0, 0.01, 0.02}) {
    test::VertexSet layer;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (std::abs(mesh.vertices[v].z - z) < 1e-9) layer.push_back(v);
    }
    s.drive(layer, [z](double t) { return Vec3d{0, 0, 0.05 * z * std::min(1.0, t / 0.01)}; });
  }
  return s;
}

// Branches go on from their stress at the moment of change with their new time, F_v(t) = F_v(t_c) e^(−(t − t_c)/τ'), whatever
// the modulus; elastic force follows the modulus at once; a branch that is new starts without stress and, where nothing
// moves, stays so.
TEST(TissueChangePhysics, MaxwellStressIsKept) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (const bool large : {false, true}) {
      SimulationOptions o;
      o.precision = precision;
      o.step = 2e-4;
      Tissue tissue;
      tissue.maxwell = {{0.4, 0.05}};
      tissue.maxwell_part = MaxwellPart::all;
      if (large) tissue.kinematics = Kinematics::green;
      Simulation s = stretched(tissue, o);
      while (s.time() < 0.03) run(s, 1);
      const ForceParts before = s.force({2});
      const double told_at = s.force_time();
      tissue.youngs_modulus *= 2.0;
      tissue.maxwell = {{0.3, 0.02}, {0.3, 0.01}};
      s.set_tissue(0, tissue);
      while (s.time() < 0.05) run(s, 1);
      const ForceParts after = s.force({2});
      // one step of the old time, then the new one
      const double decay = std::exp(-2e-4 / 0.05 - (s.force_time() - told_at - 2e-4) / 0.02);
      const double tolerance = precision == Precision::double_precision ? 1e-9 : 1e-4;
      EXPECT_NEAR(after.viscous.z, before.viscous.z * decay, tolerance * std::abs(before.viscous.z));
      // what is left after long times: (1 − Σ g) E
      EXPECT_NEAR(after.elastic.z, before.elastic.z * 2.0 * 0.4 / 0.6, tolerance * std::abs(before.elastic.z));
    }
  }
}

// A region whose neighbour goes to a tissue without lanes, which moves the whole body in double, keeps its Maxwell stress.
TEST(TissueChangePhysics, MaxwellStressSurvivesAnotherEngine) {
  const TetMesh mesh = two_regions();
  Tissue plain, relaxing, without_lanes;
  relaxing.maxwell = {{0.5, 0.5}};
  without_lanes.measure = DeformationMeasure::solid_angle;
  without_lanes.law = LinearLaw{1000.0};
  SimulationOptions o;
  o.step = 1e-4;
  Simulation s = held_and_loaded(mesh, {{0, plain}, {1, relaxing}}, o);
  Simulation other = held_and_loaded(mesh, {{0, plain}, {1, relaxing}}, o);
  run(s, 300), run(other, 300);
  const double before = s.force({1}).viscous.z;
  s.set_tissue(0, without_lanes);
  EXPECT_EQ(s.engine_info().submeshes, 0U);
  run(s, 1), run(other, 1);
  EXPECT_NEAR(s.force({1}).viscous.z, other.force({1}).viscous.z, 1e-4 * std::abs(before));
  s.set_tissue(0, plain);
  EXPECT_GT(s.engine_info().submeshes, 0U);
  run(s, 1), run(other, 1);
  EXPECT_NEAR(s.force({1}).viscous.z, other.force({1}).viscous.z, 1e-4 * std::abs(before));
  EXPECT_GT(std::abs(before), 1e-3);
}

// Values there and back between two steps leave the bytes, where a given step keeps out what an automatic one remembers.
TEST(TissueChangePhysics, ThereAndBackLeavesTheBytes) {
  const TetMesh mesh = two_regions();
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (const std::size_t k : {0, 1, 2, 3, 4, 6, 7}) {
      SimulationOptions o;
      o.precision = precision;
      o.step = 5e-5;
      const Tissue tissue = kinds()[k];
      Tissue other = tissue;
      other.youngs_modulus *= 0.7, other.poisson_ratio = 0.3, other.viscosity *= 0.5, other.density = 1500.0;
      if (other.hyperelastic) other.hyperelastic = NeoHookean{.mu = 1000.0, .bulk_modulus = 5000.0};
      Simulation touched = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
      Simulation alone = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
      run(touched, 50), run(alone, 50);
      touched.set_tissue(0, other);
      touched.set_tissue(0, tissue);
      run(touched, 50), run(alone, 50);
      EXPECT_EQ(touched.state_hash(), alone.state_hash()) << "tissue " << k;
    }
  }
}

// The bytes do not depend on threads, over a change of values and one that lays submeshes out anew.
TEST(TissueChangePhysics, HasTheSameBytesOnAnyNumberOfThreads) {
  const TetMesh mesh = box_mesh({.cells = {10, 10, 12}, .size = {0.1, 0.1, 0.12}});
  std::optional<std::uint64_t> hash;
  for (const int threads : {1, 2, 5}) {
    SimulationOptions o;
    o.threads = threads;
    Simulation s(mesh, {{0, Tissue{}}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.05, .depth = 0.01, .start = 0.0, .hold = 1.0}));
    run(s, 20);
    Tissue t;
    t.youngs_modulus = 5000.0;
    s.set_tissue(0, t);
    run(s, 20);
    t.law = LinearLaw{50000.0}, t.maxwell = {{0.3, 0.1}}, t.volume_change = VolumeChange::nodal;
    s.set_tissue(0, t);
    run(s, 20);
    EXPECT_GT(s.engine_info().submeshes, 2U);
    EXPECT_EQ(s.state_hash(), hash.value_or(s.state_hash())) << threads << " threads";
    hash = s.state_hash();
  }
}

// On a body that was cut and thinned, a change gives what the body of the new tissue gives that was cut and thinned: sums
// over elements go in another order, which float shows as its rounding.
TEST(TissueChangePhysics, ActsOnWhatIsLeftOfTheBody) {
  const TetMesh mesh = two_regions();
  const std::vector<Tissue> all = kinds();
  std::vector<Triangle> cut;
  for (const Tet& t : mesh.tets) {  // faces in the plane x = 0.02 above z = 0.03
    for (const Triangle& f : {Triangle{t[0], t[1], t[2]}, Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[2], t[3]},
                              Triangle{t[1], t[2], t[3]}}) {
      const auto in = [&](std::uint32_t v) {
        return std::abs(mesh.vertices[v].x - 0.02) < 1e-9 && mesh.vertices[v].z > 0.029;
      };
      if (std::all_of(f.begin(), f.end(), in)) cut.push_back(f);
    }
  }
  std::vector<std::uint32_t> thinned;
  for (std::uint32_t t = 0; t < mesh.tets.size(); t += 29) {
    const Tet& tet = mesh.tets[t];
    if (std::all_of(tet.begin(), tet.end(), [&](std::uint32_t v) { return mesh.vertices[v].x > 0.021; })) {
      thinned.push_back(t);
    }
  }
  ASSERT_GT(thinned.size(), 5U);
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (std::size_t k = 1; k < all.size(); ++k) {
      SimulationOptions o;
      o.precision = precision;
      o.step = 2e-5;
      const auto changed_mesh = [&](Simulation& s) {
        s.remove_tets(thinned);
        EXPECT_FALSE(s.split_faces(cut).origins.empty());
      };
      Simulation s = held_and_loaded(mesh, {{0, all[0]}, {1, all[0]}}, o);
      changed_mesh(s);
      s.set_tissues({{0, all[k]}, {1, all[k]}});
      Simulation anew = held_and_loaded(mesh, {{0, all[k]}, {1, all[k]}}, o);
      changed_mesh(anew);
      EXPECT_EQ(s.masses()[30], anew.masses()[30]);
      run(s, 100), run(anew, 100);
      const double tolerance = precision == Precision::double_precision ? 1e-11 : 2e-5;
      EXPECT_LT(test::relative_difference(s.displacement(), anew.displacement()), tolerance) << "tissue " << k;
    }
  }
}

// Masses follow the density at the velocities there are; mass scaling is made for the new tissue.
TEST(TissueChangePhysics, MassesFollowTheDensity) {
  const TetMesh mesh = two_regions();
  Tissue tissue, heavy, stiff;
  heavy.density = 2500.0;
  stiff.youngs_modulus = 40.0 * tissue.youngs_modulus;
  for (const bool scaled : {false, true}) {
    SimulationOptions o = test::in_double();
    if (scaled) o.mass_scaling_step = 1e-3;
    Simulation s = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    run(s, 20);
    const Energies before = s.energies();
    double gain = 0.0;
    const std::vector<double> masses(s.masses().begin(), s.masses().end());
    s.set_tissues({{0, heavy}, {1, stiff}});
    const Simulation anew = held_and_loaded(mesh, {{0, heavy}, {1, stiff}}, o);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      EXPECT_EQ(s.masses()[i], anew.masses()[i]);
      gain += 0.5 * (s.masses()[i] - masses[i]) * dot(s.velocity()[i], s.velocity()[i]);
    }
    EXPECT_EQ(s.mass_scaling().added, anew.mass_scaling().added);
    EXPECT_NEAR(s.energies().kinetic - before.kinetic, gain, 1e-12 * gain);
    run(s, 20);
    EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-10 * s.energies().work_tools);
  }
}

// ---- the step

// A step that was given and is above h* of the new tissue is refused with h*, and all is as it was; enforced it is not where
// the user said so.
TEST(TissueChangeStep, RefusesAStepThatIsTooLarge) {
  const TetMesh mesh = two_regions();
  Tissue tissue, stiff;
  tissue.maxwell = stiff.maxwell = {{0.3, 0.02}};
  stiff.youngs_modulus = 1000.0 * tissue.youngs_modulus;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SimulationOptions o;
    o.precision = precision;
    o.step = 2e-4;
    Simulation asked = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    Simulation alone = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    run(asked, 30), run(alone, 30);
    try {
      asked.set_tissue(1, stiff);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("h* = "), std::string::npos) << error.what();
    }
    EXPECT_EQ(asked.tissue(1), tissue);
    EXPECT_EQ(asked.stable_step(), alone.stable_step());
    run(asked, 30), run(alone, 30);
    EXPECT_EQ(asked.state_hash(), alone.state_hash());
    o.enforce_stability = false;
    Simulation free = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    EXPECT_NO_THROW(free.set_tissue(1, stiff));
  }
}

// An automatic step of a body in motion follows the tissue: up and down, never above h* of the body built anew.
TEST(TissueChangeStep, FollowsATissueUpAndDown) {
  const TetMesh mesh = two_regions();
  for (const bool exact : {true, false}) {
    SimulationOptions o;
    o.exact_steps = exact;
    Tissue tissue;
    tissue.viscosity = 1.0;
    Simulation s = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    const double at_first = s.step_size();
    for (const double E : {7200.0, 30000.0, 1000.0, 500000.0, 3600.0}) {
      run(s, 10);
      tissue.youngs_modulus = E;
      s.set_tissues({{0, tissue}, {1, tissue}});
      const Simulation anew = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
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
  const TetMesh mesh = two_regions();
  SimulationOptions o;
  o.exact_steps = false;
  Tissue tissue, viscous;
  viscous.viscosity = 20.0;
  Simulation s = held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
  run(s, 10);
  s.set_tissue(1, viscous);
  const Simulation anew = held_and_loaded(mesh, {{0, tissue}, {1, viscous}}, o);
  EXPECT_LE(s.step_size(), anew.stable_step());
  EXPECT_GT(s.step_size(), 0.1 * anew.stable_step());
  run(s, 200);
}

}  // namespace
}  // namespace glisson

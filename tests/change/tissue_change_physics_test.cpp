// After a region has got another tissue, what follows is the physics of the new tissue from the state there is.
#include <cmath>
#include <numbers>

#include "change/changed_tissues.h"
#include "element/block_response.h"
#include "support/column.h"

namespace glisson {
namespace {

using enum Integrator;

// A bar under a dead load, free to bulge: u_z(L) = −p L / E, whose load stays when E and ν change. Constant strain is exact
// for linear tets; what is left is Newton's tolerance.
TEST(TissueChangePhysics, BarFindsItsNewEquilibrium) {  // long
  const double L = 0.08, p = 40.0;
  const TetMesh mesh = box_mesh({.cells = {2, 2, 8}, .size = {0.02, 0.02, L}});
  Tissue tissue;
  SimulationOptions o;
  o.integrator = quasi_static;
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
TEST(TissueChangePhysics, TwiceTheModulusSoundsHigherByRootTwo) {  // long
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
TEST(TissueChangePhysics, ElasticEnergyIsThatOfTheNewTissue) {  // long
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
    test::run(s, 37);
    tissue.youngs_modulus *= factor;
    s.set_tissue(0, tissue);
    test::run(s, 3);
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
TEST(TissueChangePhysics, MaxwellStressIsKept) {  // long
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
      while (s.time() < 0.03) test::run(s, 1);
      const ForceParts before = s.force({2});
      const double told_at = s.force_time();
      tissue.youngs_modulus *= 2.0;
      tissue.maxwell = {{0.3, 0.02}, {0.3, 0.01}};
      s.set_tissue(0, tissue);
      while (s.time() < 0.05) test::run(s, 1);
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
TEST(TissueChangePhysics, MaxwellStressSurvivesAnotherEngine) {  // long
  const TetMesh mesh = test::two_regions();
  Tissue plain, relaxing, without_lanes;
  relaxing.maxwell = {{0.5, 0.5}};
  without_lanes.measure = DeformationMeasure::solid_angle;
  without_lanes.law = LinearLaw{1000.0};
  SimulationOptions o;
  o.step = 1e-4;
  Simulation s = test::held_and_loaded(mesh, {{0, plain}, {1, relaxing}}, o);
  Simulation other = test::held_and_loaded(mesh, {{0, plain}, {1, relaxing}}, o);
  test::run(s, 300), test::run(other, 300);
  const double before = s.force({1}).viscous.z;
  s.set_tissue(0, without_lanes);
  EXPECT_EQ(s.engine_info().submeshes, 0U);
  test::run(s, 1), test::run(other, 1);
  EXPECT_NEAR(s.force({1}).viscous.z, other.force({1}).viscous.z, 1e-4 * std::abs(before));
  s.set_tissue(0, plain);
  EXPECT_GT(s.engine_info().submeshes, 0U);
  test::run(s, 1), test::run(other, 1);
  EXPECT_NEAR(s.force({1}).viscous.z, other.force({1}).viscous.z, 1e-4 * std::abs(before));
  EXPECT_GT(std::abs(before), 1e-3);
}

// Values there and back between two steps leave the bytes, where a given step keeps out what an automatic one remembers.
TEST(TissueChangePhysics, ThereAndBackLeavesTheBytes) {  // long
  const TetMesh mesh = test::two_regions();
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (const std::size_t k : {0, 1, 2, 3, 4, 6, 7}) {
      SimulationOptions o;
      o.precision = precision;
      o.step = 5e-5;
      const Tissue tissue = test::kinds()[k];
      Tissue other = tissue;
      other.youngs_modulus *= 0.7, other.poisson_ratio = 0.3, other.viscosity *= 0.5, other.density = 1500.0;
      if (other.hyperelastic) other.hyperelastic = NeoHookean{.mu = 1000.0, .bulk_modulus = 5000.0};
      Simulation touched = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
      Simulation alone = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
      test::run(touched, 50), test::run(alone, 50);
      touched.set_tissue(0, other);
      touched.set_tissue(0, tissue);
      test::run(touched, 50), test::run(alone, 50);
      EXPECT_EQ(touched.state_hash(), alone.state_hash()) << "tissue " << k;
    }
  }
}

// The bytes do not depend on threads, over a change of values and one that lays submeshes out anew.
TEST(TissueChangePhysics, HasTheSameBytesOnAnyNumberOfThreads) {  // long
  const TetMesh mesh = box_mesh({.cells = {10, 10, 12}, .size = {0.1, 0.1, 0.12}});
  std::optional<std::uint64_t> hash;
  for (const int threads : {1, 2, 5}) {
    SimulationOptions o;
    o.threads = threads;
    Simulation s(mesh, {{0, Tissue{}}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.05, .depth = 0.01, .start = 0.0, .hold = 1.0}));
    test::run(s, 20);
    Tissue t;
    t.youngs_modulus = 5000.0;
    s.set_tissue(0, t);
    test::run(s, 20);
    t.law = LinearLaw{50000.0}, t.maxwell = {{0.3, 0.1}}, t.volume_change = VolumeChange::average_nodal;
    s.set_tissue(0, t);
    test::run(s, 20);
    EXPECT_GT(s.engine_info().submeshes, 2U);
    EXPECT_EQ(s.state_hash(), hash.value_or(s.state_hash())) << threads << " threads";
    hash = s.state_hash();
  }
}

// On a body that was cut and thinned, a change gives what the body of the new tissue gives that was cut and thinned: sums
// over elements go in another order, which float shows as its rounding.
TEST(TissueChangePhysics, ActsOnWhatIsLeftOfTheBody) {  // long
  const TetMesh mesh = test::two_regions();
  const std::vector<Tissue> all = test::kinds();
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
      Simulation s = test::held_and_loaded(mesh, {{0, all[0]}, {1, all[0]}}, o);
      changed_mesh(s);
      s.set_tissues({{0, all[k]}, {1, all[k]}});
      Simulation anew = test::held_and_loaded(mesh, {{0, all[k]}, {1, all[k]}}, o);
      changed_mesh(anew);
      EXPECT_EQ(s.masses()[30], anew.masses()[30]);
      test::run(s, 100), test::run(anew, 100);
      const double tolerance = precision == Precision::double_precision ? 1e-11 : 2e-5;
      EXPECT_LT(test::relative_difference(s.displacement(), anew.displacement()), tolerance) << "tissue " << k;
    }
  }
}

// Masses follow the density at the velocities there are; mass scaling is made for the new tissue.
TEST(TissueChangePhysics, MassesFollowTheDensity) {  // long
  const TetMesh mesh = test::two_regions();
  Tissue tissue, heavy, stiff;
  heavy.density = 2500.0;
  stiff.youngs_modulus = 40.0 * tissue.youngs_modulus;
  for (const bool scaled : {false, true}) {
    SimulationOptions o = test::in_double();
    if (scaled) o.mass_scaling_step = 1e-3;
    Simulation s = test::held_and_loaded(mesh, {{0, tissue}, {1, tissue}}, o);
    test::run(s, 20);
    const Energies before = s.energies();
    double gain = 0.0;
    const std::vector<double> masses(s.masses().begin(), s.masses().end());
    s.set_tissues({{0, heavy}, {1, stiff}});
    const Simulation anew = test::held_and_loaded(mesh, {{0, heavy}, {1, stiff}}, o);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      EXPECT_EQ(s.masses()[i], anew.masses()[i]);
      gain += 0.5 * (s.masses()[i] - masses[i]) * dot(s.velocity()[i], s.velocity()[i]);
    }
    EXPECT_EQ(s.mass_scaling().added, anew.mass_scaling().added);
    EXPECT_NEAR(s.energies().kinetic - before.kinetic, gain, 1e-12 * gain);
    test::run(s, 20);
    EXPECT_NEAR(s.energies().imbalance(), 0.0, 1e-10 * s.energies().work_tools);
  }
}

}  // namespace
}  // namespace glisson

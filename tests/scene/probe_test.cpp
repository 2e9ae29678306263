// Probes read what the forces are made of: a uniform stress exactly, on an irregular mesh, by point, region and section; the
// tool's force by every section of a body at rest; and the creep of a standard linear solid. They follow cuts.
#include "glisson/simulation/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "glisson/instruments/motion.h"
#include "glisson/scene/tissue_presets.h"
#include "scene/scene_text.h"
#include "support/bodies.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kEdge = 0.03;

/// Values of a probe by the ends of its columns.
struct Reading {
  std::vector<std::string> columns;
  std::vector<double> values;

  Reading(Probes& probes, const Simulation& simulation) : columns(probes.columns()), values(probes.read(simulation)) {}
  double operator[](const std::string& column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    if (found == columns.end()) throw std::out_of_range("no column " + column);
    return values[static_cast<std::size_t>(found - columns.begin())];
  }
  Vec3d vector(const std::string& what, const std::string& unit) const {
    return {(*this)[what + "_x_" + unit], (*this)[what + "_y_" + unit], (*this)[what + "_z_" + unit]};
  }
};

TetMesh irregular() {
  std::mt19937 random(7);
  return test::jittered_box({3, 3, 3}, 0.01, 0.25, random);
}

/// λ tr(ε) δ_ij + 2 μ ε_ij of a symmetric gradient.
Mat3d hooke(const Tissue& tissue, const Mat3d& e) {
  const double E = tissue.youngs_modulus, nu = tissue.poisson_ratio;
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 * E / (1.0 + nu);
  Mat3d s;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) s(i, j) = 2.0 * mu * e(i, j) + (i == j ? lambda * trace(e) : 0.0);
  }
  return s;
}

// A linear field strains every tet alike: point, region and section read Hooke's stress to rounding, the mean of a face lies
// at its centre, and a box of volume V has V (1 + tr H + …) exactly, det F V.
TEST(Probes, ReadAUniformStateExactly) {
  for (const VolumeChange volume : {VolumeChange::element, VolumeChange::average_nodal}) {
    const TetMesh mesh = irregular();
    Tissue tissue;
    tissue.poisson_ratio = 0.4, tissue.volume_change = volume;
    Simulation simulation(mesh, {{0, tissue}}, test::in_double());
    const Mat3d H{{{{0.01, 0.004, -0.002}, {0.004, -0.02, 0.003}, {-0.002, 0.003, 0.015}}}};
    std::vector<Vec3d> u, v(mesh.vertices.size());
    for (const Vec3d& x : mesh.vertices) u.push_back(H * x);
    simulation.set_state(u, v);
    const Mat3d s = hooke(tissue, H);
    const ProbePlane plane{{0.0, 0.0, 0.0171}, {0.3, -0.2, 2.0}};
    const Vec3d n = unit(plane.normal), x{0.011, 0.0142, 0.0207};
    Probes probes(simulation,
                  {{"p", ProbePoint{x}}, {"r", ProbeRegion{"0"}}, {"s", plane}, {"top", ProbeSet{"z_max"}}});
    const Reading read(probes, simulation);
    const double size = std::abs(s(0, 0)) + std::abs(s(1, 1));
    for (const char* probe : {"p", "r"}) {
      const auto is = [&](const char* ij, double expected, double scale) {
        EXPECT_NEAR(read[std::string(probe) + ij], expected, 1e-10 * scale) << probe << ij;
      };
      is("_stress_xx_Pa", s(0, 0), size), is("_stress_yy_Pa", s(1, 1), size), is("_stress_zz_Pa", s(2, 2), size);
      is("_stress_xy_Pa", s(0, 1), size), is("_stress_yz_Pa", s(1, 2), size), is("_stress_zx_Pa", s(2, 0), size);
      is("_pressure_Pa", -trace(s) / 3.0, size);
      is("_strain_xx", 0.01 + 0.5 * (0.01 * 0.01 + 0.004 * 0.004 + 0.002 * 0.002), 1.0);
    }
    EXPECT_LE(norm(read.vector("p_displacement", "m") - H * x), 1e-15);
    EXPECT_LE(norm(read.vector("s_traction", "Pa") - s * n), 1e-10 * size) << "P n over the section";
    EXPECT_LE(norm(read.vector("top_displacement", "m") - H * Vec3d{0.5 * kEdge, 0.5 * kEdge, kEdge}), 1e-15)
        << "the face's centre";
    Mat3d F = H;
    for (std::size_t i = 0; i < 3; ++i) F(i, i) += 1.0;
    EXPECT_NEAR(read["r_volume_m3"], determinant(F) * kEdge * kEdge * kEdge, 1e-16);
    EXPECT_NEAR(read["p_volume_ratio"], determinant(F), 1e-12);
    EXPECT_NEAR(read["s_area_m2"], kEdge * kEdge / n.z, 1e-12) << "a slanted section of a prism";
  }
}

// In equilibrium every section carries the tool's force, wherever it cuts an irregular mesh and whatever the tissue; the
// section's moment is that of the tool about the same point, and a set reads the force that is exerted on it.
TEST(Probes, SectionsCarryTheForceOfTheTool) {
  for (const char* preset : {"liver_mre", "phantom_ef10_100t", "paper_liver"}) {
    const TetMesh mesh = irregular();
    Simulation simulation(mesh, {{0, tissue_preset(preset).tissue}},
                          {.integrator = Integrator::quasi_static, .step = 0.05, .implicit = {.tolerance = 1e-11}});
    simulation.fix("z_min");
    std::vector<std::uint32_t> pad;
    for (const std::uint32_t v : mesh.vertex_sets.at("z_max")) {
      if (mesh.vertices[v].x < 0.5 * kEdge) pad.push_back(v);
    }
    const ConstraintId tool =
        simulation.drive(pad, press({.direction = {0.2, 0.0, -1.0}, .velocity = 0.01, .depth = 0.001}));
    ASSERT_TRUE(simulation.advance_to(0.1).made());
    const Vec3d force = simulation.force(tool).total();
    for (const double z : {0.003, 0.0101, 0.0155, 0.027}) {
      Probes probes(simulation,
                    {{"cut", ProbePlane{{0.015, 0.015, z}, {0.1, 0.05, 1.0}}}, {"base", ProbeSet{"z_min"}}});
      const Reading read(probes, simulation);
      EXPECT_LE(norm(read.vector("cut_force", "N") - force), 1e-6 * norm(force)) << preset << ", z = " << z;
      EXPECT_LE(norm(read.vector("base_force", "N") + force), 1e-6 * norm(force)) << preset;
    }
  }
}

// In motion the part in front of a section is pushed by the tool and by the section: F_tool = F_section + Σ m a over its vertices, at
// each instant of explicit steps. a is the change of the velocities of the half steps around it; 1e-6 is for double precision.
TEST(Probes, SectionsAndInertiaCarryTheForceOfTheTool) {
  constexpr double h = 2e-5;
  Tissue tissue = tissue_preset("phantom_ef10_100t").tissue;
  tissue.maxwell = {{.share = 0.3, .time = 0.01}};
  const TetMesh mesh = irregular();
  Simulation simulation(mesh, {{0, tissue}}, {.step = h, .precision = Precision::double_precision});
  simulation.fix("z_min");
  const ConstraintId tool =
      simulation.drive("z_max", press({.direction = {0.2, 0.0, -1.0}, .velocity = 0.05, .depth = 0.003}));
  double inertia_share = 0.0;
  for (const double z : {0.0101, 0.0155, 0.027}) {
    ASSERT_TRUE(simulation.advance_to(simulation.time() + 0.004).made());
    const Vec3d point{0.015, 0.015, z};
    Probes probes(simulation, {{"cut", ProbePlane{point, {0.0, 0.0, 1.0}}}});
    const Vec3d section = Reading(probes, simulation).vector("cut_force", "N");
    const std::vector<Vec3d> before(simulation.velocity().begin(), simulation.velocity().end());
    ASSERT_TRUE(simulation.step().made());
    Vec3d inertia{};
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (mesh.vertices[v].z > z) inertia += (simulation.velocity()[v] - before[v]) * (simulation.masses()[v] / h);
    }
    const Vec3d force = simulation.force(tool).total();
    EXPECT_LE(norm(section + inertia - force), 1e-6 * norm(force)) << "z = " << z;
    inertia_share = std::max(inertia_share, norm(inertia) / norm(force));
  }
  EXPECT_GT(inertia_share, 1e-3);  // without it the test would fail
}

// The moment of a section: a bar bent by a force across its end carries F L there, about a point of the section.
TEST(Probes, SectionCarriesTheMoment) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 8}, .size = {0.01, 0.01, 0.04}});
  Tissue tissue;
  tissue.kinematics = Kinematics::green;
  Simulation simulation(mesh, {{0, tissue}}, {.integrator = Integrator::quasi_static, .step = 1.0});
  simulation.fix("z_min");
  const Vec3d force{1e-4, 0.0, 0.0};
  simulation.add_load("z_max", force);
  ASSERT_TRUE(simulation.step().made());
  const Vec3d point{0.005, 0.005, 0.0125};
  Probes probes(simulation, {{"cut", ProbePlane{point, {0.0, 0.0, 1.0}}}});
  const Reading read(probes, simulation);
  Vec3d expected{};
  const std::vector<Vec3d> x = simulation.positions();
  const auto& end = mesh.vertex_sets.at("z_max");
  for (const std::uint32_t v : end) expected += cross(x[v] - point, force * (1.0 / static_cast<double>(end.size())));
  EXPECT_LE(norm(read.vector("cut_moment", "N_m") - expected), 1e-6 * norm(expected));
  EXPECT_NEAR(expected.y, 1e-4 * 0.0275, 1e-7) << "F (L − z), but for the bend";
}

// Under a constant load a bar of a standard linear solid creeps. Of its modulus E₀ at once a share g relaxes in τ: in tension
//   ε(t) = σ/E∞ (1 − g e^(−t/τ_c)),  E∞ = E₀ (1 − g),  τ_c = τ / (1 − g).
// With every component relaxing and free sides this is exact; backward Euler's steps of τ/400 err by some 1e-3.
TEST(Probes, CreepIsThatOfTheStandardLinearSolid) {
  const double share = 0.6, tau = 0.2, stress = 30.0;
  Tissue tissue;
  tissue.youngs_modulus = 3000.0, tissue.poisson_ratio = 0.3;
  tissue.maxwell = {{.share = share, .time = tau}};
  tissue.density = 1.0;  // waves die within a step
  tissue.maxwell_part = MaxwellPart::all;
  const TetMesh mesh = box_mesh({.cells = {1, 1, 2}, .size = {0.01, 0.01, 0.02}});
  Simulation simulation(mesh, {{0, tissue}}, {.integrator = Integrator::implicit, .step = tau / 400.0});
  simulation.fix("z_min", {false, false, true});
  simulation.fix("x_min", {true, false, false});
  simulation.fix("y_min", {false, true, false});
  // A uniform traction on the upper end, by the areas of its triangles.
  for (const Triangle& t : boundary_triangles(mesh)) {
    if (mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z < 0.06 - 1e-9) continue;
    simulation.add_load(t, {0.0, 0.0, stress * 0.5e-4});
  }
  Probes probes(simulation, {{"end", ProbeSet{"z_max"}}, {"middle", ProbePoint{{0.004, 0.003, 0.01}}}});
  const double slow = 3000.0 * (1.0 - share);
  for (const double t : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    ASSERT_TRUE(simulation.advance_to(t * tau).made());
    const double expected = stress / slow * (1.0 - share * std::exp(-simulation.time() * (1.0 - share) / tau));
    const Reading read(probes, simulation);
    EXPECT_NEAR(read["end_displacement_z_m"] / 0.02, expected, 3e-3 * stress / slow) << "at " << t << " τ";
    EXPECT_NEAR(read["middle_displacement_z_m"] / 0.01, expected, 3e-3 * stress / slow);
    EXPECT_NEAR(read["middle_stress_zz_Pa"], stress, 2e-3 * stress) << "while the load is held";
  }
}

// A body that falls freely from rest moves as one, also in float: after n explicit steps of h each of its points has
//   v = −g h (n + ½) half a step on,  u = −g h² n (n + 1)/2,
// which point, set and region read alike, without stress, and with the inertia of the part in front as the only force of a section.
TEST(Probes, ReadTheFreeFallOfExplicitSteps) {
  const double g = 9.81, h = 2e-4;
  SimulationOptions options{.step = h, .gravity = {0.0, 0.0, -g}};
  Simulation simulation(irregular(), {{0, Tissue{}}}, options);
  Probes probes(simulation, {{"p", ProbePoint{{0.011, 0.0142, 0.0207}}},
                             {"s", ProbeSet{"x_max"}},
                             {"r", ProbeRegion{"0"}},
                             {"c", ProbePlane{{0.0, 0.0, 0.0117}}}});
  for (const int n : {1, 50, 200}) {
    while (simulation.steps() < static_cast<std::uint64_t>(n)) ASSERT_TRUE(simulation.step().made());
    const double steps = n, fall = -g * h * h * steps * (steps + 1.0) / 2.0;
    const Reading read(probes, simulation);
    for (const std::string probe : {"p", "s", "r"}) {
      EXPECT_NEAR(read[probe + "_velocity_z_m_s"], -g * h * steps, 1e-5 * g * h * steps) << probe << " after " << n;
      EXPECT_NEAR(read[probe + "_displacement_z_m"], fall, 1e-5 * std::abs(fall)) << probe << " after " << n;
      EXPECT_NEAR(read[probe + "_displacement_x_m"], 0.0, 1e-6 * std::abs(fall));
    }
    EXPECT_NEAR(read["p_von_mises_Pa"], 0.0, 1e-2) << "of a modulus of some kPa, in float";
    EXPECT_NEAR(read["c_force_z_N"], 0.0, 1e-5);
  }
}

// Probes keep nothing that a checkpoint would have to hold: those of a body that goes on from one read the same bytes, also
// after a cut, and on two threads as on one.
TEST(Probes, GoOnFromACheckpointAndOnAnyThreads) {
  const TetMesh mesh = irregular();
  Tissue tissue;
  tissue.viscosity = 2.0, tissue.maxwell = {{.share = 0.4, .time = 0.1}};
  const auto made = [&](int threads) {
    Simulation simulation(mesh, {{0, tissue}}, {.threads = threads});
    simulation.fix("z_min");
    simulation.drive("z_max", press({.direction = {0.3, 0.0, -1.0}, .velocity = 0.02, .depth = 0.002}));
    return simulation;
  };
  const auto probes_of = [](const Simulation& simulation) {
    return Probes(simulation, {{"p", ProbePoint{{0.011, 0.0142, 0.0207}}},
                               {"s", ProbeSet{"x_max"}},
                               {"r", ProbeRegion{"0"}},
                               {"c", ProbePlane{{0.0, 0.0, 0.0117}, {0.2, 0.1, 1.0}}}});
  };
  Simulation one = made(1), two = made(2), continued = made(1);
  Probes of_one = probes_of(one), of_two = probes_of(two), early = probes_of(continued);
  for (Simulation* s : {&one, &two}) {
    ASSERT_TRUE(s->advance_to(0.02).made());
    s->remove_tets(std::vector<std::uint32_t>{3, 4, 60});
    ASSERT_TRUE(s->advance_to(0.03).made());
  }
  std::stringstream file;
  one.save(file);
  continued.load(file);
  Probes late = probes_of(continued);
  const std::vector<double> expected = of_one.read(one);
  EXPECT_EQ(of_two.read(two), expected);
  EXPECT_EQ(early.read(continued), expected) << "made before the checkpoint was loaded";
  EXPECT_EQ(late.read(continued), expected) << "made after it";
}

// Tets that are removed are left out; a probe without any reads nan. Vertices that a cut copies follow their tets.
TEST(Probes, FollowCutsAndRemovedTets) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {kEdge, kEdge, kEdge}});
  Simulation simulation(mesh, {{0, Tissue{}}}, test::in_double());
  const Vec3d point{0.02, 0.021, 0.019};
  Probes probes(simulation, {{"p", ProbePoint{point}}, {"all", ProbeRegion{"0"}}, {"s", ProbePlane{{0.0, 0.0, 0.01}}}});
  const double volume = Reading(probes, simulation)["all_volume_m3"];
  std::vector<Triangle> faces;  // of the middle plane z = 15 mm
  for (const Tet& t : mesh.tets) {
    std::vector<std::uint32_t> on;
    for (const std::uint32_t v : t) {
      if (std::abs(mesh.vertices[v].z - 0.5 * kEdge) < 1e-9) on.push_back(v);
    }
    if (on.size() == 3) faces.push_back({on[0], on[1], on[2]});
  }
  const SplitReport split = simulation.split_faces(faces);
  ASSERT_EQ(split.origins.size(), 9u);
  std::vector<Vec3d> u(simulation.mesh().vertices.size()), v(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = {0.0, 0.0, 0.0};
  for (const std::uint32_t t : [&] {
         std::vector<std::uint32_t> upper;
         for (std::uint32_t k = 0; k < mesh.tets.size(); ++k) {
           double z = 0.0;
           for (const std::uint32_t i : mesh.tets[k]) z += 0.25 * mesh.vertices[i].z;
           if (z > 0.5 * kEdge) upper.push_back(k);
         }
         return upper;
       }()) {
    for (const std::uint32_t i : simulation.mesh().tets[t]) u[i] = {0.001, 0.0, 0.002};
  }
  simulation.set_state(u, v);
  Reading read(probes, simulation);
  EXPECT_LE(norm(read.vector("p_displacement", "m") - Vec3d{0.001, 0.0, 0.002}), 1e-15) << "with the upper half";
  EXPECT_NEAR(read["all_volume_m3"], volume, 1e-15) << "both halves as they were";
  EXPECT_LE(norm(read.vector("s_force", "N")), 1e-12);
  std::vector<std::uint32_t> upper;
  for (std::uint32_t t = 0; t < simulation.mesh().tets.size(); ++t) {
    double z = 0.0;
    for (const std::uint32_t i : simulation.mesh().tets[t]) z += 0.25 * simulation.mesh().vertices[i].z;
    if (z > 0.5 * kEdge) upper.push_back(t);
  }
  simulation.remove_tets(upper);
  read = Reading(probes, simulation);
  EXPECT_TRUE(probes.lost(0));
  EXPECT_FALSE(probes.lost(1));
  EXPECT_TRUE(std::isnan(read["p_stress_xx_Pa"]));
  EXPECT_NEAR(read["all_volume_m3"], 0.5 * volume, 1e-15);
  EXPECT_NEAR(read["s_area_m2"], kEdge * kEdge, 1e-12);
}

// Probes compute the fields of their tets alone, and these are those of all tets to the last bit, with shared volume changes,
// viscosity and branches that have not relaxed.
TEST(Probes, ReadWhatFramesShow) {
  std::mt19937 random(3);
  TetMesh mesh = irregular();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(t % 5 == 0 ? 2 : 0);
  Tissue tissue;
  tissue.volume_change = VolumeChange::average_nodal, tissue.poisson_ratio = 0.45, tissue.viscosity = 3.0;
  tissue.maxwell = {{.share = 0.4, .time = 0.1}};
  Simulation simulation(mesh, {{0, tissue}, {2, Tissue{}}});
  simulation.set_state(test::random_field(mesh.vertices.size(), 3e-4, random),
                       test::random_field(mesh.vertices.size(), 1e-2, random));
  ASSERT_TRUE(simulation.step().made());
  const TetFields all = simulation.tet_fields();
  for (const std::size_t t : {17u, 5u, 40u, 81u}) {
    Vec3d centroid{};
    for (const std::uint32_t v : mesh.tets[t]) centroid += mesh.vertices[v] * 0.25;
    Probes probes(simulation, {{"a", ProbePoint{centroid}}, {"b", ProbePoint{centroid}}});
    const Reading read(probes, simulation);
    for (const char* probe : {"a", "b"}) {
      EXPECT_EQ(read[std::string(probe) + "_stress_xx_Pa"], all.stress[6 * t]);
      EXPECT_EQ(read[std::string(probe) + "_stress_zx_Pa"], all.stress[6 * t + 5]);
      EXPECT_EQ(read[std::string(probe) + "_volume_ratio"], all.jacobian[t]);
    }
  }
}

/// Keeps the samples of a run, and ends it after some.
class Samples : public RunObserver {
 public:
  Samples(std::atomic<bool>& stop, std::size_t most) : stop_(stop), most_(most) {}
  void on_built(const BuiltVariant& built) override { columns = built.probes.columns(); }
  void on_sample(const Sample& s) override {
    samples.push_back(s);
    if (samples.size() == most_) stop_ = true;
  }
  std::vector<std::string> columns;
  std::vector<Sample> samples;

 private:
  std::atomic<bool>& stop_;
  std::size_t most_;
};

// Probes are read at the instant of the forces, under every integrator: the resultant of the stress on a driven set and the
// elastic and viscous force of its tool are one number, to float rounding in the tool's, also in the last sample. Without
// inertia a set's force is then exactly that of the tool. The run itself has the same bytes with probes and without.
TEST(Probes, AreReadAtTheTimeOfTheForces) {
  const std::string probes = "[[probe]]\nname = \"pad\"\nset = \"top\"\n";
  for (const char* integrator : {"central_difference", "semi_implicit", "implicit", "quasi_static"}) {
    const std::string text = test::kSmallScene + "[motion]\nprecision = \"double\"\nintegrator = \"" + integrator +
                             "\"\n" + "[tissue]\nviscosity_Pa_s = 5\nvolume_change = \"average_nodal\"\n";
    std::atomic<bool> stop{false};
    Samples with(stop, 0), without(stop, 0);
    const RunSummary a = run_variant(test::parse(text + probes).variants[0], {}, with, stop);
    const RunSummary b = run_variant(test::parse(text).variants[0], {}, without, stop);
    EXPECT_EQ(a.state_hash, b.state_hash) << integrator;
    ASSERT_EQ(with.samples.size(), without.samples.size());
    const auto column = std::find(with.columns.begin(), with.columns.end(), "pad_force_z_N") - with.columns.begin();
    double largest = 0.0, worst = 0.0;
    for (const Sample& s : with.samples) {
      EXPECT_EQ(s.probe_time, s.time) << integrator;
      const std::vector<double>& tool = s.instruments[0].values;  // depth, force x y z, force, elastic, viscous, …
      const double internal = -(tool[5] + tool[6]);               // along −z
      if (std::string(integrator) == "semi_implicit") continue;   // whose viscous force is of the end of the step
      worst = std::max(worst, std::abs(s.probes[static_cast<std::size_t>(column)] - internal));
      largest = std::max(largest, std::abs(internal));
    }
    EXPECT_LE(worst, 1e-6 * largest) << integrator;
  }
}

// A run that is interrupted ends with the state that it has: its last line says of which time it is.
TEST(Probes, OfAnInterruptedRunSayTheirTime) {
  std::atomic<bool> stop{false};
  Samples seen(stop, 5);
  const std::string probe = "[[probe]]\npoint_m = [0.01, 0.01, 0.015]\n";
  const RunSummary summary = run_variant(test::parse(test::kSmallScene + probe).variants[0], {}, seen, stop);
  EXPECT_EQ(summary.end, RunSummary::End::interrupted);
  ASSERT_GE(seen.samples.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(seen.samples[i].probe_time, seen.samples[i].time);
  EXPECT_LE(seen.samples.back().probe_time - seen.samples.back().time, 1.01 * summary.step_s);
  EXPECT_EQ(seen.samples.back().probes.size(), seen.columns.size());
}

// A scene's probe is refused at its place in the file: without a place, with two, with a name that is taken, outside of the
// body, and with a set that is not there.
TEST(Probes, OfASceneAreCheckedInTheFile) {
  const auto said = [](const std::string& probe) { return test::complaint(test::kSmallScene + probe); };
  EXPECT_THAT(said("[[probe]]\nname = \"a\"\n"),
              AllOf(HasSubstr("s.toml:"), HasSubstr("probe.0"), HasSubstr("point_m")));
  EXPECT_THAT(said("[[probe]]\nset = \"top\"\npoint_m = [0, 0, 0]\n"), AllOf(HasSubstr("probe.0"), HasSubstr("set")));
  EXPECT_THAT(said("[[probe]]\nset = \"top\"\n[[probe]]\nset = \"z_min\"\n"), HasSubstr("\"probe\" is taken"));
  EXPECT_THAT(said("[[probe]]\nset = \"tpo\"\n"), AllOf(HasSubstr("tpo"), HasSubstr("did you mean \"top\"")));
  EXPECT_THAT(said("[[probe]]\nname = \"a,b\"\nset = \"top\"\n"), HasSubstr("a,b"));
  EXPECT_THAT(said("[[probe]]\nplane_m = { normal = [0, 0, 1] }\n"), HasSubstr("point"));
  EXPECT_THAT(said("[[probe]]\nplane_m = { point = [0, 0, 0.01], normal = [0, 0, 0] }\n"), HasSubstr("normal"));
  const Scene scene = test::parse(test::kSmallScene + "[[probe]]\nname = \"far\"\npoint_m = [0, 0, 1]\n");
  try {
    build_variant(scene.variants[0], {});
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("s.toml:"), HasSubstr("probe.0"), HasSubstr("\"far\""),
                                    HasSubstr("nearest point is [0, 0, 0.02]")));
  }
}

/// What is said of a probe that cannot be.
template <class Where>
std::string refusal(const Where& where) {
  const Simulation simulation(irregular(), {{0, Tissue{}}});
  try {
    Probes(simulation, {{"here", where}});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// A probe that the body does not have is refused by its name, with the way out.
TEST(Probes, RefuseWhatTheBodyDoesNotHave) {
  EXPECT_THAT(
      refusal(ProbePoint{{0.01, 0.02, 0.05}}),
      AllOf(HasSubstr("probe \"here\""), HasSubstr("[0.01, 0.02, 0.05]"), HasSubstr("outside of the body"),
            HasSubstr("spans [0, 0, 0] to [0.03, 0.03, 0.03]"), HasSubstr("nearest point is [0.01, 0.02, 0.03]")));
  EXPECT_THAT(refusal(ProbeSet{"top"}), AllOf(HasSubstr("top"), HasSubstr("z_max")));
  EXPECT_THAT(refusal(ProbeRegion{"vessel"}), AllOf(HasSubstr("vessel"), HasSubstr("it has 0")));
  EXPECT_THAT(refusal(ProbePlane{{0.0, 0.0, 0.04}}), AllOf(HasSubstr("does not cut"), HasSubstr("-0.04 to -0.01 m")));
  EXPECT_THAT(refusal(ProbePlane{{0.0, 0.0, 0.01}, {0.0, 0.0, 0.0}}), HasSubstr("normal"));
  EXPECT_THAT(refusal(ProbePoint{{0.01, NAN, 0.03}}), HasSubstr("probe \"here\": position.y [m] = nan"));
  EXPECT_EQ(refusal(ProbePoint{{0.01, 0.02, 0.03}}), "") << "on the surface";
}

}  // namespace
}  // namespace glisson

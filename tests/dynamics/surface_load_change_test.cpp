// Loads on faces go with their faces, and their bytes through checkpoints and threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "dynamics/surface_load.h"
#include "support/integrators.h"
#include "support/must_step.h"

namespace glisson::surface_load_test {
namespace {

using test::must_step;

// What tets that are removed had of the faces is gone with them; a cut through loaded faces leaves the whole load on, and its
// own faces bear nothing. The force on the body is measured by what it does to the momentum of a free body in one step.
TEST(SurfaceLoad, GoesWithItsFaces) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const auto force = [](Simulation& s) {
    const auto momentum = [&] {
      Vec3d sum{};
      for (std::size_t v = 0; v < s.masses().size(); ++v) sum += s.velocity()[v] * s.masses()[v];
      return sum;
    };
    const Vec3d before = momentum();
    const double h = s.step_size();
    must_step(s);
    return (momentum() - before) * (1.0 / h);
  };
  Simulation s(mesh, {{0, linear_tissue()}}, with(Integrator::central_difference));
  s.add_surface_load("z_max", {.traction = {1.0, 0.0, 10.0}, .pressure = 5.0});
  EXPECT_LE(norm(force(s) - Vec3d{1.0, 0.0, 5.0} * 4e-4), 1e-12);
  std::vector<Triangle> wall;  // the plane x = 1 cm
  for (const Tet& t : mesh.tets) {
    for (std::size_t a = 0; a < 4; ++a) {
      Triangle face{};
      std::size_t n = 0;
      for (std::size_t b = 0; b < 4; ++b) {
        if (b != a && std::abs(mesh.vertices[t[b]].x - 0.01) < 1e-9) face[n++] = t[b];
        if (b != a && n == 0) continue;
      }
      if (n == 3) wall.push_back(face);
    }
  }
  s.split_faces(wall);
  ASSERT_GT(s.mesh().vertices.size(), mesh.vertices.size());
  EXPECT_LE(norm(force(s) - Vec3d{1.0, 0.0, 5.0} * 4e-4), 1e-12);
  std::vector<std::uint32_t> half;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    double x = 0.0;
    for (const std::uint32_t v : mesh.tets[t]) x += 0.25 * mesh.vertices[v].x;
    if (x > 0.01) half.push_back(t);
  }
  s.remove_tets(half);
  EXPECT_LE(norm(force(s) - Vec3d{1.0, 0.0, 5.0} * 2e-4), 1e-12);
}

/// A column whose top set has as many vertices again in no tet, some above it.
TetMesh column_with_dust() {
  TetMesh mesh = box_mesh({.cells = {2, 2, 4}, .size = {0.02, 0.02, 0.04}});
  std::vector<std::uint32_t>& top = mesh.vertex_sets["z_max"];
  for (std::size_t i = 0; i < 18; ++i) {
    top.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({0.001 * static_cast<double>(i), 0.004, i % 2 == 0 ? 0.04 : 0.05});
  }
  return mesh;
}

/// Force on the body by all that is held [N].
Vec3d reaction(const Simulation& s, ConstraintId support) { return s.force(support).total(); }

// A force on a set with vertices in no tet is borne by those in tets: the support takes all of it under every integrator, at rest.
TEST(SurfaceLoad, LooseVerticesBearNothing) {
  for (const Integrator integrator : test::every_integrator()) {
    SimulationOptions o = with(integrator);
    o.damping_rate = 100.0;
    Simulation s(column_with_dust(), {{0, linear_tissue()}}, o);
    const ConstraintId support = s.fix("z_min");
    s.add_load("z_max", {0.003, 0.0, 0.02});
    ASSERT_TRUE(s.advance_to(1.5).made());
    EXPECT_LE(norm(reaction(s, support) + Vec3d{0.003, 0.0, 0.02}), 1e-6 * 0.02) << static_cast<int>(integrator);
  }
}

// A body on springs of a set that has such vertices sinks by its weight over the springs' stiffness; so does what is left of it when
// half of it is removed with half of the set, which takes on the springs of the half that is gone.
TEST(SurfaceLoad, SpringsOfTheWholeSetHoldWhatIsLeft) {
  const double stiffness = 100.0, weight = 9.81 * 1000.0 * 1.6e-5;
  SimulationOptions o = with(Integrator::quasi_static);
  o.gravity = {0.0, 0.0, -9.81};
  Simulation s(column_with_dust(), {{0, linear_tissue()}}, o);
  s.fix("z_min", {true, true, false});
  s.add_surface_load("z_max", {.spring = {0.0, 0.0, stiffness}});
  const auto sink = [&] {  // of those that the springs hold
    double sum = 0.0, count = 0.0;
    for (const std::uint32_t v : s.mesh().vertex_sets.at("z_max")) {
      if (s.masses()[v] > 0.0) sum -= s.displacement()[v].z, count += 1.0;
    }
    return sum / count;
  };
  must_step(s);
  EXPECT_NEAR(sink(), weight / stiffness, 1e-9 * weight / stiffness);
  std::vector<std::uint32_t> half;
  for (std::uint32_t t = 0; t < s.mesh().tets.size(); ++t) {
    double x = 0.0;
    for (const std::uint32_t v : s.mesh().tets[t]) x += 0.25 * s.mesh().vertices[v].x;
    if (x > 0.01) half.push_back(t);
  }
  EXPECT_FALSE(s.remove_tets(half).loose_vertices.empty());
  must_step(s);
  EXPECT_NEAR(sink(), 0.5 * weight / stiffness, 1e-9 * weight / stiffness);
}

// When all tets of a loaded set are gone, its force acts on nothing and the body goes on without it; a load that would act on nothing
// from the start is refused.
TEST(SurfaceLoad, ASetWithoutTetsBearsNothing) {
  Simulation s(column_with_dust(), {{0, linear_tissue()}}, with(Integrator::quasi_static));
  const ConstraintId support = s.fix("z_min");
  s.add_load("z_max", {0.0, 0.0, 0.02});
  must_step(s);
  EXPECT_NEAR(reaction(s, support).z, -0.02, 1e-8);
  std::vector<std::uint32_t> upper;
  for (std::uint32_t t = 0; t < s.mesh().tets.size(); ++t) {
    const Tet& tet = s.mesh().tets[t];
    if (std::any_of(tet.begin(), tet.end(), [&](auto v) { return s.mesh().vertices[v].z > 0.035; })) upper.push_back(t);
  }
  s.remove_tets(upper);
  must_step(s);
  EXPECT_LE(norm(reaction(s, support)), 1e-10);
  EXPECT_THROW(s.add_load("z_max", {0.0, 0.0, 0.02}), std::invalid_argument);
  EXPECT_THROW(s.add_surface_load("z_max", {.spring = {0.0, 0.0, 1.0}}), std::invalid_argument);
}

// A run continued from a checkpoint, cut on the way, has the bytes of the one that was not interrupted; so has one on more
// threads.
TEST(SurfaceLoad, CheckpointsAndThreadsKeepTheBytes) {
  for (const Integrator integrator :
       {Integrator::central_difference, Integrator::semi_implicit, Integrator::implicit}) {
    const auto made = [&](int threads) {
      SimulationOptions o;
      o.integrator = integrator;
      o.threads = threads;
      Tissue tissue = linear_tissue();
      tissue.viscosity = integrator == Integrator::implicit ? 0.0 : 5.0;
      Simulation s(test::paper_mesh(), {{0, tissue}}, o);
      s.fix("z_min");
      s.add_surface_load("z_max",
                         {.force = {0.01, 0, 0},
                          .traction = {10.0, 0, 0},
                          .pressure = 100.0,
                          .moment = {0, 0, 1e-4},
                          .follows = true,
                          .spring = {1, 2, 3},
                          .dashpot_per_area = {10, 10, 5}},
                         [](double t) { return std::sin(30.0 * t); });
      return s;
    };
    const auto run = [](Simulation& s) {
      for (int i = 0; i < 15; ++i) must_step(s);
    };
    Simulation whole = made(1), two = made(2), later = made(1);
    run(whole), run(two);
    whole.remove_tets(std::vector<std::uint32_t>{700, 701}), two.remove_tets(std::vector<std::uint32_t>{700, 701});
    run(whole), run(two);
    std::stringstream file;
    whole.save(file);
    later.load(file);
    run(whole), run(two), run(later);
    EXPECT_EQ(whole.state_hash(), later.state_hash()) << static_cast<int>(integrator);
    EXPECT_EQ(whole.state_hash(), two.state_hash()) << static_cast<int>(integrator);
    EXPECT_EQ(whole.energies().dissipated, later.energies().dissipated);
  }
}

}  // namespace
}  // namespace glisson::surface_load_test

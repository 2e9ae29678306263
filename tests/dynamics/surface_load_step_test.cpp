// Springs and loads that follow enter the stable step.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <string>

#include "dynamics/surface_load.h"
#include "support/must_step.h"

namespace glisson::surface_load_test {
namespace {

using test::must_step;

// Stiff springs shorten the automatic step so far that it stays stable, and are refused where a given step does not bear them.
TEST(SurfaceLoad, SpringsEnterTheStableStep) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  const SurfaceLoad stiff{.spring_per_area = {0.0, 0.0, 1e9}};
  Simulation s(mesh, {{0, linear_tissue()}}, with(Integrator::central_difference));
  const double before = s.step_size();
  s.fix("z_min");
  s.add_surface_load("z_max", stiff);
  s.add_surface_load("x_max", {.traction = {100.0, 0.0, 0.0}});
  EXPECT_LT(s.step_size(), 0.2 * before);
  for (int i = 0; i < 2000; ++i) must_step(s);
  for (const Vec3d& u : s.displacement()) EXPECT_LT(norm(u), 1e-3);

  SimulationOptions o = with(Integrator::central_difference);
  o.step = before;
  Simulation given(mesh, {{0, linear_tissue()}}, o);
  try {
    given.add_surface_load("z_max", stiff);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("above the stable step"), std::string::npos) << error.what();
  }
  must_step(given);
  EXPECT_EQ(norm(given.displacement()[0]), 0.0) << "what was refused does not act";
}

// The squared frequency that the stable step allows for is above every eigenvalue of M⁻¹ ∂f/∂u, and not far above.
TEST(SurfaceLoad, FollowingLoadsEnterTheStableStep) {
  std::mt19937 random(13);
  const TetMesh mesh = test::jittered_box({4, 4, 2}, 0.01, 0.3, random);
  const std::vector<Vec3d> u = test::random_field(mesh.vertices.size(), 0.001, random);
  for (const SurfaceLoad& load :
       {SurfaceLoad{.pressure = 100.0, .follows = true}, SurfaceLoad{.traction = {50.0, 0.0, 80.0}, .follows = true},
        SurfaceLoad{.moment = {0.0, 0.0, 1e-3}, .follows = true},
        SurfaceLoad{.moment = {2e-3, 1e-3, 0.0}, .follows = true}}) {
    Loaded body(mesh);
    body.loads.add(body.body, mesh.vertex_sets.at("z_max"), load, {});
    const auto n = static_cast<Eigen::Index>(3 * u.size());
    Eigen::MatrixXd slope(n, n);
    const double d = 1e-8;
    for (Eigen::Index c = 0; c < n; ++c) {
      const auto force_at = [&](double step) {
        std::vector<Vec3d> there = u;
        there[static_cast<std::size_t>(c) / 3][static_cast<std::size_t>(c) % 3] += step;
        const std::span<const Vec3d> f = body.loads.at(0.0, body.body, there);
        return std::vector<Vec3d>(f.begin(), f.end());
      };
      const std::vector<Vec3d> more = force_at(d), less = force_at(-d);
      for (Eigen::Index r = 0; r < n; ++r) {
        const auto v = static_cast<std::size_t>(r) / 3, axis = static_cast<std::size_t>(r) % 3;
        slope(r, c) = (more[v][axis] - less[v][axis]) * (0.5 / d) / body.body.masses[v];
      }
    }
    static_cast<void>(body.loads.at(0.0, body.body, u));
    const double largest = Eigen::EigenSolver<Eigen::MatrixXd>(slope, false).eigenvalues().cwiseAbs().maxCoeff();
    const double bound = body.loads.squared_frequency(body.body);
    EXPECT_GE(bound, largest);
    EXPECT_LE(bound, 30.0 * largest);
    RecordProperty("bound_over_largest", std::to_string(bound / largest));
  }
}

}  // namespace
}  // namespace glisson::surface_load_test

// capsule.cpp — what a capsule costs: its sheet alone, and a step of a body with and without it.
//
// Prints the least time of many rounds, since the machine may be busy with something else: docs/capsule.md quotes it.
//   capsule_bench [cells]
#include "glisson/instruments/capsule.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "glisson/simulation/simulation.h"
#include "instruments/capsule/membrane.h"
#include "support/must_step.h"

namespace glisson {
namespace {

/// Least time of one call [s].
template <class F>
double least_time(int rounds, int calls, F call) {
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r < rounds; ++r) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    least = std::min(least, took.count() / calls);
  }
  return least;
}

void time_sheet(int cells, double stiffening) {
  const TetMesh mesh = box_mesh({.cells = {cells, cells, 1}, .size = {0.03, 0.03, 0.001}});
  std::vector<Triangle> top;
  for (const Triangle& t : boundary_triangles(mesh)) {
    if (mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z > 0.0029) top.push_back(t);
  }
  Membrane membrane(top, mesh.vertices, {800.0, 0.4, stiffening, 1.0});
  membrane.set_masses(std::vector<double>(mesh.vertices.size(), 1e-6));
  std::vector<Vec3d> x = mesh.vertices, f(x.size());
  for (Vec3d& v : x) v = {1.01 * v.x, v.y, v.z + 0.01 * std::sin(200 * v.x) * std::sin(150 * v.y)};
  const double took = least_time(400, 20, [&] { membrane.add_forces(x, f); });
  std::printf("sheet alone, stiffening %g: %zu triangles, %.1f us, %.2f ns a triangle\n", stiffening, membrane.size(),
              1e6 * took, 1e9 * took / static_cast<double>(membrane.size()));
}

void time_body(int cells) {
  const TetMesh mesh = box_mesh({.cells = {cells, cells, 6}, .size = {0.06, 0.06, 0.02}});
  Tissue tissue;
  tissue.youngs_modulus = 5000;
  tissue.poisson_ratio = 0.45;
  SimulationOptions options;
  options.threads = 1;
  options.track_energies = false;
  const auto step_time = [&](bool covered) {
    Simulation s(mesh, {{0, tissue}}, options);
    s.fix(mesh.vertex_sets.at("z_min"));
    std::size_t triangles = 0;
    const double bare = s.step_size();
    std::shared_ptr<Capsule> capsule;
    if (covered) {
      CapsuleOptions o;
      o.youngs_modulus = 1e6;
      o.vertices = mesh.vertex_sets.at("z_max");
      capsule = std::make_shared<Capsule>(o);
      s.attach(capsule);
      triangles = capsule->triangles().size();
    }
    test::must_step(s);
    const double took = least_time(200, 20, [&] { test::must_step(s); });
    if (capsule != nullptr) {
      volatile double sum = 0.0;
      double at = 0.0;
      const double asked = least_time(50, 20, [&] {
        sum = sum + capsule->tension_at({0.03 + (at += 1e-6), 0.03, 0.02});
      });
      std::printf("tension_at: %.1f us\n", 1e6 * asked);
      const double opened = least_time(10, 5, [&] { capsule->open_at({0.03, 0.03, 0.02}, 6e-4); });
      std::printf("open_at: %.1f us\n", 1e6 * opened);
    }
    std::printf("%zu tets, %zu triangles: %.1f us a step, h %.1f us (bare %.1f us)\n", mesh.tets.size(), triangles,
                1e6 * took, 1e6 * s.step_size(), 1e6 * bare);
    return took;
  };
  const double bare = step_time(false), covered = step_time(true);
  std::printf("capsule: %.1f us a step, %.1f ns a triangle\n", 1e6 * (covered - bare),
              1e9 * (covered - bare) / (2.0 * cells * cells));
}

}  // namespace
}  // namespace glisson

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 32;
  glisson::time_sheet(cells, 0.0);
  glisson::time_sheet(cells, 10.0);
  glisson::time_body(cells);
}

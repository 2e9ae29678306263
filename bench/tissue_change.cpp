// tissue_change.cpp — what a change of tissue costs a running body: docs/integrators.md quotes the medians.
//
//   tissue_change_bench
//
// Blocks of 768 and 96 000 tets under way; a slider that moves E to and fro, and a law that comes and goes.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace glisson {
namespace {

constexpr int kTimes = 9;

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

Simulation body_of(int cells, const Tissue& tissue, bool real_time) {
  const TetMesh mesh = box_mesh({.cells = {cells, cells, 2 * cells}, .size = {0.04, 0.04, 0.08}});
  SimulationOptions o;
  o.threads = 1;
  o.exact_steps = !real_time;
  o.track_energies = !real_time;
  Simulation s(mesh, {{0, tissue}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.add_load(mesh.vertex_sets.at("z_max"), {0.05, 0.0, 0.0});
  for (int i = 0; i < 50; ++i) test::must_step(s);
  return s;
}

/// Median of changes there and back [ms], beside that of a step.
void change(const char* what, int cells, const Tissue& a, const Tissue& b, bool real_time) {
  Simulation s = body_of(cells, a, real_time);
  std::vector<double> changes, steps;
  for (int i = 0; i < kTimes; ++i) {
    auto start = std::chrono::steady_clock::now();
    s.set_tissue(0, i % 2 == 0 ? b : a);
    changes.push_back(milliseconds_since(start));
    start = std::chrono::steady_clock::now();
    test::must_step(s);
    steps.push_back(milliseconds_since(start));
  }
  std::printf("%6zu tets, %-22s %-9s %8.3f ms  (a step %7.3f ms)  state %016llx\n", s.mesh().tets.size(), what,
              real_time ? "real time" : "exact", median(changes), median(steps),
              static_cast<unsigned long long>(s.state_hash()));
}

}  // namespace
}  // namespace glisson

int main() {
  using namespace glisson;
  Tissue elastic, stiffer, viscous, more_viscous, law, other_law, relaxing, slower;
  stiffer.youngs_modulus *= 1.3;
  viscous.viscosity = 2.0, more_viscous.viscosity = 3.0;
  law.law = LinearLaw{40000.0}, other_law.law = LinearLaw{50000.0};
  relaxing.kinematics = slower.kinematics = Kinematics::corotational;
  relaxing.maxwell = {{0.3, 0.05}}, slower.maxwell = {{0.3, 0.1}};
  for (const int cells : {4, 20}) {
    for (const bool real_time : {true, false}) {
      change("linear: E", cells, elastic, stiffer, real_time);
      change("linear: eta", cells, viscous, more_viscous, real_time);
      change("law: its slope", cells, law, other_law, real_time);
      change("Maxwell branch: tau", cells, relaxing, slower, real_time);
      change("linear to law", cells, elastic, law, real_time);
    }
  }
  return 0;
}

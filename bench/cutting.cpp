// cutting.cpp — what an advance of a blade costs: docs/cutting.md quotes the median and the longest.
//
//   cutting_bench
//
// An edge wider than a block comes down through it, off the planes of its vertices, a part of an element at a time, with a
// step of the body in between.
#include "glisson/instruments/cutting.h"
#include "support/must_step.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace glisson {
namespace {

double microseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

void print(const char* what, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  if (!times.empty()) std::printf("  %s %zu: %.0f, %.0f", what, times.size(), times[times.size() / 2], times.back());
}

/// @param part  of an element that the edge advances at a time
void cut_block(std::array<int, 3> cells, const Tissue& tissue, double part) {
  const double cell = 0.08 / cells[2], width = cells[0] * cell;
  SimulationOptions options;
  options.threads = 1;
  options.track_energies = false;
  options.mesh_changes = true;
  const TetMesh mesh = box_mesh({cells, {width, cells[1] * cell, 0.08}, {}, BoxSplit::alternating});
  Simulation body(mesh, {{0, tissue}}, options);
  body.fix(mesh.vertex_sets.at("z_min"));
  const auto edge = [&](double z) {
    return BladeEdge{{0.53 * width + 0.1 * z, -0.01, z}, {0.51 * width + 0.1 * z, width + 0.01, z}};
  };
  const double before = body.step_size();
  auto start = std::chrono::steady_clock::now();
  Cutter cutter(body);
  const double made = microseconds_since(start);
  cutter.place(edge(0.081));
  std::vector<double> idle, cutting;
  for (double z = 0.081; z > -0.001; z -= part * cell) {
    test::must_step(body);
    start = std::chrono::steady_clock::now();
    const bool opened = cutter.advance(edge(z)).faces > 0;
    (opened ? cutting : idle).push_back(microseconds_since(start));
  }
  std::printf("%zu tets, %s, %.1f element an advance [µs, median and longest]: made %.0f", mesh.tets.size(),
              tissue.viscosity > 0.0 ? "law, viscous" : "linear", part, made);
  print("opening nothing", idle), print("opening", cutting);
  std::printf("  step %.3g of before\n", body.step_size() / before);
}

}  // namespace
}  // namespace glisson

int main() {
  using namespace glisson;
  Tissue full;
  full.viscosity = 3.0;
  full.law = ExponentialLaw{.amplitude = 800.0, .rate = 5.0};
  for (const double part : {0.1, 1.0}) {
    for (const Tissue& tissue : {Tissue{}, full}) {
      cut_block({12, 12, 12}, tissue, part);
      cut_block({20, 20, 40}, tissue, part);
    }
  }
}

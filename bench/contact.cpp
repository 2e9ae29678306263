// contact.cpp — what a vertex in contact costs: a body stepped with a tool that presses 2 mm into it, and without.
//
// usage: contact_bench [REPEATS]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "glisson/instruments/contact.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace {

using namespace glisson;

struct Down final : ToolDriver {
  double speed;
  explicit Down(double s) : speed(s) {}
  Pose start() const override { return {}; }
  Pose advance(double time, double h, const Wrench&) override {
    return {{0.0, 0.0, -std::min(2e-3, speed * (time + h))}};
  }
};

Simulation slab() {
  const BoxOptions box{.cells = {32, 32, 4}, .size = {0.16, 0.16, 0.02}, .origin = {-0.08, -0.08, -0.02}};
  SimulationOptions o;
  o.threads = 1, o.track_energies = false, o.damping_rate = 50.0;
  Simulation s(box_mesh(box), {{0, Tissue{}}}, o);
  s.fix(s.mesh().vertex_sets.at("z_min"));
  return s;
}

/// Time of a step [ns], the least of some blocks of 100.
double step_time(Simulation& s, int repeats) {
  double best = 1e18;
  for (int k = 0; k < repeats; ++k) {
    const auto from = std::chrono::steady_clock::now();
    for (int i = 0; i < 100; ++i) test::must_step(s);
    best =
        std::min(best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - from).count() / 100);
  }
  return best;
}

void measure(const char* name, const Shape& shape, double friction, int repeats) {
  Simulation alone = slab(), touched = slab();
  ContactOptions o;
  o.shape = shape, o.friction = friction;
  const auto tool = std::make_shared<ContactTool>(o, std::make_shared<Down>(0.01));
  touched.attach(tool);
  for (int i = 0; i < 500; ++i) test::must_step(touched), test::must_step(alone);
  const double without = step_time(alone, repeats), with = step_time(touched, repeats);
  const ContactTool::Effort e = tool->effort();
  const double rows = static_cast<double>(e.vertices + e.triangles);
  std::printf("%-24s rows %5.0f  sweeps %2d  step %7.1f us, without %7.1f us  %6.0f ns a row\n", name, rows, e.sweeps,
              with * 1e-3, without * 1e-3, (with - without) / rows);
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 10;
  measure("plate, no friction", Plate{}, 0.0, repeats);
  measure("plate, mu 0.3", Plate{}, 0.3, repeats);
  measure("ball of 0.5 m, mu 0.3", Ball{.radius = 0.5}, 0.3, repeats);
  measure("punch of 40 mm, mu 0.3", FlatPunch{.radius = 0.04}, 0.3, repeats);
  measure("ball of 3 mm, mu 0.3", Ball{.radius = 3e-3}, 0.3, repeats);
}

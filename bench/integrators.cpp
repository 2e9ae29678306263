// integrators.cpp — what a simulated second of elastic tissue costs with each integrator, at equal error: the table of
// docs/integrators.md. Of viscous tissue scripts/viscosity_cures does.
//
//   integrators [cells across …]        4 9 16 by default: 768, 8748 and 49152 tets
//
// The paper's block is pressed from above at 10 mm/s for 0.1 s, its start rounded over 20 ms. The reference is the explicit scheme
// at a quarter of its step. Each integrator takes the longest step of a list with which the plate's
// force stays within 1 % of the reference's largest; time is that of one thread's processor.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "glisson/instruments/motion.h"
#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace {

using namespace glisson;

constexpr double kEnd = 0.1, kLargestError = 0.01;

/// Force of the plate against time.
struct Curve {
  std::vector<double> time{0.0}, force{0.0};
  double step = 0.0, cost = 0.0;  ///< [s], processor seconds a simulated second
  bool made = true;

  double at(double t) const {
    std::size_t i = 1;
    while (i + 1 < time.size() && time[i] < t) ++i;
    return force[i - 1] + (force[i] - force[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
  }
};

Curve run(const TetMesh& mesh, Integrator integrator, TimeScheme scheme, std::optional<double> step) {
  SimulationOptions o;
  o.integrator = integrator;
  o.implicit.scheme = scheme;
  o.implicit.tolerance = 1e-5;
  o.step = step;
  o.damping_rate = 20.0;
  o.threads = 1;
  o.track_energies = false;
  Simulation s(mesh, {{0, Tissue{}}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  const ConstraintId plate =
      s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.01, .depth = 1.0, .ramp = 0.02}));
  Curve curve;
  curve.step = s.step_size();
  test::must_step(s);  // what is built at the first step is not counted
  const std::clock_t begin = std::clock();
  const double from = s.time();
  while (s.time() < kEnd - 1e-9 && curve.made) {
    curve.made = s.step().status <= StepStatus::inverted;
    curve.time.push_back(s.force_time());
    curve.force.push_back(-s.force(plate).total().z);
  }
  curve.cost = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / (s.time() - from);
  return curve;
}

/// Largest difference from the reference after the start, over its largest force.
double error(const Curve& curve, const Curve& reference) {
  double worst = 0.0, size = 0.0;
  for (int k = 1; k <= 40; ++k) {
    const double t = 0.02 + (0.095 - 0.02) * k / 40.0;
    worst = std::max(worst, std::abs(curve.at(t) - reference.at(t)));
    size = std::max(size, std::abs(reference.at(t)));
  }
  return worst / size;
}

void show(const char* name, const Curve& curve, double difference) {
  std::printf("| %-26s | %8.3g | %7.3f | %9.3g |\n", name, 1e3 * curve.step, 100.0 * difference, curve.cost);
  std::fflush(stdout);
}

void compare(int cells) {
  const TetMesh mesh = box_mesh({.cells = {cells, cells, 2 * cells}, .size = {0.04, 0.04, 0.08}});
  std::printf("\n%zu tets\n\n| integrator | step [ms] | error [%%] | s a simulated second |\n|---|---|---|---|\n",
              mesh.tets.size());
  const auto scheme = TimeScheme::backward_euler;
  const Curve automatic = run(mesh, Integrator::central_difference, scheme, {});
  const Curve reference = run(mesh, Integrator::central_difference, scheme, 0.25 * automatic.step);
  show("explicit", automatic, error(automatic, reference));
  struct Way {
    const char* name;
    TimeScheme scheme;
  };
  const double shortest = cells > 10 ? 0.002 : 0.0002;  // shorter ones of a large body would take minutes
  for (const Way& way : {Way{"implicit, backward_euler", scheme}, Way{"implicit, newmark", TimeScheme::newmark}}) {
    bool found = false;
    for (const double step : {0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002}) {
      if (found || step < shortest) continue;
      const Curve curve = run(mesh, Integrator::implicit, way.scheme, step);
      if (!curve.made || error(curve, reference) > kLargestError) continue;
      show(way.name, curve, error(curve, reference));
      found = true;
    }
    if (!found) std::printf("| %-26s | none of the list | | |\n", way.name);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> cells{4, 9, 16};
  if (argc > 1) cells.clear();
  for (int i = 1; i < argc; ++i) cells.push_back(std::atoi(argv[i]));
  for (const int n : cells) {
    if (n < 1 || n > 100) {
      std::fprintf(stderr, "integrators: cells across = %d is outside the allowed range, 1 to 100\n", n);
      return 1;
    }
    compare(n);
  }
  return 0;
}

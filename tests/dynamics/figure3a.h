// figure3a.h — the paper's viscous press, as a curve that integrators are held against.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "dynamics/viscous_case.h"
#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson::test {

/// Forces of figure 3a at 10 mm/s, η = 1000 Pa·s, and the processor time they took. The tool gets up to speed within 2 ms.
struct PressRun {
  std::vector<double> forces;                    ///< every 5 ms until 10 mm [N]
  std::vector<double> start_time, start_forces;  ///< of each step of the first 5 ms [s], [N]
  double seconds = 0.0;
};

inline PressRun figure3a(SimulationOptions o) {
  o.damping_rate = 20.0;
  o.threads = 1;
  const TetMesh mesh = paper_mesh();
  Simulation s(mesh, {{0, viscous(1000.0)}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  const ConstraintId tool = s.drive(paper_triangle(), press({.velocity = 0.01, .depth = 0.0105, .ramp = 0.002}));
  PressRun run;
  const std::clock_t start = std::clock();
  double before = 0.0, at = 0.0;
  while (run.forces.size() < 200) {
    EXPECT_EQ(s.step().status, StepStatus::ok);
    const double now = -s.force(tool).total().z, time = 0.005 * static_cast<double>(run.forces.size() + 1);
    if (run.forces.empty()) run.start_time.push_back(s.force_time()), run.start_forces.push_back(now);
    if (s.force_time() >= time) {
      run.forces.push_back(before + (now - before) * (time - at) / (s.force_time() - at));
    }
    before = now, at = s.force_time();
  }
  run.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return run;
}

/// How far a run's forces are from those of a reference, over the peak of these.
inline double apart(const PressRun& run, const PressRun& reference) {
  double most = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < reference.forces.size(); ++i) {
    most = std::max(most, std::abs(run.forces[i] - reference.forces[i]));
    peak = std::max(peak, reference.forces[i]);
  }
  return most / peak;
}

/// The same in the first 5 ms, at the run's own steps: the reference's are many times as short, and linear between.
inline double apart_at_the_start(const PressRun& run, const PressRun& reference) {
  const std::vector<double>&t = reference.start_time, &f = reference.start_forces;
  double most = 0.0;
  for (std::size_t i = 0; i < run.start_time.size() && run.start_time[i] <= t.back(); ++i) {
    const auto next = std::max<std::ptrdiff_t>(1, std::ranges::lower_bound(t, run.start_time[i]) - t.begin());
    const auto k = static_cast<std::size_t>(next);
    const double there = f[k - 1] + (f[k] - f[k - 1]) * (run.start_time[i] - t[k - 1]) / (t[k] - t[k - 1]);
    most = std::max(most, std::abs(run.start_forces[i] - there));
  }
  return most / *std::ranges::max_element(reference.forces);
}

}  // namespace glisson::test

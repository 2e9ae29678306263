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

/// Forces of figure 3a at 10 mm/s, η = 1000 Pa·s, every 5 ms until 10 mm, and the processor time they took.
struct PressRun {
  std::vector<double> forces;  ///< [N]
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

}  // namespace glisson::test

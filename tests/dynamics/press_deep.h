// press_deep.h — the paper's block pressed to 40 % of its height, which no scheme may answer by blowing up.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson::test {

/// Presses the paper's block at 0.1 m/s: the energy in it never exceeds what the plate has put in, and the books are closed.
inline void press_deep(const Tissue& tissue, const SimulationOptions& options) {
  const TetMesh mesh = paper_mesh();
  Simulation s(mesh, {{0, tissue}}, options);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.1, .depth = 0.048, .hold = 0.1}));
  while (s.time() < 0.55) {
    ASSERT_LE(s.step().status, StepStatus::inverted) << s.time();
    ASSERT_LE(s.energies().kinetic, 1e-3 + std::abs(s.energies().work_tools)) << s.time();
  }
  for (const Vec3d& u : s.displacement()) EXPECT_LT(norm(u), 0.1);
  EXPECT_LE(std::abs(s.energies().imbalance()), 1e-7 * s.energies().work_tools);
}

}  // namespace glisson::test

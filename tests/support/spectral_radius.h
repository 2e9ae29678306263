// spectral_radius.h — how a step of a small body magnifies its state: the true limit of a step, from the step itself.
#pragma once

#include <Eigen/Eigenvalues>
#include <vector>

#include "glisson/simulation/simulation.h"
#include "support/must_step.h"

namespace glisson::test {

/// Largest |z| of the map (u, v₋) → (u⁺, v₊) of a free linear body, in double, at `factor` × h*.
inline double spectral_radius(const TetMesh& mesh, const Tissue& tissue, SimulationOptions o, double factor) {
  o.precision = Precision::double_precision;
  o.step = factor * Simulation(mesh, {{0, tissue}}, o).stable_step();
  o.enforce_stability = false;
  Simulation s(mesh, {{0, tissue}}, o);
  const std::size_t n = mesh.vertices.size();
  const auto size = static_cast<Eigen::Index>(6 * n);
  Eigen::MatrixXd map(size, size);
  for (std::size_t c = 0; c < 6 * n; ++c) {
    std::vector<Vec3d> state[2]{std::vector<Vec3d>(n), std::vector<Vec3d>(n)};
    state[c / (3 * n)][c % (3 * n) / 3][c % 3] = c < 3 * n ? 1.0 : 1.0 / *o.step;  // v in units of u/h
    s.set_state(state[0], state[1]);
    must_step(s);
    for (std::size_t i = 0; i < 3 * n; ++i) {
      map(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = s.displacement()[i / 3][i % 3];
      map(static_cast<Eigen::Index>(3 * n + i), static_cast<Eigen::Index>(c)) = s.velocity()[i / 3][i % 3] * *o.step;
    }
  }
  return Eigen::EigenSolver<Eigen::MatrixXd>(map, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace glisson::test

// columns.h — the first mode of a column that cannot bulge: what several integrators are tested on.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

#include "material/reference/reference.h"
#include "support/column.h"

namespace glisson::test {

/// The first mode of a column's mesh, as a dense eigenvalue solver finds it: M φ ω² = K φ along z, φ_max = 1.
struct ColumnMode {
  double frequency = 0.0;  ///< ω [rad/s]
  std::vector<Vec3d> shape;

  explicit ColumnMode(const Column& column) : shape(column.mesh.vertices.size()) {
    const Eigen::SparseMatrix<double> K = reference::stiffness_matrix(column.mesh, {{0, Tissue{}}});
    std::vector<std::uint32_t> free;
    for (std::uint32_t i = 0; i < shape.size(); ++i) {
      if (column.mesh.vertices[i].z > 1e-9) free.push_back(i);
    }
    const auto n = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd scaled(n, n);
    const std::span<const double> m = column.simulation.masses();
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < n; ++b) {
        const std::uint32_t i = free[static_cast<std::size_t>(a)], j = free[static_cast<std::size_t>(b)];
        scaled(a, b) = K.coeff(3 * i + 2, 3 * j + 2) / std::sqrt(m[i] * m[j]);
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
    frequency = std::sqrt(solver.eigenvalues()[0]);
    double largest = 0.0;
    for (Eigen::Index a = 0; a < n; ++a) {
      const std::uint32_t i = free[static_cast<std::size_t>(a)];
      shape[i].z = solver.eigenvectors()(a, 0) / std::sqrt(m[i]);
      largest = std::max(largest, std::abs(shape[i].z));
    }
    for (Vec3d& u : shape) u.z /= largest;
  }
};

}  // namespace glisson::test

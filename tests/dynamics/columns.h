// columns.h — a column that cannot bulge, which is one-dimensional: what several integrators are tested on.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

#include "glisson/simulation.h"
#include "mechanics/reference.h"
#include "support/bodies.h"

namespace glisson::test {

/// A column of square section, free to move along z only, held at z = 0.
struct Column {
  double length, width;
  TetMesh mesh;
  Simulation simulation;
  VertexSet top;

  Column(const Tissue& tissue, double L, int cells, int cells_across, const SimulationOptions& options)
      : length(L), width(L / cells * cells_across),
        mesh(box_mesh({.cells = {cells_across, cells_across, cells}, .size = {width, width, L}})),
        simulation(mesh, {{0, tissue}}, options), top(mesh.vertex_sets.at("z_max")) {
    simulation.fix(all_vertices(mesh), {true, true, false});
    simulation.fix(mesh.vertex_sets.at("z_min"), {false, false, true});
  }

  double area() const { return width * width; }

  /// A uniform pressure on the top, by each triangle's third to its vertices [Pa].
  void add_pressure(double pressure) {
    for (const Triangle& t : boundary_triangles(mesh)) {
      const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      if (std::min({a.z, b.z, c.z}) < length - 1e-9) continue;
      simulation.add_load(t, {0.0, 0.0, -pressure * 0.5 * norm(cross(b - a, c - a))});
    }
  }

  /// Mean over the top: its corners carry different shares of mass.
  double top_displacement() const {
    double sum = 0.0;
    for (const std::uint32_t v : top) sum += simulation.displacement()[v].z;
    return sum / static_cast<double>(top.size());
  }
};

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

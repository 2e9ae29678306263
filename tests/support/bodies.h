// bodies.h — the bodies that several tests press, shake or load.
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "glisson/mesh.h"
#include "glisson/simulation/simulation.h"

namespace glisson::test {

using VertexSet = std::vector<std::uint32_t>;

/// The paper's figure 1: 4 × 4 × 8 cubes of 1 cm.
inline TetMesh paper_mesh() { return box_mesh({}); }

/// Triangle of the top face with top-grid vertices (2,2), (1,2), (2,1).
inline VertexSet paper_triangle() { return {200 + 12, 200 + 11, 200 + 7}; }

inline SimulationOptions in_double() {
  SimulationOptions options;
  options.precision = Precision::double_precision;
  return options;
}

inline VertexSet all_vertices(const TetMesh& mesh) {
  VertexSet all(mesh.vertices.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

/// A box whose inner vertices are moved at random by up to `amount` of a cell, so that no two tets are alike.
inline TetMesh jittered_box(std::array<int, 3> cells, double cell, double amount, std::mt19937& random,
                            BoxSplit split = BoxSplit::kuhn) {
  TetMesh mesh =
      box_mesh({.cells = cells, .size = {cells[0] * cell, cells[1] * cell, cells[2] * cell}, .split = split});
  std::uniform_real_distribution<double> shift(-amount * cell, amount * cell);
  for (Vec3d& x : mesh.vertices) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double edge = cells[a] * cell, margin = 1e-9 * edge;
      if (x[a] > margin && x[a] < edge - margin) x[a] += shift(random);
    }
  }
  return mesh;
}

/// Numbers in [−amount, amount] for every component of every vertex.
inline std::vector<Vec3d> random_field(std::size_t n, double amount, std::mt19937& random) {
  std::uniform_real_distribution<double> value(-amount, amount);
  std::vector<Vec3d> field(n);
  for (Vec3d& v : field) v = {value(random), value(random), value(random)};
  return field;
}

/// Largest ‖a − b‖ over largest ‖b‖.
inline double relative_difference(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, norm(a[i] - b[i]));
    size = std::max(size, norm(b[i]));
  }
  return size > 0.0 ? difference / size : difference;
}

}  // namespace glisson::test

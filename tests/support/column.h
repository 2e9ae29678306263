// column.h — a column that cannot bulge, which is one-dimensional: what schemes are held against closed forms on.
#pragma once

#include "glisson/simulation/simulation.h"
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

}  // namespace glisson::test

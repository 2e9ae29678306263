// boundary.h — which components of which vertices an experiment prescribes, and the force that it takes to hold them.
#pragma once

#include <vector>

#include "compare/models/rival.h"

namespace glisson::models {

/// The displacement of a vertex of a tool at a time [m].
Vec3d tool_displacement(const Tool& tool, const Vec3d& rest, double time);

class Boundary {
 public:
  explicit Boundary(const Problem& problem);

  bool prescribes(std::size_t vertex, std::size_t axis) const { return prescribed_[3 * vertex + axis]; }
  /// Writes the prescribed components at a time into the displacements of all vertices.
  void set(double time, std::vector<Vec3d>& displacement) const;
  /// What the first tool, or without tools the first support, exerts where the body's own forces, weight among them, are these: its
  /// force [N], or its moment about Problem::moment_about [N m].
  Vec3d force(const std::vector<Vec3d>& own, const std::vector<Vec3d>& displacement) const;

 private:
  const Problem& problem_;
  std::vector<bool> prescribed_;
};

double youngs_modulus(const LameParameters& lame);  ///< [Pa]

/// A quarter of each tet's mass at each of its vertices [kg].
std::vector<double> lumped_masses(const Problem& problem);

/// A tet at rest: H = Σ u_a ⊗ s_a.
struct RestTet {
  std::array<Vec3d, 4> s;  ///< gradients of the shape functions [1/m]
  double volume = 0.0;     ///< [m³]
};
RestTet rest_tet(const TetMesh& mesh, std::size_t tet);
/// I + H.
Mat3d deformation_gradient(const RestTet& rest, const Tet& tet, const std::vector<Vec3d>& displacement);

/// The edges of all tets, each once, the lower vertex first.
std::vector<std::array<std::uint32_t, 2>> mesh_edges(const TetMesh& mesh);

}  // namespace glisson::models

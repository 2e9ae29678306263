// reference.h — the executable specification: the paper's equations with explicit tensors, in double.
//
// Slow on purpose and written to be read beside the paper; everything fast is tested against it. It shares
// no code with the production operator: the shape gradients, the measure and the moduli are formed anew.
//
//   A_jk = V s_j ⊗ s_k                                    (the λ part)
//   B_jk = V [ s_k ⊗ s_j + (s_j·s_k) I ]                  (the μ part)
//   K_jk = λ A_jk + μ B_jk                                [Schwartz2002, eq. 5]
//   F_j  = −Σ_k K_jk u_k                                  [Schwartz2002, eq. 1]
//   F_j  = −Σ_k (K_jk + δλ A_jk + δμ B_jk) u_k            [Schwartz2002, eq. 6]
//   F_j⁽ᵛ⁾ = −Σ_k K_jk⁽ᵛ⁾ du_k/dt                         [Schwartz2002, eq. 7]
//
// Sign: the paper leaves it to the definition of K; here K is positive semi-definite and the force restores.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <map>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/mesh.h"

namespace glisson::reference {

using Tensor = Eigen::Matrix3d;
/// The sixteen tensors of a tetrahedron, [j][k].
using ElementTensors = std::array<std::array<Tensor, 4>, 4>;
using Corners = std::array<Eigen::Vector3d, 4>;

/// Shape gradients s_0 … s_3 [1/m] and volume [m³] of a tetrahedron.
struct Gradients {
  Corners s;
  double volume;
};
Gradients gradients(const Corners& rest);

ElementTensors tensors_A(const Gradients& g);  ///< [m]
ElementTensors tensors_B(const Gradients& g);  ///< [m]

/// λ A + μ B [N/m], [Schwartz2002, eq. 5].
ElementTensors stiffness_tensors(const Gradients& g, LameParameters lame);
/// K⁽ᵛ⁾ [N·s/m] for the tissue's choice of viscous tensor, [Schwartz2002, eq. 7].
ElementTensors viscous_tensors(const Gradients& g, const Tissue& tissue);

/// The tissue's measure of the deformed tetrahedron, from positions by its textbook formula.
double measure(const Tissue& tissue, const Corners& rest, const Corners& displacement);

/// −Σ_k K_jk u_k for the four vertices.
Corners force_of(const ElementTensors& K, const Corners& u);

/// Elastic force with the law, [Schwartz2002, eq. 6] [N].
Corners elastic_force(const Tissue& tissue, const Corners& rest, const Corners& u);
/// Viscous force, [Schwartz2002, eq. 7] [N].
Corners viscous_force(const Tissue& tissue, const Corners& rest, const Corners& velocity);

/// Forces of a whole mesh, summed per vertex [N].
struct MeshForces {
  std::vector<Vec3d> elastic, viscous;
};
MeshForces mesh_forces(const TetMesh& mesh, const std::map<int, Tissue>& tissues, std::span<const Vec3d> u,
                       std::span<const Vec3d> velocity);

/// The linear tissue by assembled vertex and edge tensors K_ii and K_ij [N/m], [Schwartz2002, eq. 2].
struct EdgeTensors {
  std::vector<Tensor> vertex;                                      ///< K_ii
  std::map<std::pair<std::uint32_t, std::uint32_t>, Tensor> edge;  ///< K_ij, both (i,j) and (j,i)
};
EdgeTensors assemble_edges(const TetMesh& mesh, const std::map<int, Tissue>& tissues);
std::vector<Vec3d> edge_forces(const EdgeTensors& K, std::span<const Vec3d> u);

/// The 3n × 3n matrix of the linear tissue at rest [N/m]; row and column 3 i + component.
Eigen::SparseMatrix<double> stiffness_matrix(const TetMesh& mesh, const std::map<int, Tissue>& tissues);

}  // namespace glisson::reference

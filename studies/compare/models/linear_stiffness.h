// linear_stiffness.h — the sparse matrix of linear elasticity, for the models that solve with it.
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "compare/models/boundary.h"

namespace glisson::models {

using Sparse = Eigen::SparseMatrix<double>;

/// K_ab = V (λ s_a s_bᵀ + μ s_b s_aᵀ + μ (s_a·s_b) I) of the tets that are taken, rows 3 v + axis.
Sparse stiffness_matrix(const Problem& problem, const std::function<bool(std::size_t tet)>& takes);

/// The matrix with rows and columns of prescribed components replaced by those of the identity.
Sparse of_free_components(const Sparse& matrix, const Boundary& boundary);
/// Sets the prescribed components to 0.
void clear_prescribed(Eigen::VectorXd& components, const Boundary& boundary);

/// The weight of all vertices at a time, components in the order of flat() [N].
Eigen::VectorXd weight(const Problem& problem, const std::vector<double>& masses, double time);

/// The components of all vertices, 3 v + axis.
Eigen::VectorXd flat(const std::vector<Vec3d>& vectors);
/// The same back.
std::vector<Vec3d> vectors_of(const Eigen::VectorXd& flat);

}  // namespace glisson::models

// branch_memory.h — what the Maxwell branches of a tissue block hold of their past, whichever operator keeps it.
//
//   σ_k = g_k (S − q_k) = g_k (left_k S − held_k)        q_k = held_k + (1 − left_k) S, S of the present deformation
//
// So the stress of a branch follows from the present S and from numbers that no step is needed for. Where the times of
// branches follow the deformation, `left` is a tet's own, as `held` always is.
#pragma once

#include <vector>

#include "glisson/material/tissue.h"
#include "material/strain.h"

namespace glisson {

/// Empty: all branches have relaxed, or there are none.
struct BranchMemory {
  std::size_t branches = 0;        ///< n of the tissue; 0: empty
  std::vector<Sym3<double>> held;  ///< of branch k of n of the block's element i at n i + k [Pa]
  std::vector<double> left;        ///< likewise [-]
  /// Of the block's elements: the share that a linear law without branches has in the forces (Precision::adaptive); empty: none.
  std::vector<double> linear;

  bool empty() const { return branches == 0; }
  double linear_share(std::size_t i) const { return linear.empty() ? 0.0 : linear[i]; }
  /// σ_k of an element, counted from the block's first [Pa].
  Sym3<double> stress(const MaxwellBranch& branch, std::size_t i, std::size_t k, const Sym3<double>& S) const {
    return (S * left[i * branches + k] - held[i * branches + k]) * branch.share;
  }
};

}  // namespace glisson

// relaxation.h — what models without viscosity are given of a tissue that has it.
//
// A tissue with Maxwell branches has no stiffness but at a time. Over a ramp of a time T the stress of linear tissue is the strain times
// the mean of the moduli over T, so this mean is what a test that lasts T finds:
//
//   μ(T) = 1/T ∫₀ᵀ μ(t) dt = μ₀ [1 − Σ g (1 − τ/T (1 − e^(−T/τ)))]
//
// T is the time of the experiment, of several experiments with one tissue that of the middle one (Problem::test_time): a model cannot
// be another at each speed.
#pragma once

#include "compare/models/rival.h"

namespace glisson::models {

/// Whether a tissue's stress depends on more than its present strain.
bool is_viscous(const Tissue& tissue);
bool is_viscous(const Problem& problem);

/// Share of the instantaneous modulus that is left, of its mean over `time` [s]; 1 without branches or time. A branch whose time follows the
/// deformation counts with its own time.
double mean_share(const Tissue& tissue, double time);

/// Moduli at rest that a test of Problem::test_time finds [Pa].
LameParameters test_moduli(const Problem& problem, const Tissue& tissue);

}  // namespace glisson::models

// stable_step.h — h*, the largest step for which the paper's scheme is stable.
//
// The scheme [Schwartz2002, eq. 4] with nodal damping G, viscous matrix C (its force lagging by half a step)
// and stiffness K reads
//   (M + hG) u⁺ − (2M + hG − h²K − hC) u + (M − hC) u⁻ = 0.
// A solution z^n x satisfies the scalar quadratic whose coefficients are the Rayleigh quotients of x, and by
// the Jury conditions |z| ≤ 1 for all of them exactly when
//   φ(h) = λ_max( M^(−½) [ h²K + 2h (C − G) ] M^(−½) ) ≤ 4.
// φ is convex with φ(0) = 0, so h* is the one positive root of φ = 4. For modes it is
//   h* = [ (g − c) + √((g − c)² + 4 k m) ] / k.
// No simultaneous diagonalisation is assumed: K, C and G may differ in shape.
//
// The semi-implicit scheme takes the viscous force of a matrix C₀ at v⁺ and what C differs from it at v⁻: M + hC₀ takes the
// place of M. With C ≤ w C₀ that is C replaced by (w − 2) C₀ above, −C₀ for the tissue's own matrix (w = 1).
//
// λ_max comes from Lanczos with its residual norm added, which bounds it from above unless the random start
// is orthogonal to the answer [ZhouLi2011]; where Lanczos does not converge, from the rigorous element bound. Small
// bodies have their whole matrix decomposed.
#pragma once

#include <span>
#include <vector>

#include "element/body.h"

namespace glisson {

struct StableStep {
  double step = 0.0;           ///< h* [s], from below
  bool from_elements = false;  ///< Lanczos did not converge; the element bound was taken
};

/// Where a search for h* begins; filled with where it ended, for the next one.
struct StabilityGuess {
  double step = 0.0;         ///< [s]; 0: none
  std::vector<double> mode;  ///< the worst mode, 3 per vertex, scaled by √m; empty: none
};

/// @param stiffening  per tissue block: bound of tangent over rest stiffness [-], ≥ 0
/// @param viscosity  per tissue block: factor on C, 1 for the explicit scheme [-]; empty: 1 for all
/// @param nodal_damping  γ_i per vertex [kg/s]
/// @param held  per vertex component (3 i + axis): 1 where a constraint holds it; empty: free body, which is
///              safe for any constraints
/// @param guess  may be null; speeds up a search after a small change of stiffness
/// Cost: some hundred passes over the elements, some tens from a good guess.
StableStep stable_step(const Body& body, std::span<const double> stiffening, std::span<const double> nodal_damping,
                       std::span<const char> held = {}, StabilityGuess* guess = nullptr,
                       std::span<const double> viscosity = {});

/// Rigorous lower bound of h* from the single elements, damping left out, and negative factors of viscosity [s].
double element_bound_step(const Body& body, std::span<const double> stiffening, std::span<const double> viscosity = {});

/// What an element's mass is to be multiplied with to have the bound `step` at rest stiffness; below 1 where it has more.
double mass_factor_for(const Body& body, const TissueBlock& block, std::size_t element, double step, double viscosity);

/// Bound of λ tr(ε)² + 2 μ ε:ε over ‖ε‖².
double modulus_bound(LameParameters lame);
/// h* of a mode of unit mass: the root of k h² + 2 c h = 4 [s]; infinite where there is none.
/// @param k  [1/s²], @param c  [1/s]
double damped_step(double k, double c);

/// The same for one element.
double element_step(const Body& body, const TissueBlock& block, std::size_t element, double stiffening,
                    double viscosity);

}  // namespace glisson

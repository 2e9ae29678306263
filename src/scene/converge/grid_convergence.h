// grid_convergence.h — what finer and finer meshes say of the result on none of them.
//
//   f(h) ≈ f₀ + C h^p        three meshes give f₀ and p [Roache1994], also where their sizes do not grow by one factor
//                            [Celik2008]; two give f₀ with p = 1 assumed
//   |f₀ − f₁| ≤ F |f₁ − f₂| / (r^p − 1)      F = 1.25 where p was observed and is believable, else 3 [Roache1994]
#pragma once

#include <span>
#include <string>

namespace glisson {

/// A result and the size of the cells it was computed with.
struct MeshResult {
  double h = 0.0;  ///< [m], > 0
  double value = 0.0;
};

struct GridConvergence {
  enum class Verdict {
    converging,     ///< by an order that linear elements can have, 0.5 … 2.5
    independent,    ///< differences below a millionth: the mesh does not matter
    two_meshes,     ///< the order is assumed
    unusual_order,  ///< observed, but outside of 0.5 … 2.5: nothing is extrapolated
    not_monotone    ///< up and down, or by more with every refinement: nothing is extrapolated
  };
  Verdict verdict = Verdict::converging;
  double order = 1.0;         ///< p that the extrapolation uses
  double seen_order = 0.0;    ///< p of the three finest meshes; 0: none
  double extrapolated = 0.0;  ///< f₀; where nothing is extrapolated the value of the finest mesh
  /// The finest mesh's value ± its uncertainty, between which f₀ is expected; where nothing is extrapolated ± three times the
  /// largest of the last two differences.
  double low = 0.0, high = 0.0;

  bool extrapolates() const { return verdict != Verdict::unusual_order && verdict != Verdict::not_monotone; }
  /// (f − f₀)/|f₀| of a result; 0 where f₀ is.
  double error_of(double value) const;
};

/// @param results  of one quantity, from the coarsest mesh to the finest; two or more, of which the last three count
/// @throws std::invalid_argument for fewer, or sizes that do not fall
GridConvergence grid_convergence(std::span<const MeshResult> results);

/// What the verdict means, in a sentence; empty where it converges as it should.
std::string verdict_text(const GridConvergence& found);

}  // namespace glisson

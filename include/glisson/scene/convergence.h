// convergence.h — what finer and finer meshes say of the result on none of them.
//
//   f(h) ≈ f₀ + C h^p        three meshes give the observed order p [Roache1994], also where their sizes do not fall by one factor
//                            [Celik2008]; two give none, and p = 1 is assumed
//
// An observed order is believed up to that which the geometry allows, P ≤ 2 (convergence_order.h): on coarse meshes errors of higher order
// hide the singular ones, which remain. With the step to the limit s(p) = (f₁ − f₂)/(r^p − 1), r = h₂/h₁, f₁ of the finest mesh,
//
//   f₀ = f₁ + s(min(p, P))        within  f₁ + s(max(min(p, 2), P))/F  and  f₁ + F s(min(p, P)),  F = 1.5
//
// Below p = ½ the meshes are so coarse, or their tets lock so much, that no power describes them: the next changes will be the
// larger, the smaller p is. How the limits were chosen, and how often they hold: docs/convergence.md.
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
    converging,   ///< from one side, by an observed order of ½ or more
    independent,  ///< differences below a millionth: the mesh does not matter
    two_meshes,   ///< the order is assumed
    alternating,  ///< up and down by ever less, half or less of the change before: the finest value is taken
    slow,         ///< by an observed order of 0 to ½, as where tets lock: the extrapolation is rough
    not_monotone  ///< up and down, or by more with every refinement: nothing is extrapolated
  };
  Verdict verdict = Verdict::converging;
  double order = 1.0;            ///< p that the extrapolation uses, at most the largest; 0: none
  double seen_order = 0.0;       ///< p of the three finest meshes, of any size; 0: none
  double largest = 2.0;          ///< P, which the geometry allows
  double extrapolated = 0.0;     ///< f₀; where nothing is extrapolated the value of the finest mesh
  double low = 0.0, high = 0.0;  ///< f₀ is expected between them

  bool extrapolates() const { return verdict != Verdict::not_monotone; }
  /// (f − f₀)/|f₀| of a result; 0 where f₀ is.
  double error_of(double value) const;
};

/// @param results  of one quantity, from the coarsest mesh to the finest; two or more, of which the last three count
/// @param largest_order  P of the body's edges, in [1, 2] (convergence_order.h)
/// @throws std::invalid_argument for fewer, sizes that do not fall, or another order
GridConvergence grid_convergence(std::span<const MeshResult> results, double largest_order = 2.0);

/// What the verdict means, in a sentence; empty where it converges as it should.
std::string verdict_text(const GridConvergence& found);

}  // namespace glisson

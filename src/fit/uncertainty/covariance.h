// covariance.h — how sure a fit is, from the curvature of its cost at the optimum.
//
// Nothing is inverted that the curves do not determine: J is split into directions of z (singular vectors), weakest first,
// and a direction without weight is reported, not divided by. What the noise is decides the rest:
//
//   given            C = max(1, χ²/(N − p)) (JᵀJ)⁻¹                     each value has the deviation that whoever measured says
//   independent      C = σ² (JᵀJ)⁻¹                                     residuals look like white noise
//   autocorrelated   C = σ² (JᵀJ)⁻¹ JᵀVJ (JᵀJ)⁻¹                        they swing (residual_correlation.h)
//   by_curve         C = (JᵀJ)⁻¹ (Σ_c u_c u_cᵀ) (JᵀJ)⁻¹ (G − 1) / G     G specimens, which differ from one another
//                    of several kinds of test: the sum over kinds of Σ_c (u_c − ū)(u_c − ū)ᵀ G/(G − 1) in its place
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/search/problem.h"
#include "glisson/fit.h"

namespace glisson::fit {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kTakesPart = 1e-3;  ///< of a unit vector: below it a parameter is no part of a direction

enum class Hold { free, at_low, at_high };
enum class NoiseKind { independent, autocorrelated, by_curve, given };
const char* name_of(NoiseKind kind);

/// A combination of the parameters that the curves see as one, Σ vector_p z_p.
struct Direction {
  std::vector<double> vector;  ///< of unit length, in z; 0 for held parameters
  double singular = 0.0;       ///< ‖J vector‖
  bool determined = true;      ///< false: the curves do not see it at all
  double sd = 0.0;             ///< in z; infinite where it is not determined
};

struct NoiseEstimate {
  NoiseKind kind = NoiseKind::independent;
  std::string why;                         ///< a sentence: which of them is used, on what evidence
  double variance = 0.0;                   ///< σ² of the scaled residuals
  double rms = 0.0;                        ///< of the scaled residuals
  std::size_t samples = 0;                 ///< residuals with weight
  double effective = 0.0;                  ///< Σ_c n_c / τ_c, τ_c samples of a curve counting as one
  std::vector<double> effective_by_curve;  ///< n_c / τ_c; 0 for curves without weight
  double independence = 1.0;               ///< probability of such autocorrelations from independent samples
};

struct Covariance {
  std::string failure;  ///< why there is none (a forward run failed); empty: there is
  std::vector<double> scaled;
  std::vector<Hold> hold;        ///< parameters at a bound are held there and left out
  std::vector<char> determined;  ///< 0: held, or part of a direction that the curves do not see
  NoiseEstimate noise;
  double level = 0.95;
  double freedom = 0.0;               ///< degrees of freedom of Student's t
  double quantile = 0.0;              ///< of Student's t, two-sided
  std::vector<double> sd;             ///< in z; infinite where not determined, NaN where held
  std::vector<Interval> interval;     ///< own units; open at bounds
  std::vector<double> matrix;         ///< C, row-major, in z; of the determined directions only
  std::vector<double> correlation;    ///< row-major; ± 1 within directions that are not determined
  std::vector<double> information;    ///< JᵀJ, row-major, in z
  std::vector<double> inflation;      ///< C_pp over that of independent noise
  std::vector<Direction> directions;  ///< of the free parameters, weakest first
  double cost_unit = 0.0;             ///< 2 Δcost / cost_unit is χ² of one degree of freedom, for independent noise

  std::size_t parameters() const { return scaled.size(); }
  /// Variance of Σ weights_p z_p, of the determined directions.
  double variance_of(std::span<const double> weights) const;
};

struct CovarianceOptions {
  double level = 0.95;
  double rank_tolerance =
      1e-5;  ///< a direction below it, over the strongest, is not determined: differences see no less
  double bound_tolerance = 1e-6;        ///< in z
  double significance = 0.05;           ///< of the test of independence, which is told [LjungBox1978]
  std::optional<NoiseKind> force = {};  ///< instead of the tests; by_curve falls back where there are too few curves
};

/// Covariance, intervals by Student's t and correlations at an optimum.
///
///   z_p ± t √C_pp, mapped to the parameter's unit (on a logarithmic scale the interval is lopsided)              [SeberWild1989]
///   σ² = Σ ψ² / (N − p) / mean(ψ')², ψ the influence of the loss; squares: ψ = r, ψ' = 1                         [Huber1981]
///   u_c = (I − J_cᵀJ_c (JᵀJ)⁻¹)⁻¹ J_cᵀr_c: the curves' own pull, freed of their part in the fit; t of G − 1      [BellMcCaffrey2002]
///
/// by_curve is used where three curves or more each tell all that is determined: then an interval is that of the mean over
/// specimens, the exact t-interval of their own estimates for a linear law, and a law's misfit, which they share, is not in
/// it. Fewer curves say nothing of other specimens: their intervals are of noise and misfit, by the correlation that is most likely
/// (residual_correlation.h). A test of independence does not decide: on some 40 samples it overlooks a correlation of 0.6 between neighbours
/// three times in ten, and intervals that then count all samples hold the truth in 82 to 88 %; with the likelihood alone in 91 to 96 %.
Covariance covariance(const Problem& problem, std::span<const double> scaled, const CovarianceOptions& options = {});

}  // namespace glisson::fit

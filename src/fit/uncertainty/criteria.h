// criteria.h — which of several laws the curves support: information criteria, and the error on curves held out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glisson::fit {

struct Criteria {
  double log_likelihood = 0.0;
  double aic = 0.0, aicc = 0.0, bic = 0.0;  ///< aicc infinite where samples are too few for the parameters
};

/// Criteria of a least-squares fit with estimated variance; k = parameters + 1, n the effective samples.
///
///   ln L = −½ n (ln(2π SSR / N) + 1)
///   AIC = −2 ln L + 2k [Akaike1974],  AICc = AIC + 2k (k + 1) / (n − k − 1) [HurvichTsai1989],  BIC = −2 ln L + k ln n [Schwarz1978]
///
/// @param sum_squares  of the scaled residuals; twice the cost for a robust loss @param samples  N
/// @param effective  samples that count, from the covariance's noise; N where residuals are independent
Criteria criteria(double sum_squares, std::size_t samples, double effective, std::size_t parameters);

/// A law's fit to the same curves as the others', in order of no meaning.
struct LawFit {
  std::string name;
  std::size_t parameters = 0;
  double sum_squares = 0.0;
  std::size_t samples = 0;
  double effective = 0.0;
  /// [N] of each curve held out, and of each left out in turn; the same curves for every law; empty: none.
  std::vector<double> heldout_rms;
};

struct LawRank {
  std::size_t law = 0;  ///< place in the list given
  Criteria criteria;
  double delta_aicc = 0.0, delta_bic = 0.0;  ///< above the least of all; of AIC where `corrected` is false
  double akaike_weight = 0.0;                ///< exp(−½ Δ) over the sum of all
  double heldout = 0.0;                      ///< √ of the mean square over those curves [N]; 0 without any
  double behind = 0.0;                       ///< by so much more than the best law, curve by curve [N]
  double behind_error = 0.0;                 ///< standard error of that, over curves [N]
  bool as_good = false;                      ///< not told apart from the best
  std::string words;                         ///< where it stands: "errs by 0.12 ± 0.05 N more than the best"
};

struct LawRanking {
  std::vector<LawRank> order;  ///< best first: by held-out error, by AICc where fewer than two curves are held out
  std::size_t best = 0;        ///< law with the least error or AICc
  std::size_t chosen = 0;      ///< the simplest that is as good
  bool corrected = true;       ///< false: the samples that count are too few for any law's AICc, and AIC is taken
  std::string sentence;        ///< "the data support 2 parameters: …"
};

/// Ranks laws by their error on curves that a fit has not seen, and chooses the simplest that is as good as the best: it errs
/// by at most 5 % more, or by less than 20 % more where that is within one standard error of the difference, curve by curve
/// [Breiman1984]. Without two such curves it is the simplest within 2 of the least AICc [BurnhamAnderson2002].
/// Likelihoods share the effective samples of the law with the least squares: its residuals are nearest to the noise, and
/// likelihoods of different sample sizes do not compare (as the variance inflation of [BurnhamAnderson2002], taken from the
/// most general model).
/// @throws std::invalid_argument  no law, or laws with different samples or held-out curves
LawRanking rank_laws(std::span<const LawFit> laws, const std::string& unit = "N");

}  // namespace glisson::fit

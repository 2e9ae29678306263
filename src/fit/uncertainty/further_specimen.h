// further_specimen.h — what a specimen that was not fitted is to be expected to show, from how those fitted differ.
//
// With C of the mean over G specimens (covariance.h, by_curve) a further one scatters about it by (G + 1) C:
//   parameter   z_p ± t √((G + 1) C_pp)
//   force       f ± t √((G + 1) jᵀC j + s²),   j = ∂f/∂z, s² the mean square that each curve's own fit leaves it
// s is the law's misfit and noise, which all specimens have: it is in the forces, not in the parameters.
#pragma once

#include <vector>

#include "fit/uncertainty/covariance.h"

namespace glisson::fit {

/// Forces between which a curve of a further specimen lies, at each of its instants [N].
struct Band {
  std::vector<double> low, high;
};

class FurtherSpecimen {
 public:
  /// @param fitted  the problem that `covariance` is of
  FurtherSpecimen(const Problem& fitted, const Covariance& covariance);

  /// Whether the fitted curves tell how specimens differ.
  bool known() const { return known_; }
  /// Prediction interval of each parameter, in its unit; open where it is not determined or reaches a bound.
  std::vector<Interval> parameters() const;
  /// Prediction bands of curves.
  /// @param curves  a problem of the same parameters, with spreads and weights of 1; none where the model fails
  std::vector<Band> bands(const Problem& curves) const;
  /// What each curve's own fit, to first order, leaves it: rms over all [N].
  double left_newtons() const { return left_; }

 private:
  const Problem& fitted_;
  const Covariance& covariance_;
  bool known_ = false;
  double specimens_ = 0.0, left_ = 0.0;
};

}  // namespace glisson::fit

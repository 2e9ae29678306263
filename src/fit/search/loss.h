// loss.h — what one residual adds to the cost of a fit, and how it pulls: squares, or robust losses that bend down.
//
//   cost = ½ Σ ρ(r²);   influence ψ(r) = ρ'(r²) r;   its slope ψ'(r) = ρ' + 2 r² ρ''                     [Huber1981]
#pragma once

namespace glisson::fit {

enum class LossKind { squares, huber, soft_l1, cauchy };
struct Loss {
  LossKind kind = LossKind::squares;
  double scale = 1.0;  ///< residuals far above it count less; in standard deviations of the noise, > 0
};

/// ρ. @param square  r²
double loss_of(const Loss& loss, double square);

struct Influence {
  double weight = 1.0;  ///< ρ'(r²): how much the residual counts, 1 for squares
  double value = 0.0;   ///< ψ(r): its pull
  double slope = 0.0;   ///< dψ/dr: 1 for squares, less than 0 where a loss bends down
};
Influence influence(const Loss& loss, double residual);

}  // namespace glisson::fit

#include "fit/search/loss.h"

#include <cmath>

namespace glisson::fit {

double loss_of(const Loss& loss, double square) {
  const double c = loss.scale * loss.scale, x = square / c;
  switch (loss.kind) {
    case LossKind::squares:
      return square;
    case LossKind::huber:
      return x <= 1.0 ? square : c * (2.0 * std::sqrt(x) - 1.0);
    case LossKind::soft_l1:
      return 2.0 * c * (std::sqrt(1.0 + x) - 1.0);
    case LossKind::cauchy:
      return c * std::log1p(x);
  }
  return square;
}

Influence influence(const Loss& loss, double residual) {
  const double c = loss.scale * loss.scale, x = residual * residual / c;
  double first = 1.0, second_x = 0.0;  // ρ' and r² ρ''
  switch (loss.kind) {
    case LossKind::squares:
      break;
    case LossKind::huber:
      if (x > 1.0) {
        first = 1.0 / std::sqrt(x);
        second_x = -0.5 * first;
      }
      break;
    case LossKind::soft_l1:
      first = 1.0 / std::sqrt(1.0 + x);
      second_x = -0.5 * x * first / (1.0 + x);
      break;
    case LossKind::cauchy:
      first = 1.0 / (1.0 + x);
      second_x = -x * first * first;
      break;
  }
  return {first, first * residual, first + 2.0 * second_x};
}

}  // namespace glisson::fit

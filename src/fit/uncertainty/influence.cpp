#include "fit/uncertainty/influence.h"

#include <cmath>

namespace glisson::fit {

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
  return {first * residual, first + 2.0 * second_x};
}

}  // namespace glisson::fit

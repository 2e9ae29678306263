// volume_powers.h — powers of J and logarithms of stretches that go on below a limit, so that inverted tets stay finite.
//
// J^(−⅔) and ln λ end at 0, but tets do not: a fast needle or a scrambled start inverts them, and the force has to
// lead back. Below kSmallestVolume the power follows its Taylor polynomial of second order, below kSmallestStretch the
// logarithm a bounded branch with the same slope. Both limits lie beyond what tissue survives.
#pragma once

#include <cmath>

#include "tissue/dual.h"

namespace glisson {

inline constexpr double kSmallestVolume = 0.2;   ///< J
inline constexpr double kSmallestStretch = 0.2;  ///< λ

/// A function and its derivative.
template <class T>
struct ValueSlopeOf {
  T value, slope;
};

/// J^(−n/3), n = 2 or 4.
template <int n, class T>
ValueSlopeOf<T> volume_power(T J) {
  using std::cbrt;
  constexpr double e = -n / 3.0;
  if (J >= T(kSmallestVolume)) {
    const T c = cbrt(J);
    const T value = n == 2 ? T(1.0) / (c * c) : T(1.0) / (c * J);
    return {value, T(e) * value / J};
  }
  const double J0 = kSmallestVolume, a = std::pow(J0, e), slope = e * a / J0, bend = e * (e - 1.0) * a / (J0 * J0);
  const T x = J - T(J0);
  return {T(a) + x * (T(slope) + T(0.5 * bend) * x), T(slope) + T(bend) * x};
}

/// ln λ of λ = 1 + b.
template <class T>
ValueSlopeOf<T> stretch_logarithm(T b) {
  using std::log1p;
  const double l0 = kSmallestStretch;
  const T stretch = T(1.0) + b;
  if (stretch >= T(l0)) return {log1p(b), T(1.0) / stretch};
  const T x = (T(l0) - stretch) / T(l0), y = T(1.0) + T(0.5) * x;
  return {T(std::log(l0)) - x / y, T(1.0 / l0) / (y * y)};
}

}  // namespace glisson

// volume_powers.h — powers of J and logarithms of stretches that go on below a limit, so that inverted tets stay finite.
//
// J^(−⅔) and ln λ end at 0, but tets do not: a fast needle or a scrambled start inverts them, and the force has to
// lead back. Both limits lie beyond what tissue survives. What lies below depends on what else pushes a tet back:
//
//   fade   its own κ (J − 1): the slope falls to 0 and the value stays. A rising value would be a wall
//          between folded and unfolded states: of 20 blocks with all vertices at random places, 19 of neo-Hooke's law
//          come back, 2 where the power rises below the limit (tests/dynamics/torture_test.cpp)
//   rise   nothing, where volume change is shared: the power follows its Taylor polynomial of second order, the
//          logarithm a bounded branch with the same slope
#pragma once

#include <cmath>

#include "tissue/dual.h"

namespace glisson {

inline constexpr double kSmallestVolume = 0.2;   ///< J
inline constexpr double kSmallestStretch = 0.2;  ///< λ
/// Share of a power's slope that fades last; 0.14 is enough for J^(−4/3) I₂ of a tet squashed flat not to fall.
inline constexpr double kLinger = 0.2;

/// How a function goes on below its limit.
enum class Beyond { fade, rise };

/// A function and its derivative.
template <class T>
struct ValueSlopeOf {
  T value, slope;
};

/// Goes on from a value and a slope at `limit`; most of the slope is gone at limit/2, the share `linger` of it at 0.
template <class T>
ValueSlopeOf<T> fading(double value, double slope, double limit, double linger, T at) {
  const T y = at * T(1.0 / limit), early = y > T(0.5) ? T(2.0) * y - T(1.0) : T(0.0), late = y > T(0.0) ? y : T(0.0);
  const T left = T(0.25 * (1.0 - linger)) * (T(1.0) - early * early) + T(0.5 * linger) * (T(1.0) - late * late);
  return {T(value) - T(slope * limit) * left, T(slope) * (T(1.0 - linger) * early + T(linger) * late)};
}

/// J^(−n/3), n = 2 or 4.
template <int n, class T>
ValueSlopeOf<T> volume_power(T J, Beyond beyond) {
  using std::cbrt;
  constexpr double e = -n / 3.0;
  if (J >= T(kSmallestVolume)) {
    const T c = cbrt(J);
    const T value = n == 2 ? T(1.0) / (c * c) : T(1.0) / (c * J);
    return {value, T(e) * value / J};
  }
  const double J0 = kSmallestVolume, a = std::pow(J0, e), slope = e * a / J0, bend = e * (e - 1.0) * a / (J0 * J0);
  if (beyond == Beyond::fade) return fading(a, slope, J0, kLinger, J);
  const T x = J - T(J0);
  return {T(a) + x * (T(slope) + T(0.5 * bend) * x), T(slope) + T(bend) * x};
}

/// ln λ of λ = 1 + b.
template <class T>
ValueSlopeOf<T> stretch_logarithm(T b, Beyond beyond) {
  using std::log1p;
  const double l0 = kSmallestStretch;
  const T stretch = T(1.0) + b;
  if (stretch >= T(l0)) return {log1p(b), T(1.0) / stretch};
  if (beyond == Beyond::fade) return fading(std::log(l0), 1.0 / l0, l0, 0.0, stretch);
  const T x = (T(l0) - stretch) / T(l0), y = T(1.0) + T(0.5) * x;
  return {T(std::log(l0)) - x / y, T(1.0 / l0) / (y * y)};
}

}  // namespace glisson

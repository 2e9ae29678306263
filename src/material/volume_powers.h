// volume_powers.h — powers of J and logarithms of stretches that go on below a limit, so that inverted tets stay finite.
//
// J^(−⅔) and ln λ end at 0, but tets do not: a fast needle or a scrambled start inverts them, and the force has to
// lead back. Both limits lie beyond what tissue survives. Below, the slope fades to 0 and the value stays: a rising value
// would be a wall between folded and unfolded states. Of 20 blocks with all vertices at random places, 19 of neo-Hooke's
// law come back, 2 where the power goes on rising (tests/dynamics/torture_test.cpp).
//
// What pushes a tet back is then its own κ (J − 1). One whose volume change is shared with its neighbours has none: it gets
//
//     W += ½ β κ (J − 0.2)²,  J < 0.2,
//
// which is nothing above the limit. Of 20 blocks with vertices up to a cell away (κ = 50 μ) 19 come back with β = 0.1, 16
// with β = 0.5, 18 with β = 0.02, and 11 where instead of it the power goes on rising.
#pragma once

#include <cmath>

#include "glisson/material/scalar.h"
#include "material/dual.h"

namespace glisson {

inline constexpr double kSmallestVolume = 0.2;   ///< J
inline constexpr double kSmallestStretch = 0.2;  ///< λ
/// Share of a power's slope that fades last; 0.14 is enough for J^(−4/3) I₂ of a tet squashed flat not to fall.
inline constexpr double kLinger = 0.2;
/// β: the share of κ with which a tet that shares its volume change pushes back by itself.
inline constexpr double kOwnShare = 0.1;

/// Goes on from a value and a slope at `limit`; most of the slope is gone at limit/2, the share `linger` of it at 0.
template <class T>
ValueSlope<T> fading(double value, double slope, double limit, double linger, T at) {
  const T y = at * T(1.0 / limit), early = y > T(0.5) ? T(2.0) * y - T(1.0) : T(0.0), late = y > T(0.0) ? y : T(0.0);
  const T left = T(0.25 * (1.0 - linger)) * (T(1.0) - early * early) + T(0.5 * linger) * (T(1.0) - late * late);
  return {T(value) - T(slope * limit) * left, T(slope) * (T(1.0 - linger) * early + T(linger) * late)};
}

/// J^(−n/3), n = 2 or 4.
template <int n, class T>
ValueSlope<T> volume_power(T J) {
  using std::cbrt;
  constexpr double e = -n / 3.0;
  if (J >= T(kSmallestVolume)) {
    const T c = cbrt(J);
    const T value = n == 2 ? T(1.0) / (c * c) : T(1.0) / (c * J);
    return {value, T(e) * value / J};
  }
  const double J0 = kSmallestVolume, a = std::pow(J0, e);
  return fading(a, e * a / J0, J0, kLinger, J);
}

/// J − 0.2 of a tet that is nearly lost, else 0.
template <class T>
T lost_volume(T J) {
  const T left = J - T(kSmallestVolume);
  return left < T(0.0) ? left : T(0.0);
}

/// ln λ of λ = 1 + b.
template <class T>
ValueSlope<T> stretch_logarithm(T b) {
  using std::log1p;
  const double l0 = kSmallestStretch;
  const T stretch = T(1.0) + b;
  if (stretch >= T(l0)) return {log1p(b), T(1.0) / stretch};
  return fading(std::log(l0), 1.0 / l0, l0, 0.0, stretch);
}

}  // namespace glisson

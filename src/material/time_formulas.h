// time_formulas.h — the formulas of the laws of a branch's time: ln φ and its slope at measure x, written once for doubles,
// duals and lanes as those of stiffness are (stiffness_formulas.h). `c` are the law's numbers.
#pragma once

#include "glisson/material/time_law.h"

namespace glisson {

/// ln φ between its bounds; beyond them it has no slope.
template <class T>
GLISSON_FORMULA ValueSlope<T> clamped(T value, T slope, T least, T most) {
  using namespace scalar;
  const T inside = select(value < most, slope, T(0));
  return {min(max(value, least), most), select(value > least, inside, T(0))};
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> ExponentialTime::at(const C& c, T x) {
  const T a(c[0]);
  return clamped(a * x, a, T(c[1]), T(c[2]));
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> PowerTime::at(const C& c, T x) {
  using namespace scalar;
  const T n(c[0]), safe = max(x, T(kSmallestMeasure));
  return clamped(n * (log(safe) - T(c[1])), n / safe, T(c[2]), T(c[3]));
}

}  // namespace glisson

// stiffness_formulas.h — the formulas of the laws of stiffness: M and dM/dx at measure x.
//
// Each is written once, in the words of glisson/material/scalar.h, and runs on a double, on a number with a derivative
// (dual.h) and on vectors of lanes (engine/kernels/lane_scalar-inl.h). `c` are the law's numbers. They stand apart from the
// parameters so that a change of a formula compiles again what computes with it, and not all that knows what a tissue is.
#pragma once

#include <cstddef>

#include "glisson/material/stiffness_law.h"

namespace glisson {

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> ConstantLaw::at(const C& c, T /*x*/) {
  return {T(c[0]), T(0)};
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> StepLaw::at(const C& c, T x) {
  using namespace scalar;
  const T base(c[0]), rise(c[1]), middle(c[2]), zero(0), one(1);
  if (!(c[3] > 0)) return {select(x < middle, base, base + rise), zero};
  const T w(c[3]), t = min(max(mul_add(x - middle, one / w, T(0.5)), zero), one);
  return {mul_add(rise, t * t * (T(3) - (t + t)), base), T(6) / w * rise * t * (one - t)};
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> LinearLaw::at(const C& c, T x) {
  using namespace scalar;
  const T k(c[1]);
  return not_below_zero(mul_add(k, x, T(c[0])), k);
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> PolynomialLaw::at(const C& c, T x) {
  using namespace scalar;
  T m(c[c.size() - 1]), slope(0);
  for (std::size_t i = c.size() - 1; i-- > 0;) {
    slope = mul_add(slope, x, m);
    m = mul_add(m, x, T(c[i]));
  }
  return not_below_zero(m, slope);
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> ExponentialLaw::at(const C& c, T x) {
  using namespace scalar;
  const T A(c[1]), b(c[2]), most(kLargestExponent), e = b * x;
  const T growth = expm1(min(e, most));
  return not_below_zero(mul_add(A, growth, T(c[0])), select(e > most, T(0), A * b * (growth + T(1))));
}

template <class C, class T>
GLISSON_FORMULA ValueSlope<T> TableLaw::at(const C& c, T x) {
  using namespace scalar;
  T from(c[0]), m(c[1]), slope(0);
  for (std::size_t i = 0; i < c.size(); i += 3) {
    const auto right = x >= T(c[i]);
    from = select(right, T(c[i]), from);
    m = select(right, T(c[i + 1]), m);
    slope = select(right, T(c[i + 2]), slope);
  }
  return {mul_add(slope, x - from, m), slope};
}

/// The modulus and its slope at measure `x` for the modulus `base` at rest [Pa].
template <class T>
ValueSlope<T> law_at(const StiffnessLaw& law, double base, T x) {
  return std::visit([&](const auto& l) { return l.at(l.numbers(base), x); }, law);
}

}  // namespace glisson

// invariant_series.h — powers of I + X for a symmetric, traceless X: no eigenvalues.
//
// Powers of X are combinations of I, X and X² (Cayley and Hamilton), whose coefficients are power series of
// J₂ = ½ X:X and J₃ = det X:
//
//   (I + X)^a = Σ_n binom(a, n) X^n,   X^n = α_n X² + α_(n+1) X + α_(n−1) J₃ I,   α_(n+2) = J₂ α_n + J₃ α_(n−1), α₂ = 1
//
// The series are cut off behind the fourteenth power of X.
#pragma once

#include <array>
#include <cstddef>

#include "glisson/material/scalar.h"

namespace glisson {

/// How many powers of J₂ go with the j-th power of J₃: 2 i + 3 j ≤ kSeriesOrder.
inline constexpr std::size_t kSeriesOrder = 14;
inline constexpr std::array<std::size_t, 5> kSeriesPowers{8, 6, 5, 3, 2};
/// [power of J₃][power of J₂]. Number is double, or float for lanes.
template <class Number = double>
using InvariantSeries = std::array<std::array<Number, kSeriesPowers[0]>, kSeriesPowers.size()>;

/// Σ c_ji J₂^(i − I) of the terms from I on.
template <std::size_t J, std::size_t I, class T, class Number>
GLISSON_FORMULA T series_row(const InvariantSeries<Number>& c, T J2) {
  using namespace scalar;
  if constexpr (I + 1 == kSeriesPowers[J])
    return T(c[J][I]);
  else
    return mul_add(series_row<J, I + 1>(c, J2), J2, T(c[J][I]));
}
/// Σ c_ji J₂^i J₃^(j − J) of the rows from J on, on numbers or lanes. No loops: compilers leave them in lanes.
template <std::size_t J = 0, class T, class Number>
GLISSON_FORMULA T series_at(const InvariantSeries<Number>& c, T J2, T J3) {
  using namespace scalar;
  const T row = series_row<J, 0>(c, J2);
  if constexpr (J + 1 == kSeriesPowers.size())
    return row;
  else
    return mul_add(series_at<J + 1>(c, J2, J3), J3, row);
}

/// a + factor b.
InvariantSeries<> sum_of(const InvariantSeries<>& a, const InvariantSeries<>& b, double factor = 1.0);
InvariantSeries<> product_of(const InvariantSeries<>& a, const InvariantSeries<>& b);
InvariantSeries<float> rounded(const InvariantSeries<>& series);

/// (I + X)^a = (1 + whole) I + first X + second X².
struct TensorPower {
  InvariantSeries<> whole{}, first{}, second{};
};
TensorPower tensor_power(double a);
/// det(I + X)^a.
InvariantSeries<> determinant_power(double a);

/// Eigenvalues of X of all shapes, from one long axis to one short axis, the largest of them `delta`.
std::array<std::array<double, 3>, 25> shapes_of(double delta);

}  // namespace glisson

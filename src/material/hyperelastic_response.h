// hyperelastic_response.h — P = ∂W/∂F of the hyperelastic laws, from H = F − I, in double or with a derivative.
//
// With I₁ = tr C, I₂ = ‖cof F‖², K = cof F − I and w₁, w₂ the slopes of W by Ī₁, Ī₂,
//
//   ∂Ī₁/∂F = 2 J^(−⅔) [ F − r cof F ]                     r = I₁/(3J)
//   ∂Ī₂/∂F = 4 J^(−4/3) [ F + tr(E) F − F E − ρ cof F ]    ρ = I₂/(3J)
//   F − r cof F = H − r K + (1 − r) I,   1 − r = ( 3 (J − 1) − 2 tr H − ‖H‖² ) / (3J)
//
// where all that cancels near rest is cancelled on paper. Ī₂ of F is Ī₁ of cof F, so one formula serves both.
#pragma once

#include <variant>

#include "glisson/material/shape_measure.h"
#include "material/hyperelastic_formulas.h"
#include "material/principal.h"
#include "material/volume_powers.h"

namespace glisson {

/// F − (I₁/3J) cof F of F = I + H.
template <class T>
Mat3<T> deviatoric_direction(const Mat3<T>& H, const Mat3<T>& K, T volume_change) {
  const T three_J = T(3.0) * (T(1.0) + volume_change);
  const T left = (T(3.0) * volume_change - T(2.0) * trace(H) - squared_norm(H)) / three_J;  // 1 − r
  Mat3<T> D = sum(H, scaled(K, left - T(1.0)));
  for (std::size_t i = 0; i < 3; ++i) D(i, i) = D(i, i) + left;
  return D;
}

/// Ī₁ − 3 of F = I + H, for J > 0.
template <class T>
T isochoric_excess(const Mat3<T>& H) {
  const T p = one_minus_q(H);
  return T(3.0) * p / (T(1.0) - p);
}

/// The slopes of a law at Ī₁ − 3 and Ī₂ − 3. @param i2  a function that works it out, for laws that ask
template <class Law, class T, class Second>
InvariantSlopes<T> slopes_at(const Law& law, T i1, Second i2) {
  if constexpr (Law::kSecond == SecondInvariant::general) {
    return law.slopes(i1, i2());
  } else {
    return law.slopes(i1, T(0.0));
  }
}

/// The isochoric part of a law of the invariants.
template <class Law, class T>
Mat3<T> invariant_piola(const Law& law, const Mat3<T>& H) {
  const T j = trace(H) + second_invariant(H) + determinant(H), J = T(1.0) + j;
  const Mat3<T> K = cofactor_change(H), F = deformation_gradient(H);
  const Sym3<T> E = green_strain(H);
  const ValueSlope<T> a = volume_power<2>(J), b = volume_power<4>(J);
  const Mat3<T> second = sum(scaled(F, trace(E)), scaled(product(F, full(E)), T(-1.0)));  // tr(E) F − F E
  if (J >= T(kSmallestVolume)) {
    const InvariantSlopes<T> w = slopes_at(law, isochoric_excess(H), [&] { return isochoric_excess(K); });
    const Mat3<T> first = deviatoric_direction(H, K, j);
    const T I2 = T(3.0) + T(2.0) * trace(K) + squared_norm(K), rho = I2 / (T(3.0) * J);
    const T left = (T(3.0) * j - T(2.0) * trace(K) - squared_norm(K)) / (T(3.0) * J);  // 1 − ρ
    Mat3<T> D = sum(sum(H, scaled(K, -rho)), second);
    for (std::size_t i = 0; i < 3; ++i) D(i, i) = D(i, i) + left;
    return sum(scaled(first, T(2.0) * w.first * a.value), scaled(D, T(4.0) * w.second * b.value));
  }
  const Mat3<T> cof = deformation_gradient(K);
  const T I1 = squared_norm(F), I2 = squared_norm(cof);
  const InvariantSlopes<T> w = slopes_at(law, a.value * I1 - T(3.0), [&] { return b.value * I2 - T(3.0); });
  const Mat3<T> shear = sum(scaled(F, T(2.0) * (w.first * a.value + T(2.0) * w.second * b.value)),
                            scaled(second, T(4.0) * w.second * b.value));
  return sum(shear, scaled(cof, w.first * a.slope * I1 + w.second * b.slope * I2));
}

template <class Law>
double invariant_energy(const Law& law, const Mat3d& H) {
  const double J = jacobian(H);
  if (J >= kSmallestVolume) return law.energy(isochoric_excess(H), isochoric_excess(cofactor_change(H)));
  const double I1 = squared_norm(deformation_gradient(H)), I2 = squared_norm(deformation_gradient(cofactor_change(H)));
  return law.energy(volume_power<2>(J).value * I1 - 3.0, volume_power<4>(J).value * I2 - 3.0);
}

/// ln λ̄ and d ln λ/dλ of the three stretches.
template <class T>
struct IsochoricLogarithms {
  std::array<T, 3> l, slope;
};
template <class T>
IsochoricLogarithms<T> isochoric_logarithms(const std::array<T, 3>& b) {
  const std::array<ValueSlope<T>, 3> ln{stretch_logarithm(b[0]), stretch_logarithm(b[1]), stretch_logarithm(b[2])};
  const T mean = (ln[0].value + ln[1].value + ln[2].value) * T(1.0 / 3.0);
  return {{ln[0].value - mean, ln[1].value - mean, ln[2].value - mean}, {ln[0].slope, ln[1].slope, ln[2].slope}};
}

template <StretchLaw Law, class T>
Mat3<T> stretch_piola(const Law& law, const Mat3<T>& H) {
  return isotropic_piola(H, [&](const std::array<T, 3>& b) {
    const IsochoricLogarithms<T> ln = isochoric_logarithms(b);
    const std::array<T, 3> t = law.slopes(ln.l);
    return std::array<T, 3>{t[0] * ln.slope[0], t[1] * ln.slope[1], t[2] * ln.slope[2]};
  });
}

/// The isochoric part of any law: ∂W/∂F without κ/2 (J − 1)².
template <class T>
Mat3<T> isochoric_piola(const HyperelasticLaw& law, const Mat3<T>& H) {
  return std::visit(
      [&]<class Law>(const Law& l) {
        if constexpr (StretchLaw<Law>) {
          return stretch_piola(l, H);
        } else {
          return invariant_piola(l, H);
        }
      },
      law);
}

inline double isochoric_energy(const HyperelasticLaw& law, const Mat3d& H) {
  return std::visit(
      [&]<class Law>(const Law& l) {
        if constexpr (StretchLaw<Law>) {
          return l.energy(isochoric_logarithms(principal_frame(H).b).l);
        } else {
          return invariant_energy(l, H);
        }
      },
      law);
}

}  // namespace glisson

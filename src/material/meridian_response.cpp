#include "material/meridian_response.h"

#include <cmath>

#include "material/dual.h"
#include "material/hyperelastic_formulas.h"

namespace glisson {
namespace {

/// ∂W/∂ln λ_i of the isochoric part, of sum 0. @param l  ln λ̄_i, of sum 0
template <class Law, class T>
std::array<T, 3> logarithmic_slopes(const Law& law, const std::array<T, 3>& l) {
  if constexpr (StretchLaw<Law>) {
    return law.slopes(l);
  } else {
    using std::expm1;
    const auto powers = [&](double n) { return std::array<T, 3>{expm1(l[0] * n), expm1(l[1] * n), expm1(l[2] * n)}; };
    const std::array<T, 3> square = powers(2.0);
    const T i1 = square[0] + square[1] + square[2];
    std::array<T, 3> inverse{T(0.0), T(0.0), T(0.0)};
    if constexpr (Law::kSecond != SecondInvariant::none) inverse = powers(-2.0);
    const T i2 = inverse[0] + inverse[1] + inverse[2];
    const InvariantSlopes<T> w = law.slopes(i1, i2);
    std::array<T, 3> t;
    for (std::size_t i = 0; i < 3; ++i) t[i] = T(2.0) * w.first * (square[i] - i1 * (1.0 / 3.0));
    if constexpr (Law::kSecond != SecondInvariant::none) {
      for (std::size_t i = 0; i < 3; ++i) t[i] = t[i] - T(2.0) * w.second * (inverse[i] - i2 * (1.0 / 3.0));
    }
    return t;
  }
}

/// w_i = ∂W/∂λ_i and ∂w_i/∂λ_j.
struct PrincipalStress {
  std::array<double, 3> w{};
  std::array<std::array<double, 3>, 3> slope{};
};

template <class Law>
PrincipalStress principal_stress(const Law& law, const std::array<double, 3>& stretch) {
  std::array<double, 3> l;
  for (std::size_t i = 0; i < 3; ++i) l[i] = std::log(stretch[i]);
  const double mean = (l[0] + l[1] + l[2]) / 3.0;
  PrincipalStress s;
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<Dual, 3> x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = {l[i] - mean, ((i == j ? 1.0 : 0.0) - 1.0 / 3.0) / stretch[j]};
    const std::array<Dual, 3> t = logarithmic_slopes(law, x);
    for (std::size_t i = 0; i < 3; ++i) s.w[i] = t[i].v / stretch[i], s.slope[i][j] = t[i].d / stretch[i];
    s.slope[j][j] -= t[j].v / (stretch[j] * stretch[j]);
  }
  return s;
}

/// F = U diag(first, second) Vᵀ of a 2 × 2 matrix with det > 0, by the angles of its two rotations.
struct PlaneFrame {
  double first = 1.0, second = 1.0;
  std::array<std::array<double, 2>, 2> U{}, V{};
};

PlaneFrame plane_frame(const MeridianTensor& F) {
  const double e = 0.5 * (F[0] + F[3]), f = 0.5 * (F[0] - F[3]), g = 0.5 * (F[2] + F[1]), h = 0.5 * (F[2] - F[1]);
  const double q = std::hypot(e, h), r = std::hypot(f, g);
  const double sum = r > 0.0 ? std::atan2(g, f) : 0.0, turn = std::atan2(h, e);
  const double left = 0.5 * (sum + turn), right = 0.5 * (sum - turn);
  const double cl = std::cos(left), sl = std::sin(left), cr = std::cos(right), sr = std::sin(right);
  return {q + r, q - r, {{{cl, -sl}, {sl, cl}}}, {{{cr, -sr}, {sr, cr}}}};
}

MeridianStress out_of_frame(const PrincipalStress& s, const PlaneFrame& f) {
  const double difference = f.first - f.second, total = f.first + f.second;
  const bool close = std::abs(difference) < 1e-6 * total;
  const double minus =
      close ? 0.5 * (s.slope[0][0] + s.slope[1][1] - s.slope[0][1] - s.slope[1][0]) : (s.w[0] - s.w[1]) / difference;
  const double plus = (s.w[0] + s.w[1]) / total;
  const double even = 0.5 * (minus + plus), odd = 0.5 * (minus - plus);
  const std::array<std::array<double, 4>, 4> local{{{s.slope[0][0], 0.0, 0.0, s.slope[0][1]},
                                                    {0.0, even, odd, 0.0},
                                                    {0.0, odd, even, 0.0},
                                                    {s.slope[1][0], 0.0, 0.0, s.slope[1][1]}}};
  double turn[4][4];  // of components: (i, j) → (k, l) by U_ik V_jl
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) turn[a][b] = f.U[a / 2][b / 2] * f.V[a % 2][b % 2];
  MeridianStress out;
  double half[4][4];
  for (std::size_t a = 0; a < 4; ++a) {
    out.P[a] = turn[a][0] * s.w[0] + turn[a][3] * s.w[1];
    const double hoop = turn[a][0] * s.slope[0][2] + turn[a][3] * s.slope[1][2];
    out.tangent[a][4] = out.tangent[4][a] = hoop;
    for (std::size_t b = 0; b < 4; ++b) {
      half[a][b] = 0.0;
      for (std::size_t c = 0; c < 4; ++c) half[a][b] += turn[a][c] * local[c][b];
    }
  }
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t c = 0; c < 4; ++c) out.tangent[a][b] += half[a][c] * turn[b][c];
  out.P[4] = s.w[2];
  out.tangent[4][4] = s.slope[2][2];
  return out;
}

}  // namespace

MeridianStress isochoric_stress(const HyperelasticLaw& law, const MeridianTensor& F) {
  const PlaneFrame frame = plane_frame(F);
  const std::array<double, 3> stretch{frame.first, frame.second, F[4]};
  return out_of_frame(std::visit([&](const auto& l) { return principal_stress(l, stretch); }, law), frame);
}

}  // namespace glisson

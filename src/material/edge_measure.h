// edge_measure.h — radius ratio and minimum solid angle [LiuJoe1994], measured like q from the rest tetrahedron.
//
// Both were made to tell a tetrahedron from the regular one. To be 0 at rest on any mesh they are taken of a regular
// tetrahedron that is carried along by F, turned at rest as its own tetrahedron lies (R of the polar decomposition of
// the map between the two). With a_k the squared lengths of its six edges and V its volume
//
//   ρ = 216 V² / (S √Π)          S: area of the faces;  Π = 2 (PQ + QR + RP) − P² − Q² − R²,
//                                P, Q, R: products of opposite a_k
//   σ = 9/√6 min_i sin(θ_i/2)    sin(θ_i/2) = 12 V / √( Π_{j<k} ((l_ij + l_ik)² − l_jk²) ),  θ_i: solid angle at i
//
// 1 at rest, blind to rotation and dilation, but not isotropic: near rest
//
//   1 − ρ ≈ ⅔ ‖ε_E‖² + 8/9 ‖ε_T‖²      ε_E, ε_T: diagonal and off-diagonal part of dev ε in the tetrahedron's axes
//   1 − σ ≈ 5/√6 max_i n_i·ε n_i        n_i: unit vectors from the middle to the corners; 0 for all ε_E
//
// so that no constant makes either equal to ‖dev ε‖. They are scaled to it in the mean of squares over all directions:
//   s_ρ = √( 5/4 (1 − ρ) )   0.91 to 1.05 ‖dev ε‖      s_σ = 0.831 (1 − σ)   0 to 1.70 ‖dev ε‖
#pragma once

#include <array>

#include "material/dual.h"
#include "material/strain.h"

namespace glisson {

/// A measure and its slopes by the six squared edge lengths (01, 02, 03, 12, 13, 23) and by J.
template <class T>
struct EdgeMeasure {
  T value{};
  std::array<T, 6> by_square{};
  T by_J{};
};

namespace detail {

inline constexpr double kRegularVolume = 0.11785113019775793;  ///< √2/12, of edge 1
/// The edges of a regular tetrahedron of edge 1, positively oriented.
inline constexpr double kHalfDiagonal = 0.70710678118654752;
inline constexpr std::array<Vec3d, 6> kRegularEdges{{{-kHalfDiagonal, 0.0, -kHalfDiagonal},
                                                     {0.0, -kHalfDiagonal, -kHalfDiagonal},
                                                     {-kHalfDiagonal, -kHalfDiagonal, 0.0},
                                                     {kHalfDiagonal, -kHalfDiagonal, 0.0},
                                                     {0.0, -kHalfDiagonal, kHalfDiagonal},
                                                     {-kHalfDiagonal, 0.0, kHalfDiagonal}}};
/// Edges of the faces 012, 013, 023, 123.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{0, 1, 3}, {0, 2, 4}, {1, 2, 5}, {3, 4, 5}}};
/// At each corner: its three edges, and opposite to each the edge between the other two.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kSpokes{{{0, 1, 2}, {0, 3, 4}, {1, 3, 5}, {2, 4, 5}}};
inline constexpr std::array<std::array<std::size_t, 3>, 4> kAcross{{{5, 4, 3}, {5, 2, 1}, {4, 2, 0}, {3, 1, 0}}};

}  // namespace detail

/// ρ in [0, 1] and its slopes.
/// @param a  squared edge lengths, of edge 1 at rest
/// @param J  > 0
template <class T>
EdgeMeasure<T> radius_ratio(const std::array<T, 6>& a, T J) {
  using std::sqrt;
  const T P = a[0] * a[5], Q = a[1] * a[4], R = a[2] * a[3];
  const T product = T(2.0) * (P * Q + Q * R + R * P) - P * P - Q * Q - R * R;
  T area(0.0);
  std::array<T, 6> area_slope{};
  for (const auto& [i, j, k] : detail::kFaces) {
    const T sixteen = T(2.0) * (a[i] * a[j] + a[j] * a[k] + a[k] * a[i]) - a[i] * a[i] - a[j] * a[j] - a[k] * a[k];
    const T A = T(0.25) * sqrt(sixteen), scale = T(1.0) / (T(16.0) * A);
    area += A;
    area_slope[i] += (a[j] + a[k] - a[i]) * scale;
    area_slope[j] += (a[k] + a[i] - a[j]) * scale;
    area_slope[k] += (a[i] + a[j] - a[k]) * scale;
  }
  const T V = T(detail::kRegularVolume) * J;
  EdgeMeasure<T> m;
  m.value = T(216.0) * V * V / (area * sqrt(product));
  m.by_J = T(2.0) * m.value / J;
  const std::array<T, 3> slope{(Q + R - P) / product, (R + P - Q) / product, (P + Q - R) / product};  // ½ ∂ln Π
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t pair = k < 3 ? k : 5 - k;
    m.by_square[k] = T(-1.0) * m.value * (area_slope[k] / area + slope[pair] * a[5 - k]);
  }
  return m;
}

/// σ in [0, 1] and its slopes, those of the smallest corner.
template <class T>
EdgeMeasure<T> minimum_solid_angle(const std::array<T, 6>& a, T J) {
  using std::sqrt;
  std::array<T, 6> l;
  for (std::size_t k = 0; k < 6; ++k) l[k] = sqrt(a[k]);
  const auto term = [&](std::size_t corner, std::size_t n) {
    const T sum = l[detail::kSpokes[corner][(n + 1) % 3]] + l[detail::kSpokes[corner][(n + 2) % 3]];
    return sum * sum - a[detail::kAcross[corner][n]];
  };
  const auto product = [&](std::size_t corner) { return term(corner, 0) * term(corner, 1) * term(corner, 2); };
  std::size_t sharpest = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (product(i) > product(sharpest)) sharpest = i;
  }
  constexpr double kScale = 9.0 / 2.449489742783178 * 12.0 * detail::kRegularVolume;
  EdgeMeasure<T> m;
  m.value = T(kScale) * J / sqrt(product(sharpest));
  m.by_J = m.value / J;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t j = detail::kSpokes[sharpest][(n + 1) % 3], k = detail::kSpokes[sharpest][(n + 2) % 3];
    const T share = T(-0.5) * m.value / term(sharpest, n);
    m.by_square[j] += share * (T(1.0) + l[k] / l[j]);
    m.by_square[k] += share * (T(1.0) + l[j] / l[k]);
    m.by_square[detail::kAcross[sharpest][n]] -= share;
  }
  return m;
}

/// The six edges of the carried tetrahedron.
template <class T>
std::array<Vec3<T>, 6> carried_edges(const Mat3<T>& F, const Mat3d& turn) {
  std::array<Vec3<T>, 6> edges;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3d r = turn * detail::kRegularEdges[k];
    edges[k] = F * Vec3<T>{T(r.x), T(r.y), T(r.z)};
  }
  return edges;
}

/// ρ or σ of H = F − I. 0 without slope where the tetrahedron is inverted or flat to 1e-6, where its edges lie on one
/// circle or line and rounding rules.
/// @param turn  R: rotation from the axes of the regular tetrahedron to the element's
template <class T>
EdgeMeasure<T> edge_measure(bool radius, const Mat3<T>& H, const Mat3d& turn) {
  const T J = T(1.0) + trace(H) + second_invariant(H) + determinant(H);
  const Mat3<T> F = deformation_gradient(H);
  const double size = value_of(squared_norm(F));
  if (!(value_of(J) > 1e-6 * size * std::sqrt(size))) return {};
  std::array<T, 6> squares;
  const auto edges = carried_edges(F, turn);
  for (std::size_t k = 0; k < 6; ++k) squares[k] = dot(edges[k], edges[k]);
  return radius ? radius_ratio(squares, J) : minimum_solid_angle(squares, J);
}

/// s_ρ = √(5/4 (1 − ρ)) or s_σ = 0.831 (1 − σ) [-], 0 at rest; good to 3e-8 for ρ.
template <class T>
T edge_strain(bool radius, T value) {
  using std::sqrt;
  const T rest = T(1.0) - value, p = rest > T(0.0) ? rest : T(0.0);
  return radius ? sqrt(T(1.25) * p) : T(0.831) * p;
}

/// ∂s/∂F; 0 at rest, where neither has a derivative.
template <class T>
Mat3<T> edge_strain_gradient(bool radius, const Mat3<T>& H, const Mat3d& turn) {
  const EdgeMeasure<T> m = edge_measure(radius, H, turn);
  const T s = edge_strain(radius, m.value);
  if (!(s > T(1e-7))) return {};
  const T outer = radius ? T(-0.625) / s : T(-0.831);
  const Mat3<T> F = deformation_gradient(H);
  Mat3<T> gradient = scaled(deformation_gradient(cofactor_change(H)), outer * m.by_J);
  const auto edges = carried_edges(F, turn);
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3d r = turn * detail::kRegularEdges[k];
    const T weight = T(2.0) * outer * m.by_square[k];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) gradient(i, j) = gradient(i, j) + weight * edges[k][i] * T(r[j]);
    }
  }
  return gradient;
}

}  // namespace glisson

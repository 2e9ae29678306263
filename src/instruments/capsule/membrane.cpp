#include "instruments/capsule/membrane.h"

#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

constexpr double kMostExponent = 100.0;  ///< of αQ: keeps numbers finite in states beyond any tissue

MembraneFactors factors_of(const MembraneLaw& law) {
  const double nu = law.poisson_ratio;
  return {.stiffness = law.stiffness,
          .nu = nu,
          .alpha = law.stiffening,
          .shear = 1.0 / (1.0 + nu),
          .bulk = 2.0 * nu / (1.0 - nu * nu),
          .modulus = 1.0 / (1.0 - nu),
          .most_exponent = kMostExponent};
}

/// Diagonal D with the matrix Lᵢⱼ = A ∇Nᵢ·∇Nⱼ ≤ D: that of L times the largest eigenvalue of L over it. L has a
/// constant field for free, so the other two are the roots of μ² − 3 μ + Σ (1 − Lᵢⱼ²/(Lᵢᵢ Lⱼⱼ)) over the pairs.
std::array<double, 3> diagonal_above(double a, double b, double c) {
  // edges (a, 0) and (b, c) of the triangle; A ∇Nᵢ·∇Nⱼ = eᵢ·eⱼ / (4A) with the edges opposite the corners
  const std::array<std::array<double, 2>, 3> edge{{{b - a, c}, {-b, -c}, {a, 0.0}}};
  const auto l = [&](std::size_t i, std::size_t j) {
    return (edge[i][0] * edge[j][0] + edge[i][1] * edge[j][1]) / (2.0 * a * c);
  };
  double pairs = 3.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    pairs -= l(i, j) * l(i, j) / (l(i, i) * l(j, j));
  }
  const double most = 1.5 + std::sqrt(std::max(0.0, 2.25 - pairs));
  return {most * l(0, 0), most * l(1, 1), most * l(2, 2)};
}

}  // namespace

MembraneResponse membrane_response(const MembraneLaw& law, double e11, double e12, double e22) {
  const double mean = 0.5 * (e11 + e22), half = 0.5 * (e11 - e22), nu = law.poisson_ratio;
  const double radius = std::sqrt(half * half + e12 * e12), e1 = mean + radius, e2 = mean - radius;
  if (!(e1 > 0.0)) return {};
  const bool taut = e2 + nu * e1 > 0.0;
  const double q = taut ? (e1 * e1 + e2 * e2 + 2.0 * nu * e1 * e2) / (1.0 - nu * nu) : e1 * e1;
  const double alpha = law.stiffening;
  const double form = alpha > 0.0 ? std::expm1(std::min(alpha * q, kMostExponent)) / alpha : q;
  return {0.5 * law.stiffness * form, taut ? MembraneState::taut : MembraneState::wrinkled};
}

Membrane::Membrane(std::span<const Triangle> triangles, std::span<const Vec3d> rest, const MembraneLaw& law)
    : law_(law), area_(triangles.size(), 0.0), kept_(triangles.size(), 1.0),
      blocks_((triangles.size() + kSize - 1) / kSize), forces_(membrane_forces(law.stiffening > 0.0)) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    MembraneBlock& b = blocks_[t / kSize];
    const std::size_t k = t % kSize;
    for (std::size_t i = 0; i < 3; ++i) b.corner[i][k] = triangles[t][i];
    const Vec3d d1 = rest[triangles[t][1]] - rest[triangles[t][0]], d2 = rest[triangles[t][2]] - rest[triangles[t][0]];
    const double twice = norm(cross(d1, d2)), length = norm(d1);
    if (!(twice > 0.0)) continue;
    area_[t] = 0.5 * twice;
    // the first edge lies along the first axis
    b.g00[k] = law.prestretch / length;
    b.g11[k] = law.prestretch * length / twice;
    b.g01[k] = -law.prestretch * dot(d1, d2) / (length * twice);
    // natural edges; their scale does not matter
    const double edge = 1.0 / b.g00[k], height = 1.0 / b.g11[k], foot = -b.g01[k] * edge * height;
    const std::array<double, 3> above = diagonal_above(edge, foot, height);
    for (std::size_t i = 0; i < 3; ++i) b.above[i][k] = above[i];
    keep(t, 1.0);
  }
}

void Membrane::keep(std::size_t triangle, double share) {
  kept_[triangle] = share;
  blocks_[triangle / kSize].area[triangle % kSize] = share * natural_area(triangle);
}

void Membrane::set_masses(std::span<const double> masses) {
  masses_.assign(masses.begin(), masses.end());
  sharp_rate_ = kNone;
  std::vector<double> of_vertex(masses.size(), 0.0);
  for (std::size_t t = 0; t < size(); ++t) {
    if (!(area_[t] > 0.0)) continue;
    const MembraneBlock& b = blocks_[t / kSize];
    const std::size_t k = t % kSize;
    for (std::size_t i = 0; i < 3; ++i) of_vertex[b.corner[i][k]] += b.above[i][k];
  }
  for (std::size_t v = 0; v < masses.size(); ++v) of_vertex[v] = masses[v] > 0.0 ? of_vertex[v] / masses[v] : 0.0;
  for (std::size_t t = 0; t < size(); ++t) {
    MembraneBlock& b = blocks_[t / kSize];
    const std::size_t k = t % kSize;
    b.rate[k] = std::max({of_vertex[b.corner[0][k]], of_vertex[b.corner[1][k]], of_vertex[b.corner[2][k]]});
  }
}

void Membrane::add_forces(std::span<const Vec3d> positions, std::span<Vec3d> forces) {
  if (blocks_.empty()) return;
  seen_ = forces_(factors_of(law_), blocks_.data(), blocks_.size(), positions.data(), forces.data());
}

void Membrane::add_stiffness_bound(std::span<double> per_vertex) const {
  for (const MembraneBlock& b : blocks_) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < kSize; ++k) per_vertex[b.corner[i][k]] += b.modulus[k] * b.above[i][k];
    }
  }
}

Membrane::Strain Membrane::strain(std::span<const Vec3d> positions, std::size_t triangle) const {
  const MembraneBlock& b = blocks_[triangle / kSize];
  const std::size_t k = triangle % kSize;
  const Vec3d& x0 = positions[b.corner[0][k]];
  const Vec3d d1 = positions[b.corner[1][k]] - x0, d2 = positions[b.corner[2][k]] - x0;
  const double g00 = b.g00[k], g01 = b.g01[k], g11 = b.g11[k], p = dot(d1, d1), q = dot(d1, d2), r = dot(d2, d2);
  return {0.5 * (g00 * g00 * p - 1.0), 0.5 * g00 * (g01 * p + g11 * q),
          0.5 * (g01 * g01 * p + 2.0 * g01 * g11 * q + g11 * g11 * r - 1.0)};
}

double Membrane::energy(std::span<const Vec3d> positions, std::size_t triangle) const {
  const Strain s = strain(positions, triangle);
  return natural_area(triangle) * membrane_response(law_, s.e11, s.e12, s.e22).energy;
}

double Membrane::energy(std::span<const Vec3d> positions) const {
  double sum = 0.0;
  for (std::size_t t = 0; t < size(); ++t) sum += kept_[t] * energy(positions, t);
  return sum;
}

MembraneState Membrane::state(std::span<const Vec3d> positions, std::size_t triangle) const {
  const Strain s = strain(positions, triangle);
  return membrane_response(law_, s.e11, s.e12, s.e22).state;
}

// |F S| per natural width; per rest width it is 1/λ₀ of that
double Membrane::tension(std::size_t triangle) const {
  return std::sqrt(blocks_[triangle / kSize].squared_tension[triangle % kSize]) / law_.prestretch;
}
double Membrane::largest_tension() const { return std::sqrt(seen_.squared_tension) / law_.prestretch; }

}  // namespace glisson

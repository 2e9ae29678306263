#include "instruments/membrane.h"

#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

constexpr double kMostExponent = 100.0;  ///< of αQ: keeps numbers finite in states beyond any tissue

/// Constants of a law that the loop over triangles needs.
struct Factors {
  explicit Factors(const MembraneLaw& law)
      : stiffness(law.stiffness), nu(law.poisson_ratio), alpha(law.stiffening), shear(1.0 / (1.0 + law.poisson_ratio)),
        bulk(2.0 * law.poisson_ratio / (1.0 - law.poisson_ratio * law.poisson_ratio)),
        modulus(1.0 / (1.0 - law.poisson_ratio)) {}
  double stiffness, nu, alpha, shear, bulk, modulus;
};

/// Fills all but the energy, whose sum over E_Y t is (e^{αQ} − 1) / (2α); returns Q.
template <bool kStiffens>
inline double respond(const Factors& f, double e11, double e12, double e22, MembraneResponse& r) {
  const double mean = 0.5 * (e11 + e22), half = 0.5 * (e11 - e22);
  const double radius = std::sqrt(half * half + e12 * e12);
  const double e1 = mean + radius, e2 = mean - radius;
  const bool slack = !(e1 > 0.0), taut = e2 + f.nu * e1 > 0.0;
  // S / (E_Y t e^{αQ}) = a E + b 1
  const double fold = 0.5 * e1 / std::max(radius, 1e-300);
  const double a = slack ? 0.0 : (taut ? f.shear : fold);
  const double b = slack ? 0.0 : (taut ? f.bulk * mean : 0.5 * e1 - fold * mean);
  const double s1 = a * e1 + b, s2 = a * e2 + b;
  const double q = s1 * e1 + s2 * e2;
  double factor = f.stiffness, modulus = f.modulus;
  if constexpr (kStiffens) {
    factor *= std::exp(std::min(f.alpha * q, kMostExponent));
    modulus += 2.0 * f.alpha * (s1 * s1 + s2 * s2);
  }
  r.s11 = factor * (a * e11 + b);
  r.s12 = factor * a * e12;
  r.s22 = factor * (a * e22 + b);
  const double stretch = 1.0 + 2.0 * std::max(e1, 0.0);  // λ₁²
  r.squared_tension = stretch * (factor * s1) * (factor * s1);
  r.modulus = factor * (modulus * stretch + s1);
  r.state = slack ? MembraneState::slack : (taut ? MembraneState::taut : MembraneState::wrinkled);
  return q;
}

double energy_of(const MembraneLaw& law, double q) {
  if (!(law.stiffening > 0.0)) return 0.5 * law.stiffness * q;
  return law.stiffness * std::expm1(std::min(law.stiffening * q, kMostExponent)) / (2.0 * law.stiffening);
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
  MembraneResponse r;
  const Factors f(law);
  r.energy =
      energy_of(law, law.stiffening > 0.0 ? respond<true>(f, e11, e12, e22, r) : respond<false>(f, e11, e12, e22, r));
  return r;
}

Membrane::Membrane(std::span<const Triangle> triangles, std::span<const Vec3d> rest, const MembraneLaw& law)
    : law_(law), elements_(triangles.size()), squared_tension_(triangles.size(), 0.0) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Element& e = elements_[t];
    e.corner = triangles[t];
    const Vec3d d1 = rest[e.corner[1]] - rest[e.corner[0]], d2 = rest[e.corner[2]] - rest[e.corner[0]];
    const double twice = norm(cross(d1, d2)), length = norm(d1);
    if (!(twice > 0.0)) continue;
    e.area = 0.5 * twice;
    e.natural_area = e.area / (law.prestretch * law.prestretch);
    // the first edge lies along the first axis
    e.g00 = law.prestretch / length;
    e.g11 = law.prestretch * length / twice;
    e.g01 = -law.prestretch * dot(d1, d2) / (length * twice);
  }
}

void Membrane::set_masses(std::span<const double> masses) {
  masses_.assign(masses.begin(), masses.end());
  sharp_rate_ = kNone;
  std::vector<double> of_vertex(masses.size(), 0.0);
  for (const Element& e : elements_) {
    if (!(e.area > 0.0)) continue;
    const double a = 1.0 / e.g00, c = 1.0 / e.g11, b = -e.g01 * a * c;  // natural edges; their scale does not matter
    const std::array<double, 3> above = diagonal_above(a, b, c);
    for (std::size_t i = 0; i < 3; ++i) of_vertex[e.corner[i]] += above[i];
  }
  for (std::size_t v = 0; v < masses.size(); ++v) of_vertex[v] = masses[v] > 0.0 ? of_vertex[v] / masses[v] : 0.0;
  for (Element& e : elements_) {
    e.rate = std::max({of_vertex[e.corner[0]], of_vertex[e.corner[1]], of_vertex[e.corner[2]]});
  }
}

Membrane::Strain Membrane::strain(const Element& e, const Vec3d& d1, const Vec3d& d2) {
  const double p = dot(d1, d1), q = dot(d1, d2), r = dot(d2, d2);
  return {0.5 * (e.g00 * e.g00 * p - 1.0), 0.5 * e.g00 * (e.g01 * p + e.g11 * q),
          0.5 * (e.g01 * e.g01 * p + 2.0 * e.g01 * e.g11 * q + e.g11 * e.g11 * r - 1.0)};
}

template <bool kStiffens>
void Membrane::add_forces_of(std::span<const Vec3d> positions, std::span<Vec3d> forces) {
  const Factors factors(law_);
  double frequency = 0.0, largest = 0.0, modulus = 0.0;
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Element& e = elements_[t];
    const Vec3d &x0 = positions[e.corner[0]], d1 = positions[e.corner[1]] - x0, d2 = positions[e.corner[2]] - x0;
    const auto [e11, e12, e22] = strain(e, d1, d2);
    MembraneResponse r;
    respond<kStiffens>(factors, e11, e12, e22, r);
    // ∂(A W)/∂(d1 d2) = A (d1 d2) G S Gᵀ
    const double area = e.kept * e.natural_area;
    const double k11 = area * (e.g00 * e.g00 * r.s11 + 2.0 * e.g00 * e.g01 * r.s12 + e.g01 * e.g01 * r.s22);
    const double k12 = area * e.g11 * (e.g00 * r.s12 + e.g01 * r.s22);
    const double k22 = area * e.g11 * e.g11 * r.s22;
    const Vec3d f1 = d1 * k11 + d2 * k12, f2 = d1 * k12 + d2 * k22;
    forces[e.corner[0]] += f1 + f2;
    forces[e.corner[1]] -= f1;
    forces[e.corner[2]] -= f2;
    squared_tension_[t] = area > 0.0 ? r.squared_tension : 0.0;
    frequency = std::max(frequency, area > 0.0 ? r.modulus * e.rate : 0.0);
    modulus = std::max(modulus, r.modulus);
    largest = std::max(largest, squared_tension_[t]);
  }
  squared_frequency_ = std::min(frequency, sharp_rate_ * modulus);
  largest_modulus_ = modulus;
  largest_ = largest;
}

void Membrane::add_forces(std::span<const Vec3d> positions, std::span<Vec3d> forces) {
  if (law_.stiffening > 0.0) {
    add_forces_of<true>(positions, forces);
  } else {
    add_forces_of<false>(positions, forces);
  }
}

double Membrane::energy(std::span<const Vec3d> positions, std::size_t triangle) const {
  const Element& e = elements_[triangle];
  const Vec3d& x0 = positions[e.corner[0]];
  const Strain s = strain(e, positions[e.corner[1]] - x0, positions[e.corner[2]] - x0);
  return e.natural_area * membrane_response(law_, s.e11, s.e12, s.e22).energy;
}

double Membrane::energy(std::span<const Vec3d> positions) const {
  double sum = 0.0;
  for (std::size_t t = 0; t < elements_.size(); ++t) sum += elements_[t].kept * energy(positions, t);
  return sum;
}

MembraneState Membrane::state(std::span<const Vec3d> positions, std::size_t triangle) const {
  const Element& e = elements_[triangle];
  const Vec3d& x0 = positions[e.corner[0]];
  const Strain s = strain(e, positions[e.corner[1]] - x0, positions[e.corner[2]] - x0);
  return membrane_response(law_, s.e11, s.e12, s.e22).state;
}

// |F S| per natural width; per rest width it is 1/λ₀ of that
double Membrane::tension(std::size_t triangle) const { return std::sqrt(squared_tension_[triangle]) / law_.prestretch; }
double Membrane::largest_tension() const { return std::sqrt(largest_) / law_.prestretch; }

}  // namespace glisson

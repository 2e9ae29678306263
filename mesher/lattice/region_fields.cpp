// region_fields.cpp — see region_fields.h.
#include "mesher/lattice/region_fields.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace glisson::lattice {
namespace {

constexpr std::size_t kMostSurfaces = 3;  ///< three surfaces meet in a point

/// The shortest step d with gᵢ·d = −fᵢ for up to three surfaces: d = Gᵀ (G Gᵀ + ε)⁻¹ (−f).
Vec3d shortest_step(const double* f, const Vec3d* g, std::size_t n) {
  if (n == 1) return g[0] * (-f[0] / std::max(dot(g[0], g[0]), 1e-6));
  Mat3d gram = identity<double>();
  Vec3d rhs{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) gram(i, j) = dot(g[i], g[j]);
    gram(i, i) += 1e-3;  // surfaces that nearly touch: a short step rather than a far crossing
    rhs[i] = -f[i];
  }
  const Vec3d weights = inverse(gram) * rhs;
  Vec3d step{};
  for (std::size_t i = 0; i < n; ++i) step += g[i] * weights[i];
  return step;
}

std::size_t hash(std::size_t k, const Vec3d& p) {
  std::uint64_t mixed = k;
  for (const double x : {p.x, p.y, p.z}) {
    mixed = (mixed ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
    mixed ^= mixed >> 32;
  }
  return mixed;
}

}  // namespace

Vec3d RegionFields::gradient(std::size_t k, const Vec3d& p, double edge) const {
  Remembered& known = gradients_[hash(k, p) % kRemembered];
  if (known.k == k && known.edge == edge && known.at == p) return known.gradient;
  const double h = 1e-3 * edge;
  const double a = value(k, p + Vec3d{h, -h, -h}), b = value(k, p + Vec3d{-h, -h, h});
  const double c = value(k, p + Vec3d{-h, h, -h}), d = value(k, p + Vec3d{h, h, h});
  known = {k, edge, p, Vec3d{a - b - c + d, -a - b + c + d, -a + b - c + d} * (0.25 / h)};
  return known.gradient;
}

Label RegionFields::label(const Vec3d& p) const {
  for (std::size_t k = 0; k < count(); ++k) {
    const Bounds& b = regions_[k].bounds;
    const bool near =
        p.x >= b.min.x && p.y >= b.min.y && p.z >= b.min.z && p.x <= b.max.x && p.y <= b.max.y && p.z <= b.max.z;
    if (near && value(k, p) < 0.0) return static_cast<Label>(k);
  }
  return outside();
}

Bounds RegionFields::bounds() const {
  Bounds box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (const BodyRegion& r : regions_) {
    if (r.hole) continue;
    for (std::size_t d = 0; d < 3; ++d) {
      box.min[d] = std::min(box.min[d], r.bounds.min[d]);
      box.max[d] = std::max(box.max[d], r.bounds.max[d]);
    }
  }
  return box;
}

bool RegionFields::reached(const Vec3d& centre, double half) const {
  for (std::size_t r = 0; r < count(); ++r) {
    if (regions_[r].hole) continue;
    const Bounds& b = regions_[r].bounds;
    bool near = true;
    for (std::size_t d = 0; d < 3; ++d) near = near && centre[d] + half >= b.min[d] && centre[d] - half <= b.max[d];
    if (near && value(r, centre) <= 1.7321 * half) return true;
  }
  return false;
}

double RegionFields::project(Vec3d& p, Mask surfaces, double edge) const {
  std::size_t ks[kMostSurfaces], n = 0;
  for (Mask m = surfaces; m && n < kMostSurfaces; m &= m - 1) ks[n++] = static_cast<std::size_t>(std::countr_zero(m));
  double f[kMostSurfaces];
  Vec3d g[kMostSurfaces];
  const double close = 1e-4 * edge;
  double left = 0.0, best = 1e300;
  Vec3d best_at = p;
  for (int i = 0; i < 8; ++i) {
    left = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      f[j] = value(ks[j], p);
      left = std::max(left, std::abs(f[j]));
    }
    if (left < best) {
      best = left;
      best_at = p;
    }
    if (left < close) break;
    if (i == 0 || n > 1 || i > 2) {
      for (std::size_t j = 0; j < n; ++j) g[j] = gradient(ks[j], p, edge);
    }
    Vec3d step = shortest_step(f, g, n);
    const double length = norm(step);
    if (length > 0.5 * edge) step *= 0.5 * edge / length;
    p += step;
  }
  p = best_at;
  return best;
}

double RegionFields::off(const Vec3d& p, Mask surfaces) const {
  double most = 0.0;
  for (Mask m = surfaces; m; m &= m - 1) {
    most = std::max(most, std::abs(value(static_cast<std::size_t>(std::countr_zero(m)), p)));
  }
  return most;
}

std::size_t RegionFields::normals(const Vec3d& p, Mask surfaces, double edge, Vec3d* out, std::size_t capacity) const {
  std::size_t n = 0;
  for (Mask m = surfaces; m && n < capacity; m &= m - 1) {
    const Vec3d g = gradient(static_cast<std::size_t>(std::countr_zero(m)), p, edge);
    const double length = norm(g);
    if (length > 1e-6) out[n++] = g * (1.0 / length);
  }
  return n;
}

}  // namespace glisson::lattice

// capsule_sheets.h — flat sheets of triangles and the rest position of a loaded one, for tests of the capsule.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "instruments/capsule/membrane.h"

namespace glisson {

struct Sheet {
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;
  std::vector<char> is_rim;  ///< per vertex
};

/// The faces of a box along x, 5 cm long, but for its two ends.
inline std::vector<Triangle> skin_of_strip(const TetMesh& mesh) {
  std::vector<Triangle> skin;
  for (const Triangle& t : boundary_triangles(mesh)) {
    const auto on = [&](double x) {
      return std::all_of(t.begin(), t.end(), [&](auto v) { return std::abs(mesh.vertices[v].x - x) < 1e-9; });
    };
    if (!on(0.0) && !on(0.05)) skin.push_back(t);
  }
  return skin;
}

/// A rectangle of n × m cells in the plane z = 0; inner vertices off their place by up to `jitter` cells, diagonals either way.
inline Sheet patch(std::size_t n, std::size_t m, double width, double height, double jitter, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-jitter, jitter);
  Sheet s;
  for (std::size_t j = 0; j <= m; ++j) {
    for (std::size_t i = 0; i <= n; ++i) {
      const bool rim = i == 0 || j == 0 || i == n || j == m;
      const double x = static_cast<double>(i) + (rim ? 0.0 : off(random));
      const double y = static_cast<double>(j) + (rim ? 0.0 : off(random));
      s.vertices.push_back({x * width / static_cast<double>(n), y * height / static_cast<double>(m), 0.0});
      s.is_rim.push_back(rim);
    }
  }
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1;
      const auto d = static_cast<std::uint32_t>(a + n + 1), c = d + 1;
      if (jitter > 0.0 && off(random) > 0.0) {
        s.triangles.push_back({a, b, c}), s.triangles.push_back({a, c, d});
      } else {
        s.triangles.push_back({a, b, d}), s.triangles.push_back({b, c, d});
      }
    }
  }
  return s;
}

/// A disc of radius 1 of `rings` rings about its centre, vertex 0; ring k has 6 k vertices at radius (k/rings)^grading.
inline Sheet disc(std::size_t rings, double grading = 1.0) {
  Sheet s;
  s.vertices.push_back({});
  s.is_rim.push_back(0);
  const auto start = [](std::size_t k) { return k == 0 ? std::size_t{0} : 1 + 3 * k * (k - 1); };
  const auto on_ring = [&](std::size_t k, std::size_t i) {
    return static_cast<std::uint32_t>(k == 0 ? 0 : start(k) + i % (6 * k));
  };
  for (std::size_t k = 1; k <= rings; ++k) {
    const double r = std::pow(static_cast<double>(k) / static_cast<double>(rings), grading);
    for (std::size_t i = 0; i < 6 * k; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(6 * k);
      s.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0.0});
      s.is_rim.push_back(k == rings);
    }
    for (std::size_t sector = 0; sector < 6; ++sector) {
      for (std::size_t i = 0; i < k; ++i) {
        const std::size_t out = sector * k + i, in = sector * (k - 1) + i;
        s.triangles.push_back({on_ring(k - 1, in), on_ring(k, out), on_ring(k, out + 1)});
        if (i + 1 < k) s.triangles.push_back({on_ring(k - 1, in), on_ring(k, out + 1), on_ring(k - 1, in + 1)});
      }
    }
  }
  return s;
}

inline std::vector<Vec3d> forces_of(Membrane& membrane, std::span<const Vec3d> x) {
  std::vector<Vec3d> f(x.size());
  membrane.add_forces(x, f);
  return f;
}

inline double sum_of_products(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/// Brings a sheet under loads to rest, by limited-memory BFGS on its convex energy.
/// @param free  per vertex and axis, 1 or 0 @param tolerance  forces out of balance over the loads or reactions [-]
inline void bring_to_rest(Membrane& membrane, std::vector<Vec3d>& x, const std::vector<Vec3d>& loads,
                          const std::vector<Vec3d>& free, double tolerance = 1e-7, int most = 20000) {
  std::vector<Vec3d> last_x, last_g, g(x.size()), direction;
  std::deque<std::pair<std::vector<Vec3d>, std::vector<Vec3d>>> pairs;  // steps and changes of the gradient
  const auto energy = [&](const std::vector<Vec3d>& at) { return membrane.energy(at) - sum_of_products(loads, at); };
  double before = energy(x);
  for (int iteration = 0; iteration < most; ++iteration) {
    const std::vector<Vec3d> f = forces_of(membrane, x);
    double out = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3d r = f[i] + loads[i];
      g[i] = {-r.x * free[i].x, -r.y * free[i].y, -r.z * free[i].z};
      out = std::max(out, norm(g[i]));
      largest = std::max({largest, norm(loads[i]), norm(f[i])});
    }
    if (out <= tolerance * largest) return;
    if (!last_x.empty()) {
      std::vector<Vec3d> s(x.size()), y(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) s[i] = x[i] - last_x[i], y[i] = g[i] - last_g[i];
      if (sum_of_products(s, y) > 0.0) pairs.emplace_back(std::move(s), std::move(y));
      if (pairs.size() > 30) pairs.pop_front();
    }
    last_x = x, last_g = g, direction = g;
    std::vector<double> along(pairs.size());
    for (std::size_t k = pairs.size(); k-- > 0;) {
      const auto& [s, y] = pairs[k];
      along[k] = sum_of_products(s, direction) / sum_of_products(s, y);
      for (std::size_t i = 0; i < x.size(); ++i) direction[i] -= y[i] * along[k];
    }
    double scale = 1e-3 / std::max(out, 1e-300);
    if (!pairs.empty()) {
      const auto& [s, y] = pairs.back();
      scale = sum_of_products(s, y) / sum_of_products(y, y);
    }
    for (Vec3d& d : direction) d = d * scale;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [s, y] = pairs[k];
      const double b = sum_of_products(y, direction) / sum_of_products(s, y);
      for (std::size_t i = 0; i < x.size(); ++i) direction[i] += s[i] * (along[k] - b);
    }
    const double slope = -sum_of_products(g, direction);
    double step = 1.0;
    bool is_lower = false;
    for (int halving = 0; halving < 40 && !is_lower; ++halving, step *= 0.5) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = last_x[i] - direction[i] * step;
      const double now = energy(x);
      // near the end the energy no longer resolves a step: a relative 1e-14 counts as no rise
      is_lower = now <= before + 1e-4 * step * slope + 1e-14 * std::abs(before);
      if (is_lower) before = now;
    }
    if (!is_lower) {  // start anew along the forces
      x = last_x;
      if (pairs.empty()) break;
      pairs.clear(), last_x.clear();
    }
  }
  throw std::runtime_error("the sheet did not come to rest");
}

}  // namespace glisson

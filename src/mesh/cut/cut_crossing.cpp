#include "mesh/cut/cut_crossing.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace glisson::detail {
namespace {

/// A vector that changes uniformly: v(s) = v₀ + s v₁.
struct Line {
  Vec3d start, rate;
  Vec3d at(double s) const { return start + rate * s; }
};

Line between(const Vec3d& p0, const Vec3d& p1, const Vec3d& q0, const Vec3d& q1) {
  const Vec3d start = q0 - p0;
  return {start, (q1 - p1) - start};
}

struct Cubic {
  std::array<double, 4> c;  // c0 + c1 s + c2 s² + c3 s³
  double operator()(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
};

/// a·(b × c) of three such vectors.
Cubic triple_product(const Line& a, const Line& b, const Line& c) {
  const Vec3d bc0 = cross(b.start, c.start), bc2 = cross(b.rate, c.rate);
  const Vec3d bc1 = cross(b.start, c.rate) + cross(b.rate, c.start);
  return {{dot(a.start, bc0), dot(a.start, bc1) + dot(a.rate, bc0), dot(a.start, bc2) + dot(a.rate, bc1),
           dot(a.rate, bc2)}};
}

/// Root in an interval at whose ends the signs differ, by bisection: 60 halvings use up the digits.
double root_between(const Cubic& f, double low, double high) {
  const bool rising = f(low) < 0.0;
  for (int i = 0; i < 60 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) < 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Where the derivative changes sign within (0, 1), ascending, with both ends.
std::vector<double> monotone_parts(const Cubic& f) {
  std::vector<double> ends{0.0};
  const double a = 3.0 * f.c[3], b = 2.0 * f.c[2], c = f.c[1];
  const double d = b * b - 4.0 * a * c;
  if (d > 0.0) {
    const double q = -0.5 * (b + (b >= 0.0 ? std::sqrt(d) : -std::sqrt(d)));
    std::array<double, 2> roots{a != 0.0 ? q / a : -1.0, q != 0.0 ? c / q : -1.0};
    std::sort(roots.begin(), roots.end());
    for (const double r : roots) {
      if (r > ends.back() && r < 1.0) ends.push_back(r);
    }
  }
  ends.push_back(1.0);
  return ends;
}

}  // namespace

std::optional<Crossing> first_crossing(const MovingSegment& blade, const MovingSegment& edge) {
  const Line A = between(blade.before[0], blade.after[0], blade.before[1], blade.after[1]);
  const Line E = between(edge.before[0], edge.after[0], edge.before[1], edge.after[1]);
  const Line W = between(blade.before[0], blade.after[0], edge.before[0], edge.after[0]);
  const Cubic f = triple_product(A, E, W);
  const std::vector<double> parts = monotone_parts(f);
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    if ((f(parts[i]) < 0.0) == (f(parts[i + 1]) < 0.0)) continue;
    const double s = root_between(f, parts[i], parts[i + 1]);
    const Vec3d a = A.at(s), e = E.at(s), w = W.at(s), n = cross(a, e);
    const double squared = dot(n, n);
    if (!(squared > 0.0)) continue;
    const double on_blade = dot(cross(w, e), n) / squared, on_edge = dot(cross(w, a), n) / squared;
    if (on_blade < 0.0 || on_blade > 1.0 || on_edge < 0.0 || on_edge > 1.0) continue;
    return Crossing{s, on_edge};
  }
  return std::nullopt;
}

}  // namespace glisson::detail

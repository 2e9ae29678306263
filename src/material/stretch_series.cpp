// stretch_series.cpp — the coefficients of stretch_series.h, how far they hold and how stiff tissue is there.
#include "material/stretch_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "material/stiffness_bound.h"

namespace glisson {
namespace {

using Coefficients = StretchSeries<>::Coefficients;

/// A power series of J₂ and J₃ without the powers of X above kOrder.
struct Series {
  Coefficients c{};

  static Series constant(double value) {
    Series s;
    s.c[0][0] = value;
    return s;
  }
  template <class Visit>
  static void visit_terms(Visit visit) {
    for (std::size_t j = 0; j < StretchSeries<>::kPowers.size(); ++j) {
      for (std::size_t i = 0; i < StretchSeries<>::kPowers[j]; ++i) visit(j, i);
    }
  }
  Series& add(const Series& b, double factor) {
    visit_terms([&](std::size_t j, std::size_t i) { c[j][i] += factor * b.c[j][i]; });
    return *this;
  }
  Series times(const Series& b) const {
    Series out;
    visit_terms([&](std::size_t j, std::size_t i) {
      visit_terms([&](std::size_t l, std::size_t k) {
        if (j + l < StretchSeries<>::kPowers.size() && i + k < StretchSeries<>::kPowers[j + l]) {
          out.c[j + l][i + k] += c[j][i] * b.c[l][k];
        }
      });
    });
    return out;
  }
};

/// (1 + y)^a of a series y without a constant.
Series power(const Series& y, double a) {
  Series sum = Series::constant(1.0), product = sum;
  double binomial = 1.0;
  for (std::size_t n = 1; 2 * n <= StretchSeries<>::kOrder; ++n) {
    product = product.times(y), binomial *= (a - double(n - 1)) / double(n);
    sum.add(product, binomial);
  }
  return sum;
}

/// Adds 2 μ/α det(I + X)^(−a/3) times what X and X² have in (I + X)^a, a = α/2.
void add_term(double mu, double alpha, StretchSeries<>& out) {
  Series J2, J3;
  J2.c[0][1] = 1.0, J3.c[1][0] = 1.0;
  const double a = 0.5 * alpha;
  Series first, second, two_back, one_back, at = Series::constant(1.0);  // α_(n−2), α_(n−1), α_n of n = 2
  first.c[0][0] = a;
  double binomial = a;
  for (std::size_t n = 2; n <= StretchSeries<>::kOrder + 2; ++n) {
    binomial *= (a - double(n - 1)) / double(n);
    second.add(at, binomial);
    const Series next = J2.times(one_back).add(J3.times(two_back), 1.0);  // α_(n+1)
    first.add(next, binomial);
    two_back = one_back, one_back = at, at = next;
  }
  const Series isochoric = power(Series(J3).add(J2, -1.0), -a / 3.0);
  out.first = Series{out.first}.add(first.times(isochoric), 2.0 * mu / alpha).c;
  out.second = Series{out.second}.add(second.times(isochoric), 2.0 * mu / alpha).c;
}

/// Eigenvalues of X of all shapes, from one long axis to one short axis.
template <class Visit>
void visit_shapes(double delta, Visit visit) {
  constexpr int kShapes = 24;
  for (int k = 0; k <= kShapes; ++k) {
    const double angle = std::numbers::pi / 3.0 * double(k) / double(kShapes), turn = 2.0 * std::numbers::pi / 3.0;
    visit(
        std::array<double, 3>{delta * std::cos(angle), delta * std::cos(angle + turn), delta * std::cos(angle - turn)});
  }
}

/// How far the series are from the law, over Σ |μ| δ.
double error_at(const Ogden& law, const StretchSeries<>& series, double delta) {
  double most = 0.0, scale = 0.0;
  for (const double mu : law.mu) scale += std::abs(mu) * delta;
  visit_shapes(delta, [&](const std::array<double, 3>& x) {
    const std::array<double, 3> l{0.5 * std::log1p(x[0]), 0.5 * std::log1p(x[1]), 0.5 * std::log1p(x[2])};
    const double mean = (l[0] + l[1] + l[2]) / 3.0;
    const std::array<double, 3> t = law.slopes(std::array<double, 3>{l[0] - mean, l[1] - mean, l[2] - mean});
    const double J2 = 0.75 * delta * delta, J3 = x[0] * x[1] * x[2];
    const double q1 = series_at(series.first, J2, J3), q2 = series_at(series.second, J2, J3);
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = q1 * x[i] + q2 * (x[i] * x[i] - 2.0 / 3.0 * J2);
      most = std::max(most, std::abs(sum - t[i]) / scale);
    }
  });
  return most;
}

/// λ_max of the tangent of the isochoric part where m = 1 [Pa].
double stiffness_at(const Ogden& law, const std::array<double, 3>& x) {
  const auto stretch = [&](std::size_t i) { return std::sqrt(1.0 + x[i]) - 1.0; };
  return stretch_bound(law, {stretch(0), stretch(1), stretch(2)});
}

/// b₁ is the slope of the tangent's largest eigenvalue at rest, b₃ the difference of its bend between one long axis and one
/// short axis, and b₂ what the states up to δ = `largest` need.
/// @return how far the bound is above the eigenvalue, as a factor
double set_bound(const Ogden& law, double largest, StretchSeries<>& out) {
  const double rest = stiffness_at(law, {0.0, 0.0, 0.0});
  double mean = 0.0;
  for (std::size_t k = 0; k < law.mu.size(); ++k) mean += 0.5 * law.mu[k] * law.alpha[k] / law.shear_modulus();
  const double slope = 0.5 * std::abs(mean - 1.5), square = largest * largest;
  const double along = stiffness_at(law, {largest, -0.5 * largest, -0.5 * largest}) / rest;
  const double across = stiffness_at(law, {0.5 * largest, 0.5 * largest, -largest}) / rest;
  const double shape = 2.0 * (along - across) / square;  // J₃/δ is ±¼ δ² there
  const auto visit_states = [&](auto visit) {
    constexpr int kRadii = 16;
    for (int n = 1; n <= kRadii; ++n) {
      const double delta = largest * double(n) / double(kRadii);
      visit_shapes(delta, [&](const std::array<double, 3>& x) {
        const double known = 1.0 + slope * delta + shape * x[0] * x[1] * x[2] / delta;
        visit(stiffness_at(law, x) / rest, known, delta * delta);
      });
    }
  };
  double bend = 0.0, most = 1.0;
  visit_states([&](double exact, double known, double squared) { bend = std::max(bend, (exact - known) / squared); });
  bend *= 1.05;  // for states between those
  visit_states(
      [&](double exact, double known, double squared) { most = std::max(most, (known + bend * squared) / exact); });
  out.bound = {rest, rest * slope, rest * bend, rest * shape};
  return most;
}

}  // namespace

template <>
StretchSeries<float> StretchSeries<>::rounded() const {
  StretchSeries<float> out;
  for (std::size_t j = 0; j < kPowers.size(); ++j) {
    for (std::size_t i = 0; i < kPowers[j]; ++i) {
      out.first[j][i] = float(first[j][i]), out.second[j][i] = float(second[j][i]);
    }
  }
  out.largest_J2 = float(largest_J2);
  for (std::size_t k = 0; k < bound.size(); ++k) out.bound[k] = float(bound[k]);
  return out;
}

StretchSeries<> stretch_series(const Ogden& law) {
  StretchSeries<> out;
  for (std::size_t k = 0; k < law.mu.size(); ++k) add_term(law.mu[k], law.alpha[k], out);
  constexpr double kMostError = 1e-7, kLoosest = 1.2, kFarthest = 0.5, kNearest = 1e-3, kCloser = 0.9;
  for (double delta = kFarthest; delta > kNearest; delta *= kCloser) {
    if (error_at(law, out, delta) <= kMostError && set_bound(law, delta, out) <= kLoosest) {
      out.largest_J2 = 0.75 * delta * delta;
      return out;
    }
  }
  return out;
}

}  // namespace glisson

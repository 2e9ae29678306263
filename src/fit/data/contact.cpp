#include "fit/data/contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "fit/data/smooth.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kFewestAtRest = 5, kInARow = 5, kFewestRows = 12;
// Up to where the parabola is fitted: farther, noise weighs less and stiffening more.
constexpr double kPartOfRise = 0.03, kDeviations = 20.0;

/// First row from which the force stays above a level for five rows; the number of rows where none does.
std::size_t first_above(std::span<const double> f, double level) {
  std::size_t run = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    run = f[i] > level ? run + 1 : 0;
    if (run == kInARow) return i + 1 - kInARow;
  }
  return f.size();
}

struct Bent {
  double squares = std::numeric_limits<double>::infinity();
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();  ///< b, k₁, k₂
};

/// Flat to x_c, a parabola from there on.
class BentFit {
 public:
  BentFit(std::span<const double> x, std::span<const double> f) : x_(x), f_(f), width_(x.back() - x.front()) {}

  Bent at(double touch) const {
    Bent fit = solve(touch, true);
    return fit.coefficients[1] >= 0.0 ? fit : solve(touch, false);
  }

 private:
  Bent solve(double touch, bool linear) const {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Eigen::Vector3d row = basis(x_[i], touch, linear);
      normal += row * row.transpose();
      right += f_[i] * row;
    }
    if (!linear) normal(1, 1) = 1.0;
    Bent fit;
    fit.coefficients = normal.ldlt().solve(right);
    fit.squares = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double r = f_[i] - fit.coefficients.dot(basis(x_[i], touch, linear));
      fit.squares += r * r;
    }
    return fit;
  }
  Eigen::Vector3d basis(double x, double touch, bool linear) const {
    const double u = std::max(0.0, x - touch) / width_;
    return {1.0, linear ? u : 0.0, u * u};
  }

  std::span<const double> x_, f_;
  double width_;
};

/// Least of a function between two points, by the golden section.
double least_between(const std::function<double(double)>& f, double a, double b) {
  constexpr double kGolden = 0.6180339887498949;
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a), fc = f(c), fd = f(d);
  for (int i = 0; i < 60 && b - a > 0.0; ++i) {
    if (fc < fd) {
      b = d;
      d = c;
      fd = fc;
      c = b - kGolden * (b - a);
      fc = f(c);
    } else {
      a = c;
      c = d;
      fc = fd;
      d = a + kGolden * (b - a);
      fd = f(d);
    }
  }
  return 0.5 * (a + b);
}

/// Distance from the optimum, on one side, at which the sum of squares has grown to a level.
double reach(const std::function<double(double)>& f, double from, double end, double level) {
  if (f(end) < level) return std::abs(end - from);
  double inside = from, outside = end;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + outside);
    (f(middle) < level ? inside : outside) = middle;
  }
  return std::abs(inside - from);
}

std::optional<Contact> bent_contact(std::span<const double> x, std::span<const double> f) {
  constexpr int kGrid = 200;
  const BentFit fit(x, f);
  const auto squares = [&](double touch) { return fit.at(touch).squares; };
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double step = (*high - *low) / kGrid;
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kGrid - 2; ++i) {
    const double s = squares(*low + i * step);
    if (s < least) {
      least = s;
      best = i;
    }
  }
  const double touch = least_between(squares, *low + (best - 1) * step, *low + (best + 1) * step);
  const Bent found = fit.at(touch);
  const double level = found.squares * (1.0 + 1.0 / static_cast<double>(x.size() - 4));
  Contact contact{.at = touch, .rest_force = found.coefficients[0]};
  contact.deviation = 0.5 * (reach(squares, touch, *low, level) + reach(squares, touch, *high - 2 * step, level));
  contact.before = static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < touch; }));
  return contact;
}

/// The parabola through the first rows, carried to F = 0; its deviation by that of the fitted force there.
std::optional<Contact> extrapolated_contact(std::span<const double> x, std::span<const double> f, double noise) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const double width = x.back() - x.front();
  Eigen::MatrixX3d powers(n, 3);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = (x[static_cast<std::size_t>(i)] - x.front()) / width;
    powers.row(i) << 1.0, u, u * u;
    force[i] = f[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d inverse = (powers.transpose() * powers).inverse();
  const Eigen::Vector3d a = inverse * (powers.transpose() * force);
  double u = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double slope = a[1] + 2.0 * a[2] * u;
    if (!(slope > 0.0)) return std::nullopt;
    u -= (a[0] + a[1] * u + a[2] * u * u) / slope;
  }
  const double slope = a[1] + 2.0 * a[2] * u;
  if (!(slope > 0.0) || !std::isfinite(u) || std::abs(u) > 1.0) return std::nullopt;
  const Eigen::Vector3d row(1.0, u, u * u);
  Contact contact{.at = x.front() + u * width, .extrapolated = true};
  contact.deviation = noise * std::sqrt(row.dot(inverse * row)) / slope * width;
  contact.before =
      static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < contact.at; }));
  return contact;
}

}  // namespace

namespace {

/// Rows up to the largest force.
std::size_t loading_of(std::span<const double> f) {
  return static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin()) + 1;
}

double noise_of(std::span<const double> f) {
  std::vector<double> rows(f.size());
  std::iota(rows.begin(), rows.end(), 0.0);
  return noise_about_curve(rows, f);
}

}  // namespace

std::optional<Contact> find_contact(std::span<const double> x, std::span<const double> f, double threshold) {
  if (x.size() < kFewestRows) return std::nullopt;
  const std::size_t loading = loading_of(f);
  if (loading < kFewestRows) return std::nullopt;
  x = x.first(loading);
  f = f.first(loading);
  const double noise = noise_of(f);
  const std::size_t head = std::clamp<std::size_t>(loading / 50, kFewestAtRest, 50);
  const double rest = median_of({f.begin(), f.begin() + static_cast<std::ptrdiff_t>(head)});
  const double rise = f.back() - rest;
  const std::size_t risen = first_above(f, rest + threshold * noise);
  if (risen == f.size() || !(rise > threshold * noise)) return std::nullopt;
  const std::size_t upper = first_above(f, rest + std::max(kPartOfRise * rise, kDeviations * noise));
  const std::size_t end = std::min(loading, std::max({upper, risen + kFewestRows, kFewestRows}));
  if (!(x[end - 1] > x.front())) return std::nullopt;
  std::optional<Contact> contact;
  if (risen >= 2 * kFewestAtRest) contact = bent_contact(x.first(end), f.first(end));
  if (!contact || contact->before < kFewestAtRest) contact = extrapolated_contact(x.first(end), f.first(end), noise);
  if (contact) contact->first_force = rest;
  return contact;
}

std::optional<Contact> contact_from(std::span<const double> x, std::span<const double> f, const Contact& own,
                                    double preload) {
  const std::size_t loading = loading_of(f);
  std::vector<double> force(f.begin(), f.begin() + static_cast<std::ptrdiff_t>(loading));
  for (double& value : force) value -= own.rest_force;
  const double noise = noise_of(force);
  const std::size_t from = first_above(force, preload);
  const std::size_t upper = first_above(force, preload + std::max(kPartOfRise * force.back(), kDeviations * noise));
  const std::size_t end = std::min(loading, std::max(upper, from + kFewestRows));
  if (from >= end || end - from < kFewestRows) return std::nullopt;
  auto contact = extrapolated_contact(x.subspan(from, end - from), std::span(force).subspan(from, end - from), noise);
  if (!contact) return std::nullopt;
  contact->rest_force = own.rest_force, contact->first_force = own.first_force;
  contact->before =
      static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < contact->at; }));
  return contact;
}

}  // namespace glisson::fit

#include "fit/data/bent_line.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "fit/algebra/decompositions.h"

namespace glisson::fit {
namespace {

/// The least squares at a given touch. @tparam Columns  3: at rest before it; 4: with a slope
template <int Columns>
class BentFit {
 public:
  using Vector = Eigen::Matrix<double, Columns, 1>;
  using Matrix = Eigen::Matrix<double, Columns, Columns>;

  struct Solution {
    double squares = std::numeric_limits<double>::infinity();
    Vector coefficients = Vector::Zero();  ///< b, k₁, k₂, s over the width
    Matrix normal = Matrix::Zero();
  };

  BentFit(std::span<const double> x, std::span<const double> f) : x_(x), f_(f), width_(x.back() - x.front()) {}

  Solution at(double touch) const {
    Solution fit = solve(touch, true);
    return fit.coefficients[1] >= 0.0 ? fit : solve(touch, false);
  }
  double width() const { return width_; }

 private:
  Solution solve(double touch, bool linear) const {
    Solution fit;
    Vector right = Vector::Zero();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Vector row = basis(x_[i], touch, linear);
      fit.normal += row * row.transpose();
      right += f_[i] * row;
    }
    if (!linear) fit.normal(1, 1) = 1.0;
    fit.coefficients = fit.normal.ldlt().solve(right);
    fit.squares = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double r = f_[i] - fit.coefficients.dot(basis(x_[i], touch, linear));
      fit.squares += r * r;
    }
    return fit;
  }
  Vector basis(double x, double touch, bool linear) const {
    const double u = std::max(0.0, x - touch) / width_;
    Vector row;
    row[0] = 1.0, row[1] = linear ? u : 0.0, row[2] = u * u;
    if constexpr (Columns == 4) row[3] = (x - touch) / width_;
    return row;
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

template <int Columns>
BentLine best_bent(std::span<const double> x, std::span<const double> f) {
  constexpr int kGrid = 200;
  const BentFit<Columns> fit(x, f);
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
  BentLine out;
  out.touch = least_between(squares, *low + (best - 1) * step, *low + (best + 1) * step);
  const auto found = fit.at(out.touch);
  out.level = found.coefficients[0];
  out.squares = found.squares;
  const double variance = found.squares / static_cast<double>(x.size() - (Columns + 1)),
               level = found.squares + variance;
  out.deviation = 0.5 * (reach(squares, out.touch, *low, level) + reach(squares, out.touch, *high - 2 * step, level));
  out.before = static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < out.touch; }));
  if constexpr (Columns == 4) {
    const typename BentFit<Columns>::Vector one = BentFit<Columns>::Vector::Unit(3);
    out.slope = found.coefficients[3] / fit.width();
    out.slope_deviation = std::sqrt(variance * std::max(0.0, found.normal.ldlt().solve(one)[3])) / fit.width();
  }
  return out;
}

}  // namespace

BentLine bent_line(std::span<const double> x, std::span<const double> f, bool sloped) {
  return sloped ? best_bent<4>(x, f) : best_bent<3>(x, f);
}

double evidence_of_bend(std::span<const double> x, std::span<const double> f, const BentLine& bent) {
  constexpr Eigen::Index kNumbers = 5;  // b, s, k₁, k₂ and the touch; of a quartic as many
  const auto n = static_cast<Eigen::Index>(x.size());
  const double middle = 0.5 * (x.front() + x.back()), half = 0.5 * (x.back() - x.front());
  Eigen::MatrixXd powers(n, kNumbers);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = (x[static_cast<std::size_t>(i)] - middle) / half;
    powers(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < kNumbers; ++k) powers(i, k) = powers(i, k - 1) * u;
  }
  const Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(f.data(), n);
  const double smooth = (powers * least_squares(powers, force) - force).squaredNorm();
  const double least = std::numeric_limits<double>::min();
  return 0.5 * static_cast<double>(n) * std::log(std::max(smooth, least) / std::max(bent.squares, least));
}

}  // namespace glisson::fit

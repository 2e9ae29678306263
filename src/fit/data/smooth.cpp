#include "fit/data/smooth.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fit/algebra/decompositions.h"

namespace glisson::fit {
namespace {

/// Row `at` of the projection onto polynomials over the points of a window.
Eigen::VectorXd weights(std::span<const double> x, std::size_t at, std::size_t degree) {
  const auto n = static_cast<Eigen::Index>(x.size()), m = static_cast<Eigen::Index>(degree + 1);
  const double width = std::max(x.back() - x.front(), 1e-300);
  Eigen::MatrixXd powers(n, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = (x[static_cast<std::size_t>(i)] - x[at]) / width;
    powers(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < m; ++k) powers(i, k) = powers(i, k - 1) * u;
  }
  const Eigen::MatrixXd q = QrFactor(powers).thin();
  return q * q.row(static_cast<Eigen::Index>(at)).transpose();
}

/// Weights of the last window, which serve again where the next one has the same spacing.
class Window {
 public:
  const Eigen::VectorXd& at(std::span<const double> x, std::size_t at, std::size_t degree) {
    if (!same_spacing(x, at)) {
      weights_ = weights(x, at, degree);
      last_ = x;
      at_ = at;
    }
    return weights_;
  }

 private:
  bool same_spacing(std::span<const double> x, std::size_t at) const {
    if (last_.size() != x.size() || at_ != at) return false;
    const double tolerance = 1e-9 * (x.back() - x.front());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(std::abs((x[i] - x[0]) - (last_[i] - last_[0])) <= tolerance)) return false;
    }
    return true;
  }

  std::span<const double> last_;
  std::size_t at_ = 0;
  Eigen::VectorXd weights_;
};

}  // namespace

LocalFit local_fit(std::span<const double> x, std::span<const double> y, std::size_t half_width, std::size_t degree) {
  const std::size_t n = x.size(), width = std::min(2 * half_width + 1, n);
  LocalFit fit{std::vector<double>(y.begin(), y.end()), std::vector<double>(n, 1.0)};
  if (width <= degree) return fit;
  Window window;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = std::min(i - std::min(i, half_width), n - width);
    const Eigen::VectorXd& w = window.at(x.subspan(first, width), i - first, degree);
    double value = 0.0;
    for (std::size_t k = 0; k < width; ++k) value += w[static_cast<Eigen::Index>(k)] * y[first + k];
    fit.values[i] = value;
    fit.leverage[i] = w[static_cast<Eigen::Index>(i - first)];
  }
  return fit;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<double> running_median(std::span<const double> y, std::size_t half_width) {
  std::vector<double> result(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const std::size_t first = i - std::min(i, half_width), last = std::min(i + half_width + 1, y.size());
    result[i] =
        median_of({y.begin() + static_cast<std::ptrdiff_t>(first), y.begin() + static_cast<std::ptrdiff_t>(last)});
  }
  return result;
}

namespace {

std::vector<double> free_residuals(std::span<const double> x, std::span<const double> y) {
  constexpr std::size_t kHalfWidth = 7, kDegree = 2;
  const LocalFit fit = local_fit(x, y, kHalfWidth, kDegree);
  std::vector<double> residuals;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double free = 1.0 - fit.leverage[i];
    residuals.push_back(free > 1e-9 ? std::abs(y[i] - fit.values[i]) / std::sqrt(free) : 0.0);
  }
  return residuals;
}

/// Puts the mean of its neighbours in place of a point that stands out by more than a limit. @return whether there was one
bool take_out_spikes(std::vector<double>& y, const std::vector<double>& residuals, double limit) {
  constexpr std::size_t kNear = 3;
  bool any = false;
  for (std::size_t i = 1; i + 1 < y.size(); ++i) {
    const auto first = residuals.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, kNear));
    const auto last = residuals.begin() + static_cast<std::ptrdiff_t>(std::min(i + kNear + 1, y.size()));
    if (!(residuals[i] > limit) || *std::max_element(first, last) > residuals[i]) continue;
    y[i] = 0.5 * (y[i - 1] + y[i + 1]);
    any = true;
  }
  return any;
}

}  // namespace

double noise_about_curve(std::span<const double> x, std::span<const double> y) {
  constexpr std::size_t kFewest = 7;
  constexpr double kSpike = 5.0;
  constexpr int kPasses = 4;
  if (x.size() < kFewest) return 0.0;
  std::vector<double> clean(y.begin(), y.end());
  double noise = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<double> residuals = free_residuals(x, clean);
    noise = 1.4826 * median_of(residuals);
    if (!(noise > 0.0) || !take_out_spikes(clean, residuals, kSpike * noise)) break;
  }
  return noise;
}

}  // namespace glisson::fit

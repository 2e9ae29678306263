#include "fit/uncertainty/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/algebra/decompositions.h"
#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kPlaces = 12,
              kLooks = 4;          // places looked at along w and φ, and how often between the neighbours of the best
constexpr double kShortest = 0.3;  // of the lengths −1/ln φ that are tried [samples]
constexpr double kLeast = std::numeric_limits<double>::min();

double phi_of(double length) { return std::exp(-1.0 / length); }

/// Where a search looks: between two ends, closer with every round.
struct Span {
  double low, high;
  double at(int i) const { return low + (high - low) * i / (kPlaces - 1); }
  void close_in(double best) {
    const double step = (high - low) / (kPlaces - 1);
    low = std::max(low, best - step), high = std::min(high, best + step);
  }
};

double product_at(std::span<const double> x, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
  return sum;
}

/// Autocorrelation of a series about zero: ρ_k = Σ_i x_i x_{i+k} / Σ_i x_i², k = 0 … lags (fewer where the series is shorter).
/// About zero, not about the mean: a curve that lies off as a whole is one sample, not many.
std::vector<double> autocorrelation(std::span<const double> series, std::size_t lags) {
  const std::size_t n = series.size();
  std::vector<double> rho(n == 0 ? 0 : std::min(lags, n - 1) + 1, 0.0);
  for (std::size_t k = 0; k < rho.size(); ++k) rho[k] = product_at(series, k);
  if (rho.empty() || rho[0] == 0.0) return std::vector<double>(rho.size(), 0.0);
  const double squares = rho[0];
  for (double& r : rho) r /= squares;
  return rho;
}

}  // namespace

ResidualCorrelation::ResidualCorrelation(const Vector& residuals, const Matrix& jacobian,
                                         std::span<const Rows> curves) {
  Matrix columns(residuals.size(), jacobian.cols() + 1);
  columns << jacobian, residuals;
  double longest = 2.0 * kShortest;
  for (const Rows& curve : curves) longest = std::max(longest, static_cast<double>(curve.size));
  // p shapes that the fit takes out of a curve leave swings that change sign p times or more
  longest /=
      2.0 * (1.0 + static_cast<double>(jacobian.cols()) / static_cast<double>(std::max<std::size_t>(curves.size(), 1)));
  Span white{0.0, 1.0}, length{std::log(kShortest), std::log(std::max(longest, 2.0 * kShortest))};
  double most = -std::numeric_limits<double>::infinity();
  ResidualCorrelation best;
  double best_length = length.low;
  for (int round = 0; round < kLooks; ++round) {
    for (int k = 0; k < kPlaces * kPlaces; ++k) {
      ResidualCorrelation tried;
      tried.white_ = white.at(k % kPlaces), tried.phi_ = phi_of(std::exp(length.at(k / kPlaces)));
      const double likelihood = tried.likelihood(columns, curves, tried.variance_);
      if (likelihood > most) most = likelihood, best = tried, best_length = length.at(k / kPlaces);
    }
    white.close_in(best.white_), length.close_in(best_length);
  }
  *this = best;
}

/// Replaces the rows of a curve by L⁻¹ times them, V = L Lᵀ. @return ln |V|
double ResidualCorrelation::whiten(Matrix& columns, const Rows& curve) const {
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(columns.cols());
  const double slow = 1.0 - white_;
  double spread = slow, determinant = 0.0;
  for (Eigen::Index i = curve.first; i < curve.first + curve.size; ++i) {
    const double variance = std::max(spread + white_, kLeast), gain = spread / variance;
    const Eigen::RowVectorXd innovation = columns.row(i) - mean;
    mean = phi_ * (mean + gain * innovation);
    spread = phi_ * phi_ * spread * (1.0 - gain) + (1.0 - phi_ * phi_) * slow;
    columns.row(i) = innovation / std::sqrt(variance);
    determinant += std::log(variance);
  }
  return determinant;
}

/// 2 ln of the restricted likelihood but for a constant; −∞ where it cannot be said.
double ResidualCorrelation::likelihood(const Matrix& columns, std::span<const Rows> curves, double& variance) const {
  Matrix whitened = Matrix::Zero(columns.rows(), columns.cols());
  double determinant = 0.0, samples = 0.0;
  for (const Rows& curve : curves) {
    whitened.middleRows(curve.first, curve.size) = columns.middleRows(curve.first, curve.size);
    determinant += whiten(whitened, curve);
    samples += static_cast<double>(curve.size);
  }
  const Eigen::Index p = columns.cols() - 1;
  const Matrix square = whitened.transpose() * whitened;
  double squares = square(p, p);
  const double left = samples - static_cast<double>(p);
  if (p > 0) {
    const auto projected = solve_definite(square.topLeftCorner(p, p), square.col(p).head(p));
    if (!projected) return -std::numeric_limits<double>::infinity();
    squares -= square.col(p).head(p).dot(projected->x);
    determinant += projected->log_determinant;
  }
  variance = left > 0.0 ? std::max(squares, 0.0) / left : 0.0;
  return -determinant - left * std::log(std::max(variance, kLeast));
}

double ResidualCorrelation::time(Eigen::Index size) const {
  double sum = 1.0, power = 1.0;
  for (Eigen::Index lag = 1; lag < size; ++lag) {
    power *= phi_;
    sum += 2.0 * (1.0 - white_) * power * (1.0 - static_cast<double>(lag) / static_cast<double>(size));
  }
  return sum;
}

Matrix ResidualCorrelation::times(const Matrix& x, std::span<const Rows> curves) const {
  Matrix out = Matrix::Zero(x.rows(), x.cols());
  for (const Rows& curve : curves) {
    const Eigen::Index end = curve.first + curve.size;
    Eigen::RowVectorXd before = Eigen::RowVectorXd::Zero(x.cols()), after = before;
    for (Eigen::Index i = curve.first; i < end; ++i) {
      out.row(i) = x.row(i) + (1.0 - white_) * before;
      before = phi_ * (before + x.row(i));
    }
    for (Eigen::Index i = end; i-- > curve.first;) {
      out.row(i) += (1.0 - white_) * after;
      after = phi_ * (after + x.row(i));
    }
  }
  return out;
}

double ResidualCorrelation::freedom(const Matrix& jacobian, const Matrix& inverse, std::span<const Rows> curves) const {
  double trace = 0.0, squares = 0.0;
  for (const Rows& curve : curves) {
    const auto n = static_cast<double>(curve.size);
    double power = 1.0;
    trace += n, squares += n;
    for (Eigen::Index lag = 1; lag < curve.size; ++lag) {
      power *= phi_;
      squares += 2.0 * (n - static_cast<double>(lag)) * std::pow((1.0 - white_) * power, 2);
    }
  }
  const Matrix v_j = times(jacobian, curves), taken = inverse * (jacobian.transpose() * v_j);
  const double mean = trace - taken.trace();
  const double scatter = squares - 2.0 * (inverse * (v_j.transpose() * v_j)).trace() + (taken * taken).trace();
  return std::max(mean * mean / std::max(scatter, kLeast), 1.0);
}

double independence_probability(const std::vector<std::vector<double>>& series) {
  double sum = 0.0, freedom = 0.0;
  for (const std::vector<double>& x : series) {
    const auto n = static_cast<double>(x.size());
    const std::vector<double> rho = autocorrelation(x, std::min<std::size_t>(10, x.size() / 5));
    for (std::size_t k = 1; k < rho.size(); ++k) sum += n * (n + 2.0) * rho[k] * rho[k] / (n - static_cast<double>(k));
    freedom += rho.size() > 1 ? static_cast<double>(rho.size() - 1) : 0.0;
  }
  return freedom > 0.0 ? chi_squared_tail(sum, freedom) : 1.0;
}

}  // namespace glisson::fit

#include "fit/uncertainty/covariance.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/algebra/decompositions.h"
#include "fit/uncertainty/distribution.h"
#include "fit/uncertainty/noise.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

std::vector<std::size_t> free_parameters(const Covariance& c) {
  std::vector<std::size_t> free;
  for (std::size_t p = 0; p < c.hold.size(); ++p) {
    if (c.hold[p] == Hold::free) free.push_back(p);
  }
  return free;
}

void hold_at_bounds(Covariance& c, double tolerance) {
  for (const double z : c.scaled)
    c.hold.push_back(z <= tolerance ? Hold::at_low : z >= 1.0 - tolerance ? Hold::at_high : Hold::free);
}

/// Singular directions of J, weakest first.
struct Split {
  Matrix vectors;  ///< free parameters × directions, weakest first
  Vector singular;
  Eigen::Index weak = 0;  ///< the first so many are not determined

  Split(const Matrix& jacobian, double tolerance) {
    const SingularDirections all = singular_directions(jacobian);
    vectors = all.vectors.rowwise().reverse();
    singular = all.values.reverse();
    const double least = tolerance * singular[singular.size() - 1];
    while (weak < singular.size() && (singular[weak] <= least || singular[weak] == 0.0)) ++weak;
  }
  Matrix strong() const { return vectors.rightCols(vectors.cols() - weak); }
  /// (JᵀJ)⁻¹ in the coordinates of strong().
  Matrix inverse() const {
    return singular.tail(singular.size() - weak).array().square().inverse().matrix().asDiagonal();
  }
};

void fill_directions(Covariance& c, const Split& split, const std::vector<std::size_t>& free, const Matrix& spread) {
  for (Eigen::Index k = 0; k < split.singular.size(); ++k) {
    Direction d;
    d.vector.assign(c.parameters(), 0.0);
    // signs are free: the largest component counts as positive
    Eigen::Index largest = 0;
    split.vectors.col(k).cwiseAbs().maxCoeff(&largest);
    const double sign = split.vectors(largest, k) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < free.size(); ++i)
      d.vector[free[i]] = sign * split.vectors(static_cast<Eigen::Index>(i), k);
    d.singular = split.singular[k];
    d.determined = k >= split.weak;
    d.sd = d.determined ? std::sqrt(spread(k - split.weak, k - split.weak)) : kInfinity;
    c.directions.push_back(std::move(d));
  }
}

/// Correlations with the weakest directions kept, at the least weight that differences can see.
Matrix correlation_of(const Split& split, const Matrix& strong_covariance, double variance) {
  Matrix full = split.strong() * strong_covariance * split.strong().transpose();
  const double top = split.singular[split.singular.size() - 1];
  for (Eigen::Index k = 0; k < split.weak; ++k) {
    const double weight = std::max({split.singular[k], 1e-9 * top, std::numeric_limits<double>::min()});
    full += variance / (weight * weight) * split.vectors.col(k) * split.vectors.col(k).transpose();
  }
  const Vector root = full.diagonal().array().max(std::numeric_limits<double>::min()).sqrt().inverse();
  return root.asDiagonal() * full * root.asDiagonal();
}

void fill_parameters(Covariance& c, const Split& split, const std::vector<std::size_t>& free, const Matrix& strong,
                     const Matrix& independent) {
  const Matrix v = split.strong(), full = v * strong * v.transpose(), plain = v * independent * v.transpose();
  const Matrix correlation = correlation_of(split, strong, c.noise.variance);
  const std::size_t n = c.parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::size_t p = free[i];
    const double part = split.weak == 0 ? 0.0 : split.vectors.leftCols(split.weak).row(row).norm();
    c.determined[p] = part < kTakesPart ? 1 : 0;
    c.sd[p] = c.determined[p] != 0 ? std::sqrt(full(row, row)) : kInfinity;
    c.inflation[p] = plain(row, row) > 0.0 ? full(row, row) / plain(row, row) : 1.0;
    for (std::size_t j = 0; j < free.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      c.matrix[p * n + free[j]] = full(row, column);
      c.correlation[p * n + free[j]] = i == j ? 1.0 : std::clamp(correlation(row, column), -1.0, 1.0);
    }
  }
}

void fill_intervals(Covariance& c, const Problem& problem) {
  std::vector<double> low = c.scaled, high = c.scaled;
  for (std::size_t p = 0; p < c.parameters(); ++p) {
    const double half = c.hold[p] == Hold::free ? c.quantile * c.sd[p] : kInfinity;
    low[p] -= half;
    high[p] += half;
  }
  const std::vector<double> values_low = problem.to_values(low), values_high = problem.to_values(high);
  for (std::size_t p = 0; p < c.parameters(); ++p)
    c.interval.push_back({values_low[p], values_high[p], low[p]<0.0, high[p]> 1.0});
}

/// What is said where nothing is free, or nothing is seen.
void fill_empty(Covariance& c) {
  const std::size_t n = c.parameters();
  c.determined.assign(n, 0);
  c.sd.assign(n, std::numeric_limits<double>::quiet_NaN());
  c.inflation.assign(n, 1.0);
  c.matrix.assign(n * n, 0.0);
  c.correlation.assign(n * n, 0.0);
  for (std::size_t p = 0; p < n; ++p) c.correlation[p * n + p] = 1.0;
}

}  // namespace

const char* name_of(NoiseKind kind) {
  switch (kind) {
    case NoiseKind::independent:
      return "independent";
    case NoiseKind::autocorrelated:
      return "autocorrelated";
    case NoiseKind::by_curve:
      return "by curve";
    case NoiseKind::given:
      return "given";
  }
  return "";
}

double Covariance::variance_of(std::span<const double> weights) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < parameters(); ++i)
    for (std::size_t j = 0; j < parameters(); ++j) sum += weights[i] * matrix[i * parameters() + j] * weights[j];
  return sum;
}

Covariance covariance(const Problem& problem, std::span<const double> scaled, const CovarianceOptions& options) {
  Covariance c;
  c.scaled.assign(scaled.begin(), scaled.end());
  c.level = options.level;
  hold_at_bounds(c, options.bound_tolerance);
  const Residuals r = problem.residuals(scaled, true);
  if (r.values.empty()) {
    c.failure = r.failure;
    return c;
  }
  fill_empty(c);
  const auto n = static_cast<Eigen::Index>(c.parameters());
  const std::vector<std::size_t> free = free_parameters(c);
  const Matrix all = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      r.jacobian.data(), static_cast<Eigen::Index>(r.values.size()), n);
  c.information.resize(static_cast<std::size_t>(n * n));
  Eigen::Map<Matrix>(c.information.data(), n, n) = all.transpose() * all;
  Matrix jacobian(all.rows(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    jacobian.col(static_cast<Eigen::Index>(i)) = all.col(static_cast<Eigen::Index>(free[i]));
  if (free.empty()) jacobian = Matrix::Zero(all.rows(), 1);
  const Split split(jacobian, options.rank_tolerance);
  NoiseStudy study(problem, r.values, jacobian * split.strong(), split.inverse());
  c.noise = study.choose(options);
  c.cost_unit = study.cost_unit();
  c.freedom = study.freedom();
  c.quantile = student_quantile(0.5 * (1.0 + options.level), c.freedom);
  if (!free.empty()) {
    const Matrix strong = study.covariance();
    fill_directions(c, split, free, strong);
    fill_parameters(c, split, free, strong, c.noise.variance * split.inverse());
  }
  fill_intervals(c, problem);
  return c;
}

}  // namespace glisson::fit

#include "fit/uncertainty/further_specimen.h"

#include <Eigen/Core>
#include <cmath>

#include "fit/algebra/decompositions.h"
#include "fit/model/curve_kinds.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Matrix rows_of(const Residuals& r, std::size_t first, std::size_t size, std::size_t parameters) {
  const auto n = static_cast<Eigen::Index>(parameters);
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(r.jacobian.data() + first * parameters,
                                                                          static_cast<Eigen::Index>(size), n);
}

/// What a curve's own fit leaves of its residuals, to first order.
Vector left_of(const Matrix& j, const Vector& r) {
  constexpr double kRank = 1e-5;
  return r - j * least_squares(j, r, kRank);
}

}  // namespace

FurtherSpecimen::FurtherSpecimen(const Problem& fitted, const Covariance& covariance)
    : fitted_(fitted), covariance_(covariance) {
  if (!covariance.failure.empty() || covariance.noise.kind != NoiseKind::by_curve || !of_one_kind(fitted.curves()))
    return;  // a further specimen of one kind of test; which specimens made several is not known
  const Residuals r = fitted.residuals(covariance.scaled, true);
  if (r.values.empty()) return;
  double samples = 0.0;
  for (std::size_t c = 0; c < fitted.curves().size(); ++c) {
    const Curve& curve = fitted.curves()[c];
    if (!(curve.weight > 0.0)) continue;
    const Vector own =
        left_of(rows_of(r, fitted.offset(c), curve.size(), covariance.parameters()),
                Eigen::Map<const Vector>(r.values.data() + fitted.offset(c), static_cast<Eigen::Index>(curve.size())));
    const double newtons = fitted.spread()[c] / curve.weight;
    left_ += newtons * newtons * own.squaredNorm();
    samples += static_cast<double>(curve.size());
    specimens_ += 1.0;
  }
  left_ = std::sqrt(left_ / samples);
  known_ = true;
}

std::vector<Interval> FurtherSpecimen::parameters() const {
  std::vector<double> low = covariance_.scaled, high = low;
  for (std::size_t p = 0; p < low.size(); ++p) {
    const bool free = covariance_.hold[p] == Hold::free && covariance_.determined[p] != 0;
    const double half = free ? covariance_.quantile * std::sqrt(specimens_ + 1.0) * covariance_.sd[p] : kInfinity;
    low[p] -= half, high[p] += half;
  }
  const std::vector<double> values_low = fitted_.to_values(low), values_high = fitted_.to_values(high);
  std::vector<Interval> out;
  for (std::size_t p = 0; p < low.size(); ++p) out.push_back({values_low[p], values_high[p], low[p]<0.0, high[p]> 1.0});
  return out;
}

std::vector<Band> FurtherSpecimen::bands(const Problem& curves) const {
  const Residuals r = curves.residuals(covariance_.scaled, true);
  if (!known_ || r.values.empty()) return {};
  const std::size_t n = covariance_.parameters();
  const Matrix spread =
      (specimens_ + 1.0) *
      Eigen::Map<const Matrix>(covariance_.matrix.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  std::vector<Band> out(curves.curves().size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    const Curve& curve = curves.curves()[c];
    const Matrix j = rows_of(r, curves.offset(c), curve.size(), n);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const auto row = j.row(static_cast<Eigen::Index>(i));
      const double variance = row.dot(row * spread) + left_ * left_;
      const double force = r.values[curves.offset(c) + i] + curve.force[i],
                   half = covariance_.quantile * std::sqrt(variance);
      out[c].low.push_back(force - half), out[c].high.push_back(force + half);
    }
  }
  return out;
}

}  // namespace glisson::fit

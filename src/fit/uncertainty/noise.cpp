#include "fit/uncertainty/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fit/uncertainty/autocorrelation.h"
#include "fit/uncertainty/distribution.h"
#include "fit/uncertainty/influence.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
constexpr std::size_t kFewestCurves = 4;

std::string format(const char* pattern, double a, double b) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

std::string probability_text(double probability) {
  return probability < 0.001 ? "p < 0.001" : format("p = %.3f", probability, 0.0);
}

std::vector<double> series_of(const Vector& x) { return {x.data(), x.data() + x.size()}; }

}  // namespace

NoiseStudy::NoiseStudy(const Problem& problem, const std::vector<double>& residuals, Matrix jacobian, Matrix inverse)
    : problem_(problem), jacobian_(std::move(jacobian)), inverse_(std::move(inverse)) {
  scores_.resize(static_cast<Eigen::Index>(residuals.size()));
  double slopes = 0.0;
  for (std::size_t c = 0; c < problem.curves().size(); ++c) {
    const Curve& curve = problem.curves()[c];
    for (std::size_t i = problem.offset(c); i < problem.offset(c) + curve.size(); ++i) {
      const Influence psi = influence(problem.loss(), residuals[i]);
      scores_[static_cast<Eigen::Index>(i)] = psi.value;
      if (curve.weight > 0.0) slopes += psi.slope;
    }
    if (!(curve.weight > 0.0) || curve.size() == 0) continue;
    parts_.push_back({static_cast<Eigen::Index>(problem.offset(c)), static_cast<Eigen::Index>(curve.size()), 1.0, c});
    samples_ += static_cast<double>(curve.size());
  }
  // a loss that bends down everywhere has no optimum there: the least is kept above zero
  mean_slope_ = std::max(slopes / std::max(samples_, 1.0), 1e-3);
  scores_ /= mean_slope_;
}

void NoiseStudy::set_effective(NoiseKind kind) {
  kind_ = kind;
  effective_ = 0.0;
  const double share =
      static_cast<double>(jacobian_.cols()) / static_cast<double>(std::max<std::size_t>(parts_.size(), 1));
  for (Part& part : parts_) {
    part.time = kind == NoiseKind::independent ? 1.0 : correlation_time(series_of(rows(part)), share);
    effective_ += static_cast<double>(part.size) / part.time;
  }
  const double left = std::max(effective_ - static_cast<double>(jacobian_.cols()), 1.0);
  double squares = 0.0;
  for (const Part& part : parts_) squares += rows(part).squaredNorm();
  variance_ = samples_ > 0.0 ? squares / samples_ * std::max(effective_ / left, 1.0) : 0.0;
}

double NoiseStudy::freedom() const {
  if (kind_ == NoiseKind::by_curve) return static_cast<double>(parts_.size() - 1);
  return std::max(effective_ - static_cast<double>(jacobian_.cols()), 1.0);
}

bool NoiseStudy::clusters_possible() const {
  const auto n = jacobian_.cols();
  if (n == 0 || parts_.size() < kFewestCurves || static_cast<Eigen::Index>(parts_.size()) <= n) return false;
  return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    // without this curve the others still determine everything
    const Matrix j = block(part), rest = Matrix::Identity(n, n) - j.transpose() * j * inverse_;
    return rest.partialPivLu().rcond() > 1e-8;
  });
}

std::optional<double> NoiseStudy::common_probability() const {
  double explained = 0.0, left = 0.0, ranks = 0.0, effective = 0.0;
  for (const Part& part : parts_) {
    Eigen::ColPivHouseholderQR<Matrix> qr(block(part));
    qr.setThreshold(1e-5);
    const Vector own = block(part) * qr.solve(rows(part));
    const Vector rest = rows(part) - own;
    const auto rank = static_cast<double>(qr.rank());
    explained += own.squaredNorm();
    left += rest.squaredNorm();
    ranks += rank;
    effective += static_cast<double>(part.size) / correlation_time(series_of(rest), rank);
  }
  const double above = ranks - static_cast<double>(jacobian_.cols()), below = effective - ranks;
  if (above < 1.0 || below < 1.0 || left <= 0.0) return std::nullopt;
  // left / below is σ² τ, the variance along one direction, from what each curve's own parameters leave
  return fisher_tail((explained / above) / (left / below), above, below);
}

NoiseEstimate NoiseStudy::choose(const CovarianceOptions& options) {
  NoiseEstimate e;
  std::vector<std::vector<double>> series;
  for (const Part& part : parts_) series.push_back(series_of(rows(part)));
  e.independence = independence_probability(series);
  const bool clusters = clusters_possible();
  if (clusters) e.common = common_probability();
  const std::string white = probability_text(e.independence);
  if (options.force) {
    const bool refused = *options.force == NoiseKind::by_curve && !clusters;
    set_effective(refused ? NoiseKind::autocorrelated : *options.force);
    e.why = refused ? "by curve was asked for, but needs four curves or more, and more than parameters: autocorrelated"
                    : "as asked for";
  } else if (clusters && (!e.common || *e.common < options.significance)) {
    set_effective(NoiseKind::by_curve);
    e.why = e.common ? "the curves differ by more than their own noise explains (" + probability_text(*e.common) +
                           "): each curve counts as one sample"
                     : "the residuals vary so slowly that each curve counts as one sample";
  } else if (e.independence < options.significance) {
    set_effective(NoiseKind::autocorrelated);
    e.why = "the residuals are not independent (" + white +
            "): " + format("%.0f samples count as %.1f", samples_, effective_);
  } else {
    set_effective(NoiseKind::independent);
    e.why = "the residuals look independent (" + white + ")";
  }
  e.kind = kind_;
  e.variance = variance_;
  e.samples = static_cast<std::size_t>(samples_);
  e.effective = effective_;
  e.effective_by_curve.assign(problem_.curves().size(), 0.0);
  for (const Part& part : parts_) e.effective_by_curve[part.curve] = static_cast<double>(part.size) / part.time;
  return e;
}

Matrix NoiseStudy::autocorrelated() const {
  const auto n = jacobian_.cols();
  const double left = std::max(effective_ - static_cast<double>(n), 1.0), factor = std::max(effective_ / left, 1.0);
  Matrix middle = Matrix::Zero(n, n);
  for (const Part& part : parts_) {
    const double variance = rows(part).squaredNorm() / static_cast<double>(part.size) * factor;
    middle += variance * part.time * block(part).transpose() * block(part);
  }
  return inverse_ * middle * inverse_;
}

Matrix NoiseStudy::by_curve() const {
  const auto n = jacobian_.cols();
  const auto curves = static_cast<double>(parts_.size());
  Matrix middle = Matrix::Zero(n, n);
  for (const Part& part : parts_) {
    const Matrix j = block(part), rest = Matrix::Identity(n, n) - j.transpose() * j * inverse_;
    const Vector pull = rest.partialPivLu().solve(j.transpose() * rows(part));
    middle += pull * pull.transpose();
  }
  return inverse_ * middle * inverse_ * ((curves - 1.0) / curves);
}

Matrix NoiseStudy::covariance() const {
  switch (kind_) {
    case NoiseKind::independent:
      return variance_ * inverse_;
    case NoiseKind::autocorrelated:
      return autocorrelated();
    case NoiseKind::by_curve:
      return by_curve();
  }
  return inverse_;
}

}  // namespace glisson::fit

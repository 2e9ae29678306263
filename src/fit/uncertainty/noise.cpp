#include "fit/uncertainty/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ranges>

#include "base/symmetric_eigen.h"
#include "fit/algebra/decompositions.h"
#include "fit/model/curve_kinds.h"
#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
constexpr std::size_t kFewestCurves = 3;
constexpr double kAlike = 0.995;  ///< of the samples: more that count are all of them
constexpr double kOwnPart = 0.9;  ///< of what is known of a combination, that may come from one curve

std::string format(const char* pattern, double a, double b) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

std::string probability_text(double probability) {
  return probability < 0.001 ? "p < 0.001" : format("p = %.3f", probability, 0.0);
}

/// What a mean over these specimens is of, and what it says nothing of.
std::string whose_specimens(const std::vector<Curve>& curves) {
  const bool batches = std::ranges::any_of(curves, [](const Curve& c) { return !c.batch.empty(); });
  if (batches) return "in these batches, and not of a further batch's";
  return "not of another batch's, which differ by more where batches do; name three batches or more (batch = \"A\" of "
         "[[data]]) for an interval of a further one";
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
    curves_.push_back({static_cast<Eigen::Index>(problem.offset(c)), static_cast<Eigen::Index>(curve.size())});
    numbers_.push_back(c);
    const auto kind = std::ranges::find_if(
        kinds_, [&](const auto& of) { return same_kind(problem.curves()[numbers_[of.front()]], curve); });
    if (kind == kinds_.end())
      kinds_.push_back({curves_.size() - 1});
    else
      kind->push_back(curves_.size() - 1);
    samples_ += static_cast<double>(curve.size());
  }
  // a loss that bends down everywhere has no optimum there: the least is kept above zero
  mean_slope_ = std::max(slopes / std::max(samples_, 1.0), 1e-3);
  scores_ /= mean_slope_;
}

/// What the curve's own pull leaves to the others: I − J_cᵀJ_c (JᵀJ)⁻¹.
Matrix NoiseStudy::rest_of(const Rows& curve) const {
  const Matrix j = block(curve);
  return Matrix::Identity(j.cols(), j.cols()) - j.transpose() * j * inverse_;
}

/// Whether there are several kinds of test.
bool NoiseStudy::of_kinds() const { return kinds_.size() > 1; }

/// Whether each combination is known from several curves, and each kind of test has several: curves of different kinds differ by
/// the law's misfit, too.
bool NoiseStudy::stand_alone() const {
  if (jacobian_.cols() == 0) return false;
  if (std::ranges::any_of(kinds_, [](const auto& kind) { return kind.size() < kFewestCurves; })) return false;
  const Vector root = inverse_.diagonal().array().sqrt();
  return std::ranges::all_of(curves_, [&](const Rows& curve) {
    const Matrix j = block(curve) * root.asDiagonal();
    return symmetric_eigen(j.transpose() * j).values.maxCoeff() < kOwnPart;
  });
}

/// Whether residuals are measured in deviations that whoever measured says.
bool NoiseStudy::is_given() const {
  return !numbers_.empty() && std::ranges::all_of(numbers_, [&](std::size_t c) {
    const Curve& curve = problem_.curves()[c];
    return curve.noise_given && curve.weight == 1.0 && problem_.spread()[c] == curve.noise;
  });
}

/// Deviations that are given leave nothing to estimate, but a law that misses by more than they say widens its intervals.
NoiseEstimate NoiseStudy::as_given(NoiseEstimate e) {
  const double left = samples_ - static_cast<double>(jacobian_.cols()), squares = scores_.squaredNorm();
  const double ratio = left > 0.0 ? squares / left : 0.0;
  variance_ = std::max(1.0, ratio);
  for (std::size_t c = 0; c < curves_.size(); ++c)
    e.effective_by_curve[numbers_[c]] = static_cast<double>(curves_[c].size);
  e.effective = samples_;
  e.why = "intervals follow from the deviations that are given";
  if (ratio > 1.0)
    e.why += format(", widened by %.2g, since the residuals are so many times as large", std::sqrt(ratio), 0.0);
  if (!(left > 0.0))
    e.why += ": there are as many parameters as values, so that nothing tells whether these deviations are right";
  return e;
}

NoiseKind NoiseStudy::kind_of(const CovarianceOptions& options, NoiseEstimate& e) const {
  const bool alone = stand_alone();
  if (options.force) {
    const bool refused = *options.force == NoiseKind::by_curve && !alone;
    e.why = refused
                ? "by curve was asked for, but some combination is known from fewer than three curves: autocorrelated"
                : "as asked for";
    return refused ? NoiseKind::autocorrelated : *options.force;
  }
  if (alone) {
    e.why = "each of the " + std::to_string(curves_.size()) + " curves counts as one sample" +
            (of_kinds() ? " of its kind of test" : "") + ": intervals are of the mean of specimens such as these, " +
            whose_specimens(problem_.curves());
    return NoiseKind::by_curve;
  }
  const bool swings = e.effective < kAlike * samples_;
  e.why = "the residuals " +
          std::string(e.independence < options.significance ? "are not independent" : "look independent") + " (" +
          probability_text(e.independence) + ")";
  if (swings) e.why += format("; by their likeliest correlation %.0f samples count as %.1f", samples_, e.effective);
  e.why += std::string(". How specimens differ is not in the intervals: ") +
           (of_kinds()                       ? "that takes three curves or more of each kind of test"
            : curves_.size() < kFewestCurves ? "that takes three curves or more"
                                             : "some parameter is known from one curve alone");
  return swings ? NoiseKind::autocorrelated : NoiseKind::independent;
}

NoiseEstimate NoiseStudy::choose(const CovarianceOptions& options) {
  NoiseEstimate e;
  e.effective_by_curve.assign(problem_.curves().size(), 0.0);
  e.samples = static_cast<std::size_t>(samples_);
  e.rms = std::sqrt(scores_.squaredNorm() / std::max(samples_, 1.0));
  if (!options.force && is_given()) {
    e.kind = kind_ = NoiseKind::given;
    e = as_given(std::move(e));
    e.variance = variance_;
    return e;
  }
  std::vector<std::vector<double>> series;
  for (const Rows& curve : curves_) series.push_back(series_of(of(curve)));
  e.independence = independence_probability(series);
  const bool white = options.force == NoiseKind::independent;
  if (!white) correlation_ = ResidualCorrelation(scores_, jacobian_, curves_);
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const double samples = static_cast<double>(curves_[c].size) / correlation_.time(curves_[c].size);
    e.effective_by_curve[numbers_[c]] = samples;
    e.effective += samples;
  }
  kind_ = kind_of(options, e);
  const double left = samples_ - static_cast<double>(jacobian_.cols());
  variance_ = kind_ == NoiseKind::independent ? scores_.squaredNorm() / std::max(left, 1.0) : correlation_.variance();
  e.kind = kind_;
  e.variance = variance_;
  return e;
}

/// J_cᵀr_c of the curves of one kind about their mean: what all of a kind share is the law's misfit to it.
Matrix NoiseStudy::pulls_of_kind(std::size_t kind) const {
  const std::vector<std::size_t>& own = kinds_[kind];
  Matrix pulls(jacobian_.cols(), static_cast<Eigen::Index>(own.size()));
  for (std::size_t k = 0; k < own.size(); ++k)
    pulls.col(static_cast<Eigen::Index>(k)) = block(curves_[own[k]]).transpose() * of(curves_[own[k]]);
  return pulls.colwise() - pulls.rowwise().mean();
}

/// The part of one kind in the covariance: G/(G − 1) Σ_c (u_c − ū)(u_c − ū)ᵀ between inverses.
Matrix NoiseStudy::by_kind(std::size_t kind) const {
  const Matrix pulls = pulls_of_kind(kind);
  const auto curves = static_cast<double>(pulls.cols());
  return inverse_ * (pulls * pulls.transpose()) * inverse_ * (curves / (curves - 1.0));
}

/// The least over the combinations of (Σ v)² / Σ v²/(G − 1), v the variance by each kind [Welch1947].
double NoiseStudy::freedom_by_kind() const {
  Vector sum = Vector::Zero(jacobian_.cols()), parts = sum;
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    const Vector v = by_kind(kind).diagonal();
    sum += v;
    parts += v.cwiseAbs2() / static_cast<double>(kinds_[kind].size() - 1);
  }
  return std::max(1.0, (sum.cwiseAbs2().array() / parts.array().max(1e-300)).minCoeff());
}

/// u_c = (I − J_cᵀJ_c (JᵀJ)⁻¹)⁻¹ J_cᵀr_c over the curves.
Matrix NoiseStudy::by_curve() const {
  const auto n = jacobian_.cols();
  if (of_kinds()) {
    Matrix sum = Matrix::Zero(n, n);
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind) sum += by_kind(kind);
    return sum;
  }
  const auto curves = static_cast<double>(curves_.size());
  Matrix middle = Matrix::Zero(n, n);
  for (const Rows& curve : curves_) {
    const Vector pull = solve(rest_of(curve), block(curve).transpose() * of(curve));
    middle += pull * pull.transpose();
  }
  return inverse_ * middle * inverse_ * ((curves - 1.0) / curves);
}

Matrix NoiseStudy::covariance() const {
  switch (kind_) {
    case NoiseKind::independent:
    case NoiseKind::given:
      return variance_ * inverse_;
    case NoiseKind::autocorrelated:
      return variance_ * inverse_ * (jacobian_.transpose() * correlation_.times(jacobian_, curves_)) * inverse_;
    case NoiseKind::by_curve:
      return by_curve();
  }
  return inverse_;
}

/// Of the sandwich's variance of a combination, were residuals independent: G − 1 for curves that are alike
/// [BellMcCaffrey2002]. With a the combination, v_c = (I − A J_cᵀJ_c)⁻¹ A a and w_c = J_c v_c it is (Σ λ)² / Σ λ² of the
/// matrix w_cᵀ (δ_cd − J_c A J_dᵀ) w_d.
double NoiseStudy::freedom_of(const Vector& combination) const {
  const auto curves = static_cast<Eigen::Index>(curves_.size());
  Matrix own(jacobian_.cols(), curves), parts = Matrix::Zero(curves, curves);
  for (Eigen::Index c = 0; c < curves; ++c) {
    const Matrix j = block(curves_[static_cast<std::size_t>(c)]), square = j.transpose() * j;
    const Vector v = solve(rest_of(curves_[static_cast<std::size_t>(c)]).transpose(), inverse_ * combination);
    own.col(c) = square * v;
    parts(c, c) = v.dot(own.col(c));
  }
  parts -= own.transpose() * inverse_ * own;
  return std::max(parts.trace() * parts.trace() / std::max((parts * parts).trace(), 1e-300), 1.0);
}

double NoiseStudy::freedom() const {
  const double left = std::max(samples_ - static_cast<double>(jacobian_.cols()), 1.0);
  constexpr double kMany = 1e6;  // as good as a normal distribution
  if (kind_ == NoiseKind::given && variance_ == 1.0) return kMany;
  if (kind_ == NoiseKind::independent || kind_ == NoiseKind::given) return left;
  if (kind_ == NoiseKind::autocorrelated) return correlation_.freedom(jacobian_, inverse_, curves_);
  if (of_kinds()) return freedom_by_kind();
  double least = static_cast<double>(curves_.size() - 1);
  for (Eigen::Index p = 0; p < jacobian_.cols(); ++p)
    least = std::min(least, freedom_of(Vector::Unit(jacobian_.cols(), p)));
  return least;
}

}  // namespace glisson::fit

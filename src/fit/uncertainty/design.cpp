#include "fit/uncertainty/design.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/symmetric_eigen.h"
#include "fit/algebra/decompositions.h"
#include "fit/uncertainty/combination.h"
#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr double kUnseen =
    1e-10;  // of the strongest eigenvalue: a direction's weight that differences cannot tell from 0

/// What is known of the free parameters: a matrix of information, and how much wider than it says.
struct Knowledge {
  std::vector<std::size_t> free;
  Matrix information;
  std::vector<double> inflation;
};

/// Variance of each free parameter from an information matrix; infinite where it is part of a direction without weight.
std::vector<double> variances(const Knowledge& k, const Matrix& information) {
  const SymmetricEigen eigen = symmetric_eigen(information);
  const double least = kUnseen * std::max(eigen.values.maxCoeff(), 0.0);
  std::vector<double> out(k.free.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (Eigen::Index d = 0; d < information.cols(); ++d) {
      const double part = eigen.vectors(static_cast<Eigen::Index>(i), d), weight = eigen.values[d];
      if (weight > least)
        out[i] += k.inflation[i] * part * part / weight;
      else if (std::abs(part) > kTakesPart)
        out[i] = kInfinity;
    }
  }
  return out;
}

Matrix picked(const std::vector<double>& square, const std::vector<std::size_t>& free) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(square.size()))));
  Matrix out(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = square[free[i] * n + free[j]];
  return out;
}

Knowledge knowledge_of(const Covariance& c) {
  Knowledge k;
  double typical = 0.0, count = 0.0;
  for (std::size_t p = 0; p < c.parameters(); ++p) {
    if (c.determined[p] == 0) continue;
    typical += std::log(std::max(c.inflation[p], 1e-300));
    count += 1.0;
  }
  // a direction that is not seen yet has no inflation of its own: that of the others, or of the noise
  typical = count > 0.0 ? std::exp(typical / count) : static_cast<double>(c.noise.samples) / c.noise.effective;
  for (std::size_t p = 0; p < c.parameters(); ++p) {
    if (c.hold[p] != Hold::free) continue;
    k.free.push_back(p);
    k.inflation.push_back(c.determined[p] != 0 ? c.inflation[p] : typical);
  }
  k.information = picked(c.information, k.free) / std::max(c.noise.variance, std::numeric_limits<double>::min());
  return k;
}

/// Noise of the fit's residuals [N], over all curves.
double noise_of(const Problem& problem, const Covariance& c) {
  double squares = 0.0, samples = 0.0;
  for (std::size_t i = 0; i < problem.curves().size(); ++i) {
    const Curve& curve = problem.curves()[i];
    if (!(curve.weight > 0.0)) continue;
    const double unit = problem.spread()[i] / curve.weight;
    squares += unit * unit * static_cast<double>(curve.size());
    samples += static_cast<double>(curve.size());
  }
  return samples > 0.0 ? std::sqrt(c.noise.variance * squares / samples) : 0.0;
}

double width(const Problem& problem, const Covariance& c, std::size_t p, double sd, double quantile) {
  std::vector<double> low = c.scaled, high = c.scaled;
  const double half = std::min(quantile * sd, 2.0);
  low[p] -= half;
  high[p] += half;
  const Parameter& x = problem.parameters()[p];
  const double a = problem.to_values(low)[p], b = problem.to_values(high)[p];
  if (x.low > 0.0) return b / a - 1.0;
  if (x.high < 0.0) return a / b - 1.0;
  return (b - a) / (x.high - x.low);
}

std::string percent(double relative) { return number(100.0 * relative, "%", 3); }

std::string words_of(const Problem& problem, const Candidate& candidate, const Design& d) {
  const auto name = [&](std::size_t p) { return problem.parameters()[p].name; };
  std::string made;
  for (std::size_t p = 0; p < d.of.size(); ++p) {
    if (!d.of[p].determined_now && d.of[p].determined_after) made += (made.empty() ? "" : " and ") + name(p);
  }
  if (!made.empty()) {
    return candidate.what + ": makes " + made + " identifiable, " + name(d.widest) + " to a width of " +
           percent(d.width_after);
  }
  const WidthForecast& w = d.of[d.widest];
  if (!w.determined_now) return candidate.what + ": leaves " + name(d.widest) + " unknown";
  return candidate.what + ": interval of " + name(d.widest) + " from " + percent(d.width_now) + " to " +
         percent(d.width_after);
}

/// JᵀJ / σ² of a candidate, of the free parameters; the failure where there is none.
std::optional<Matrix> information_of(const Problem& problem, const Covariance& c, const Knowledge& k,
                                     const Candidate& candidate, const Model& model, std::string& failure) {
  Curve plan = candidate.plan;
  plan.force.assign(plan.size(), 0.0);
  plan.weight = 1.0;
  const double noise = candidate.noise > 0.0 ? candidate.noise : noise_of(problem, c);
  const double unit = std::max(noise, std::numeric_limits<double>::min());
  Problem one(problem.parameters(), {plan}, {candidate.model_index}, {unit}, model);
  one.difference_step = problem.difference_step;
  const Residuals r = one.residuals(c.scaled, true);
  if (r.values.empty()) {
    failure = r.failure;
    return std::nullopt;
  }
  const auto rows = static_cast<Eigen::Index>(r.values.size()), n = static_cast<Eigen::Index>(c.parameters());
  const Matrix j = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(r.jacobian.data(), rows, n);
  std::vector<double> square(static_cast<std::size_t>(n * n));
  Eigen::Map<Matrix>(square.data(), n, n) = j.transpose() * j;
  return picked(square, k.free);
}

void forecast(Design& d, const Problem& problem, const Covariance& c, const Knowledge& k, const Matrix& after,
              double samples) {
  // a sandwich over curves gains one degree of freedom, other noise as many as the samples that count
  const double share = c.noise.effective / static_cast<double>(std::max<std::size_t>(c.noise.samples, 1));
  const double gained = c.noise.kind == NoiseKind::by_curve ? 1.0 : samples * share;
  const double quantile = student_quantile(0.5 * (1.0 + c.level), c.freedom + gained);
  const std::vector<double> now_variance = variances(k, k.information), after_variance = variances(k, after);
  for (std::size_t i = 0; i < k.free.size(); ++i) {
    const std::size_t p = k.free[i];
    WidthForecast& w = d.of[p];
    w.determined_now = std::isfinite(now_variance[i]);
    w.determined_after = std::isfinite(after_variance[i]);
    w.sd_after = std::sqrt(after_variance[i]);
    w.now = width(problem, c, p, std::sqrt(now_variance[i]), c.quantile);
    w.after = width(problem, c, p, w.sd_after, quantile);
    if (w.now > d.of[d.widest].now) d.widest = p;
  }
}

double total(const Design& d) {
  double sum = 0.0;
  for (const WidthForecast& w : d.of) sum += w.after;
  return sum;
}

}  // namespace

std::vector<Design> rank_designs(const Problem& problem, const Covariance& covariance,
                                 std::span<const Candidate> candidates, const Model& model) {
  std::vector<Design> out;
  if (!covariance.failure.empty()) return out;
  const Knowledge k = knowledge_of(covariance);
  if (k.free.empty()) return out;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Design d;
    d.candidate = i;
    d.of.resize(covariance.parameters());
    d.widest = k.free.front();
    const std::optional<Matrix> gain = information_of(problem, covariance, k, candidates[i], model, d.failure);
    const Matrix after = gain ? Matrix(k.information + *gain) : k.information;
    forecast(d, problem, covariance, k, after, gain ? static_cast<double>(candidates[i].plan.size()) : 0.0);
    d.width_now = d.of[d.widest].now;
    d.width_after = d.of[d.widest].after;
    d.words = gain ? words_of(problem, candidates[i], d) : candidates[i].what + ": " + d.failure;
    out.push_back(std::move(d));
  }
  std::stable_sort(out.begin(), out.end(), [](const Design& a, const Design& b) {
    if (a.failure.empty() != b.failure.empty()) return a.failure.empty();
    return a.width_after != b.width_after ? a.width_after < b.width_after : total(a) < total(b);
  });
  return out;
}

}  // namespace glisson::fit

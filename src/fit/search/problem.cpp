#include "fit/search/problem.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::fit {
namespace {

/// A forward run of one curve at one point: the point itself, or one beside it for a difference.
struct Run {
  std::size_t curve = 0;
  std::size_t column = 0;  ///< of the point's list
  Prediction result;
};

/// The points at which a Jacobian needs the curves: the middle, then one or two for each free parameter.
struct Stencil {
  struct Pair {
    std::size_t low = 0, high = 0;  ///< numbers of points
    double width = 0.0;             ///< z distance; 0: the parameter is held
  };
  std::vector<std::vector<double>> points;
  std::vector<Pair> pairs;  ///< of each parameter

  Stencil(std::span<const double> z, double step, std::span<const char> skip, Differences differences) {
    points.emplace_back(z.begin(), z.end());
    for (std::size_t p = 0; p < z.size(); ++p) {
      pairs.emplace_back();
      if (!skip.empty() && skip[p] != 0) continue;
      double low = std::max(0.0, z[p] - step), high = std::min(1.0, z[p] + step);
      if (differences == Differences::one_sided) (z[p] + step <= 1.0 ? low : high) = z[p];
      pairs.back() = {at(p, low), at(p, high), high - low};
    }
  }

 private:
  /// The number of the point with another value of a parameter.
  std::size_t at(std::size_t p, double value) {
    if (value == points.front()[p]) return 0;
    points.push_back(points.front());
    points.back()[p] = value;
    return points.size() - 1;
  }
};

}  // namespace

Problem::Problem(std::vector<Parameter> parameters, std::vector<Curve> curves, std::vector<std::size_t> indices,
                 std::vector<double> spread, const Model& model, Loss loss)
    : parameters_(std::move(parameters)), curves_(std::move(curves)), indices_(std::move(indices)),
      spread_(std::move(spread)), model_(&model), loss_(loss) {
  if (parameters_.empty()) throw std::invalid_argument("a fit needs at least one free parameter; got none");
  if (curves_.empty() || indices_.size() != curves_.size() || spread_.size() != curves_.size())
    throw std::invalid_argument("a fit needs one or more curves, with a number in the model and a spread for each");
  for (const Parameter& p : parameters_) {
    const bool ordered = p.low < p.high && std::isfinite(p.low) && std::isfinite(p.high);
    if (!ordered || (p.scale == Scale::logarithmic && !(p.low > 0.0)))
      throw std::invalid_argument("parameter " + p.name + ": bounds " + std::to_string(p.low) + " to " +
                                  std::to_string(p.high) + " are not usable; allowed: low < high, both > 0 on a " +
                                  "logarithmic scale");
  }
  for (const double s : spread_) {
    if (!(s > 0.0)) throw std::invalid_argument("the spread of a curve is " + std::to_string(s) + " N; allowed: > 0");
  }
  for (const Curve& curve : curves_) {
    offsets_.push_back(size_);
    size_ += curve.size();
  }
}

std::unique_ptr<Problem> Problem::with(std::vector<Curve> curves, std::span<const std::size_t> origin) const {
  std::vector<std::size_t> indices;
  std::vector<double> spread;
  for (const std::size_t c : origin) {
    indices.push_back(indices_[c]);
    spread.push_back(spread_[c]);
  }
  auto other =
      std::make_unique<Problem>(parameters_, std::move(curves), std::move(indices), std::move(spread), *model_, loss_);
  other->difference_step = difference_step;
  return other;
}

std::vector<double> Problem::to_scaled(std::span<const double> values) const {
  std::vector<double> z(parameters_.size());
  for (std::size_t p = 0; p < z.size(); ++p) {
    const Parameter& x = parameters_[p];
    z[p] = x.scale == Scale::linear ? (values[p] - x.low) / (x.high - x.low)
                                    : std::log(values[p] / x.low) / std::log(x.high / x.low);
    z[p] = std::clamp(z[p], 0.0, 1.0);
  }
  return z;
}

std::vector<double> Problem::to_values(std::span<const double> scaled) const {
  std::vector<double> values(parameters_.size());
  for (std::size_t p = 0; p < values.size(); ++p) {
    const Parameter& x = parameters_[p];
    const double z = std::clamp(scaled[p], 0.0, 1.0);
    values[p] = x.scale == Scale::linear ? x.low + z * (x.high - x.low) : x.low * std::pow(x.high / x.low, z);
    values[p] = std::clamp(values[p], x.low, x.high);
  }
  return values;
}

std::vector<double> Problem::value_slopes(std::span<const double> scaled) const {
  std::vector<double> slopes = to_values(scaled);
  for (std::size_t p = 0; p < slopes.size(); ++p) {
    const Parameter& x = parameters_[p];
    slopes[p] = x.scale == Scale::linear ? x.high - x.low : slopes[p] * std::log(x.high / x.low);
  }
  return slopes;
}

Residuals Problem::residuals(std::span<const double> scaled, bool derivatives, std::span<const char> skip,
                             Differences differences) const {
  const std::vector<char> all(scaled.size(), 1);
  const Stencil stencil(scaled, difference_step, derivatives ? skip : std::span(all), differences);
  std::vector<Run> runs;
  for (std::size_t point = 0; point < stencil.points.size(); ++point)
    for (std::size_t c = 0; c < curves_.size(); ++c) runs.push_back({c, point, {}});
  tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
    runs[i].result = model_->predict(indices_[runs[i].curve], to_values(stencil.points[runs[i].column]));
  });
  runs_ += runs.size();
  Residuals out;
  const auto force = [&](std::size_t point, std::size_t c) -> const std::vector<double>& {
    return runs[point * curves_.size() + c].result.force;
  };
  for (const Run& run : runs) {
    if (run.result.force.size() == curves_[run.curve].size()) continue;
    out.failure = run.result.failure.empty() ? "the model gave no force" : run.result.failure;
    return out;
  }
  out.values.resize(size_);
  if (derivatives) out.jacobian.assign(size_ * parameters_.size(), 0.0);
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const Curve& curve = curves_[c];
    const double factor = curve.weight / spread_[c];
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const std::size_t row = offsets_[c] + i;
      out.values[row] = factor * (force(0, c)[i] - curve.force[i]);
      for (std::size_t p = 0; derivatives && p < parameters_.size(); ++p) {
        const Stencil::Pair& pair = stencil.pairs[p];
        if (pair.width == 0.0) continue;
        const double difference = force(pair.high, c)[i] - force(pair.low, c)[i];
        out.jacobian[row * parameters_.size() + p] = factor * difference / pair.width;
      }
    }
  }
  return out;
}

double Problem::cost(std::span<const double> residuals) const {
  double sum = 0.0;
  for (const double r : residuals) sum += loss_of(loss_, r * r);
  return 0.5 * sum;
}

double Problem::weight(double residual) const { return influence(loss_, residual).weight; }

}  // namespace glisson::fit

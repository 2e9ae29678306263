#include "fit/uncertainty/validation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glisson::fit {
namespace {

constexpr std::size_t kGrid = 200;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// The samples of a curve that go further than all before: force as a function of displacement.
struct Loading {
  std::vector<double> x, force;

  explicit Loading(const Curve& c) {
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (!x.empty() && c.displacement[i] <= x.back()) continue;
      x.push_back(c.displacement[i]);
      force.push_back(c.force[i]);
    }
  }
  double at(double position) const {
    const auto above = std::upper_bound(x.begin(), x.end(), position);
    if (above == x.begin()) return force.front();
    if (above == x.end()) return force.back();
    const auto i = static_cast<std::size_t>(above - x.begin());
    return force[i - 1] + (position - x[i - 1]) / (x[i] - x[i - 1]) * (force[i] - force[i - 1]);
  }
};

/// Sums of squares that become an rms.
struct Squares {
  double sum = 0.0;
  std::size_t samples = 0;
  void add(const CurveError& e) {
    sum += e.rms * e.rms * static_cast<double>(e.samples);
    samples += e.samples;
  }
  double rms() const { return samples > 0 ? std::sqrt(sum / static_cast<double>(samples)) : kNothing; }
};

CurveError error_of(const Curve& c, const Prediction& prediction, double limit) {
  CurveError e{c.name, c.group, c.held_out, 0, kNothing, kNothing, prediction.failure};
  if (prediction.force.size() != c.size()) {
    if (e.failure.empty()) e.failure = "the model gave no force";
    return e;
  }
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (c.displacement[i] > limit) continue;
    const double d = prediction.force[i] - c.force[i];
    sum += d;
    squares += d * d;
    ++e.samples;
  }
  if (e.samples == 0) return e;
  e.rms = std::sqrt(squares / static_cast<double>(e.samples));
  e.mean = sum / static_cast<double>(e.samples);
  return e;
}

GroupError group_error(const std::string& name, std::span<const Curve> curves, const std::vector<CurveError>& errors,
                       double limit) {
  GroupError g;
  g.name = name;
  Squares fitted, heldout;
  std::vector<const Curve*> repetitions;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].group != name) continue;
    repetitions.push_back(&curves[i]);
    if (errors[i].samples > 0) (curves[i].held_out ? heldout : fitted).add(errors[i]);
  }
  g.rms_fit = fitted.rms();
  g.rms_heldout = heldout.rms();
  g.spread = spread_of(repetitions, limit);
  g.within_spread = g.spread.curves > 1 && heldout.samples > 0 && g.rms_heldout <= g.spread.deviation;
  return g;
}

}  // namespace

Spread spread_of(std::span<const Curve* const> repetitions, double displacement_limit) {
  Spread s;
  std::vector<Loading> loadings;
  for (const Curve* c : repetitions) {
    if (c->size() > 1) loadings.emplace_back(*c);
  }
  if (loadings.size() < 2) return s;
  s.low = -std::numeric_limits<double>::infinity();
  s.high = displacement_limit;
  for (const Loading& l : loadings) {
    s.low = std::max(s.low, l.x.front());
    s.high = std::min(s.high, l.x.back());
  }
  if (!(s.low < s.high)) return {};
  s.curves = loadings.size();
  const auto n = static_cast<double>(loadings.size());
  double squares = 0.0;
  for (std::size_t k = 0; k < kGrid; ++k) {
    const double x = s.low + (s.high - s.low) * static_cast<double>(k) / static_cast<double>(kGrid - 1);
    double mean = 0.0;
    for (const Loading& l : loadings) mean += l.at(x) / n;
    for (const Loading& l : loadings) squares += (l.at(x) - mean) * (l.at(x) - mean) / n;
  }
  s.about_mean = std::sqrt(squares / static_cast<double>(kGrid));
  s.deviation = s.about_mean * std::sqrt(n / (n - 1.0));
  return s;
}

Validation validate(std::span<const Curve> curves, std::span<const Prediction> predictions, double displacement_limit) {
  if (curves.size() != predictions.size())
    throw std::invalid_argument("there are " + std::to_string(predictions.size()) + " predictions for " +
                                std::to_string(curves.size()) + " curves; one for each is needed");
  Validation v;
  Squares fitted, heldout;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    v.curves.push_back(error_of(curves[i], predictions[i], displacement_limit));
    if (v.curves.back().samples > 0) (curves[i].held_out ? heldout : fitted).add(v.curves.back());
  }
  v.rms_fit = fitted.rms();
  v.rms_heldout = heldout.rms();
  for (const Curve& c : curves) {
    const bool known =
        std::any_of(v.groups.begin(), v.groups.end(), [&](const GroupError& g) { return g.name == c.group; });
    if (!known) v.groups.push_back(group_error(c.group, curves, v.curves, displacement_limit));
  }
  return v;
}

}  // namespace glisson::fit

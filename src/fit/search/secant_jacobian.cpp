#include "fit/search/secant_jacobian.h"

#include <algorithm>

namespace glisson::fit {
namespace {

constexpr double kLittle = 0.25;  // of the gain that J promised

bool same_point(std::span<const double> a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// J s, a sum for each residual.
std::vector<double> rises(const Residuals& r, const std::vector<double>& step) {
  std::vector<double> list(r.values.size(), 0.0);
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t p = 0; p < step.size(); ++p) list[i] += r.jacobian[i * step.size() + p] * step[p];
  return list;
}

std::vector<double> step_between(const std::vector<double>& from, std::span<const double> to) {
  std::vector<double> step(to.begin(), to.end());
  for (std::size_t p = 0; p < step.size(); ++p) step[p] -= from[p];
  return step;
}

double squared(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return sum;
}

}  // namespace

SecantJacobian::SecantJacobian(const Problem& problem, std::vector<char> skip, std::size_t most_updates)
    : problem_(problem), skip_(std::move(skip)), most_(most_updates), updates_(most_updates) {}

const Residuals& SecantJacobian::values_at(std::span<const double> scaled) {
  if (same_point(scaled, z_)) return latest_;
  if (same_point(scaled, seen_z_)) return seen_;
  seen_ = problem_.residuals(scaled, false);
  seen_z_.assign(scaled.begin(), scaled.end());
  return seen_;
}

const Residuals& SecantJacobian::at(std::span<const double> scaled) {
  if (same_point(scaled, z_) && updates_ < most_) return latest_;
  if (!latest_.values.empty() && updates_ < most_) {
    const Residuals& now = values_at(scaled);
    if (now.values.empty()) return now;
    if (worth_an_update(scaled, now)) {
      update(scaled, now);
      return latest_;
    }
  }
  Residuals next = problem_.residuals(scaled, true, skip_, differences_);
  if (next.values.empty()) {
    seen_ = std::move(next);
    seen_z_.assign(scaled.begin(), scaled.end());
    return seen_;
  }
  latest_ = std::move(next);
  z_.assign(scaled.begin(), scaled.end());
  kind_ = differences_ == Differences::central ? Kind::central : Kind::one_sided;
  differences_ = Differences::one_sided;
  updates_ = 0;
  return latest_;
}

/// Whether the step gained what J promised.
bool SecantJacobian::worth_an_update(std::span<const double> scaled, const Residuals& now) const {
  std::vector<double> promised = rises(latest_, step_between(z_, scaled));
  for (std::size_t i = 0; i < promised.size(); ++i) promised[i] += latest_.values[i];
  const double before = problem_.cost(latest_.values);
  return before - problem_.cost(now.values) >= kLittle * (before - problem_.cost(promised));
}

void SecantJacobian::update(std::span<const double> scaled, const Residuals& now) {
  const std::vector<double> step = step_between(z_, scaled), rise = rises(latest_, step);
  const double length = squared(step), own = problem_.difference_step;
  for (std::size_t i = 0; i < rise.size() && length > own * own; ++i) {
    const double missed = (now.values[i] - latest_.values[i] - rise[i]) / length;
    for (std::size_t p = 0; p < step.size(); ++p) latest_.jacobian[i * step.size() + p] += missed * step[p];
  }
  latest_.values = now.values;
  z_.assign(scaled.begin(), scaled.end());
  kind_ = Kind::carried;
  ++updates_;
}

}  // namespace glisson::fit

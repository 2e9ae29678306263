// least_squares.cpp — the only file that knows Ceres.
#include "fit/search/least_squares.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <limits>

#include "fit/search/secant_descent.h"

namespace glisson::fit {
namespace {

constexpr double kAtBound = 1e-9;  // in z

/// All residuals as one block of Ceres, whose parameters are those that are free.
class AllResiduals final : public ceres::CostFunction {
 public:
  AllResiduals(const Problem& problem, std::vector<double> z, std::vector<std::size_t> free)
      : problem_(problem), z_(std::move(z)), free_(std::move(free)), skip_(z_.size(), 1) {
    for (const std::size_t p : free_) skip_[p] = 0;
    set_num_residuals(static_cast<int>(problem_.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
  }

  bool Evaluate(double const* const* blocks, double* values, double** jacobians) const override {
    const std::vector<double> z = point(blocks[0]);
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const Residuals r = problem_.residuals(z, derivatives, skip_);
    if (!r.failure.empty()) failure_ = r.failure;
    if (r.values.empty()) return false;
    std::copy(r.values.begin(), r.values.end(), values);
    for (std::size_t row = 0; derivatives && row < problem_.size(); ++row)
      for (std::size_t k = 0; k < free_.size(); ++k)
        jacobians[0][row * free_.size() + k] = r.jacobian[row * z_.size() + free_[k]];
    return true;
  }

  std::vector<double> point(const double* free_values) const {
    std::vector<double> z = z_;
    for (std::size_t k = 0; k < free_.size(); ++k) z[free_[k]] = std::clamp(free_values[k], 0.0, 1.0);
    return z;
  }
  const std::string& failure() const { return failure_; }

 private:
  const Problem& problem_;
  std::vector<double> z_;
  std::vector<std::size_t> free_;
  std::vector<char> skip_;
  mutable std::string failure_;  // Ceres evaluates one point at a time
};

/// Ceres applies a loss to a block's summed squares; ours acts on each residual, so it is folded into them.
/// A robust residual r' = sign(r) √ρ(r²) has the same cost, and r'² = ρ.
class RobustResiduals final : public ceres::CostFunction {
 public:
  RobustResiduals(const AllResiduals& inner, const Problem& problem) : inner_(inner), problem_(problem) {
    set_num_residuals(inner_.num_residuals());
    *mutable_parameter_block_sizes() = inner_.parameter_block_sizes();
  }
  bool Evaluate(double const* const* blocks, double* values, double** jacobians) const override {
    if (!inner_.Evaluate(blocks, values, jacobians)) return false;
    const auto n = static_cast<std::size_t>(num_residuals());
    const auto columns = static_cast<std::size_t>(parameter_block_sizes()[0]);
    for (std::size_t i = 0; i < n; ++i) {
      const double r = values[i];
      const double rho = 2.0 * problem_.cost({&r, 1});
      const double robust = std::copysign(std::sqrt(rho), r);
      const double slope = slope_of(r, robust);
      values[i] = robust;
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      for (std::size_t k = 0; k < columns; ++k) jacobians[0][i * columns + k] *= slope;
    }
    return true;
  }

 private:
  /// d r'/d r = ρ'(r²) r / r'; 1 near zero, where every loss is the square.
  double slope_of(double r, double robust) const {
    return std::abs(robust) < 1e-12 ? 1.0 : problem_.weight(r) * r / robust;
  }
  const AllResiduals& inner_;
  const Problem& problem_;
};

/// Ends the descent when the caller asks for it.
class StopWatcher final : public ceres::IterationCallback {
 public:
  explicit StopWatcher(const std::atomic<bool>* stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return stop_ != nullptr && stop_->load() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::atomic<bool>* stop_;
};

std::vector<std::size_t> free_of(const Problem& problem, const std::vector<char>& fixed) {
  std::vector<std::size_t> free;
  for (std::size_t p = 0; p < problem.parameters().size(); ++p) {
    if (fixed.empty() || fixed[p] == 0) free.push_back(p);
  }
  return free;
}

/// Ceres says on standard error what its summary says too: only what ends the program may still be said.
void silence_log() {
  static const int level = FLAGS_minloglevel = google::GLOG_FATAL;
  static_cast<void>(level);
}

ceres::Solver::Options solver_options(const DescentOptions& options, StopWatcher& watcher) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_QR;
  o.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  o.max_num_iterations = options.most_iterations;
  o.function_tolerance = options.tolerance;
  o.parameter_tolerance = 1e-9;
  o.gradient_tolerance = 1e-14;
  o.num_threads = 1;  // the forward runs are side by side, not the algebra
  o.logging_type = ceres::SILENT;
  o.max_num_consecutive_invalid_steps = 20;
  o.callbacks.push_back(&watcher);
  return o;
}

/// One run of Ceres. Its steps are cut at the bounds, not solved within them: where a parameter meets one, descend()
/// goes on with that parameter held.
Optimum one_descent(const Problem& problem, std::span<const double> start, const DescentOptions& options,
                    const std::vector<char>& fixed) {
  Optimum optimum;
  optimum.scaled.assign(start.begin(), start.end());
  const std::vector<std::size_t> free = free_of(problem, fixed);
  AllResiduals residuals(problem, optimum.scaled, free);
  if (free.empty()) {
    const Residuals r = problem.residuals(optimum.scaled, false);
    optimum.cost = r.values.empty() ? std::numeric_limits<double>::infinity() : problem.cost(r.values);
    optimum.converged = !r.values.empty();
    optimum.message = r.values.empty() ? r.failure : "nothing is free";
    return optimum;
  }
  RobustResiduals robust(residuals, problem);
  std::vector<double> block;
  for (const std::size_t p : free) block.push_back(optimum.scaled[p]);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres_problem(ownership);
  ceres_problem.AddResidualBlock(&robust, nullptr, block.data());
  for (std::size_t k = 0; k < free.size(); ++k) {
    ceres_problem.SetParameterLowerBound(block.data(), static_cast<int>(k), 0.0);
    ceres_problem.SetParameterUpperBound(block.data(), static_cast<int>(k), 1.0);
  }
  silence_log();
  StopWatcher watcher(options.stop);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options, watcher), &ceres_problem, &summary);
  optimum.scaled = residuals.point(block.data());
  const bool failed = summary.termination_type == ceres::FAILURE;
  optimum.cost = failed ? std::numeric_limits<double>::infinity() : summary.final_cost;
  optimum.converged = summary.termination_type == ceres::CONVERGENCE;
  optimum.iterations = static_cast<int>(summary.iterations.size());
  optimum.message = failed && !residuals.failure().empty() ? residuals.failure() : summary.message;
  return optimum;
}

bool at_a_bound(const std::vector<double>& z) {
  return std::any_of(z.begin(), z.end(), [](double x) { return x <= kAtBound || x >= 1.0 - kAtBound; });
}

/// The caller's own, and the parameters at a bound that the cost would push beyond it.
std::vector<char> held_at(const Problem& problem, const std::vector<double>& z, std::vector<char> fixed) {
  const Residuals r = problem.residuals(z, true, fixed);
  if (r.values.empty()) return fixed;
  for (std::size_t p = 0; p < z.size(); ++p) {
    double gradient = 0.0;
    for (std::size_t i = 0; i < problem.size(); ++i)
      gradient += problem.weight(r.values[i]) * r.values[i] * r.jacobian[i * z.size() + p];
    if ((z[p] <= kAtBound && gradient > 0.0) || (z[p] >= 1.0 - kAtBound && gradient < 0.0)) fixed[p] = 1;
  }
  return fixed;
}

}  // namespace

Optimum descend(const Problem& problem, std::span<const double> start, const DescentOptions& options) {
  if (options.secant) return secant_descent(problem, start, options);
  constexpr int kPasses = 4;
  DescentOptions left = options;
  std::vector<char> own = options.fixed;
  own.resize(problem.parameters().size(), 0);
  std::vector<char> fixed = own;
  Optimum optimum = one_descent(problem, start, options, fixed);
  for (int pass = 1; pass < kPasses && std::isfinite(optimum.cost) && at_a_bound(optimum.scaled); ++pass) {
    const std::vector<char> held = held_at(problem, optimum.scaled, own);
    if (held == fixed) break;
    fixed = held;
    left.most_iterations = options.most_iterations - optimum.iterations;
    if (left.most_iterations < 1) break;
    Optimum next = one_descent(problem, optimum.scaled, left, fixed);
    if (!(next.cost <= optimum.cost)) break;
    next.iterations += optimum.iterations;
    optimum = std::move(next);
  }
  return optimum;
}

}  // namespace glisson::fit

#include "fit/search/secant_descent.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/algebra/decompositions.h"
#include "fit/search/secant_jacobian.h"

namespace glisson::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kFirstDamping = 1e-4, kRefusedDamping = 1e-3, kLeastDamping = 1e-10, kMostDamping = 1e12;
constexpr double kGrowth = 4.0, kEase = 0.3;      // of the damping, after a step that was refused or good
constexpr double kAtFace = 1e-12, kShort = 1e-9;  // in z
constexpr double kLeastSeen = 1e-6;  // of the longest column: the damping of parameters that are hardly seen
constexpr double kGood = 0.75;       // of the gain that was promised
constexpr double kNear = 1e-3;       // of the cost

/// The cost about a point: ½ ‖r + J s‖², robust residuals folded as sign(r) √ρ(r²), which has the same cost.
struct LocalCost {
  Vector r;
  Matrix jacobian;

  LocalCost(const Problem& problem, const Residuals& at) {
    const auto rows = static_cast<Eigen::Index>(at.values.size());
    const auto columns = static_cast<Eigen::Index>(problem.parameters().size());
    r = Eigen::Map<const Vector>(at.values.data(), rows);
    jacobian = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(at.jacobian.data(), rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double own = r[i], robust = std::copysign(std::sqrt(2.0 * problem.cost({&own, 1})), own);
      r[i] = robust;
      if (std::abs(robust) > 1e-12) jacobian.row(i) *= problem.weight(own) * own / robust;
    }
  }
  double gain(const Vector& step) const { return 0.5 * (r.squaredNorm() - (r + jacobian * step).squaredNorm()); }
};

/// The damped step within the box: parameters that would leave it are set on its face, one after the other, and the rest is
/// solved again.
Vector step_of(const LocalCost& cost, const std::vector<double>& z, const std::vector<char>& fixed, double damping) {
  const Eigen::Index n = cost.jacobian.cols();
  const Vector gradient = cost.jacobian.transpose() * cost.r, weight = cost.jacobian.colwise().squaredNorm();
  const double least = kLeastSeen * kLeastSeen * weight.maxCoeff();
  Vector step = Vector::Zero(n);
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = 0; p < n; ++p) {
    const double at = z[static_cast<std::size_t>(p)];
    const bool pushed = (at <= kAtFace && gradient[p] > 0.0) || (at >= 1.0 - kAtFace && gradient[p] < 0.0);
    if (fixed[static_cast<std::size_t>(p)] == 0 && !pushed && weight[p] > 0.0) free.push_back(p);
  }
  while (!free.empty()) {
    const auto count = static_cast<Eigen::Index>(free.size());
    Matrix stacked = Matrix::Zero(cost.jacobian.rows() + count, count);
    Vector aim = Vector::Zero(stacked.rows());
    aim.head(cost.r.size()) = -(cost.r + cost.jacobian * step);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index p = free[static_cast<std::size_t>(k)];
      stacked.col(k).head(cost.r.size()) = cost.jacobian.col(p);
      stacked(cost.r.size() + k, k) = std::sqrt(damping * std::max(weight[p], least));
    }
    const Vector solved = least_squares(stacked, aim);
    double furthest = 0.0;
    Eigen::Index leaves = -1;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double at = z[static_cast<std::size_t>(free[static_cast<std::size_t>(k)])], to = at + solved[k];
      const double beyond = std::max(-to, to - 1.0);
      if (beyond > furthest) furthest = beyond, leaves = k;
    }
    if (leaves < 0) {
      for (Eigen::Index k = 0; k < count; ++k) step[free[static_cast<std::size_t>(k)]] = solved[k];
      break;
    }
    const Eigen::Index p = free[static_cast<std::size_t>(leaves)];
    step[p] = (solved[leaves] > 0.0 ? 1.0 : 0.0) - z[static_cast<std::size_t>(p)];
    free.erase(free.begin() + leaves);
  }
  return step;
}

std::vector<double> moved(const std::vector<double>& z, const Vector& step) {
  std::vector<double> to = z;
  for (std::size_t p = 0; p < to.size(); ++p) to[p] = std::clamp(z[p] + step[static_cast<Eigen::Index>(p)], 0.0, 1.0);
  return to;
}

class SecantDescent {
 public:
  SecantDescent(const Problem& problem, std::span<const double> start, const DescentOptions& options)
      : problem_(problem), options_(options), fixed_(options.fixed) {
    fixed_.resize(problem.parameters().size(), 0);
    const auto free = static_cast<std::size_t>(std::count(fixed_.begin(), fixed_.end(), 0));
    jacobian_.emplace(problem, fixed_, 2 * free);
    out_.scaled.assign(start.begin(), start.end());
    for (double& z : out_.scaled) z = std::clamp(z, 0.0, 1.0);
  }

  Optimum run() {
    const Residuals& first = jacobian_->at(out_.scaled);
    if (first.values.empty()) {
      out_.cost = std::numeric_limits<double>::infinity();
      out_.message = first.failure;
      return out_;
    }
    out_.cost = problem_.cost(first.values);
    while (!ended()) iterate();
    return out_;
  }

 private:
  using Kind = SecantJacobian::Kind;

  bool ended() {
    if (out_.converged) return true;
    if (options_.stop != nullptr && options_.stop->load()) out_.message = "interrupted";
    if (out_.iterations >= options_.most_iterations) out_.message = "no more iterations are allowed";
    return !out_.message.empty();
  }

  void iterate() {
    const Residuals& here = jacobian_->at(out_.scaled);
    if (here.values.empty()) {  // a difference about a point that does run
      out_.message = here.failure;
      return;
    }
    const LocalCost local(problem_, here);
    const Vector step = step_of(local, out_.scaled, fixed_, damping_);
    const double promised = local.gain(step), least = options_.tolerance * out_.cost;
    if (!(promised > least) || step.cwiseAbs().maxCoeff() <= kShort) return confirm("a step would gain nothing");
    ++out_.iterations;
    const std::vector<double> to = moved(out_.scaled, step);
    const Residuals& there = jacobian_->values_at(to);
    const double cost = there.values.empty() ? std::numeric_limits<double>::infinity() : problem_.cost(there.values);
    const double gained = out_.cost - cost;
    if (std::abs(gained) <= least && jacobian_->kind() == Kind::central) return confirm("a step gained nothing");
    if (!(gained > 0.0)) return refuse(promised < kNear * out_.cost);
    if (gained > kGood * promised && !refused_) damping_ = std::max(kLeastDamping, kEase * damping_);
    refused_ = false;  // a step that a shorter one replaced is not tried again at once
    growth_ = kGrowth;
    out_.scaled = to;
    out_.cost = cost;
  }

  /// The end, if the Jacobian is one of central differences; else such a one is made first.
  void confirm(const char* message) {
    if (jacobian_->kind() != Kind::central) return jacobian_->renew(Differences::central);
    out_.converged = true;
    out_.message = message;
  }

  /// @param near  the end, where only central differences are good enough
  void refuse(bool near) {
    if (near && jacobian_->kind() != Kind::central) return jacobian_->renew(Differences::central);
    if (jacobian_->kind() == Kind::carried) return jacobian_->renew(Differences::one_sided);
    refused_ = true;
    damping_ = std::clamp(growth_ * damping_, kRefusedDamping, kMostDamping);
    growth_ *= 2.0;
  }

  const Problem& problem_;
  const DescentOptions& options_;
  std::vector<char> fixed_;
  std::optional<SecantJacobian> jacobian_;
  Optimum out_;
  double damping_ = kFirstDamping, growth_ = kGrowth;
  bool refused_ = false;  ///< the latest step that was tried by differences
};

}  // namespace

Optimum secant_descent(const Problem& problem, std::span<const double> start, const DescentOptions& options) {
  return SecantDescent(problem, start, options).run();
}

}  // namespace glisson::fit

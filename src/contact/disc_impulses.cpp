#include "contact/disc_impulses.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

constexpr int kMostDiscSweeps = 4000;
constexpr double kDiscsSettled = 1e-11;  ///< change of a velocity in a sweep, of the largest to be stopped
constexpr int kDiscsTogether = 5;        ///< sweeps, after which all points are solved for together
constexpr double kRidge =
    1e-12;  ///< of the mean of W, on its diagonal: points that nearly coincide share what they get
constexpr double kLeastShare = 1e-4;  ///< of a step that is tried
constexpr int kMostDiscIterations = 40;
constexpr double kOpen = 1e-12;  ///< of the larger eigenvalue: one that is below it moves nothing

Eigen::Vector2d put_within(const Eigen::Vector2d& J, double most) {
  const double size = J.norm();
  return size > most ? (J * (most / size)).eval() : J;
}

/// A step of Newton's method on J_j = P(J_j + ρ s_j) for all points, P the nearest in the disc; taken where ½ Jᵀ W J − Jᵀ r falls by it.
/// Sweeps alone take thousands where points nearly coincide.
void solve_together(const Eigen::MatrixXd& W, std::span<const double> most, Eigen::VectorXd& J, Eigen::VectorXd& slip) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Identity(W.rows(), W.cols());
  Eigen::VectorXd F = Eigen::VectorXd::Zero(W.rows());
  const double ridge = kRidge * W.trace() / static_cast<double>(W.rows());
  for (std::size_t j = 0; j < most.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(2 * j);
    const double trace = W.block<2, 2>(at, at).trace();
    if (!(trace > 0.0) || !(most[j] > 0.0)) continue;  // stays where the sweep has put it
    const double rho = 2.0 / trace;
    const Eigen::Vector2d now = J.segment<2>(at), y = now + rho * slip.segment<2>(at);
    Eigen::Matrix2d T = Eigen::Matrix2d::Identity();  // of P
    if (const double size = y.norm(); size > most[j]) {
      T = (most[j] / size) * (T - y * y.transpose() / (size * size)).eval();
    }
    F.segment<2>(at) = now - put_within(y, most[j]);
    K.middleRows<2>(at) = rho * T * W.middleRows<2>(at);
    K.block<2, 2>(at, at) += Eigen::Matrix2d::Identity() - (1.0 - rho * ridge) * T;
  }
  const Eigen::VectorXd whole = K.partialPivLu().solve(-F);
  if (!whole.allFinite()) return;
  Eigen::VectorXd step(J.size());
  for (double share = 1.0; share > kLeastShare; share *= 0.25) {
    for (std::size_t j = 0; j < most.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(2 * j);
      const Eigen::Vector2d now = J.segment<2>(at);
      step.segment<2>(at) = put_within(now + share * whole.segment<2>(at), most[j]) - now;
    }
    const Eigen::VectorXd slower = W * step;
    if (!(0.5 * step.dot(slower) < step.dot(slip))) continue;
    J += step;
    slip -= slower;
    return;
  }
}

}  // namespace

Eigen::Vector2d within_disc(const Eigen::Matrix2d& A, const Eigen::Vector2d& r, double most) {
  const double speed = r.norm();
  if (!(speed > 0.0) || !(most > 0.0)) return Eigen::Vector2d::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> own;
  own.computeDirect(A);
  const Eigen::Vector2d a = own.eigenvalues().cwiseMax(0.0), q = own.eigenvectors().transpose() * r;
  const double least = kOpen * a[1];
  bool held = false;  // it is pushed where it cannot move
  Eigen::Vector2d J = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (a[i] > least) {
      J[i] = q[i] / a[i];
    } else {
      held = held || std::abs(q[i]) > kOpen * speed;
    }
  }
  if (!held && J.norm() <= most) return own.eigenvectors() * J;
  // (A + λ) J = r with |J| = L: Newton's method on 1/|J| − 1/L, from below, where it stays; |J| ≥ |J_i|
  double lambda = std::max({0.0, speed / most - a[1], std::abs(q[0]) / most - a[0], std::abs(q[1]) / most - a[1]});
  for (int k = 0; k < kMostDiscIterations; ++k) {
    const Eigen::Vector2d shifted = (a.array() + lambda).max(1e-300);
    J = q.cwiseQuotient(shifted);
    const double size = J.norm();
    const double step = (size / most - 1.0) * size * size / J.cwiseProduct(J).cwiseQuotient(shifted).sum();
    if (!(step > 1e-15 * lambda)) break;
    lambda += step;
  }
  return own.eigenvectors() * J * (most / J.norm());
}

int solve_within_discs(const Eigen::MatrixXd& W, const Eigen::VectorXd& r, std::span<const double> most,
                       Eigen::VectorXd& J) {
  const double speed = r.size() > 0 ? r.cwiseAbs().maxCoeff() : 0.0;
  if (!(speed > 0.0)) {
    J.setZero(r.size());
    return 0;
  }
  Eigen::VectorXd slip = r - W * J;
  int sweep = 0;
  for (double change = speed; change > kDiscsSettled * speed && sweep < kMostDiscSweeps; ++sweep) {
    if (sweep % kDiscsTogether == kDiscsTogether - 1) solve_together(W, most, J, slip);
    change = 0.0;
    for (std::size_t j = 0; j < most.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(2 * j);
      const Eigen::Matrix2d own = W.block<2, 2>(at, at);
      const Eigen::Vector2d before = J.segment<2>(at);
      const Eigen::Vector2d more = within_disc(own, slip.segment<2>(at) + own * before, most[j]) - before;
      if (more.isZero(0.0)) continue;
      J.segment<2>(at) += more;
      slip.noalias() -= W.middleCols<2>(at) * more;
      change = std::max(change, (own * more).norm());
    }
  }
  return sweep;
}

}  // namespace glisson

// krylov.h — A x = b for a matrix that is only applied: conjugate gradients, and BiCGSTAB where A is not symmetric.
//
// Eigen's own solvers do not tell when a direction of negative curvature is met, which Newton's method far from
// equilibrium must know: there the best x so far is a direction of descent and is handed out [DemboSteihaug1983].
#pragma once

#include <Eigen/Core>

namespace glisson {

/// How a linear solve went.
struct KrylovResult {
  int iterations = 0;
  bool converged = false;  ///< ‖b − A x‖ ≤ tolerance ‖b‖
  bool curved = false;     ///< x·A x ≤ 0 was met: x is what was found before, a direction of descent
};

/// For solves that always go on.
struct NeverStops {
  bool operator()() const { return false; }
};

/// Preconditioned conjugate gradients from x = 0.
/// @param apply  y = A x, @param precondition  z ≈ A⁻¹ r, symmetric and positive @param stops  asked before each iteration
template <class Apply, class Precondition, class Stops = NeverStops>
KrylovResult conjugate_gradients(const Apply& apply, const Precondition& precondition, const Eigen::VectorXd& b,
                                 double tolerance, int most, Eigen::VectorXd& x, const Stops& stops = {}) {
  KrylovResult result;
  x = Eigen::VectorXd::Zero(b.size());
  Eigen::VectorXd r = b, z(b.size()), q(b.size());
  const double goal = tolerance * b.norm();
  precondition(r, z);
  Eigen::VectorXd p = z;
  double rz = r.dot(z);
  while (r.norm() > goal && result.iterations < most && !stops()) {
    apply(p, q);
    ++result.iterations;
    const double curvature = p.dot(q);
    if (!(curvature > 0.0)) {
      result.curved = true;
      if (result.iterations == 1) x = p;
      return result;
    }
    const double a = rz / curvature;
    x += a * p;
    r -= a * q;
    precondition(r, z);
    const double next = r.dot(z);
    p = z + (next / rz) * p;
    rz = next;
  }
  result.converged = r.norm() <= goal;
  return result;
}

/// Preconditioned BiCGSTAB from x = 0 [VanDerVorst1992].
template <class Apply, class Precondition, class Stops = NeverStops>
KrylovResult bicgstab(const Apply& apply, const Precondition& precondition, const Eigen::VectorXd& b, double tolerance,
                      int most, Eigen::VectorXd& x, const Stops& stops = {}) {
  KrylovResult result;
  const Eigen::Index n = b.size();
  x = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd r = b, p = b, s(n), t(n), v(n), p_hat(n), s_hat(n);
  const double goal = tolerance * b.norm();
  double rho = b.squaredNorm();
  while (r.norm() > goal && result.iterations < most && !stops()) {
    precondition(p, p_hat);
    apply(p_hat, v);
    ++result.iterations;
    const double along = b.dot(v);
    if (along == 0.0) return result;
    const double a = rho / along;
    s = r - a * v;
    precondition(s, s_hat);
    apply(s_hat, t);
    const double tt = t.squaredNorm(), w = tt > 0.0 ? t.dot(s) / tt : 0.0;
    x += a * p_hat + w * s_hat;
    r = s - w * t;
    const double next = b.dot(r);
    if (w == 0.0 || next == 0.0) break;
    p = r + (next / rho) * (a / w) * (p - w * v);
    rho = next;
  }
  result.converged = r.norm() <= goal;
  return result;
}

}  // namespace glisson

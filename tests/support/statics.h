// statics.h — equilibrium of a body of tissue, for tests that know the answer in closed form.
//
// Newton's method on TissueOperator's exact tangent. Each step is solved by a sparse factorisation or, where volume is
// shared and the matrix wide, by conjugate gradients with the 3 × 3 blocks of the diagonal as preconditioner. Slow and
// plain, and independent of the integrators. Both solvers take the tangent for symmetric.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "element/tissue_operator.h"

namespace glisson::test {

using Field = std::vector<Vec3d>;

/// Which components of each vertex are given, and by what.
struct Supports {
  explicit Supports(std::size_t n) : held(n, {false, false, false}), value(n) {}
  void hold(std::uint32_t vertex, std::size_t axis, double displacement = 0.0) {
    held[vertex][axis] = true;
    value[vertex][axis] = displacement;
  }
  void hold_all(std::uint32_t vertex, const Vec3d& displacement = {}) {
    for (std::size_t axis = 0; axis < 3; ++axis) hold(vertex, axis, displacement[axis]);
  }
  /// Sets what is held to 0.
  void clear(Field& field) const {
    for (std::size_t i = 0; i < held.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (held[i][a]) field[i][a] = 0.0;
      }
    }
  }
  /// Sets what is held to its value.
  void apply(Field& u) const {
    for (std::size_t i = 0; i < held.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (held[i][a]) u[i][a] = value[i][a];
      }
    }
  }

  std::vector<std::array<bool, 3>> held;
  Field value;  ///< [m]
};

inline double inner(const Field& a, const Field& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}
inline void add(Field& a, const Field& b, double scale) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i] * scale;
}

/// Inverse 3 × 3 blocks on the diagonal of the tangent, free components only.
class BlockPreconditioner {
 public:
  BlockPreconditioner(const Body& body, const TissueTangent& tangent, const Supports& supports)
      : inverse_(body.vertex_count, Eigen::Matrix3d::Zero()) {
    for (std::size_t e = 0; e < body.elements.size(); ++e) {
      const ElementRest& rest = body.rest[e];
      const Vec3d s0 = -(rest.s[0] + rest.s[1] + rest.s[2]);
      for (std::size_t a = 0; a < 4; ++a) {
        const Vec3d s = a == 0 ? s0 : rest.s[a - 1];
        inverse_[body.elements[e][a]] += rest.volume * block(tangent, e, Eigen::Vector3d(s.x, s.y, s.z));
      }
    }
    for (std::size_t i = 0; i < inverse_.size(); ++i) {
      Eigen::Matrix3d& D = inverse_[i];
      D += 1e-12 * (D.trace() + 1e-300) * Eigen::Matrix3d::Identity();
      for (int a = 0; a < 3; ++a) {
        if (!supports.held[i][static_cast<std::size_t>(a)]) continue;
        D.row(a).setZero(), D.col(a).setZero();
        D(a, a) = 1.0;
      }
      D = D.inverse().eval();
    }
  }
  void apply(const Field& r, Field& z) const {
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Eigen::Vector3d x = inverse_[i] * Eigen::Vector3d(r[i].x, r[i].y, r[i].z);
      z[i] = {x.x(), x.y(), x.z()};
    }
  }

 private:
  static Eigen::Matrix3d block(const TissueTangent& tangent, std::size_t e, const Eigen::Vector3d& s) {
    Eigen::Matrix3d K;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) K(i, k) = s.dot(tangent.local[e].block<3, 3>(3 * i, 3 * k) * s);
    }
    if (tangent.volume.empty()) return K;
    // the mean of four vertices' means: about a quarter of what the element alone would have
    const auto as_eigen = [](const Mat3d& m) {
      return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.m[0].data());
    };
    return K + 0.25 * (as_eigen(tangent.pressure[e]) * s) * (as_eigen(tangent.volume[e]) * s).transpose();
  }

  std::vector<Eigen::Matrix3d> inverse_;
};

/// Solves K x = b on the free components. @return  iterations; −1 where K is not positive
inline int solve_linear(const TissueOperator& op, const TissueTangent& K, const Supports& supports, const Field& b,
                        double tolerance, Field& x) {
  const BlockPreconditioner precondition(op.body(), K, supports);
  Field r = b, z(b.size()), p, Kp(b.size());
  supports.clear(r);
  x.assign(b.size(), {});
  precondition.apply(r, z);
  p = z;
  double rz = inner(r, z);
  const double target = tolerance * tolerance * inner(r, r);
  const int most = 20 * static_cast<int>(b.size()) + 100;
  for (int n = 0; n < most; ++n) {
    if (inner(r, r) <= target) return n;
    op.apply(K, p, Kp);
    supports.clear(Kp);
    const double curvature = inner(p, Kp);
    if (!(curvature > 0.0)) return -1;
    const double alpha = rz / curvature;
    add(x, p, alpha), add(r, Kp, -alpha);
    precondition.apply(r, z);
    const double next = inner(r, z);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = z[i] + p[i] * (next / rz);
    rz = next;
  }
  return most;
}

/// K of the free components, 1 on the diagonal of the held ones; tissues that do not share volume.
inline Eigen::SparseMatrix<double> assembled(const Body& body, const TissueTangent& tangent, const Supports& supports) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto held = [&](std::uint32_t v, int i) { return supports.held[v][static_cast<std::size_t>(i)]; };
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    const ElementRest& rest = body.rest[e];
    const Vec3d s0 = -(rest.s[0] + rest.s[1] + rest.s[2]);
    Eigen::Matrix<double, 9, 12> B = Eigen::Matrix<double, 9, 12>::Zero();  // H of the twelve displacements
    for (int a = 0; a < 4; ++a) {
      const Vec3d s = a == 0 ? s0 : rest.s[static_cast<std::size_t>(a) - 1];
      for (int i = 0; i < 3; ++i) B.block<3, 1>(3 * i, 3 * a + i) = Eigen::Vector3d(s.x, s.y, s.z);
    }
    const Eigen::Matrix<double, 12, 12> K = rest.volume * B.transpose() * tangent.local[e] * B;
    for (int r = 0; r < 12; ++r) {
      for (int c = 0; c < 12; ++c) {
        const std::uint32_t row = body.elements[e][static_cast<std::size_t>(r / 3)],
                            column = body.elements[e][static_cast<std::size_t>(c / 3)];
        if (held(row, r % 3) || held(column, c % 3)) continue;
        entries.emplace_back(static_cast<int>(3 * row) + r % 3, static_cast<int>(3 * column) + c % 3, K(r, c));
      }
    }
  }
  for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
    for (int i = 0; i < 3; ++i) {
      if (held(v, i)) entries.emplace_back(static_cast<int>(3 * v) + i, static_cast<int>(3 * v) + i, 1.0);
    }
  }
  const int n = static_cast<int>(3 * body.vertex_count);
  Eigen::SparseMatrix<double> K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// Solves K x = b on the free components. @return  whether it could
inline bool solve(const TissueOperator& op, const TissueTangent& K, const Supports& supports, const Field& b,
                  double tolerance, Field& x) {
  if (!K.volume.empty()) return solve_linear(op, K, supports, b, tolerance, x) >= 0;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(assembled(op.body(), K, supports));
  if (factors.info() != Eigen::Success) return false;
  Field r = b;
  supports.clear(r);
  const Eigen::VectorXd solution =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(&r[0].x, static_cast<Eigen::Index>(3 * r.size())));
  x.resize(b.size());
  Eigen::Map<Eigen::VectorXd>(&x[0].x, static_cast<Eigen::Index>(3 * x.size())) = solution;
  return true;
}

/// Elastic and viscous forces together [N].
inline Field forces(const TissueOperator& op, const TissueState& state) {
  Field f(state.u.size()), viscous(state.u.size());
  ElementWatch watch;
  op.forces(state, f, viscous, watch);
  add(f, viscous, 1.0);
  return f;
}

/// Equilibrium under supports and dead loads, from u on. Maxwell branches relax for `since`.
/// @param load  [N] per vertex; empty: none
/// @return  whether the residual fell below `tolerance` of the reactions
inline bool equilibrate(const TissueOperator& op, const Supports& supports, const Field& load, Field& u,
                        double since = 0.0, double tolerance = 1e-9) {
  const Field still(u.size());
  TissueTangent K;
  Field start = u, step;
  supports.apply(start);
  for (int n = 0; n < 40; ++n) {
    op.linearise({u, still, since}, 0.0, false, K);
    Field r = forces(op, {u, still, since});
    if (!load.empty()) add(r, load, 1.0);
    Field jump(u.size());
    bool jumps = false;
    for (std::size_t i = 0; i < u.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (supports.held[i][a]) jump[i][a] = supports.value[i][a] - u[i][a], jumps = jumps || jump[i][a] != 0.0;
      }
    }
    if (jumps) {  // the first step carries the supports to where they belong
      Field pulled(u.size());
      op.apply(K, jump, pulled);
      add(r, pulled, -1.0), add(u, jump, 1.0);
    }
    double reactions = inner(r, r);
    supports.clear(r);
    const double residual = inner(r, r);
    if (!jumps && (residual <= tolerance * tolerance * reactions)) return true;
    if (!solve(op, K, supports, r, 1e-3 * tolerance, step)) return false;
    add(u, step, 1.0);
  }
  return false;
}

/// Sum of what supports exert on a set of vertices, in equilibrium [N].
inline Vec3d reaction(const TissueOperator& op, const Field& u, std::span<const std::uint32_t> vertices,
                      double since = 0.0) {
  const Field still(u.size()), f = forces(op, {u, still, since});
  Vec3d sum;
  for (const std::uint32_t v : vertices) sum -= f[v];
  return sum;
}

}  // namespace glisson::test

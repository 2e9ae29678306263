// projective_dynamics.cpp — projective dynamics: each tet's F is projected onto what it wants to be, then all positions are solved for
// at once with a matrix that never changes [Bouaziz2014]:
//
//   μ V ‖F − R‖²             R the nearest rotation
//   (3 λ V/2) ‖F − S‖²       S the nearest matrix of determinant 1; at rest this is ½ λ V tr(ε)²
//
// Both have the tissue's stiffness at rest once the iterations have converged; with fewer the body is stiffer or softer.
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <memory>
#include <string>

#include "compare/models/boundary.h"
#include "compare/models/relaxation.h"
#include "compare/models/stepping.h"

namespace glisson::models {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// The nearest singular values of product 1: σ + d with Π (σ + d) = 1 and least |d|, by Newton steps along the gradient.
Eigen::Vector3d of_unit_product(const Eigen::Vector3d& sigma) {
  Eigen::Vector3d d = Eigen::Vector3d::Zero();
  for (int k = 0; k < 10; ++k) {
    const Eigen::Vector3d v = sigma + d;
    const double c = v[0] * v[1] * v[2] - 1.0;
    const Eigen::Vector3d g(v[1] * v[2], v[0] * v[2], v[0] * v[1]);
    d = g * ((g.dot(d) - c) / g.squaredNorm());
  }
  return sigma + d;
}

/// F = left diag(sigma) rightᵀ with two rotations; the least value is negative where F is inside out.
struct Split {
  Eigen::Matrix3d left, right;
  Eigen::Vector3d sigma;
};

Split split_of(const Mat3d& f) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = f(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m.transpose() * m);
  Split split;
  split.right = solver.eigenvectors().rowwise().reverse();  // the largest first
  if (split.right.determinant() < 0.0) split.right.col(2) *= -1.0;
  const Eigen::Matrix3d turned = m * split.right;
  split.left.col(0) = turned.col(0).normalized();
  split.left.col(1) = (turned.col(1) - split.left.col(0) * split.left.col(0).dot(turned.col(1))).normalized();
  split.left.col(2) = split.left.col(0).cross(split.left.col(1));
  for (int k = 0; k < 3; ++k) split.sigma[k] = split.left.col(k).dot(turned.col(k));
  return split;
}

class Projective {
 public:
  /// @param h  of all steps: the matrix has it
  Projective(const Problem& problem, double h, int iterations)
      : problem_(problem), boundary_(problem), h_(h), iterations_(iterations), masses_(lumped_masses(problem)),
        u_(masses_.size()), v_(masses_.size()), f_(masses_.size()) {
    for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
      const RestTet rest = rest_tet(problem.mesh, t);
      const LameParameters lame = test_moduli(problem, problem.tissue_of(t));
      tets_.push_back({rest, 2.0 * lame.mu * rest.volume, 3.0 * lame.lambda * rest.volume});
    }
    make_matrix();
  }

  /// The tets weigh nothing any more, and the matrix is factorised anew. Their mass stays.
  std::string remove(std::span<const std::uint32_t> tets) {
    for (const std::uint32_t t : tets) tets_[t].shape = tets_[t].volume = 0.0;
    factors_.clear();
    make_matrix();
    return {};
  }

  void advance(double time, double /*h*/) {
    const std::vector<Vec3d> before = u_;
    std::vector<Vec3d> inertial(u_.size());
    const Vec3d gravity = problem_.gravity_at(time);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      v_[i] = (v_[i] + gravity * h_) * (1.0 / (1.0 + problem_.motion.damping_rate * h_));
      inertial[i] = u_[i] + v_[i] * h_;
    }
    u_ = inertial;
    boundary_.set(time + h_, u_);
    for (int k = 0; k < iterations_; ++k) {
      project();
      for (std::size_t axis = 0; axis < 3; ++axis) solve(axis, inertial);
    }
    for (std::size_t i = 0; i < u_.size(); ++i) v_[i] = (u_[i] - before[i]) * (1.0 / h_);
  }

  Vec3d force(double time) {
    project();
    std::vector<Vec3d> own(f_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd pull = elastic_ * column(u_, axis);
      for (std::size_t i = 0; i < own.size(); ++i)
        own[i][axis] += problem_.gravity_at(time)[axis] * masses_[i] - pull[index(i)];
    }
    return boundary_.force(own, u_);
  }

  const std::vector<Vec3d>& displacement() const { return u_; }
  std::size_t bytes() const {
    std::size_t entries = static_cast<std::size_t>(elastic_.nonZeros());
    for (const auto& f : factors_) entries += static_cast<std::size_t>(f->matrixL().nestedExpression().nonZeros());
    return 12 * entries + tets_.size() * sizeof(TetState) + u_.size() * 3 * sizeof(Vec3d);
  }

 private:
  void make_matrix() {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      const auto& s = tets_[t].rest.s;
      const double weight = tets_[t].shape + tets_[t].volume;
      if (weight == 0.0) continue;
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
          entries.emplace_back(static_cast<int>(problem_.mesh.tets[t][a]), static_cast<int>(problem_.mesh.tets[t][b]),
                               weight * dot(s[a], s[b]));
        }
      }
    }
    elastic_.resize(index(masses_.size()), index(masses_.size()));
    elastic_.setFromTriplets(entries.begin(), entries.end());
    for (std::size_t axis = 0; axis < 3; ++axis) factorise(axis);
  }

  struct TetState {
    RestTet rest;
    double shape, volume;  // weights
  };

  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  static Eigen::VectorXd column(const std::vector<Vec3d>& vectors, std::size_t axis) {
    Eigen::VectorXd out(index(vectors.size()));
    for (std::size_t i = 0; i < vectors.size(); ++i) out[index(i)] = vectors[i][axis];
    return out;
  }
  bool prescribed(Eigen::Index i, std::size_t axis) const {
    return boundary_.prescribes(static_cast<std::size_t>(i), axis);
  }

  /// M/h² + Σ w GᵀG of the free components along an axis; axes that prescribe the same vertices share it.
  void factorise(std::size_t axis) {
    for (std::size_t other = 0; other < axis; ++other) {
      bool same = true;
      for (Eigen::Index i = 0; same && i < elastic_.rows(); ++i) same = prescribed(i, axis) == prescribed(i, other);
      if (!same) continue;
      factor_of_[axis] = factor_of_[other];
      return;
    }
    Sparse matrix = elastic_;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      matrix.coeffRef(i, i) += masses_[static_cast<std::size_t>(i)] / (h_ * h_);
    matrix.prune([&](Eigen::Index i, Eigen::Index j, double) {
      return i == j || (!prescribed(i, axis) && !prescribed(j, axis));
    });
    factors_.push_back(std::make_unique<Eigen::SimplicialLDLT<Sparse>>(matrix));
    factor_of_[axis] = factors_.size() - 1;
  }

  /// Σ w Gᵀ (P − I) of all tets into f_, P what each tet's F is projected onto.
  void project() {
    std::fill(f_.begin(), f_.end(), Vec3d{});
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      const TetState& state = tets_[t];
      if (state.shape == 0.0) continue;
      const Tet& tet = problem_.mesh.tets[t];
      const Mat3d f = deformation_gradient(state.rest, tet, u_);
      const Split split = split_of(f);
      const Eigen::Vector3d wanted =
          Eigen::Vector3d::Constant(state.shape) + state.volume * of_unit_product(split.sigma);
      const Eigen::Matrix3d p = split.left * wanted.asDiagonal() * split.right.transpose() -
                                (state.shape + state.volume) * Eigen::Matrix3d::Identity();
      for (std::size_t a = 0; a < 4; ++a) {
        const Eigen::Vector3d g = p * Eigen::Vector3d(state.rest.s[a].x, state.rest.s[a].y, state.rest.s[a].z);
        f_[tet[a]] += Vec3d{g[0], g[1], g[2]};
      }
    }
  }

  void solve(std::size_t axis, const std::vector<Vec3d>& inertial) {
    Eigen::VectorXd given = column(u_, axis);
    for (Eigen::Index i = 0; i < given.size(); ++i) {
      if (!prescribed(i, axis)) given[i] = 0.0;
    }
    Eigen::VectorXd right = -(elastic_ * given);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      right[index(i)] += f_[i][axis] + masses_[i] / (h_ * h_) * inertial[i][axis];
      if (boundary_.prescribes(i, axis)) right[index(i)] = 0.0;
    }
    const Eigen::VectorXd solved = factors_[factor_of_[axis]]->solve(right);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      if (!boundary_.prescribes(i, axis)) u_[i][axis] = solved[index(i)];
    }
  }

  const Problem& problem_;
  Boundary boundary_;
  double h_;
  int iterations_;
  std::vector<double> masses_;
  std::vector<TetState> tets_;
  Sparse elastic_;
  std::vector<std::unique_ptr<Eigen::SimplicialLDLT<Sparse>>> factors_;
  std::array<std::size_t, 3> factor_of_{};
  std::vector<Vec3d> u_, v_, f_;
};

}  // namespace

Answer projective_dynamics(const Problem& problem, const Effort& effort, const Stop& stop) {
  Stopwatch watch;
  Projective model(problem, problem.duration / effort.steps, effort.iterations);
  return run_in_steps(problem, stop, model, static_cast<std::size_t>(effort.steps), watch);
}

}  // namespace glisson::models

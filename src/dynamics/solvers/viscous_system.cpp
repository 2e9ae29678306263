#include "dynamics/solvers/viscous_system.h"

#include <algorithm>
#include <array>

#include "dynamics/solvers/krylov.h"

namespace glisson {
namespace {

constexpr double kTolerance = 1e-6;  ///< of conjugate gradients
constexpr int kMostViscousIterations = 1000;

}  // namespace

bool ViscousSystem::needed(const Body& body) {
  return std::any_of(body.blocks.begin(), body.blocks.end(),
                     [](const TissueBlock& b) { return b.tissue.viscosity > 0.0; });
}

/// Rows of the free components, and of the held ones.
void ViscousSystem::number() {
  row_.assign(held_.size(), 0);
  free_of_row_.clear(), held_of_row_.clear();
  for (std::size_t c = 0; c < held_.size(); ++c) {
    std::vector<std::size_t>& list = held_[c] != 0 ? held_of_row_ : free_of_row_;
    row_[c] = static_cast<Eigen::Index>(list.size());
    list.push_back(c);
  }
}

bool ViscousSystem::build(const Body& body, std::span<const double> nodal_damping, double h, std::vector<char> held,
                          std::span<const Vec3d> dashpots, std::size_t most_tets) {
  h_ = h;
  held_ = std::move(held);
  number();
  const auto free = static_cast<Eigen::Index>(free_of_row_.size()),
             fixed = static_cast<Eigen::Index>(held_of_row_.size());
  std::vector<Eigen::Triplet<double>> inner, across, outer;
  for (const std::size_t c : free_of_row_)
    inner.emplace_back(
        row_[c], row_[c],
        body.masses[c / 3] + h * (nodal_damping[c / 3] + (dashpots.empty() ? 0.0 : dashpots[c / 3][c % 3])));
  for (const TissueBlock& block : body.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) {
      const std::array<Vec3d, 4> s = shape_gradients(body.rest[e]);
      const double V = body.rest[e].volume, a = V * block.viscous.lambda, b = V * block.viscous.mu;
      for (std::size_t k = 0; k < 144; ++k) {  // a s_p s_qᵀ + b (s_q s_pᵀ + s_p·s_q I)
        const std::size_t p = k / 36, q = k / 9 % 4, i = k / 3 % 3, j = k % 3;
        const double value = a * s[p][i] * s[q][j] + b * (s[q][i] * s[p][j] + (i == j ? dot(s[p], s[q]) : 0.0));
        const std::size_t row = 3 * body.elements[e][p] + i, column = 3 * body.elements[e][q] + j;
        if (held_[row] == 0 && held_[column] == 0) inner.emplace_back(row_[row], row_[column], h * value);
        if (held_[row] != 0 && held_[column] == 0) across.emplace_back(row_[row], row_[column], value);
        if (held_[row] != 0 && held_[column] != 0) outer.emplace_back(row_[row], row_[column], value);
      }
    }
  }
  matrix_.resize(free, free), coupling_.resize(fixed, free), held_block_.resize(fixed, fixed);
  matrix_.setFromTriplets(inner.begin(), inner.end());
  coupling_.setFromTriplets(across.begin(), across.end());
  held_block_.setFromTriplets(outer.begin(), outer.end());
  packed_.resize(free, 1);
  last_ = Eigen::VectorXd::Zero(free);
  factorised_ = body.elements.size() <= most_tets;
  ++factor_number_;
  solved_.reset();
  if (factorised_) return factor_.factorise(matrix_.triangularView<Eigen::Lower>());
  rows_ = matrix_;
  inverse_diagonal_ = matrix_.diagonal().cwiseInverse();
  return inverse_diagonal_.allFinite();
}

void ViscousSystem::iterate(Eigen::MatrixXd& x) {
  const auto product = [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) { out.noalias() = rows_ * in; };
  const auto nearly = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = r.cwiseProduct(inverse_diagonal_); };
  const double size = x.norm();
  const Eigen::VectorXd left = x.col(0) - rows_ * last_;
  Eigen::VectorXd more;
  const double rest = left.norm();
  if (rest > kTolerance * size) {
    conjugate_gradients(product, nearly, left, kTolerance * size / rest, kMostViscousIterations, more);
    last_ += more;
  }
  x = last_;
}

void ViscousSystem::solve(std::span<const Vec3d> b, std::span<Vec3d> x) {
  Eigen::VectorXd given(static_cast<Eigen::Index>(held_of_row_.size()));
  for (std::size_t r = 0; r < held_of_row_.size(); ++r) {
    given[static_cast<Eigen::Index>(r)] = x[held_of_row_[r] / 3][held_of_row_[r] % 3];
  }
  for (std::size_t r = 0; r < free_of_row_.size(); ++r) {
    packed_(static_cast<Eigen::Index>(r), 0) = b[free_of_row_[r] / 3][free_of_row_[r] % 3];
  }
  if (given.squaredNorm() > 0.0) packed_.noalias() -= h_ * (coupling_.transpose() * given);
  if (factorised_) {
    factor_.solve(packed_);
  } else {
    iterate(packed_);
  }
  for (std::size_t r = 0; r < free_of_row_.size(); ++r) {
    x[free_of_row_[r] / 3][free_of_row_[r] % 3] = packed_(static_cast<Eigen::Index>(r), 0);
  }
  last_ = packed_;
}

bool ViscousSystem::set_last(std::span<const double> last) {
  if (static_cast<Eigen::Index>(last.size()) != last_.size()) return false;
  std::copy(last.begin(), last.end(), last_.begin());
  return true;
}

void ViscousSystem::factor_solve(Eigen::MatrixXd& x) const {
  Eigen::MatrixXd packed(static_cast<Eigen::Index>(free_of_row_.size()), x.cols());
  for (std::size_t r = 0; r < free_of_row_.size(); ++r) {
    packed.row(static_cast<Eigen::Index>(r)) = x.row(static_cast<Eigen::Index>(free_of_row_[r]));
  }
  factor_.solve(packed);
  x.setZero();
  for (std::size_t r = 0; r < free_of_row_.size(); ++r) {
    x.row(static_cast<Eigen::Index>(free_of_row_[r])) = h_ * h_ * packed.row(static_cast<Eigen::Index>(r));
  }
}

void ViscousSystem::held_drag(std::span<const Vec3d> x, std::span<Vec3d> drag) const {
  const auto gather = [&](const std::vector<std::size_t>& components) {
    Eigen::VectorXd of(static_cast<Eigen::Index>(components.size()));
    for (std::size_t r = 0; r < components.size(); ++r) {
      of[static_cast<Eigen::Index>(r)] = x[components[r] / 3][components[r] % 3];
    }
    return of;
  };
  const Eigen::VectorXd pull = coupling_ * gather(free_of_row_) + held_block_ * gather(held_of_row_);
  std::fill(drag.begin(), drag.end(), Vec3d{});
  for (std::size_t r = 0; r < held_of_row_.size(); ++r) {
    drag[held_of_row_[r] / 3][held_of_row_[r] % 3] = pull[static_cast<Eigen::Index>(r)];
  }
}

}  // namespace glisson

#include "contact/coupled_shaft.h"

#include "base/two_across.h"
#include "contact/coupled_points.h"

namespace glisson::shaft {
namespace {

constexpr Effort kEffort{.most_sweeps = 4000, .enough = 1e-11, .most_breaks = 30};

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// Directions of rows as columns: three components a row.
Eigen::MatrixXd directions(std::size_t rows, std::size_t used, std::span<const Vec3d> each) {
  const std::size_t n = each.size();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(at(3 * rows), at(n * used));
  for (std::size_t j = 0; j < used; ++j) {
    for (std::size_t i = 0; i < n; ++i) all.block<3, 1>(at(3 * j), at(n * j + i)) = eigen(each[i]);
  }
  return all;
}

}  // namespace

CoupledShaft::CoupledShaft(Block& block, const Eigen::MatrixXd& W) : block_(block), e_(two_across(block.direction)) {
  const std::size_t n = block.rows.size(), held = block.held;
  const Eigen::MatrixXd E = directions(n, held, e_), d = directions(n, n, {&block.direction, 1});
  along_ = d.transpose() * W * d;
  given_.resize(n);
  if (held < n) {  // the last one: a tip that cuts
    const Eigen::VectorXd moved = W.rightCols<3>() * eigen(block.across.back());
    for (std::size_t j = 0; j < n; ++j) given_[j] = {moved[at(3 * j)], moved[at(3 * j + 1)], moved[at(3 * j + 2)]};
  }
  if (held == 0) return;
  Eigen::MatrixXd A = E.transpose() * W * E;
  by_along_ = E.transpose() * W * d;
  const double slack = block.slack_share * A.trace() / static_cast<double>(2 * held);
  for (std::size_t j = 0; j < held; ++j) {
    for (std::size_t k = 0; k < held; ++k) {
      for (std::size_t i = 0; i < 2; ++i) A(at(2 * j + i), at(2 * k + i)) += block.compliance(at(j), at(k));
    }
  }
  A.diagonal().array() += slack;
  across_.compute(0.5 * (A + A.transpose()));
  across_by_along_ = across_.solve(by_along_);
  along_ -= by_along_.transpose() * across_by_along_;
}

/// What impulses across are to make up for, two components a held row [m/s].
Eigen::VectorXd CoupledShaft::wanted_across(std::span<const Vec3d> tissue) const {
  Eigen::VectorXd wanted(at(2 * block_.held));
  for (std::size_t j = 0; j < block_.held; ++j) {
    const Vec3d speed = (block_.off[j] + block_.more[j]) * (1.0 / block_.h) - (tissue[j] + given_[j] - block_.velocity);
    for (std::size_t i = 0; i < 2; ++i) wanted[at(2 * j + i)] = dot(e_[i], speed);
  }
  return wanted;
}

void CoupledShaft::solve(std::span<const Vec3d> tissue) {
  const std::size_t n = block_.rows.size();
  const Eigen::VectorXd wanted = wanted_across(tissue);
  Eigen::VectorXd speed(at(n));
  for (std::size_t j = 0; j < n; ++j) {
    speed[at(j)] = dot(block_.velocity - tissue[j] - given_[j], block_.direction) - block_.closing[j];
  }
  if (block_.held > 0) speed -= across_by_along_.transpose() * wanted;
  std::vector<int> in_sweeps(n, 0);
  block_.slips = solve_along(along_, std::vector<double>(speed.begin(), speed.end()), block_.limits, block_.friction,
                             block_.h, block_.along, kEffort, in_sweeps);
  if (block_.held == 0) return;
  const Eigen::Map<const Eigen::VectorXd> p(block_.along.data(), at(n));
  const Eigen::VectorXd across = across_.solve(wanted - by_along_ * p);
  for (std::size_t j = 0; j < block_.held; ++j) {
    block_.across[j] = e_[0] * across[at(2 * j)] + e_[1] * across[at(2 * j + 1)];
  }
}

}  // namespace glisson::shaft

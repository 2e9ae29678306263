#include "contact/coupled_newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/two_across.h"
#include "contact/point_laws.h"

namespace glisson {
namespace {

constexpr int kMostNewtons = 10;
constexpr double kNewtonSettled = 1e-7;  ///< what iterations leave of what was lacking
constexpr double kBetter = 0.5;          ///< the same, of iterations that are taken
constexpr std::array kDampings{0.0, 1e-3, 1e-2};
constexpr Eigen::Index kMostUnknowns = 300;  ///< above it the cost grows beyond that of sweeps

Vec3d vec(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }

/// The nearest to y of no more than `most`.
Eigen::Vector2d within(const Eigen::Vector2d& y, double most) {
  const double size = y.norm();
  return size > most ? (y * (most / size)).eval() : y;
}

double limit_of(const ContactRow& row) { return row.pressing > 0.0 ? row.solid->friction * row.pressing : 0.0; }

}  // namespace

CoupledNewton::CoupledNewton(std::span<ContactRow* const> rows, CoupledPoints& points, double h)
    : rows_(rows), points_(points), h_(h) {
  for (const ContactRow* row : rows) {
    const auto [s, t] = two_across(row->normal);
    frames_.emplace_back() << eigen(row->normal), eigen(s), eigen(t);
  }
  away_.resize(rows.size()), wanted_.resize(rows.size()), presses_.resize(rows.size());
}

bool CoupledNewton::is_of_use() const {
  return std::all_of(rows_.begin(), rows_.end(), [](const ContactRow* row) {
    const bool is_free = std::min({row->response.x, row->response.y, row->response.z}) > 0.0;
    return is_free && !row->fast && row->softness == 0.0;
  });
}

Vec3d CoupledNewton::end(std::size_t k) const {
  const ContactRow& row = *rows_[k];
  return row.solid->after.to_own(row.origin + points_.velocity(k) * h_);
}

Eigen::Vector3d CoupledNewton::in_frame(std::size_t k, const Vec3d& x) const {
  return frames_[k].transpose() * eigen(x);
}

/// How fast the point goes along the solid, or away from where it is bonded [m/s].
Eigen::Vector3d CoupledNewton::drift(std::size_t k) const {
  const ContactRow& row = *rows_[k];
  return in_frame(k, row.solid->after.axes * (end(k) - (row.bonded ? row.face : row.start)) * (1.0 / h_));
}

/// ρ: impulse across the normal by the slip that it is to stop.
double CoupledNewton::across(std::size_t k) const { return 1.0 / rows_[k]->response.x; }

/// Whether the point would be behind its plane without the row's own impulse: there alone a law of points presses (point_laws.h).
bool CoupledNewton::meets(std::size_t k, const Vec3d& end) const {
  const ContactRow& row = *rows_[k];
  if (row.solid->traits.hollow) return true;
  const Vec3d own = transposed(row.solid->after.axes) * points_.own(k, row.normal) * (h_ * row.pressing);
  return dot(row.n, row.face - (end - own)) + row.level > 0.0;
}

/// What the equations ask impulses to change by, in the frames of the rows.
Eigen::VectorXd CoupledNewton::find_lack() {
  Eigen::VectorXd lack(CoupledPoints::at(rows_.size()));
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const ContactRow& row = *rows_[k];
    const Eigen::Index i = CoupledPoints::at(k);
    const Eigen::Vector3d speed = drift(k);
    if (row.bonded) {
      presses_[k] = 1, lack.segment<3>(i) = -across(k) * speed;
      continue;
    }
    const Vec3d y = end(k);
    ShapeDistance gap{dot(row.n, y - row.face), row.n};
    if (!row.solid->holds) gap = point_laws::distance_of(row, y);
    away_[k] = in_frame(k, row.solid->after.axes * gap.normal);
    const double p = row.pressing - (gap.distance - row.level) / (h_ * row.along);
    presses_[k] = row.solid->holds || (p > 0.0 && meets(k, y));
    lack[i] = (presses_[k] != 0 ? p : 0.0) - row.pressing;
    const Eigen::Vector2d r = in_frame(k, row.rubbing).tail<2>();
    wanted_[k] = r - across(k) * speed.tail<2>();
    lack.segment<2>(i + 1) = within(wanted_[k], limit_of(row)) - r;
  }
  return lack;
}

/// Components of impulses that take part.
std::vector<Eigen::Index> CoupledNewton::unknowns() const {
  std::vector<Eigen::Index> all;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const ContactRow& row = *rows_[k];
    const bool rubs = row.bonded || limit_of(row) > 0.0 || row.rubbing != Vec3d{};
    if (presses_[k] == 0 && row.pressing == 0.0 && !rubs) continue;
    for (Eigen::Index i = 0; i < (rubs ? 3 : 1); ++i) all.push_back(CoupledPoints::at(k) + i);
  }
  return all;
}

Eigen::VectorXd CoupledNewton::change(const Eigen::VectorXd& lack, double damping) const {
  const std::vector<Eigen::Index> mine = unknowns();
  const auto n = static_cast<Eigen::Index>(mine.size());
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(lack.size());
  if (n == 0 || n > kMostUnknowns) return whole;
  Eigen::MatrixXd K = Eigen::MatrixXd::Identity(n, n), W(3, n);
  for (Eigen::Index u = 0; u < n;) {
    const auto k = static_cast<std::size_t>(mine[static_cast<std::size_t>(u)] / 3);
    const ContactRow& row = *rows_[k];
    const Eigen::Index mine_end =
        u + 3 <= n && mine[static_cast<std::size_t>(u + 2)] == CoupledPoints::at(k) + 2 ? 3 : 1;
    for (Eigen::Index c = 0; c < n; ++c) {  // how each unknown moves the point, in its frame
      const Eigen::Index column = mine[static_cast<std::size_t>(c)];
      const auto by = static_cast<std::size_t>(column / 3);
      W.col(c) = frames_[k].transpose() *
                 (points_.W().block<3, 3>(CoupledPoints::at(k), CoupledPoints::at(by)) * frames_[by].col(column % 3));
    }
    if (row.bonded) {
      K.middleRows<3>(u) = across(k) * W;
    } else {
      if (presses_[k] != 0) K.row(u) = away_[k].transpose() * W / row.along;
      const double limit = limit_of(row);
      if (mine_end == 3 && limit > 0.0) {
        const double size = wanted_[k].norm();
        Eigen::Matrix2d T = Eigen::Matrix2d::Identity();
        if (size > limit) {
          const Eigen::Vector2d y = wanted_[k] / size;
          T = (limit / size) * (T - y * y.transpose()).eval();
          K.block<2, 1>(u + 1, u) -= row.solid->friction * y;
        }
        K.middleRows<2>(u + 1) += across(k) * T * W.bottomRows<2>();
        K.block<2, 2>(u + 1, u + 1) -= T;
      }
    }
    u += mine_end;
  }
  K.diagonal().array() += damping;
  Eigen::VectorXd asked(n);
  for (Eigen::Index u = 0; u < n; ++u) asked[u] = lack[mine[static_cast<std::size_t>(u)]];
  const Eigen::VectorXd found = K.partialPivLu().solve(asked);
  for (Eigen::Index u = 0; u < n; ++u) whole[mine[static_cast<std::size_t>(u)]] = found[u];
  return whole;
}

/// Changes the impulses, as far as friction allows.
void CoupledNewton::take(const Eigen::VectorXd& change) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ContactRow& row = *rows_[k];
    const Vec3d before = row.impulse();
    const Eigen::Vector3d more = change.segment<3>(CoupledPoints::at(k));
    if (more.isZero(0.0)) continue;
    row.pressing += more[0];
    row.rubbing += vec(frames_[k].rightCols<2>() * more.tail<2>());
    if (!row.bonded) {
      const double limit = limit_of(row), size = norm(row.rubbing);
      if (size > limit) row.rubbing *= limit / size;
    }
    points_.push(k, row.impulse() - before);
  }
}

bool CoupledNewton::improve() {
  struct Impulse {
    double pressing;
    Vec3d rubbing;
  };
  std::vector<Impulse> before;
  for (const ContactRow* row : rows_) before.push_back({row->pressing, row->rubbing});
  const Eigen::VectorXd v = points_.velocities();
  const double first = find_lack().norm();
  for (const double damping : kDampings) {
    Eigen::VectorXd lack = find_lack();
    for (int k = 0; k < kMostNewtons && lack.norm() > kNewtonSettled * first; ++k) {
      const Eigen::VectorXd more = change(lack, damping);
      if (!more.allFinite() || more.isZero(0.0)) break;
      take(more);
      lack = find_lack();
    }
    if (lack.norm() < kBetter * first) return true;
    for (std::size_t k = 0; k < rows_.size(); ++k)
      rows_[k]->pressing = before[k].pressing, rows_[k]->rubbing = before[k].rubbing;
    points_.velocities() = v;
  }
  return false;
}

}  // namespace glisson

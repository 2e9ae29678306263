#include "instruments/contact/long_rows.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/two_across.h"

namespace glisson {
namespace {

/// Compliance of a row over what moves its point: those that nearly coincide share what they get, and there is one answer, with the
/// least impulses.
constexpr double kSlack = 1e-8;
constexpr int kMostIterations = 10;
constexpr double kSettled = 1e-6;  ///< what iterations leave of what was lacking
constexpr double kBetter = 0.5;    ///< the same, of iterations that are taken
constexpr std::array kDampings{0.0, 1e-3, 1e-2};
constexpr double kImmobile = 1e-12;  ///< of the largest mobility: a way that is moved by less is held

Eigen::Vector3d eigen(const Vec3d& a) { return {a.x, a.y, a.z}; }
Vec3d vec(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }

/// The nearest to y of no more than `most`.
Eigen::Vector2d within(const Eigen::Vector2d& y, double most) {
  const double size = y.norm();
  return size > most ? (y * (most / size)).eval() : y;
}

double largest(const Vec3d& a) { return std::max({a.x, a.y, a.z}); }

bool moves_freely(const ContactRow& row) { return std::min({row.response.x, row.response.y, row.response.z}) > 0.0; }

double limit_of(const ContactRow& row) { return row.pressing > 0.0 ? row.solid->friction * row.pressing : 0.0; }

}  // namespace

LongRows::LongRows(std::span<ContactRow> rows, const InteractionStep& step) : rows_(rows), step_(step) {
  W_.setZero(at(rows.size()), at(rows.size()));
  v_.resize(at(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& by = rows[k];
    for (std::size_t j = 0; j < rows.size(); ++j) {
      Mat3d sum{};
      for (std::uint32_t b = 0; b < by.count; ++b) {
        for (std::uint32_t a = 0; a < rows[j].count; ++a) {
          const double share = rows[j].weights[a] * by.weights[b];
          step.compliance->add_between(rows[j].places[a], by.places[b], share, sum);
        }
      }
      for (std::size_t i = 0; i < 9; ++i)
        W_(at(j) + static_cast<Eigen::Index>(i / 3), at(k) + static_cast<Eigen::Index>(i % 3)) = sum(i / 3, i % 3);
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ContactRow& row = rows[k];
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) v += step.vertices[row.places[i]].velocity * row.weights[i];
    const double slack = kSlack * largest(row.response);
    W_.diagonal().segment<3>(at(k)).array() += slack;
    v_.segment<3>(at(k)) = eigen(v + row.impulse() * slack);
    at_first_.push_back(row.impulse());
    const auto [s, t] = two_across(row.normal);
    frames_.emplace_back() << eigen(row.normal), eigen(s), eigen(t);
    row.along = std::max(kImmobile * largest(row.response), dot(row.normal, own(k, row.normal)));
  }
  in_frames_.resize(W_.rows(), W_.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      in_frames_.block<3, 3>(at(j), at(k)).noalias() =
          frames_[j].transpose() * W_.block<3, 3>(at(j), at(k)) * frames_[k];
    }
  }
}

Vec3d LongRows::end(std::size_t k) const {
  return rows_[k].solid->after.to_own(rows_[k].origin + vec(v_.segment<3>(at(k))) * step_.h);
}

Vec3d LongRows::own(std::size_t k, const Vec3d& impulse) const {
  return vec(W_.block<3, 3>(at(k), at(k)) * eigen(impulse));
}

void LongRows::push(std::size_t k, const Vec3d& impulse) { v_.noalias() += W_.middleCols<3>(at(k)) * eigen(impulse); }

void LongRows::finish() {
  std::vector<Vec3d> more(step_.vertices.size());
  std::vector<std::uint32_t> places;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Vec3d impulse = rows_[k].impulse() - at_first_[k];
    for (std::uint32_t i = 0; i < rows_[k].count && impulse != Vec3d{}; ++i) {
      places.push_back(rows_[k].places[i]);
      more[rows_[k].places[i]] += impulse * rows_[k].weights[i];
    }
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const std::uint32_t place : places) step_.push(place, more[place]);
}

Eigen::Vector3d LongRows::in_frame(std::size_t k, const Vec3d& x) const { return frames_[k].transpose() * eigen(x); }

/// How fast the point goes along the solid, or away from where it is bonded, in the frame of the row [m/s].
Eigen::Vector3d LongRows::drift(std::size_t k) const {
  const ContactRow& row = rows_[k];
  return in_frame(k, row.solid->after.axes * (end(k) - (row.bonded ? row.face : row.start)) * (1.0 / step_.h));
}

/// What the equations ask impulses to change by, in the frames of the rows.
Eigen::VectorXd LongRows::lacks(std::span<const ShapeDistance> gaps) const {
  Eigen::VectorXd lack(at(rows_.size()));
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const ContactRow& row = rows_[k];
    const Eigen::Vector3d speed = drift(k);
    if (row.bonded) {
      lack.segment<3>(at(k)) = speed * -step_across(k);
      continue;
    }
    const double p = row.pressing - gaps[k].distance / (step_.h * row.along);
    lack[at(k)] = (row.solid->holds ? p : std::max(0.0, p)) - row.pressing;
    const Eigen::Vector2d r = in_frame(k, row.rubbing).tail<2>(), y = r - step_across(k) * speed.tail<2>();
    lack.segment<2>(at(k) + 1) = within(y, limit_of(row)) - r;
  }
  return lack;
}

Eigen::VectorXd LongRows::newton(std::span<const ShapeDistance> gaps, const Eigen::VectorXd& lack,
                                 double damping) const {
  const Eigen::MatrixXd& W = in_frames_;
  const Eigen::Index n = W.rows();
  Eigen::MatrixXd K = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const ContactRow& row = rows_[k];
    const Eigen::Index i = at(k);
    if (row.bonded) {
      K.middleRows<3>(i) = step_across(k) * W.middleRows<3>(i);
      continue;
    }
    if (row.solid->holds || row.pressing - gaps[k].distance / (step_.h * row.along) > 0.0) {
      const Eigen::Vector3d away = in_frame(k, row.solid->after.axes * gaps[k].normal);
      K.row(i) = away.transpose() * W.middleRows<3>(i) / row.along;
    }
    const double limit = limit_of(row);
    if (!(limit > 0.0)) continue;
    const Eigen::Vector2d y = in_frame(k, row.rubbing).tail<2>() - step_across(k) * drift(k).tail<2>();
    const double size = y.norm();
    Eigen::Matrix2d T = Eigen::Matrix2d::Identity();
    if (size > limit) {
      T = (limit / size) * (T - y * y.transpose() / (size * size)).eval();
      K.block<2, 1>(i + 1, i) -= row.solid->friction * y / size;
    }
    K.middleRows<2>(i + 1) += step_across(k) * T * W.middleRows<2>(i + 1);
    K.block<2, 2>(i + 1, i + 1) -= T;
  }
  K.diagonal().array() += damping;
  return K.partialPivLu().solve(lack);
}

/// Changes the impulses, as far as rows allow.
void LongRows::take(const Eigen::VectorXd& change) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ContactRow& row = rows_[k];
    const Vec3d before = row.impulse();
    const Eigen::Vector3d more = change.segment<3>(at(k));
    row.pressing += more[0];
    row.rubbing += vec(frames_[k].rightCols<2>() * more.tail<2>());
    if (!row.bonded) {
      const double limit = limit_of(row), size = norm(row.rubbing);
      if (size > limit) row.rubbing *= size > 0.0 ? limit / size : 0.0;
    }
    if (const Vec3d pushed = row.impulse() - before; pushed != Vec3d{}) push(k, pushed);
  }
}

bool LongRows::solve_together(const GapOf& gap) {
  const std::size_t n = rows_.size();
  if (n > kMostTogether || !std::ranges::all_of(rows_, moves_freely)) return false;
  std::vector<ShapeDistance> gaps(n);
  const auto look = [&] {
    for (std::size_t k = 0; k < n; ++k) gaps[k] = gap(rows_[k], end(k));
    return lacks(gaps);
  };
  const std::vector<ContactRow> before(rows_.begin(), rows_.end());
  const Eigen::VectorXd v = v_;
  const double first = look().norm();
  for (const double damping : kDampings) {
    Eigen::VectorXd lack = look();
    for (int k = 0; k < kMostIterations && lack.norm() > kSettled * first; ++k) {
      const Eigen::VectorXd change = newton(gaps, lack, damping);
      if (!change.allFinite()) break;
      take(change);
      lack = look();
    }
    if (lack.norm() < kBetter * first) return true;
    for (std::size_t k = 0; k < n; ++k) rows_[k].pressing = before[k].pressing, rows_[k].rubbing = before[k].rubbing;
    v_ = v;
  }
  return false;
}

}  // namespace glisson

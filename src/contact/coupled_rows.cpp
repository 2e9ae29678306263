#include "contact/coupled_rows.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/two_across.h"
#include "contact/disc_impulses.h"
#include "contact/point_laws.h"

namespace glisson {
namespace {

/// Compliance of a point over what moves it: points that nearly coincide share what they get.
constexpr double kSlack = 1e-8;
/// Compliance of a disc over the mean of W, for the change of its impulse since the last step: without it discs that nearly coincide
/// pull at each other with all that their limits allow. Where nothing moves it is without effect: tissue does not creep.
constexpr double kDiscSlack = 1e-4;
constexpr int kTogether = 5;               ///< sweeps, after which all points are solved for at once
constexpr int kMostTogether = 320;         ///< the same where that was in vain
constexpr double kStallsLong = 1e-5;       ///< change of what a sweep moves at which rows are taken not to be met …
constexpr double kStallsSinceLook = 1e-3;  ///< … and of the same since it was looked at last
constexpr double kStill = 10.0;            ///< tolerances: a vertex that moves by less in a step sticks
constexpr double kRounding = 1e-12;
constexpr double kMissed = 0.02;       ///< tolerances: of points, beside what a sweep moves
constexpr double kFarOffLong = 100.0;  ///< tolerances: rows that move by less are not taken to stall, they are slow
constexpr int kLookLong = 40;          ///< sweeps after which it is looked whether rows can be met
// Friction from which on two walls at right angles can hold a point by pressing and pulling it.
constexpr double kJams = 1.0;
constexpr char kMostReleases = 3;  // of a row: a corner in which it is let go and wanted again in turn needs both

/// Rows of points of a long step.
struct LongMoves {
  CoupledPoints& points;
  double length;

  double h() const { return length; }
  Vec3d end(const ContactRow& row) const { return row.solid->after.to_own(row.origin + velocity(row) * length); }
  Vec3d velocity(const ContactRow& row) const { return points.velocity(row.port); }
  Vec3d own(const ContactRow& row, const Vec3d& impulse) const { return points.own(row.port, impulse); }
  void push(const ContactRow& row, const Vec3d& impulse) const { points.push(row.port, impulse); }
};

/// The least p ≥ 0 along a second normal with which a row bears the rest of an impulse by pressing and friction; none: there is none.
std::optional<double> least_beside(const ContactRow& row, const Vec3d& normal, const Vec3d& whole) {
  const double a = dot(row.normal, whole), b = dot(row.normal, normal), mu = row.solid->friction;
  const Vec3d T = whole - row.normal * a, N = normal - row.normal * b;
  const auto bears = [&](double p) {
    return a - p * b >= 0.0 && norm(T - N * p) <= (1.0 + kRounding) * mu * (a - p * b);
  };
  if (std::isinf(mu)) return a > 0.0 ? std::optional(0.0) : std::nullopt;
  if (bears(0.0)) return 0.0;
  // |T − p N|² = μ² (a − p b)²
  const double A = dot(N, N) - mu * mu * b * b, B = dot(T, N) - mu * mu * a * b, C = dot(T, T) - mu * mu * a * a;
  const double root = B * B - A * C;
  if (!(root >= 0.0) || A == 0.0) return std::nullopt;
  for (const double p : {(B - std::sqrt(root)) / A, (B + std::sqrt(root)) / A}) {
    if (p >= 0.0 && bears(p)) return p;
  }
  return std::nullopt;
}

std::array<Vec3d, 2> across(const DiscRow& row) { return two_across(unit(row.line)); }
Eigen::Index pair_at(std::size_t k) { return static_cast<Eigen::Index>(2 * k); }

}  // namespace

CoupledRows::CoupledRows(Island& island, const InteractionStep& step, StepMobility& mobility,
                         std::span<const Vec3d> free)
    : island_(island), step_(step), mobility_(mobility), releases_(island.points.size(), 0),
      holder_(step.vertices.size(), island.points.size()) {
  add_points();
  points_.couple(mobility, step, free);
  for (std::size_t k = 0; k < island.points.size(); ++k) {
    ContactRow& row = *island.points[k];
    row.response = points_.most_own(k);
    const double most = std::max({row.response.x, row.response.y, row.response.z});
    row.along = dot(row.normal, points_.own(k, row.normal));
    points_.add_slack(k, kSlack * most);
  }
  for (std::size_t j = 0, first = first_shaft_; j < island.shafts.size(); ++j) {
    const auto n = static_cast<Eigen::Index>(3 * island.shafts[j]->rows.size());
    shafts_.emplace_back(*island.shafts[j],
                         points_.W().block(CoupledPoints::at(first), CoupledPoints::at(first), n, n));
    first += island.shafts[j]->rows.size();
  }
  begin();
}

void CoupledRows::add_points() {
  std::vector<VertexWeight> mean;
  const auto take = [&](std::span<const std::uint32_t> places, std::span<const double> weights, ToolYield* yields) {
    mean.clear();
    for (std::size_t i = 0; i < places.size(); ++i) mean.push_back({step_.vertices[places[i]].vertex, weights[i]});
    points_.add(mean, false, yields);
  };
  for (ContactRow* row : island_.points) {
    row->port = points_.size();
    take(places_of(*row), row->weights, row->solid->yields);
  }
  first_disc_ = points_.size();
  for (const DiscRow* row : island_.discs) take(row->places, row->weights, row->yields);
  first_shaft_ = points_.size();
  for (const shaft::Block* block : island_.shafts) {
    for (const shaft::Row* row : block->rows) points_.add(row->weights, true, block->yields);
  }
  const double whole = 1.0;
  first_hold_ = points_.size();
  for (const HoldRow* row : island_.holds) take({&row->place, 1}, {&whole, 1}, nullptr);
  first_push_ = points_.size();
  for (const GivenRow* row : island_.pushes) take({&row->place, 1}, {&whole, 1}, nullptr);
}

/// Impulses that the rows begin with.
void CoupledRows::begin() {
  for (const ContactRow* row : island_.points) points_.push(row->port, row->impulse());
  for (std::size_t k = 0; k < island_.pushes.size(); ++k) points_.push(first_push_ + k, island_.pushes[k]->impulse);
  for (std::size_t k = 0; k < island_.holds.size(); ++k) points_.push(first_hold_ + k, island_.holds[k]->impulse);
  std::size_t at = first_shaft_;
  for (shaft::Block* block : island_.shafts) {
    for (std::size_t j = 0; j < block->rows.size(); ++j) {
      points_.push(at++, block->across[j] + block->direction * block->along[j]);
    }
  }
  for (std::size_t k = 0; k < island_.discs.size(); ++k) points_.push(first_disc_ + k, island_.discs[k]->impulse);
  const std::size_t n = island_.discs.size();
  discs_.resize(pair_at(n), pair_at(n));
  for (std::size_t j = 0; j < n; ++j) {
    const auto ej = across(*island_.discs[j]);
    for (std::size_t k = 0; k < n; ++k) {
      const auto ek = across(*island_.discs[k]);
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
          const Eigen::Map<const Eigen::Vector3d> left(&ej[a].x), right(&ek[b].x);
          discs_(pair_at(j) + static_cast<Eigen::Index>(a), pair_at(k) + static_cast<Eigen::Index>(b)) = left.dot(
              points_.W().block<3, 3>(CoupledPoints::at(first_disc_ + j), CoupledPoints::at(first_disc_ + k)) * right);
        }
      }
    }
  }
}

/// A vertex in a corner that sticks to one wall needs nothing of another: they could only press and pull it against each other, as
/// far as they happen to. In a short step the first one's impulse leaves the other nothing to do.
double CoupledRows::sweep_points() {
  const LongMoves moves{points_, step_.h};
  double change = 0.0;
  for (std::size_t k = 0; k < island_.points.size(); ++k) {
    ContactRow& row = *island_.points[k];
    if (row.bonded) {
      change = std::max(change, point_laws::hold(row, moves));
      continue;
    }
    const bool vertex = row.count == 1 && row.solid->friction >= kJams;
    const std::size_t by = vertex ? holder_[row.places[0]] : island_.points.size();
    const bool spare = by < island_.points.size() && by != k && releases_[k] < kMostReleases;
    if (spare && row.impulse() != Vec3d{}) ++releases_[k];
    const double pressed = spare ? point_laws::release(row, moves) : point_laws::press(row, moves),
                 rubbed = spare ? 0.0 : point_laws::rub(row, moves);
    if (vertex && !spare) holder_[row.places[0]] = point_laws::sticks(row) ? k : island_.points.size();
    change = std::max({change, pressed, rubbed});
  }
  return change;
}

/// Whether a vertex rubs on two walls of a tool: what each bears is open then, and follows from the order of the sweeps.
bool CoupledRows::has_jams() const {
  std::vector<std::pair<std::uint32_t, std::size_t>> rubbing;
  for (const ContactRow* row : island_.points) {
    if (row->count == 1 && !row->bonded && row->solid->friction > 0.0) rubbing.emplace_back(row->places[0], row->tool);
  }
  std::sort(rubbing.begin(), rubbing.end());
  return std::adjacent_find(rubbing.begin(), rubbing.end()) != rubbing.end();
}

/// A vertex that sticks to two walls of a tool: how they share what it bears is open. The first takes all that its friction can, the other
/// what is left, along its normal alone: as in short steps, where the first finds the vertex moving and the other does not.
void CoupledRows::share_in_corners() {
  const double still = kStill * island_.enough() / step_.h;
  for (std::size_t k = 0; k + 1 < island_.points.size(); ++k) {
    ContactRow &first = *island_.points[k], &other = *island_.points[k + 1];
    const bool corner = first.count == 1 && other.count == 1 && first.places[0] == other.places[0] &&
                        first.tool == other.tool && !first.bonded && first.solid->friction > 0.0;
    if (!corner || norm(points_.velocity(k) - first.carried) > still) continue;
    const Vec3d whole = first.impulse() + other.impulse();
    const std::optional<double> least = least_beside(first, other.normal, whole);
    if (!least) continue;
    other.pressing = *least, other.rubbing = {};
    first.take(whole - other.normal * *least);
  }
}

/// All discs at once. @return by how much one was moved at most [m]
double CoupledRows::solve_discs() {
  const std::size_t n = island_.discs.size();
  if (n == 0) return 0.0;
  Eigen::MatrixXd W = discs_;
  Eigen::VectorXd slip(pair_at(n)), J(pair_at(n));
  std::vector<double> most;
  for (std::size_t k = 0; k < n; ++k) {
    const DiscRow& row = *island_.discs[k];
    const std::array<Vec3d, 2> e = across(row);
    for (std::size_t a = 0; a < 2; ++a) {
      slip[pair_at(k) + static_cast<Eigen::Index>(a)] = dot(e[a], row.velocity - points_.velocity(first_disc_ + k));
      J[pair_at(k) + static_cast<Eigen::Index>(a)] = dot(e[a], row.impulse);
    }
    most.push_back(row.most);
  }
  slip += discs_ * J;  // without them
  const double slack = kDiscSlack * discs_.trace() / static_cast<double>(discs_.rows());
  for (Eigen::Index i = 0; i < W.rows(); ++i) {
    if (!(W(i, i) > 0.0)) continue;  // held: it bears what it can get
    const DiscRow& row = *island_.discs[static_cast<std::size_t>(i / 2)];
    W(i, i) += slack, slip[i] += slack * dot(across(row)[static_cast<std::size_t>(i % 2)], row.last);
  }
  solve_within_discs(W, slip, most, J);
  double change = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    DiscRow& row = *island_.discs[k];
    const std::array<Vec3d, 2> e = across(row);
    const Vec3d impulse = e[0] * J[pair_at(k)] + e[1] * J[pair_at(k) + 1], more = impulse - row.impulse;
    row.impulse = impulse;
    points_.push(first_disc_ + k, more);
    change = std::max(change, norm(points_.own(first_disc_ + k, more)) * step_.h);
  }
  return change;
}

/// Each shaft as a whole. @return by how much a row was moved at most [m]
double CoupledRows::solve_shafts() {
  double change = 0.0;
  std::size_t first = first_shaft_;
  for (std::size_t number = 0; number < island_.shafts.size(); ++number) {
    shaft::Block& block = *island_.shafts[number];
    const std::size_t n = block.rows.size();
    const auto impulse = [&](std::size_t j) { return block.across[j] + block.direction * block.along[j]; };
    Eigen::VectorXd before(CoupledPoints::at(n));
    for (std::size_t j = 0; j < n; ++j) {
      const Vec3d p = impulse(j);
      before.segment<3>(CoupledPoints::at(j)) << p.x, p.y, p.z;
    }
    const Eigen::VectorXd moved =
        points_.W().block(CoupledPoints::at(first), CoupledPoints::at(first), 3 * static_cast<Eigen::Index>(n),
                          3 * static_cast<Eigen::Index>(n)) *
        before;
    std::vector<Vec3d> tissue(n);
    for (std::size_t j = 0; j < n; ++j) {
      const auto at = CoupledPoints::at(j);
      tissue[j] = points_.velocity(first + j) - Vec3d{moved[at], moved[at + 1], moved[at + 2]};
    }
    const std::vector<double> along = block.along;
    shafts_[number].solve(tissue);
    block.count_breaks(along);
    block.is_new = false;
    for (std::size_t j = 0; j < n; ++j) {
      const auto at = CoupledPoints::at(j);
      const Vec3d more = impulse(j) - Vec3d{before[at], before[at + 1], before[at + 2]};
      points_.push(first + j, more);
      change = std::max(change, norm(points_.own(first + j, more)) * step_.h);
    }
    first += n;
  }
  return change;
}

double CoupledRows::sweep_holds() {
  double change = 0.0;
  for (std::size_t k = 0; k < island_.holds.size(); ++k) {
    HoldRow& row = *island_.holds[k];
    const std::size_t port = first_hold_ + k;
    const Vec3d off = row.velocity - points_.velocity(port);
    Eigen::Matrix3d own = points_.W().block<3, 3>(CoupledPoints::at(port), CoupledPoints::at(port));
    Eigen::Vector3d wanted(off.x, off.y, off.z);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (!(own(i, i) > 0.0)) own(i, i) = 1.0, wanted[i] = 0.0;
    }
    const Eigen::Vector3d p = own.lu().solve(wanted);
    Vec3d impulse{p.x(), p.y(), p.z()};
    if (row.softness > 0.0) impulse = (row.impulse + impulse) * (1.0 / (1.0 + row.softness)) - row.impulse;
    row.impulse += impulse;
    points_.push(port, impulse);
    change = std::max(change, norm(points_.own(port, impulse)) * step_.h);
  }
  return change;
}

double CoupledRows::sweep() {
  double change = sweep_points();
  change = std::max(change, solve_discs());
  change = std::max(change, solve_shafts());
  return std::max(change, sweep_holds());
}

/// Whether nothing moves a block after it was solved.
bool CoupledRows::is_once() const {
  const bool discs = !island_.discs.empty();
  return island_.points.empty() && island_.holds.empty() && island_.shafts.size() + (discs ? 1 : 0) <= 1;
}

double CoupledRows::most_missed() {
  const LongMoves moves{points_, step_.h};
  double most = 0.0;
  for (const ContactRow* row : island_.points) most = std::max(most, point_laws::missed(*row, moves));
  return most;
}

CoupledRows::Outcome CoupledRows::solve(int most) {
  const double enough = island_.enough();
  CoupledNewton newton(island_.points, points_, step_.h);
  const bool may_newton = newton.is_of_use() && !has_jams();
  int every = kTogether, next = kTogether;
  double last = 0.0, at_last_look = 0.0;
  bool is_soft = false;
  Outcome outcome;
  for (;;) {
    const double change = sweep();
    ++outcome.sweeps;
    outcome.settled = is_once() || (change <= enough && most_missed() <= kMissed * enough);
    if (outcome.settled || outcome.sweeps >= most || mobility_.stops()) {
      share_in_corners();
      outcome.found = outcome.settled || is_soft || most_missed() <= island_.may_miss();
      outcome.unmet = is_soft || !outcome.found;
      return outcome;
    }
    if (may_newton && !is_soft && outcome.sweeps >= next) {
      every = newton.improve() ? kTogether : std::min(2 * every, kMostTogether);
      next = outcome.sweeps + every;
    }
    const bool looks = outcome.sweeps % kLookLong == 0;
    const bool stalls = change > kFarOffLong * enough && std::abs(1.0 - change / last) < kStallsLong &&
                        std::abs(1.0 - at_last_look / change) < kStallsSinceLook;
    if (looks && !is_soft && island_.tools.size() > 1 && stalls) {
      island_.soften();
      is_soft = true;
    }
    if (looks) at_last_look = change;
    last = change;
  }
}

void CoupledRows::finish(std::span<Vec3d> impulses) const {
  std::fill(impulses.begin(), impulses.end(), Vec3d{});
  const auto spread = [&](std::size_t k, const Vec3d& impulse) { points_.spread(k, impulse, step_, impulses); };
  for (const ContactRow* row : island_.points) spread(row->port, row->impulse());
  for (std::size_t k = 0; k < island_.discs.size(); ++k) spread(first_disc_ + k, island_.discs[k]->impulse);
  std::size_t at = first_shaft_;
  for (const shaft::Block* block : island_.shafts) {
    for (std::size_t j = 0; j < block->rows.size(); ++j)
      spread(at++, block->across[j] + block->direction * block->along[j]);
  }
  for (std::size_t k = 0; k < island_.holds.size(); ++k) spread(first_hold_ + k, island_.holds[k]->impulse);
  for (std::size_t k = 0; k < island_.pushes.size(); ++k) spread(first_push_ + k, island_.pushes[k]->impulse);
}

}  // namespace glisson

#include "contact/shaft_block.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/two_across.h"

namespace glisson::shaft {
namespace {

constexpr int kMostBreaks = 20;     ///< of a row between solves of a step
constexpr double kHeldSlip = 0.01;  ///< of the speed of sticking: a row that slips by less is held

/// The part of a vector across a direction.
Vec3d across_part(const Vec3d& a, const Vec3d& direction) { return a - direction * dot(a, direction); }

double largest(const Vec3d& a) { return std::max({a.x, a.y, a.z}); }

std::uint32_t place_of(const InteractionStep& step, const VertexWeight& w) {
  return w.vertex < step.place_of.size() ? step.place_of[w.vertex] : InteractionStep::kNowhere;
}

/// Mobility times weight of a row's vertices, at their places.
std::span<const double> spread(const InteractionStep& step, const Row& row, std::vector<double>& reached) {
  for (const VertexWeight& w : row.weights) {
    const std::uint32_t place = place_of(step, w);
    if (place != InteractionStep::kNowhere) reached[place] = w.weight * largest(step.mobility[place]);
  }
  return reached;
}

void clear(const InteractionStep& step, const Row& row, std::vector<double>& reached) {
  for (const VertexWeight& w : row.weights) {
    const std::uint32_t place = place_of(step, w);
    if (place != InteractionStep::kNowhere) reached[place] = 0.0;
  }
}

double dot_weights(const InteractionStep& step, const Row& row, std::span<const double> reached) {
  double sum = 0.0;
  for (const VertexWeight& w : row.weights) {
    const std::uint32_t place = place_of(step, w);
    if (place != InteractionStep::kNowhere) sum += w.weight * reached[place];
  }
  return sum;
}

/// The impulse of a row that would stop its slip is `stop`; `free` is the speed it would have without its own.
double shaft_impulse(double stop, double free, double mobility, const AxialLimit& limit, const ShaftFriction& f,
                     double h) {
  const bool in = free > 0.0;
  const double most_static = h * limit.length * (in ? f.static_in : f.static_out);
  if (!limit.slips && std::abs(stop) <= most_static) return stop;
  const double drag = h * limit.length * (in ? f.viscous_in : f.viscous_out);
  const double dry = h * limit.length * (in ? f.dynamic_in : f.dynamic_out);
  // p = dry + drag (free − W p), which must not turn the slip around
  const double slipping = (dry + drag * std::abs(free)) / (1.0 + drag * mobility);
  return std::copysign(std::min(slipping, std::abs(stop)), free);
}

/// Of the tissue at a row whose vertices are active.
Vec3d present_velocity(const InteractionStep& step, const Row& row) {
  Vec3d velocity{};
  for (const VertexWeight& w : row.weights) velocity += step.vertices[step.place_of[w.vertex]].velocity * w.weight;
  return velocity;
}

}  // namespace

bool read(const InteractionStep& step, Row& row) {
  row.position = row.rest;
  row.velocity = {};
  for (const VertexWeight& w : row.weights) {
    const std::uint32_t place = place_of(step, w);
    if (place == InteractionStep::kNowhere) return false;
    row.position += step.vertices[place].displacement * w.weight;
    row.velocity += step.vertices[place].velocity * w.weight;
  }
  return !row.weights.empty();
}

void push(const InteractionStep& step, const Row& row, const Vec3d& impulse) {
  for (const VertexWeight& w : row.weights) step.push(step.place_of[w.vertex], impulse * w.weight);
}

/// Rows of nodes that are new, or all where a mobility has changed.
void MobilityMatrix::extend(const InteractionStep& step, std::span<const Row> nodes) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::Index known = std::min(nodes_.rows(), n);
  for (Eigen::Index j = 0; j < known; ++j) {
    const Row& row = nodes[static_cast<std::size_t>(j)];
    if (nodes_(j, j) != dot_weights(step, row, spread(step, row, reached_))) known = 0;
    clear(step, row, reached_);
  }
  nodes_.conservativeResize(n, n);
  for (Eigen::Index j = known; j < n; ++j) {
    const Row& row = nodes[static_cast<std::size_t>(j)];
    spread(step, row, reached_);
    for (Eigen::Index k = 0; k <= j; ++k) {
      nodes_(j, k) = nodes_(k, j) = dot_weights(step, nodes[static_cast<std::size_t>(k)], reached_);
    }
    clear(step, row, reached_);
  }
}

Eigen::MatrixXd MobilityMatrix::of(const InteractionStep& step, std::span<const Row> nodes,
                                   std::span<const std::size_t> acting, const Row* tip) {
  reached_.assign(step.vertices.size(), 0.0);
  extend(step, nodes);
  const auto n = static_cast<Eigen::Index>(acting.size()), size = n + (tip != nullptr ? 1 : 0);
  Eigen::MatrixXd W(size, size);
  const auto node = [&](Eigen::Index k) { return static_cast<Eigen::Index>(acting[static_cast<std::size_t>(k)]); };
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) W(j, k) = nodes_(node(j), node(k));
  }
  if (tip == nullptr) return W;
  spread(step, *tip, reached_);
  for (Eigen::Index k = 0; k < n; ++k) {
    W(n, k) = W(k, n) = dot_weights(step, nodes[static_cast<std::size_t>(node(k))], reached_);
  }
  W(n, n) = dot_weights(step, *tip, reached_);
  return W;
}

std::vector<char> solve_along(const Eigen::MatrixXd& W, std::span<const double> speed,
                              std::span<const AxialLimit> limits, const ShaftFriction& friction, double h,
                              std::span<double> p, const Effort& effort, std::span<int> breaks) {
  const std::size_t n = speed.size();
  const auto slip_of = [&](std::size_t j) {
    double rel = speed[j];
    for (std::size_t k = 0; k < n; ++k) {
      rel -= W(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) * p[k];
    }
    return rel;
  };
  std::vector<char> stuck(n, 0);  // in the last sweep
  for (int sweep = 0; sweep < effort.most_sweeps; ++sweep) {
    double change = 0.0, top = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      const double own = W(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(j));
      if (!(own > 0.0)) continue;
      const double free = slip_of(j) + own * p[j], stop = free / own;
      AxialLimit limit = limits[j];
      if (!breaks.empty()) limit.slips = limit.slips || breaks[j] >= effort.most_breaks;
      const double wanted = limit.is_tip ? std::clamp(stop, 0.0, h * limit.tip_limit)
                                         : shaft_impulse(stop, free, own, limit, friction, h);
      if (!breaks.empty() && stuck[j] != 0 && wanted != stop) ++breaks[j];
      stuck[j] = wanted == stop;
      change = std::max(change, std::abs(wanted - p[j]));
      top = std::max(top, std::abs(wanted));
      p[j] = wanted;
    }
    if (change <= effort.enough * top) break;
  }
  std::vector<char> slips(n, 0);
  for (std::size_t j = 0; j < n; ++j) {
    if (limits[j].is_tip) {
      slips[j] = p[j] >= h * limits[j].tip_limit && slip_of(j) > 0.0 ? 1 : 0;
    } else {
      slips[j] = std::abs(slip_of(j)) > friction.stick_speed ? 1 : 0;
    }
  }
  return slips;
}

void Block::add(const Row& row) {
  rows.push_back(&row);
  tissue.push_back(row.velocity);
}

void Block::find_places(const InteractionStep& step) {
  places.clear();
  for (const Row* row : rows) {
    for (const VertexWeight& w : row->weights) places.push_back(step.place_of[w.vertex]);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

/// What the rows have without the shaft: others have pushed them since it was solved.
void Block::take_off(const InteractionStep& step) {
  if (!is_new) {
    for (std::size_t j = 0; j < rows.size(); ++j) push(step, *rows[j], -(across[j] + direction * along[j]));
  }
  for (std::size_t j = 0; j < rows.size(); ++j) tissue[j] = present_velocity(step, *rows[j]);
}

/// Impulses across: the tissue stays on the bent shaft, in all rows that are held.
void Block::solve_across() {
  if (held == 0) return;
  const auto n = static_cast<Eigen::Index>(held);
  Eigen::MatrixXd A = W.topLeftCorner(n, n) + compliance.topLeftCorner(n, n);
  A.diagonal().array() += slack;
  Eigen::MatrixXd wanted(n, 3);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto row = static_cast<std::size_t>(j);
    const Vec3d way = off[row] - across_part(tissue[row] - velocity, direction) * h + more[row];
    for (std::size_t axis = 0; axis < 3; ++axis) wanted(j, static_cast<Eigen::Index>(axis)) = way[axis] / h;
  }
  const Eigen::MatrixXd p = A.ldlt().solve(wanted);
  for (Eigen::Index j = 0; j < n; ++j) {
    across[static_cast<std::size_t>(j)] = across_part({p(j, 0), p(j, 1), p(j, 2)}, direction);
  }
}

void Block::count_breaks(std::span<const double> before) {
  breaks.resize(rows.size(), 0);
  for (std::size_t j = 0; j < rows.size() && !is_new; ++j) {
    const double in_slip = h * limits[j].length * (before[j] > 0.0 ? friction.dynamic_in : friction.dynamic_out);
    const bool held_more = !limits[j].is_tip && std::abs(before[j]) > in_slip;
    if (held_more && std::abs(along[j]) < std::abs(before[j]) && ++breaks[j] >= kMostBreaks) limits[j].slips = true;
  }
}

/// Finds the impulses on tissue that has these velocities without the shaft, and pushes.
void Block::solve_and_push(const InteractionStep& step) {
  solve_across();
  std::vector<double> speed;
  for (std::size_t j = 0; j < rows.size(); ++j) speed.push_back(dot(velocity - tissue[j], direction) - closing[j]);
  slips = solve_along(W, speed, limits, friction, h, along);
  for (std::size_t j = 0; j < rows.size(); ++j) push(step, *rows[j], across[j] + direction * along[j]);
}

double Block::solve(const InteractionStep& step) {
  if (places.empty()) {  // nobody else acts here: once is enough
    solve_and_push(step);
    is_new = false;
    return 0.0;
  }
  take_off(step);
  const std::vector<Vec3d> across_before = across;
  const std::vector<double> along_before = along;
  solve_and_push(step);
  count_breaks(along_before);
  double change = 0.0;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const double more_along = is_new ? along[j] : along[j] - along_before[j];
    const Vec3d more_across = is_new ? across[j] : across[j] - across_before[j];
    change = std::max(change, W(at, at) * h * std::max(std::abs(more_along), norm(more_across)));
  }
  is_new = false;
  return change;
}

void Block::book(const InteractionStep& step, const ToolVelocity& shaft) const {
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (const VertexWeight& w : rows[j]->weights) {
      const std::uint32_t place = step.place_of[w.vertex];
      step.book(sinks[j], place, direction * (along[j] * w.weight), shaft);
      step.book(WorkSink::contact, place, across[j] * w.weight, shaft);
    }
  }
}

void Block::list_held(const InteractionStep& step, HeldRows& all) const {
  std::uint32_t first = 0;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const std::uint32_t mean = all.add_mean(rows[j]->weights);
    if (j == 0) first = mean;
  }
  const bool cuts = tip_cuts();
  const auto stay = static_cast<Eigen::Index>(rows.size() - (cuts ? 1 : 0));
  std::vector<double> c;
  for (Eigen::Index j = 0; j < stay; ++j) {
    for (Eigen::Index k = 0; k < stay; ++k) c.push_back(compliance(j, k) + (j == k ? slack : 0.0));
  }
  for (const Vec3d& e : two_across(direction)) {
    for (std::uint32_t j = 0; j < stay; ++j) all.add_row(first + j, e);
    all.end_group(c);
  }
  for (std::uint32_t j = 0; j < rows.size(); ++j) {
    const AxialLimit& limit = limits[j];
    if (limit.is_tip && (cuts || along[j] == 0.0)) continue;
    const double slip = dot(velocity - present_velocity(step, *rows[j]), direction);
    const bool slides = !limit.is_tip && std::abs(slip) > kHeldSlip * friction.stick_speed;
    const double drag =
        slides ? step.h * limit.length * (slip > 0.0 ? friction.viscous_in : friction.viscous_out) : 0.0;
    if (slides && !(drag > 0.0)) continue;
    all.add_row(first + j, direction);
    all.end_group(std::array{slides ? 1.0 / drag : slack});
  }
}

}  // namespace glisson::shaft

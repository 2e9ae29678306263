#include "instruments/needle/shaft.h"

#include <algorithm>
#include <cmath>

namespace glisson::shaft {
namespace {

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

void book(const InteractionStep& step, WorkSink sink, const Row& row, const Vec3d& impulse,
          const ToolVelocity& needle) {
  for (const VertexWeight& w : row.weights) step.book(sink, step.place_of[w.vertex], impulse * w.weight, needle);
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

double cantilever(double at, double of, double bending_stiffness) {
  if (!(bending_stiffness > 0.0)) return 0.0;
  const double x = std::max(0.0, at), y = std::max(0.0, of);
  const double a = std::min(x, y), b = std::max(x, y);
  return a * a * (3.0 * b - a) / (6.0 * bending_stiffness);
}

Eigen::MatrixXd cantilever(std::span<const double> distances, double bending_stiffness) {
  const auto n = static_cast<Eigen::Index>(distances.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
  if (!(bending_stiffness > 0.0)) return C;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) {
      C(j, k) =
          cantilever(distances[static_cast<std::size_t>(j)], distances[static_cast<std::size_t>(k)], bending_stiffness);
    }
  }
  return C;
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

}  // namespace glisson::shaft

#include "fit/forward/law_table.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace glisson::fit {
namespace {

using Row = LawTable::Row;
using Neighbours = std::array<std::optional<Row>, 4>;  ///< at −1, 0, 1, 2

/// The cubic between the two in the middle, by slopes through their neighbours; without one of these by a parabola.
Row cubic(const Neighbours& p, double t) {
  Row out(p[1]->size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double a = (*p[1])[i], b = (*p[2])[i], chord = b - a;
    double left = chord, right = chord;
    if (p[0]) left = 0.5 * (b - (*p[0])[i]);
    if (p[3]) right = 0.5 * ((*p[3])[i] - a);
    if (!p[0] && p[3]) left = 2.0 * chord - right;
    if (!p[3] && p[0]) right = 2.0 * chord - left;
    const double s2 = t * t, s3 = s2 * t;
    out[i] = a + chord * (3.0 * s2 - 2.0 * s3) + left * (s3 - 2.0 * s2 + t) + right * (s3 - s2);
  }
  return out;
}

}  // namespace

LawTable::LawTable(std::vector<Parameter> parameters, std::vector<std::size_t> active, Run run, double error)
    : parameters_(std::move(parameters)), active_(std::move(active)), run_(std::move(run)), error_(error),
      strides_(active_.size(), kWidest) {}

double LawTable::place_of(std::size_t dimension, double value) const {
  const Parameter& p = parameters_[active_[dimension]];
  return kParts * (p.scale == Scale::linear ? (value - p.low) / (p.high - p.low)
                                            : std::log(value / p.low) / std::log(p.high / p.low));
}

double LawTable::value_of(std::size_t dimension, int part) const {
  const Parameter& p = parameters_[active_[dimension]];
  const double z = static_cast<double>(part) / kParts;
  return p.scale == Scale::linear ? p.low + z * (p.high - p.low) : p.low * std::pow(p.high / p.low, z);
}

const LawTable::Node& LawTable::node(const Index& index) const {
  std::shared_ptr<Node> found;
  {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Node>& n = nodes_[index];
    if (!n) n = std::make_shared<Node>();
    found = n;
  }
  std::call_once(found->once, [&] {
    Row values;
    for (const Parameter& p : parameters_) values.push_back(p.start);
    for (std::size_t d = 0; d < active_.size(); ++d) values[active_[d]] = value_of(d, index[d]);
    try {
      found->row = run_(values);
    } catch (const std::exception& error) {
      found->failure = error.what();
    }
  });
  return *found;
}

/// The run itself, made once.
Row LawTable::exactly(std::span<const double> values) const {
  Row key;
  for (const std::size_t p : active_) key.push_back(values[p]);
  std::shared_ptr<Node> found;
  {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Node>& n = exact_[key];
    if (!n) n = std::make_shared<Node>();
    found = n;
  }
  std::call_once(found->once, [&] {
    try {
      found->row = run_(values);
    } catch (const std::exception& error) {
      found->failure = error.what();
    }
  });
  if (found->row.empty()) throw std::runtime_error(found->failure);
  return found->row;
}

/// The largest error of cubics between every `stride`-th node, in the middles between these.
double LawTable::error_along(const Index& start, std::size_t dimension, int stride) const {
  double most = 0.0;
  std::vector<double> place(start.begin(), start.end());
  for (int middle = stride / 2; middle < kParts; middle += stride) {
    Index index = start;
    index[dimension] = middle;
    const Node& truth = node(index);
    if (truth.row.empty()) continue;
    Neighbours p;
    for (int k = 0; k < 4; ++k) {
      index[dimension] = middle - stride / 2 + (k - 1) * stride;
      if (index[dimension] < 0 || index[dimension] > kParts) continue;
      if (const Node& n = node(index); !n.row.empty()) p[static_cast<std::size_t>(k)] = n.row;
    }
    if (!p[1] || !p[2]) continue;
    const Row row = cubic(p, 0.5);
    for (std::size_t i = 0; i < row.size(); ++i) most = std::max(most, std::abs(row[i] - truth.row[i]));
  }
  return most;
}

/// How many nodes each parameter needs.
void LawTable::look_along_lines() const {
  Index start;
  for (std::size_t d = 0; d < active_.size(); ++d) {
    const double place = place_of(d, parameters_[active_[d]].start);
    start.push_back(kWidest * static_cast<int>(std::lround(place / kWidest)));
  }
  for (std::size_t d = 0; d < active_.size(); ++d) {
    for (int stride = kWidest; stride > 1; stride /= 2) {
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(0, 2 * kParts / stride + 1, [&](int k) {
          Index index = start;
          index[d] = k * stride / 2;
          node(index);
        });
      });
      strides_[d] = stride;
      if (error_along(start, d, stride) < error_) break;
      strides_[d] = stride / 2;
    }
  }
}

std::optional<Row> LawTable::between(Index& index, std::size_t dimension, const std::vector<double>& place,
                                     std::string& failure) const {
  if (dimension == active_.size()) {
    const Node& n = node(index);
    if (!n.row.empty()) return n.row;
    failure = n.failure;
    return {};
  }
  const int stride = strides_[dimension], cells = kParts / stride;
  const int cell = std::clamp(static_cast<int>(std::floor(place[dimension] / stride)), 0, cells - 1);
  const double t = std::clamp(place[dimension] / stride - cell, 0.0, 1.0);
  Neighbours p;
  for (int k = 0; k < 4; ++k) {
    index[dimension] = (cell + k - 1) * stride;
    if (index[dimension] < 0 || index[dimension] > kParts) continue;
    p[static_cast<std::size_t>(k)] = between(index, dimension + 1, place, failure);
  }
  if (!p[1] || !p[2]) return {};
  return cubic(p, t);
}

Row LawTable::at(std::span<const double> values) const {
  if (active_.size() > kMostActive || active_.empty() || error_ == 0.0) return exactly(values);
  std::call_once(looked_, [&] { look_along_lines(); });
  std::vector<double> place;
  for (std::size_t d = 0; d < active_.size(); ++d) place.push_back(place_of(d, values[active_[d]]));
  Index index(active_.size());
  std::string failure;
  if (std::optional<Row> row = between(index, 0, place, failure)) return std::move(*row);
  throw std::runtime_error(failure);
}

std::size_t LawTable::runs() const {
  const std::lock_guard lock(mutex_);
  return nodes_.size() + exact_.size();
}

}  // namespace glisson::fit

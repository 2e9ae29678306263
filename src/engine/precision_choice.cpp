#include "engine/precision_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace glisson::engine {
namespace {

constexpr std::uint64_t kPeriod = 64, kLongPeriod = 512;  ///< steps between two looks; where nothing can be linear
constexpr std::uint64_t kShortPeriod = 8;                 ///< and where a submesh asks for one
constexpr double kNewcomers = 0.8;                        ///< part of the error that is left to those not linear yet
constexpr double kMostStiffening = 1.2;
constexpr float kSmall = 1e-3F;  ///< |H| up to which no submesh asks for a look
constexpr float kGrowth = 2.0F;  ///< of the longest edge difference, from which one does
constexpr float kNotKnown = -1.0F;

double wrong(const Examined& seen) {
  return std::isfinite(seen.error) ? std::abs(seen.error) : std::numeric_limits<double>::infinity();
}

}  // namespace

void PrecisionChoice::reset() {
  for (Submesh& part : submeshes_.parts) part.linear.wanted = false, part.linear.share = 0.0;
  const std::size_t n = submeshes_.parts.size();
  seen_.assign(n, {}), gaps_.assign(n, 0.0), longest_.assign(n, 0.0F), then_.assign(n, kNotKnown);
  changed_.clear();
  period_ = since_ = kPeriod;
  moves_ = examines_ = asked_ = false;
}

void PrecisionChoice::leave(std::size_t s) {
  submeshes_.parts[s].linear.wanted = false;
  submeshes_.parts[s].linear.share = 0.0;
}

void PrecisionChoice::begin_step(bool moves) {
  moves_ = on() && moves;
  examines_ = moves_ && (since_ >= period_ || (asked_ && since_ >= kShortPeriod));
}

bool PrecisionChoice::begins(std::size_t s) const {
  const LinearForm& linear = submeshes_.parts[s].linear;
  return moves_ && linear.share == (linear.wanted ? 0.0 : 1.0);
}

bool PrecisionChoice::ends(std::size_t s) const {
  const LinearForm& linear = submeshes_.parts[s].linear;
  return moves_ && linear.wanted && linear.share == 1.0 - kShareStep;
}

const std::vector<std::size_t>& PrecisionChoice::end_step() {
  changed_.clear();
  brought_in_ = 0.0;
  if (!moves_) return changed_;
  ++since_;
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) {
    const Submesh& part = submeshes_.parts[s];
    if (part.linear.share == 0.0) continue;
    const float reach = part.gradient_reach * part.gradient_reach;
    if (then_[s] == kNotKnown) then_[s] = longest_[s];
    asked_ = asked_ || longest_[s] > std::max(kGrowth * kGrowth * then_[s], kSmall * kSmall / reach);
  }
  shift();
  if (examines_) {
    since_ = 1, asked_ = false;
    choose();
  }
  return changed_;
}

void PrecisionChoice::choose() {
  const std::size_t n = submeshes_.parts.size();
  const double body = std::accumulate(seen_.begin(), seen_.end(), 0.0,
                                      [](double sum, const Examined& seen) { return sum + seen.work; });
  const double room = share_ * std::max(body, 0.0);
  const auto wrong_per_tet = [&](std::size_t s) {
    return wrong(seen_[s]) / std::max(1.0, static_cast<double>(submeshes_.parts[s].elements.size()));
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wrong_per_tet(a) < wrong_per_tet(b); });
  double sum = 0.0;
  bool any = false;
  for (const std::size_t s : order) {
    LinearForm& linear = submeshes_.parts[s].linear;
    const double with = sum + wrong(seen_[s]);
    then_[s] = linear.share > 0.0 ? longest_[s] : kNotKnown;
    linear.wanted = seen_[s].stiffening <= kMostStiffening && with <= (linear.wanted ? 1.0 : kNewcomers) * room;
    if (linear.wanted) sum = with;
    any = any || linear.wanted;
  }
  period_ = any ? kPeriod : std::min(2 * period_, kLongPeriod);
}

/// Shares on their way.
void PrecisionChoice::shift() {
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) {
    LinearForm& linear = submeshes_.parts[s].linear;
    if (linear.share == (linear.wanted ? 1.0 : 0.0)) continue;
    const double change = linear.wanted ? kShareStep : -kShareStep;
    if (linear.share == 0.0 || linear.alone()) changed_.push_back(s);
    linear.share += change;
    if (linear.alone()) changed_.push_back(s);
    brought_in_ += change * gaps_[s];
  }
}

double PrecisionChoice::share_of_tets() const {
  double linear = 0.0, all = 0.0;
  for (const Submesh& part : submeshes_.parts) {
    const auto tets = static_cast<double>(part.elements.size());
    linear += part.linear.share * tets, all += tets;
  }
  return all > 0.0 ? linear / all : 0.0;
}

void PrecisionChoice::archive(Archive& ar) {
  std::vector<double> gaps = gaps_, stiffenings;
  for (const Examined& seen : seen_) stiffenings.push_back(seen.stiffening);
  std::vector<float> then = then_;
  ar(since_, period_, asked_, then, gaps, stiffenings);
  const std::size_t n = seen_.size();
  if (!ar.reads() || then.size() != n || gaps.size() != n || stiffenings.size() != n) return;  // other submeshes now
  then_ = std::move(then), gaps_ = std::move(gaps);
  for (std::size_t s = 0; s < n; ++s) seen_[s].stiffening = stiffenings[s];
}

}  // namespace glisson::engine

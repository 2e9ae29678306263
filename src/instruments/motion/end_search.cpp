#include "instruments/motion/end_search.h"

#include <algorithm>
#include <cmath>

#include "dynamics/solvers/most_trials.h"

namespace glisson {
namespace {

constexpr double kEnough = 1e-5;  // of what the tissue holds the tool back in the step …
constexpr double kLeast = 1e-12;  // … and so much [m]
constexpr double kLost = 0.1;     // of the same: an end that is so far from its trial is none
constexpr double kNoise = 1e-3;   // of the same: forces found by sweeps may be no more exact than to less than that …
constexpr int kMostStalls = 8;    // … which so many trials show that come no nearer
constexpr int kMostRestarts = 3;  // with the slopes known at first, where those learnt since lead nowhere
constexpr double kShort = 1e-5;   // of the longest way: a shorter one teaches nothing
constexpr double kProbe = 0.1;    // of a step that led to a worse place: so far from there slopes are learnt

}  // namespace

void EndSearch::begin(const Vec3d& before, const Vec3d& guess, const Vec3d& free) {
  begun_ = true, goes_ = false, tries_ = 0, stalls_ = 0, restarts_ = 0;
  trial_ = guess, free_ = free;
  farthest_ = std::max(norm(free - before), norm(guess - before));
  slope_ = kept_;
}

/// M⁻¹ r, or r itself where M has learnt what no tissue does: to push a tool on.
Vec3d EndSearch::forward(const Vec3d& r, double most) const {
  Vec3d way = r;
  if (std::abs(determinant(slope_)) > 0.0) {
    const Vec3d learnt = inverse(slope_) * r;
    if (dot(learnt, r) > 0.0 && norm(learnt) <= 2.0 * norm(r)) way = learnt;
  }
  const double size = norm(way);
  return size > most ? way * (most / size) : way;
}

void EndSearch::learn(const Mat3d& change) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) slope_(i, j) += change(i, j);
  }
}

bool EndSearch::goes_on(const Vec3d& end) {
  const Vec3d r = end - trial_;
  if (goes_) {
    const Vec3d way = trial_ - last_trial_;
    const double squared = dot(way, way);
    if (squared > kShort * kShort * farthest_ * farthest_)
      learn(outer(last_r_ - r - slope_ * way, way * (1.0 / squared)));
  }
  const double held_back = norm(free_ - end), off = norm(r);
  if (goes_ && off <= kNoise * held_back && off > 0.5 * norm(last_r_)) ++stalls_;
  const bool found = off <= kEnough * held_back + kLeast || stalls_ == kMostStalls;
  if (found || ++tries_ >= kMostTrials) {
    goes_ = false, tries_ = 0, stalls_ = 0, restarts_ = 0;
    kept_ = slope_;
    return !found && off > kLost * held_back;  // who asks knows how often, and what to do where nothing is found
  }
  // From a place that is worse, as deep in what the last one did not touch, a short step shows how stiff it is; from there the way back
  // is found at once, while from the other side it would be missed again and again.
  const bool worse = goes_ && off > norm(last_r_);
  Vec3d way = forward(r, worse ? kProbe * norm(trial_ - last_trial_) : farthest_);
  if (worse && norm(way) < kShort * farthest_ && restarts_ < kMostRestarts) {
    ++restarts_;
    slope_ = kept_;
    way = forward(r, farthest_);
  }
  goes_ = true;
  last_trial_ = trial_, last_r_ = r;
  trial_ += way;
  return true;
}

}  // namespace glisson

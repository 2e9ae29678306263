#include "dynamics/pace/level_pace.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr std::size_t kFewTets = 64, kFewOf = 4;  ///< tets with levels of their own: so many and this part of all

}  // namespace

double LevelPace::stable_step() const {
  const double step = limits_.with_added(now_.limits.stable, {tools_ + stiff_.k, stiff_.c});
  return std::min(step, limits_.drag_limit());
}

bool LevelPace::accept(const LastStep& last) {
  if (has_to_bear(last.stiffening) && !bear(last.stiffening, last.stiff)) return false;
  hold_back(last);
  return true;
}

bool LevelPace::bear(std::span<const double> stiffening, std::span<const StiffElement> stiff) {
  const std::span<const StiffElement> few = without_crowd(stiff);
  const StiffnessLevels::Met met = levels_.meet(few, now_.level, crowd_.empty() ? usual_ : crowd_);
  if (met.above || is_crowded() || unchecked_) {
    levels_.raise(kMostAhead);
    if (!rises(stiffening, met.rise)) return false;
  } else {
    is_calm();
  }
  return settles(stiffening);
}

void LevelPace::list_from() {
  usual_ = now_.level;
  if (!enforces_) usual_.assign(usual_.size(), std::numeric_limits<double>::infinity());
  list_above_ = usual_;
}

void LevelPace::take_stiff() {
  stiff_ = added_at(now_.level);
  list_from();
}

void LevelPace::take_base(StepLimits::Known base) {
  now_ = std::move(base);
  levels_.forget_below(now_.level);
  take_stiff();
}

void LevelPace::start_anew() {
  limits_.start_anew();
  probes_ = false;
  levels_.clear();
  take_stiff();
}

AddedStiffness LevelPace::added_at(std::span<const double> level) {
  if (levels_.empty()) return {};
  return levels_.added(level, limits_.thickening());
}

std::vector<double> LevelPace::risen(std::span<const double> stiffening, double ahead) const {
  std::vector<double> level = limits_.with_room(stiffening, ahead);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body().blocks[b])) level[b] = std::max(now_.level[b], level[b]);
  }
  return level;
}

std::size_t LevelPace::most_levels() const { return kFewTets + body().elements.size() / kFewOf; }

/// The stiffest of what is told, where that is too much to look after each; the level of the blocks has to bear the others.
std::span<const StiffElement> LevelPace::without_crowd(std::span<const StiffElement> stiff) {
  crowd_.clear();
  const std::size_t few = most_levels();
  if (stiff.size() <= few) return stiff;
  std::vector<StiffElement> ordered(stiff.begin(), stiff.end());
  const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(few);
  std::ranges::nth_element(ordered, last, std::greater<>(), &StiffElement::ratio);
  const double limit = last->ratio;
  few_.clear();
  crowd_.assign(body().blocks.size(), 0.0);
  for (const StiffElement& s : stiff) {
    double& left = crowd_[block_index(body(), s.element)];
    if (s.ratio > limit) {
      few_.push_back(s);
    } else {
      left = std::max(left, s.ratio);
    }
  }
  const std::vector<double>& least = probes_ ? list_above_ : now_.level;
  for (std::size_t b = 0; b < crowd_.size(); ++b) crowd_[b] = std::max(crowd_[b], least[b]);
  return few_;
}

bool LevelPace::is_crowded() const {
  for (std::size_t b = 0; b < crowd_.size(); ++b) {
    if (crowd_[b] > now_.level[b]) return true;
  }
  return false;
}

void LevelPace::mesh_changed(const BodyChange& change, const detail::VertexStars& stars) {
  limits_.mesh_changed(change, stars, now_);
  levels_.remove(change.removed);
  levels_.reshape(change.reshaped);
  bound_fell();
  take_stiff();
}

}  // namespace glisson

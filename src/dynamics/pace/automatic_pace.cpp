#include "dynamics/pace/automatic_pace.h"

#include <algorithm>

#include "dynamics/step/step_rules.h"

namespace glisson {
namespace {

constexpr std::uint64_t kLongestWindow = 64000, kShortWindow = 16;  ///< [steps]
constexpr double kWorthAChange = 1.05;         ///< how much longer a step makes another level of the blocks worth it
constexpr std::uint64_t kLongestProbe = 1024;  ///< [steps]
constexpr double kLadder = 0.9;                ///< of one level that is tried to the next
constexpr int kMostInVain = 8;                 ///< steps of that ladder without a better one
constexpr double kCostOfLevels = 2.0;          ///< of a tet with a level of its own, over that of a tet, a step
constexpr double kProbeDepth = 8.0;            ///< how far below the level of the blocks a probe looks

}  // namespace

AutomaticPace::AutomaticPace(StepLimits limits, const SimulationOptions& options)
    : LevelPace(std::move(limits), options.enforce_stability), restraint_(body(), enforces_) {
  step_ = kSafety * now_.limits.pace;
  start_anew();
}

/// What was seen and guessed on the way is forgotten; the search at rest is not.
void AutomaticPace::start_anew() {
  seen_.assign(body().blocks.size(), 0.0);
  lately_ = seen_;
  window_ = kFirstWindow, in_window_ = 0;
  probe_ = kFirstProbe, since_probe_ = 0;
  restraint_.start_anew(tools_);
  LevelPace::start_anew();
}

void AutomaticPace::take_added(const AddedBeside& added) {
  LevelPace::take_added(added);
  restraint_.add(tools_);
}

void AutomaticPace::follow_added(const AddedBeside& added) {
  restraint_.let_go_of_added();
  take_added(added);
}

void AutomaticPace::state_set(const AddedBeside& added, MovingBody&) {
  take_added(added);
  now_ = limits_.rest();
  step_ = kSafety * now_.limits.pace;
  start_anew();
}

void AutomaticPace::bound_fell() {
  step_ = std::min(step_, kSafety * now_.limits.pace);
  unchecked_ = enforces_ && step_ > now_.limits.stable;
}

void AutomaticPace::tissues_changed(std::span<const double> stiffening, bool undeformed) {
  stiff_ = {};  // the level of the blocks is chosen for all tets
  now_ = limits_.choose(stiffening, undeformed);
  step_ = kSafety * now_.limits.pace;
  limits_.tissues_taken();
  unchecked_ = false;
  start_anew();
}

void AutomaticPace::archive(Archive& ar, MovingBody&) {
  ar(step_, unchecked_, now_, levels_, limits_, restraint_, window_, in_window_, probe_, since_probe_, probes_);
  for (auto* list : {&seen_, &lately_}) ar.same_size(*list);
  if (ar.reads()) take_stiff();
}

/// Elements are listed from the level of their block on; where a tet's changes of shape may count, and for a probe, from below.
void AutomaticPace::list_from() {
  LevelPace::list_from();
  restraint_.list_violent(usual_);
  list_above_ = usual_;
  for (std::size_t b = 0; probes_ && b < usual_.size(); ++b) {
    list_above_[b] = std::min(usual_[b], std::max(limits_.rest().level[b], now_.level[b] / kProbeDepth));
  }
}

void AutomaticPace::take_base(StepLimits::Known base) {
  step_ = kSafety * base.limits.pace;
  LevelPace::take_base(std::move(base));
}

/// By levels of their own, or by that of the blocks.
bool AutomaticPace::rises(std::span<const double> stiffening, double rise) {
  const double before = limits_.with_added(now_.limits.pace, stiff_);
  unchecked_ = false;
  const std::vector<double> level = risen(stiffening, std::min(rise, kMostAhead));
  const bool crowded = is_crowded();
  const Limits all = limits_.bound(now_, level);
  if (all.pace >= pace_above(crowded ? crowd_ : now_.level, all.pace)) {
    take_base({limits_.knowledge().exact ? limits_.search(level) : all, level});
  } else if (crowded) {
    choose_base(crowd_, true);
  } else if (levels_.count_above(now_.level) > most_levels()) {
    choose_base(now_.level, false);
  } else {
    take_stiff();
  }
  const double shorter = before / limits_.with_added(now_.limits.pace, stiff_);
  restraint_.rise(std::min(rise, shorter * shorter));
  return true;
}

bool AutomaticPace::settles(std::span<const double> stiffening) {
  probe();
  relax(stiffening);
  return true;
}

void AutomaticPace::hold_back(const LastStep& last) {
  restraint_.forget_shape_change();
  restraint_.limit_shape_change(last.stiff, last.moving, step());
}

/// How fast time goes on at a level of the blocks, with what looking after the tets above it costs.
double AutomaticPace::pace_of(const Limits& limits, const AddedStiffness& added, std::size_t above) const {
  const double share = static_cast<double>(above) / static_cast<double>(body().elements.size());
  return limits_.with_added(limits.pace, added) / (1.0 + kCostOfLevels * share);
}

/// The same with the blocks at a level and the stiffer tets beside it, whose part is reckoned only where it matters: 0 where
/// that many are dearer than `enough` in any case.
double AutomaticPace::pace_above(std::span<const double> level, double enough) {
  const Limits limits = limits_.bound(now_, level);
  const std::size_t above = levels_.count_above(level);
  return pace_of(limits, {}, above) > enough ? pace_of(limits, added_at(level), above) : 0.0;
}

/// Chooses the level of the blocks at which time goes on fastest, from the tets that have levels of their own.
/// @param least  it may be  @param forced  whether the present one is too low
void AutomaticPace::choose_base(const std::vector<double>& least, bool forced) {
  levels_.complete();
  const std::vector<double> most = levels_.largest(least);
  std::vector<double> best;
  double fastest = 0.0;
  if (!forced) fastest = kWorthAChange * pace_of(now_.limits, added_at(now_.level), levels_.count_above(now_.level));
  int in_vain = 0;
  for (double share = 1.0; in_vain < kMostInVain; share *= kLadder) {
    std::vector<double> level = least;
    for (std::size_t b = 0; b < level.size(); ++b) level[b] = std::max(least[b], share * most[b]);
    const double pace = pace_above(level, fastest);
    in_vain = pace > fastest ? 0 : in_vain + 1;
    if (pace > fastest) fastest = pace, best = level;
    if (level == least) break;
  }
  if (!best.empty()) {
    take_base({limits_.bound(now_, best), best});
  } else {
    take_stiff();
  }
}

/// Lists all that is stiff, or chooses by what was listed. Another level makes steps at most as long as those at rest.
void AutomaticPace::probe() {
  if (probes_) {
    const std::vector<double> before = now_.level;
    choose_base(crowd_.empty() ? list_above_ : crowd_, false);
    probe_ = now_.level == before ? std::min(2 * probe_, kLongestProbe) : kFirstProbe;
    probes_ = false;
    list_from();
    return;
  }
  const Limits& rest = limits_.rest().limits;
  const bool may_gain =
      limits_.is_bounded() && rest.pace > kWorthAChange * limits_.with_added(now_.limits.pace, stiff_);
  if (++since_probe_ < probe_ || !may_gain) return;
  since_probe_ = 0;
  for (std::size_t b = 0; b < now_.level.size(); ++b) {
    probes_ = probes_ || now_.level[b] > kStiffeningMargin * limits_.rest().level[b];
  }
  list_from();
}

/// Lets levels follow what was seen in the last few steps; where the bound alone allows twice the step, it is taken, without a
/// search.
void AutomaticPace::settle() {
  if (!levels_.empty()) {
    levels_.settle();
    take_stiff();
  }
  std::vector<double> level = limits_.with_room(lately_, 1.0);
  std::fill(lately_.begin(), lately_.end(), 0.0);
  const Limits bound = limits_.bound(now_, level);
  if (!limits_.is_bounded() || kSafety * bound.pace < 2.0 * step_) return;
  take_base({bound, std::move(level)});
}

/// Lets the step grow at the end of a window in which the tissue was well softer than the validated level.
void AutomaticPace::relax(std::span<const double> stiffening) {
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    seen_[b] = std::max(seen_[b], stiffening[b]);
    lately_[b] = std::max(lately_[b], stiffening[b]);
  }
  ++in_window_;
  if (in_window_ % kShortWindow == 0) settle();
  if (in_window_ < window_) return;
  std::vector<double> level = limits_.with_room(seen_, 1.0);
  bool softer = false;
  for (std::size_t b = 0; b < level.size(); ++b) {
    level[b] = std::min(now_.level[b], level[b]);
    softer = softer || level[b] * kStiffeningMargin < now_.level[b];
  }
  in_window_ = 0;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  if (!softer) return;
  const Limits limits = limits_.find(now_, level);
  take_base({{limits.stable, std::max(now_.limits.pace, limits.pace)}, std::move(level)});
  window_ = std::min<std::uint64_t>(2 * window_, kLongestWindow);
}

}  // namespace glisson

// step_levels.cpp — how steps follow what becomes stiff: levels of single tets, those of the blocks, and what they forget again.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "dynamics/step/step_control.h"
#include "dynamics/step/step_rules.h"
#include "element/drag_stages.h"

namespace glisson {
namespace {

constexpr std::uint64_t kLongestWindow = 64000, kShortWindow = 16;  ///< [steps]
constexpr double kLeastCaution = 0.01;                              ///< least factor on a step while stiffness rises
constexpr double kRecovery = 1.1;                                   ///< of that factor, a step
constexpr double kViolent = 3.0;               ///< stiffening of large strain from which shape changes limit the step
constexpr double kShapeChange = 0.01;          ///< of a tet within such a step [-]
constexpr double kChangeOfSlack = 0.04;        ///< more of it for one that could be e times as stiff
constexpr double kCloseToLevel = 0.5;          ///< of its block's level, from which a tet's change of shape counts
constexpr double kMostAhead = 4.0;             ///< how far a level runs ahead of a rise
constexpr double kWorthAChange = 1.05;         ///< how much longer a step makes another level of the blocks worth it
constexpr std::uint64_t kLongestProbe = 1024;  ///< [steps]
constexpr double kLadder = 0.9;                ///< of one level that is tried to the next
constexpr int kMostInVain = 8;                 ///< steps of that ladder without a better one
constexpr double kCostOfLevels = 2.0;          ///< of a tet with a level of its own, over that of a tet, a step
constexpr double kMostRise = 1024.0;           ///< of stiffness that is looked at for a step
/// Of the bearable inertia of added mass: from where it is too much, below which there may be more.
constexpr double kMuchInertia = 1.6, kLittleInertia = 0.6;
constexpr double kCloseToHeavy = 1.2;    ///< so far below the level of a block tets are told, for mass
constexpr double kHeavyRoom = 1.1;       ///< of what tets bear without mass, over the stiffness seen
constexpr std::uint64_t kHeavyTurn = 2;  ///< [steps] after which levels for mass come down in the next part of the tets
constexpr std::uint64_t kMassTurn = 16;  ///< [steps] after which mass follows what has come down
constexpr double kHeavyRegrowth = 1.095;   ///< of the step of variable mass scaling, a step: below √kCloseToHeavy
constexpr double kHeavyTurnOfStep = 0.02;  ///< growth of it by e that is made in one change of masses
constexpr double kHeavyMemory = 40.0;      ///< time in which it grows by e, in steps asked for
constexpr double kQuickMemory = 4.0;       ///< the same where inertia is hardly any
constexpr double kHardlyInertia = 0.1;     ///< of the bearable inertia
constexpr std::uint64_t kSoonBack = 16;    ///< steps in which mass that came goes again too soon
constexpr std::uint64_t kShortPause = 8, kLongPause = 1024;  ///< [steps] before mass may come again after that
constexpr double kNearlyBorne = 1.02;  ///< of what tets bear without mass, from where the step falls to that
constexpr double kLeastHeavyLevel =
    1.25;                            ///< of blocks, over rest: above kCloseToHeavy, so that tets at rest are not told
constexpr double kProbeDepth = 8.0;  ///< how far below the level of the blocks a probe looks
constexpr std::size_t kFewTets = 64, kFewOf = 4;  ///< tets with levels of their own: so many and this part of all

}  // namespace

/// What was seen and guessed on the way is forgotten; the search at rest is not.
void StepControl::start_anew() {
  guess_ = rest_guess_;
  searches_made_ = 0;
  seen_.assign(body_.blocks.size(), 0.0);
  lately_ = seen_;
  window_ = kFirstWindow, in_window_ = 0;
  probe_ = kFirstProbe, since_probe_ = 0, probes_ = false;
  caution_ = 1.0, heavy_growth_ = 0.0;
  pause_ = since_came_ = since_gone_ = 0;
  held_ = tools_;
  shape_step_ = std::numeric_limits<double>::infinity();
  levels_.clear();
  if (mass_levels_) mass_levels_->clear();
  take_stiff();
}

void StepControl::state_set(const AddedBeside& added) {
  take_added(added);
  added_levels_.clear();
  if (!heavy_step_) {
    now_ = rest_;
    if (automatic_) step_ = kSafety * now_.limits.pace;
  } else {
    choose_heavy(*heavy_step_);
  }
  inertia_ = 0.0;
  listed_before_.clear();
  start_anew();
  set_added(added);
}

/// Elements are listed from the level of their block on; where a tet's changes of shape may count, from below.
void StepControl::list_from() {
  usual_ = now_.level;
  for (std::size_t b = 0; b < usual_.size(); ++b) {
    if (!enforce_) usual_[b] = std::numeric_limits<double>::infinity();
    if (automatic_ && !is_small(body_.blocks[b])) {
      usual_[b] = std::min(usual_[b], std::max(kViolent, kCloseToLevel * usual_[b]));
    }
  }
  list_above_ = usual_;
  if (listed_before_.size() != usual_.size()) listed_before_ = usual_;
  if (heavy_step_) {  // those that come close get levels when others do
    for (double& level : list_above_) level /= kCloseToHeavy;
  }
  for (std::size_t b = 0; probes_ && b < usual_.size(); ++b) {
    list_above_[b] = std::min(usual_[b], std::max(rest_.level[b], now_.level[b] / kProbeDepth));
  }
}

/// With variable mass scaling tets that are well below their levels need not be told, but those whose levels come down next.
std::span<const StiffLimit> StepControl::single_limits() const {
  return heavy_step_ ? mass_levels_->limits() : std::span<const StiffLimit>();
}

/// The part of the tets whose levels come down at the end of this turn.
std::uint32_t StepControl::heavy_part() const {
  return static_cast<std::uint32_t>(in_window_ / kHeavyTurn % MassLevels::kParts);
}

/// Has tets told whose levels come down in the next step.
void StepControl::tell_heavy() {
  if (mass_levels_ && (in_window_ + 1) % kHeavyTurn == 0) mass_levels_->tell(heavy_part());
}

/// What single tets take off the step, which depends on the level of their blocks.
AddedStiffness StepControl::added_at(std::span<const double> level) {
  if (levels_.empty()) return {};
  return levels_.added(level, thickening());
}

/// Per block, whether its viscosity grows with its stiffness.
std::vector<char> StepControl::thickening() const {
  std::vector<char> viscous;
  for (const TissueBlock& block : body_.blocks) viscous.push_back(thickens(block) ? 1 : 0);
  return viscous;
}

/// The stiffness that the body bears at a step without added mass: the largest, which leaves the least to add. Where that is hardly more
/// than at rest, elements get what they lack.
void StepControl::choose_heavy(double wanted) {
  const auto at = [&](double rise) {
    Known known{{}, rest_.level};
    for (std::size_t b = 0; b < known.level.size(); ++b) {
      if (!is_linear(body_.blocks[b])) known.level[b] *= rise;
    }
    const double pace = pace_from(rest_, known.level);
    known.limits = {pace, pace};
    return known;
  };
  step_ = wanted;
  if (kSafety * at(kLeastHeavyLevel).limits.pace < wanted) {
    now_ = at(kLeastHeavyLevel);
    now_.limits = {wanted / kSafety, wanted / kSafety};
    return;
  }
  double borne = 1.0, above = 1.0;
  while (above < kMostRise && kSafety * at(above).limits.pace >= wanted) borne = above, above *= 2.0;
  for (int halving = 0; halving < 20 && borne < above; ++halving) {
    const double middle = 0.5 * (borne + above);
    (kSafety * at(middle).limits.pace >= wanted ? borne : above) = middle;
  }
  now_ = at(borne);
}

/// What the present step asks of masses.
MassNeed StepControl::mass_need() const {
  return {.step = step_ / kSafety,
          .weight = weight_,
          .at_level = kSafety * pace_from(rest_, now_.level) < step_,
          .drags = drag_ == Drag::lags,
          .drag_end = kSafety * drag_limit_ < step_ ? DragPolynomial(drag_stages_).end() : 0.0,
          .beside = &added_levels_};
}

/// What tets bear without added mass at the present stiffness [s].
double StepControl::step_without_masses(std::span<const double> stiffening) const {
  std::vector<double> level = rest_.level;
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body_.blocks[b])) level[b] = std::max(level[b], kHeavyRoom * stiffening[b]);
  }
  return kSafety * pace_from(rest_, level);
}

/// Whether elements get mass that they lack at rest at the present step.
bool StepControl::needs_mass() const {
  const MassNeed need = mass_need();
  return need.at_level || need.drag_end > 0.0;
}

/// Takes another step of variable mass scaling. At the step that the body bears without mass elements lack much at once, since their
/// own bounds are below it. Motions near the stability limit grow where such mass comes and goes in turn, however safe each step is: with
/// θ² = h² k/m in (0, 4), two steps in turn are stable only where both θ² are on the same side of 2. So mass that had to go again at once
/// comes back later and later.
/// @return whether it is taken
bool StepControl::change_heavy(double wanted) {
  const Known before = now_;
  const double step = step_;
  const bool had = needs_mass();
  choose_heavy(wanted);
  const bool has = needs_mass();
  if (has && !had) {
    if (since_gone_ < pause_) {
      now_ = before, step_ = step;
      return false;
    }
    since_came_ = 0;
  } else if (had && !has) {
    pause_ = since_came_ < kSoonBack ? std::clamp(2 * pause_, kShortPause, kLongPause) : pause_ / 2;
    since_gone_ = 0;
  }
  return true;
}

/// Where inertia of added mass shows, the step falls to where it hardly does: mass goes with h² less what tets bear without it. The
/// step comes back by as much as tets are told of before they need mass, slowly within a swing of the tissue, and in few changes,
/// since each asks for the masses of all vertices.
/// @return whether it is another one
bool StepControl::follow_inertia(std::span<const double> stiffening) {
  const double inertia = std::exchange(inertia_, 0.0) / bearable_inertia_, most = *heavy_step_;
  ++since_came_, ++since_gone_;
  double wanted = std::min(step_, most);
  if (inertia > kMuchInertia) {
    const double tissue = std::min(step_without_masses(stiffening), kSafety * drag_limit_),
                 borne = std::min(step_, with_added(tissue, {with_mass_, 0.0})), share = 1.0 / inertia;
    wanted = std::min({step_, most, std::sqrt(share * step_ * step_ + (1.0 - share) * borne * borne)});
    if (wanted < kNearlyBorne * borne) wanted = std::min(borne, most);
    heavy_growth_ = 0.0;
  } else if (inertia < kLittleInertia && step_ < most) {
    heavy_growth_ += step_ / ((inertia < kHardlyInertia ? kQuickMemory : kHeavyMemory) * most);
    if (heavy_growth_ >= kHeavyTurnOfStep) {
      wanted = std::min(std::min(kHeavyRegrowth, std::exp(heavy_growth_)) * step_, most);
      heavy_growth_ = 0.0;
    }
  }
  return wanted != step_ && change_heavy(wanted);
}

/// Variable mass scaling: stiff tets take levels of their own, and vertices the mass that their tets lack.
void StepControl::bear(std::span<const double> stiffening, std::span<const StiffElement> stiff) {
  unchecked_ = false;
  const std::vector<double> listed = list_above_;
  const std::uint32_t part = heavy_part();
  const bool settles = ++in_window_ % kHeavyTurn == 0, above = !mass_levels_->bear(stiff, now_.level);
  double rise = 1.0;
  if (above || settles) {
    rise = mass_levels_->raise(stiff, now_.level, listed_before_);
    if (settles) mass_levels_->settle(part);
  }
  if (follow_inertia(stiffening) || above || !bears_added_ || in_window_ % kMassTurn == 0) take_stiff();
  be_cautious(above ? rise : 1.0);
  listed_before_ = listed;
  tell_heavy();
}

void StepControl::take_added(const AddedBeside& added) {
  tools_ = added.squared_frequency;
  held_ = std::max(held_, tools_);
  with_mass_ = added.with_mass;
}

void StepControl::set_added(const AddedBeside& added) {
  take_added(added);
  bears_added_ = added_levels_.meet(added.to_bear);
  if (!bears_added_) take_stiff();
}

void StepControl::follow_added(const AddedBeside& added) {
  held_ /= kRegrowth * kRegrowth;
  take_added(added);
  bears_added_ = added_levels_.meet(added.to_bear);
}

void StepControl::take_stiff() {
  if (heavy_step_) {
    if (!bears_added_ || in_window_ % kMassTurn == 0) added_levels_.settle(), bears_added_ = true;
    mass_levels_->find_masses(now_.level, thickening(), mass_need(), stiff_masses_);
    masses_are_new_ = true;
  } else {
    stiff_ = added_at(now_.level);
  }
  list_from();
}

/// Holds an automatic step back while stiffness rises by more than the room within a step.
void StepControl::be_cautious(double rise) {
  caution_ = rise > kStiffeningMargin ? std::max(kLeastCaution, caution_ * std::log(kStiffeningMargin) / std::log(rise))
                                      : std::min(1.0, kRecovery * caution_);
}

bool StepControl::is_violent(const StiffElement& element) const {
  return automatic_ && enforce_ && element.ratio > kViolent && !is_small(body_.block_of(element.element));
}

/// How many times as stiff an element could be before it alone asked for a shorter step.
double StepControl::slack(const StiffElement& stiff, double step) const {
  const ElementRest& rest = body_.rest[stiff.element];
  const std::array<Vec3d, 4> s = shape_gradients(rest);
  double per_mass = 0.0;
  for (std::size_t a = 0; a < 4; ++a) per_mass += dot(s[a], s[a]) / body_.masses[body_.elements[stiff.element][a]];
  const double modulus = stiff.norm * modulus_bound(body_.block_of(stiff.element).elastic);
  return 4.0 / (step * step * rest.volume * modulus * per_mass);
}

void StepControl::limit_shape_change(std::span<const ShapeRate> changes) {
  shape_step_ = std::numeric_limits<double>::infinity();
  const double h = step();
  for (const ShapeRate& c : changes) {
    if (c.rate * h <= kShapeChange) continue;
    const double most = kShapeChange + kChangeOfSlack * std::log(std::max(1.0, slack(c.stiff, h)));
    shape_step_ = std::min(shape_step_, most / c.rate);
  }
}

/// What a step is to be found for: the seen stiffness with room, not below that at rest.
std::vector<double> StepControl::level_of(std::span<const double> seen, double ahead) const {
  std::vector<double> level = at_least_one(seen);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body_.blocks[b])) level[b] = std::max(rest_.level[b], kStiffeningMargin * ahead * level[b]);
  }
  return level;
}

/// The same, and nowhere below the present level.
std::vector<double> StepControl::risen(std::span<const double> stiffening, double ahead) const {
  std::vector<double> level = level_of(stiffening, ahead);
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body_.blocks[b])) level[b] = std::max(now_.level[b], level[b]);
  }
  return level;
}

std::size_t StepControl::most_levels() const { return kFewTets + body_.elements.size() / kFewOf; }

void StepControl::take_base(Known base) {
  now_ = std::move(base);
  if (automatic_) step_ = kSafety * now_.limits.pace;
  levels_.forget_below(now_.level);
  take_stiff();
}

/// The stiffest of what is told, where that is too much to look after each; the level of the blocks has to bear the others.
std::span<const StiffElement> StepControl::without_crowd(std::span<const StiffElement> stiff) {
  crowd_.clear();
  const std::size_t few = most_levels();
  if (stiff.size() <= few) return stiff;
  std::vector<StiffElement> ordered(stiff.begin(), stiff.end());
  const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(few);
  std::ranges::nth_element(ordered, last, std::greater<>(), &StiffElement::ratio);
  const double limit = last->ratio;
  few_.clear();
  crowd_.assign(body_.blocks.size(), 0.0);
  for (const StiffElement& s : stiff) {
    double& left = crowd_[block_index(body_, s.element)];
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

/// Whether some of a crowd that is not looked after is above the level of its block.
bool StepControl::is_crowded() const {
  for (std::size_t b = 0; b < crowd_.size(); ++b) {
    if (crowd_[b] > now_.level[b]) return true;
  }
  return false;
}

/// Takes in tets above their levels, by levels of their own or by that of the blocks; false where a given step does not support it.
bool StepControl::rises(std::span<const double> stiffening, double rise) {
  const double before = with_added(now_.limits.pace, stiff_);
  levels_.raise(kMostAhead);
  if (!automatic_) {
    take_stiff();
    return holds_at(stiffening);
  }
  unchecked_ = false;
  const std::vector<double> level = risen(stiffening, std::min(rise, kMostAhead));
  const bool crowded = is_crowded();
  const Limits all = bound_at(level);
  if (all.pace >= pace_above(crowded ? crowd_ : now_.level, all.pace)) {
    take_base({exact_ ? limits_at(level) : all, level});
  } else if (crowded) {
    choose_base(crowd_, true);
  } else if (levels_.count_above(now_.level) > most_levels()) {
    choose_base(now_.level, false);
  } else {
    take_stiff();
  }
  const double shorter = before / with_added(now_.limits.pace, stiff_);
  be_cautious(std::min(rise, shorter * shorter));
  return true;
}

/// Whether a given step bears the stiffness there is: by levels of single tets, by that of the blocks, by that without a safety
/// factor.
bool StepControl::holds_at(std::span<const double> stiffening) {
  unchecked_ = false;
  if (!is_crowded() && step_ <= stable_step()) return true;
  levels_.clear();
  for (const std::vector<double>& level : {risen(stiffening, 1.0), at_least_one(stiffening)}) {
    take_base({limits_at(level), level});
    if (step_ <= now_.limits.stable) return true;
  }
  return false;
}

/// How fast time goes on at a level of the blocks, with what looking after the tets above it costs.
double StepControl::pace_of(const Limits& limits, const AddedStiffness& added, std::size_t above) const {
  const double share = static_cast<double>(above) / static_cast<double>(body_.elements.size());
  return with_added(limits.pace, added) / (1.0 + kCostOfLevels * share);
}

/// The same with the blocks at a level and the stiffer tets beside it, whose part is reckoned only where it matters: 0 where
/// that many are dearer than `enough` in any case.
double StepControl::pace_above(std::span<const double> level, double enough) {
  const Limits limits = bound_at(level);
  const std::size_t above = levels_.count_above(level);
  return pace_of(limits, {}, above) > enough ? pace_of(limits, added_at(level), above) : 0.0;
}

/// Chooses the level of the blocks at which time goes on fastest, from the tets that have levels of their own.
/// @param least  it may be  @param forced  whether the present one is too low
void StepControl::choose_base(const std::vector<double>& least, bool forced) {
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
    take_base({bound_at(best), best});
  } else {
    take_stiff();
  }
}

/// Lists all that is stiff, or chooses by what was listed. Another level makes steps at most as long as those at rest.
void StepControl::probe() {
  if (probes_) {
    const std::vector<double> before = now_.level;
    choose_base(crowd_.empty() ? list_above_ : crowd_, false);
    probe_ = now_.level == before ? std::min(2 * probe_, kLongestProbe) : kFirstProbe;
    probes_ = false;
    list_from();
    return;
  }
  const bool may_gain = is_bounded() && rest_.limits.pace > kWorthAChange * with_added(now_.limits.pace, stiff_);
  if (++since_probe_ < probe_ || !may_gain) return;
  since_probe_ = 0;
  for (std::size_t b = 0; b < now_.level.size(); ++b) {
    probes_ = probes_ || now_.level[b] > kStiffeningMargin * rest_.level[b];
  }
  list_from();
}

/// Lets levels follow what was seen in the last few steps; where the bound alone allows twice the step, it is taken, without a
/// search.
void StepControl::settle() {
  if (!levels_.empty()) {
    levels_.settle();
    take_stiff();
  }
  std::vector<double> level = level_of(lately_, 1.0);
  std::fill(lately_.begin(), lately_.end(), 0.0);
  const Limits bound = bound_at(level);
  if (!is_bounded() || kSafety * bound.pace < 2.0 * step_) return;
  take_base({bound, std::move(level)});
}

/// Lets an automatic step grow at the end of a window in which the tissue was well softer than the validated level.
void StepControl::relax(std::span<const double> stiffening) {
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    seen_[b] = std::max(seen_[b], stiffening[b]);
    lately_[b] = std::max(lately_[b], stiffening[b]);
  }
  ++in_window_;
  if (in_window_ % kShortWindow == 0) settle();
  if (in_window_ < window_) return;
  std::vector<double> level = level_of(seen_, 1.0);
  bool softer = false;
  for (std::size_t b = 0; b < level.size(); ++b) {
    level[b] = std::min(now_.level[b], level[b]);
    softer = softer || level[b] * kStiffeningMargin < now_.level[b];
  }
  in_window_ = 0;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  if (!softer) return;
  const Limits limits = exact_ ? limits_at(level) : bound_at(level);
  take_base({{limits.stable, std::max(now_.limits.pace, limits.pace)}, std::move(level)});
  window_ = std::min<std::uint64_t>(2 * window_, kLongestWindow);
}

}  // namespace glisson

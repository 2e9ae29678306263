#include "dynamics/pace/variable_mass_pace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/step/step_rules.h"
#include "element/drag_stages.h"

namespace glisson {
namespace {

constexpr double kMostRise = 1024.0;  ///< of stiffness that is looked at for a step
/// Of the bearable inertia of added mass: from where it is too much, below which there may be more.
constexpr double kMuchInertia = 1.6, kLittleInertia = 0.6;
constexpr double kClose = 1.2;            ///< so far below the level of a block tets are told
constexpr double kRoom = 1.1;             ///< of what tets bear without mass, over the stiffness seen
constexpr std::uint64_t kSettleTurn = 2;  ///< [steps] after which levels come down in the next part of the tets
constexpr std::uint64_t kMassTurn = 16;   ///< [steps] after which mass follows what has come down
constexpr double kMostGrowth = 1.095;     ///< of the step, a step: below √kClose
constexpr double kTurnOfGrowth = 0.02;    ///< growth of it by e that is made in one change of masses
constexpr double kMemory = 40.0;          ///< time in which it grows by e, in steps asked for
constexpr double kQuickMemory = 4.0;      ///< the same where inertia is hardly any
constexpr double kHardlyInertia = 0.1;    ///< of the bearable inertia
constexpr std::uint64_t kSoonBack = 16;   ///< steps in which mass that came goes again too soon
constexpr std::uint64_t kShortPause = 8, kLongPause = 1024;  ///< [steps] before mass may come again after that
constexpr double kNearlyBorne = 1.02;  ///< of what tets bear without mass, from where the step falls to that
constexpr double kLeastLevel = 1.25;   ///< of blocks, over rest: above kClose, so that tets at rest are not told

}  // namespace

VariableMassPace::VariableMassPace(StepLimits limits, BodyState& state, EnergyLedger& ledger)
    : Pace(std::move(limits), state.options.enforce_stability), longest_(*state.options.mass_scaling_step),
      bearable_inertia_(state.options.mass_scaling_inertia), restraint_(body(), enforces_), levels_(body()),
      masses_(state), ledger_(state.options.track_energies ? &ledger : nullptr) {
  choose(longest_);
  start_anew();
}

double VariableMassPace::drag_limit() const { return std::max(limits_.drag_limit(), step_ / kSafety); }

double VariableMassPace::stable_step() const {
  return std::min(limits_.with_added(now_.limits.stable, {tools_, 0.0}), drag_limit());
}

/// What was seen on the way is forgotten.
void VariableMassPace::start_anew() {
  limits_.start_anew();
  steps_ = 0;
  growth_ = 0.0;
  pause_ = since_came_ = since_gone_ = 0;
  restraint_.start_anew(tools_);
  levels_.clear();
  find_masses();
}

bool VariableMassPace::accept(const LastStep& last) {
  inertia_ = masses_.weigh(last.kick.outer_action(last.moving.active()), last.moving);
  if (has_to_bear(last.stiffening)) bear(last.stiffening, last.stiff);
  give_masses(last.moving);
  restraint_.forget_shape_change();
  restraint_.limit_shape_change(last.stiff, last.moving, step());
  return true;
}

/// Stiff tets take levels of their own, and vertices the mass that their tets lack.
void VariableMassPace::bear(std::span<const double> stiffening, std::span<const StiffElement> stiff) {
  const std::vector<double> listed = list_above_;
  const std::uint32_t part = settling_part();
  const bool settles = ++steps_ % kSettleTurn == 0, above = !levels_.bear(stiff, now_.level);
  double rise = 1.0;
  if (above || settles) {
    rise = levels_.raise(stiff, now_.level, listed_before_);
    if (settles) levels_.settle(part);
  }
  if (follow_inertia(stiffening) || above || !bears_added_ || steps_ % kMassTurn == 0) find_masses();
  restraint_.rise(above ? rise : 1.0);
  listed_before_ = listed;
  tell_settling();
}

/// The part of the tets whose levels come down at the end of this turn.
std::uint32_t VariableMassPace::settling_part() const {
  return static_cast<std::uint32_t>(steps_ / kSettleTurn % MassLevels::kParts);
}

/// Has tets told whose levels come down in the next step.
void VariableMassPace::tell_settling() {
  if ((steps_ + 1) % kSettleTurn == 0) levels_.tell(settling_part());
}

/// Elements are listed from a little below the level of their block on: those that come close get levels when others do.
void VariableMassPace::list_from() {
  list_above_ = now_.level;
  if (!enforces_) list_above_.assign(list_above_.size(), std::numeric_limits<double>::infinity());
  restraint_.list_violent(list_above_);
  if (listed_before_.size() != list_above_.size()) listed_before_ = list_above_;
  for (double& level : list_above_) level /= kClose;
}

void VariableMassPace::find_masses() {
  if (!bears_added_ || steps_ % kMassTurn == 0) added_levels_.settle(), bears_added_ = true;
  levels_.find_masses(now_.level, limits_.thickening(), mass_need(), wanted_);
  masses_are_new_ = true;
  list_from();
}

/// Gives vertices the mass that their tets lack, where that has become other.
void VariableMassPace::give_masses(MovingBody& moving) {
  if (!std::exchange(masses_are_new_, false)) return;
  const double kinetic = masses_.take(wanted_, moving);
  if (ledger_ != nullptr) ledger_->bring_in(kinetic, 0.0);
}

/// Takes a step, and the stiffness that the body bears at it without added mass: the largest, which leaves the least to add. Where that
/// is hardly more than at rest, elements get what they lack.
void VariableMassPace::choose(double wanted) {
  const StepLimits::Known& rest = limits_.rest();
  const auto at = [&](double rise) {
    StepLimits::Known known{{}, rest.level};
    for (std::size_t b = 0; b < known.level.size(); ++b) {
      if (!is_linear(body().blocks[b])) known.level[b] *= rise;
    }
    const double pace = limits_.pace_from(rest, known.level);
    known.limits = {pace, pace};
    return known;
  };
  step_ = wanted;
  if (kSafety * at(kLeastLevel).limits.pace < wanted) {
    now_ = at(kLeastLevel);
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
MassNeed VariableMassPace::mass_need() const {
  return {.step = step_ / kSafety,
          .weight = limits_.weight(),
          .at_level = kSafety * limits_.pace_from(limits_.rest(), now_.level) < step_,
          .drags = limits_.drag() == Drag::lags,
          .drag_end = kSafety * limits_.drag_limit() < step_ ? DragPolynomial(limits_.drag_stages()).end() : 0.0,
          .beside = &added_levels_};
}

/// Whether elements get mass that they lack at rest at the present step.
bool VariableMassPace::needs_mass() const {
  const MassNeed need = mass_need();
  return need.at_level || need.drag_end > 0.0;
}

/// @return whether another step is taken, or whether it has to wait (above)
bool VariableMassPace::change_step(double wanted) {
  const StepLimits::Known before = now_;
  const double step = step_;
  const bool had = needs_mass();
  choose(wanted);
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

/// What tets bear without added mass at the present stiffness [s].
double VariableMassPace::step_without_masses(std::span<const double> stiffening) const {
  std::vector<double> level = limits_.rest().level;
  for (std::size_t b = 0; b < level.size(); ++b) {
    if (!is_linear(body().blocks[b])) level[b] = std::max(level[b], kRoom * stiffening[b]);
  }
  return kSafety * limits_.pace_from(limits_.rest(), level);
}

/// Where inertia of added mass shows, the step falls to where it hardly does: mass goes with h² less what tets bear without it. The
/// step comes back by as much as tets are told of before they need mass, slowly within a swing of the tissue, and in few changes,
/// since each asks for the masses of all vertices.
/// @return whether it is another one
bool VariableMassPace::follow_inertia(std::span<const double> stiffening) {
  const double inertia = std::exchange(inertia_, 0.0) / bearable_inertia_;
  ++since_came_, ++since_gone_;
  double wanted = std::min(step_, longest_);
  if (inertia > kMuchInertia) {
    const double tissue = std::min(step_without_masses(stiffening), kSafety * limits_.drag_limit()),
                 borne = std::min(step_, limits_.with_added(tissue, {with_mass_, 0.0})), share = 1.0 / inertia;
    wanted = std::min({step_, longest_, std::sqrt(share * step_ * step_ + (1.0 - share) * borne * borne)});
    if (wanted < kNearlyBorne * borne) wanted = std::min(borne, longest_);
    growth_ = 0.0;
  } else if (inertia < kLittleInertia && step_ < longest_) {
    growth_ += step_ / ((inertia < kHardlyInertia ? kQuickMemory : kMemory) * longest_);
    if (growth_ >= kTurnOfGrowth) {
      wanted = std::min(std::min(kMostGrowth, std::exp(growth_)) * step_, longest_);
      growth_ = 0.0;
    }
  }
  return wanted != step_ && change_step(wanted);
}

void VariableMassPace::take_added(const AddedBeside& added) {
  Pace::take_added(added);
  restraint_.add(tools_);
  with_mass_ = added.with_mass;
}

void VariableMassPace::set_added(const AddedBeside& added) {
  take_added(added);
  bears_added_ = added_levels_.meet(added.to_bear);
  if (!bears_added_) find_masses();
}

void VariableMassPace::follow_added(const AddedBeside& added) {
  restraint_.let_go_of_added();
  take_added(added);
  bears_added_ = added_levels_.meet(added.to_bear);
}

void VariableMassPace::state_set(const AddedBeside& added, MovingBody& moving) {
  take_added(added);
  added_levels_.clear();
  choose(longest_);
  inertia_ = 0.0;
  listed_before_.clear();
  start_anew();
  set_added(added);
  masses_.state_set();
  give_masses(moving);
}

void VariableMassPace::mesh_changed(const BodyChange& change, const detail::VertexStars& stars) {
  limits_.mesh_changed(change, stars, now_);
  levels_.remove(change.removed), levels_.reshape(change.reshaped);
  choose(step_);
  find_masses();
}

void VariableMassPace::tissues_changed(std::span<const double> stiffening, bool undeformed) {
  now_ = limits_.choose(stiffening, undeformed);
  levels_.tissues_changed(), choose(longest_);
  limits_.tissues_taken();
  start_anew();
}

void VariableMassPace::body_read(const detail::VertexStars* stars) {
  Pace::body_read(stars);
  levels_.body_changed();
}

void VariableMassPace::archive(Archive& ar, MovingBody& moving) {
  masses_.archive(ar, moving);
  ar(step_, steps_, now_, limits_, restraint_, levels_, masses_are_new_, bears_added_, growth_, pause_, since_came_,
     since_gone_);
  ar.same_size(listed_before_);
  added_levels_.archive(ar, body().vertex_count);
  if (!ar.reads()) return;
  tell_settling();
  // masses that are the body's come from levels that have come down since
  masses_are_new_ ? find_masses() : list_from();
}

}  // namespace glisson

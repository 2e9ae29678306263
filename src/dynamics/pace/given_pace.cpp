#include "dynamics/pace/given_pace.h"

#include <algorithm>
#include <stdexcept>

#include "dynamics/step/step_rules.h"

namespace glisson {

GivenPace::GivenPace(StepLimits limits, const SimulationOptions& options)
    : LevelPace(std::move(limits), options.enforce_stability) {
  step_ = *options.step;
  if (const double stable = stable_step(); enforces_ && step_ > stable) refuse_above(stable);
  start_anew();
}

void GivenPace::refuse_above(double stable) const { throw std::invalid_argument(too_large(stable)); }

/// By levels of single tets, by that of the blocks, by that without a safety factor.
bool GivenPace::rises(std::span<const double> stiffening, double) {
  take_stiff();
  unchecked_ = false;
  if (!is_crowded() && step_ <= stable_step()) return true;
  levels_.clear();
  for (const std::vector<double>& level : {risen(stiffening, 1.0), at_least_one(stiffening)}) {
    take_base({limits_.search(level), level});
    if (step_ <= now_.limits.stable) return true;
  }
  return false;
}

void GivenPace::bound_fell() { unchecked_ = enforces_ && step_ > std::min(now_.limits.stable, limits_.drag_limit()); }

void GivenPace::state_set(const AddedBeside& added, MovingBody&) {
  take_added(added);
  now_ = limits_.rest();
  start_anew();
}

void GivenPace::tissues_changed(std::span<const double> stiffening, bool undeformed) {
  const StepLimits::Knowledge known = limits_.knowledge();
  const StepLimits::Known before = now_;
  const AddedStiffness stiff = stiff_;
  stiff_ = {};  // the level of the blocks is chosen for all tets
  now_ = limits_.choose(stiffening, undeformed);
  if (!bears()) {
    now_.level = at_least_one(stiffening);  // without a safety factor
    now_.limits = limits_.search(now_.level);
    if (const double stable = stable_step(); step_ > stable) {
      limits_.go_back(known);
      now_ = before, stiff_ = stiff;
      refuse_above(stable);
    }
  }
  limits_.tissues_taken();
  unchecked_ = false;
  start_anew();
}

void GivenPace::archive(Archive& ar, MovingBody&) {
  ar(step_, unchecked_, now_, levels_, limits_);
  if (ar.reads()) take_stiff();
}

}  // namespace glisson

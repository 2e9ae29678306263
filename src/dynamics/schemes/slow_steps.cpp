// slow_steps.cpp — statics in time: steps of `quasi_static` in which branches relax and viscosity resists (StaticBranches::follow).
//
//   step ─▶ an instant, where something is sudden ─▶ half ─▶ half ─▶ how wrong? ─▶ next step
//                                                     ▲                 │
//                                                     └── back, shorter ┘      (automatic steps alone)
//
// Branches are exact for stress that is linear in time over a half (branch_weights.h). Where it is not, q after two halves differs
// from q after one step by 3/4 of the error that one step has: the error of two is a third of the difference. Viscosity is wrong by
// what the velocities of its stages, as a quadrature, make of the displacement.
#include <algorithm>
#include <cmath>

#include "dynamics/schemes/implicit_scheme.h"

namespace glisson {
namespace {

constexpr double kInstant = 1e-7;      ///< of a step: so short that nothing relaxes in it
constexpr double kForceError = 3e-5;   ///< of the largest stress, that branches may err by in an automatic step …
constexpr double kTravelError = 3e-6;  ///< … and of the largest displacement, viscosity
constexpr double kSlowSafety = 0.9, kLeastError = 1e-4;
constexpr double kWorthGrowing = 1.4, kMostGrowth = 2.0;  ///< of a step: each change costs a factor
constexpr double kMostShrinking = 0.1, kLeastShrinking = 0.7;
constexpr int kMostTries = 40;

double squared(std::span<const Vec3d> field) {
  double sum = 0.0;
  for (const Vec3d& x : field) sum += dot(x, x);
  return sum;
}

}  // namespace

/// Whether some tissue or load resists velocities.
bool ImplicitScheme::resists() const {
  const auto& blocks = state_.body.blocks;
  return !state_.loads.dashpots().empty() ||
         std::any_of(blocks.begin(), blocks.end(), [](const TissueBlock& b) { return b.tissue.viscosity > 0.0; });
}

/// Lets what is sudden happen before anything relaxes. @return false where it has no balance: nothing has changed
bool ImplicitScheme::make_instant(double h) {
  const double instant = kInstant * h;
  if (stage(resists() ? slow_step(instant) : static_step(instant), false) != Part::made) return false;
  state_.time += instant;
  std::fill(last_change_.begin(), last_change_.end(), Vec3d{});
  last_h_ = 0.0;
  return true;
}

ImplicitScheme::Part ImplicitScheme::slow_part(double h, bool dates_events) {
  Backup before = backup();
  const bool viscous = resists();
  std::vector<Vec3d> travelled(viscous ? now_.u.size() : 0);
  std::size_t k = 0;
  for (const TimeStep& s : slow_stages(h, viscous)) {
    const Part outcome = stage(s, dates_events);
    if (outcome != Part::made) {
      restore(std::move(before));
      return outcome;
    }
    state_.time += s.h;
    for (std::size_t i = 0; i < travelled.size(); ++i) travelled[i] += now_.v[i] * (kSlowWeights[k] * h);
    ++k;
  }
  state_.time = before.time;
  pace_.error = std::max(pace_.error, error_of(before, h, travelled));
  return Part::made;
}

/// How wrong a part of h is, over what it may be. @param travelled  displacement by its velocities; empty: there is no viscosity [m]
double ImplicitScheme::error_of(const Backup& before, double h, std::span<const Vec3d> travelled) {
  double error = 0.0;
  if (tissue_.has_memory()) {
    const MemoryChange change = tissue_.change_by_one_step(before.memory, h, now_.u);
    pace_.largest_stress = std::max(pace_.largest_stress, change.stress);
    if (pace_.largest_stress > 0.0) error = change.overstress / 3.0 / (kForceError * pace_.largest_stress);
  }
  if (travelled.empty()) return error;
  double off = 0.0;
  for (std::size_t i = 0; i < travelled.size(); ++i) {
    const Vec3d d = now_.u[i] - before.now.u[i] - travelled[i];
    off += dot(d, d);
  }
  pace_.largest_displacement = std::max(pace_.largest_displacement, std::sqrt(squared(now_.u)));
  if (!(pace_.largest_displacement > 0.0)) return error;
  return std::max(error, std::sqrt(off) / (kTravelError * pace_.largest_displacement));
}

StepResult ImplicitScheme::slow_step_of(double h, bool sudden) {
  const bool automatic = !state_.options.step;
  double end = end_of(h), shortest = h;
  std::optional<Backup> before = backup();
  if (sudden && make_instant(h)) {
    if (automatic) return made();  // a step of its own, so that samples are on the right side of it
    h = end - state_.time;
  }
  for (int tries = 1;; ++tries) {
    pace_.error = 0.0;
    std::optional<Backup> start = before;
    if (!advance(h, end, start, shortest)) {
      adapt_slow(h, shortest);
      return failed(shortest);
    }
    if (!automatic || pace_.error <= 1.0 || tries == kMostTries) break;
    restore(*before);
    pace_.step = h * std::clamp(kSlowSafety / std::sqrt(pace_.error), kMostShrinking, kLeastShrinking);
    h = step_size(), end = end_of(h);
  }
  pace_.planned = h;
  adapt_slow(h, shortest);
  return made();
}

/// What an automatic step is next.
void ImplicitScheme::adapt_slow(double h, double shortest) {
  if (state_.options.step || shortest < h) return adapt(h, shortest);
  const double fits = h * kSlowSafety / std::sqrt(std::max(pace_.error, kLeastError));
  if (fits >= kWorthGrowing * pace_.step && is_easy())
    pace_.step = std::min({kMostGrowth * pace_.step, fits, largest_});
}

}  // namespace glisson

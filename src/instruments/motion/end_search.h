// end_search.h — where a tool ends that a force moves, in a long step: the force there depends on where.
//
//   trial x ──▶ contact or needle ──▶ force f(x) ──▶ driver: Y(f)      wanted: x = Y(f(x)), by Broyden's method [Broyden1965]
//      ▲                                               │
//      └────────── x + M⁻¹ r,  r = Y − x ◀─────────────┘               M learns −∂r/∂x, 1 where nothing resists
#pragma once

#include "glisson/archive.h"
#include "glisson/math.h"

namespace glisson {

class EndSearch {
 public:
  /// The coming step has not begun.
  void forget() { begun_ = false; }
  bool begun() const { return begun_; }
  /// Begins a step. @param before  where the tool is @param guess  of where it ends @param free  where it would end without the tissue [m]
  void begin(const Vec3d& before, const Vec3d& guess, const Vec3d& free);
  /// Where the tool is to be tried next [m].
  const Vec3d& trial() const { return trial_; }
  /// Where the tool would end without the tissue [m].
  const Vec3d& free() const { return free_; }
  /// The force found at the trial takes the tool to `end`. @return whether another trial is to follow; after kMostTrials: whether the end
  /// is far from being found
  bool goes_on(const Vec3d& end);
  /// What it has learnt of earlier steps: its trials are those of one step, and stay when this is read again in it.
  void archive(Archive& ar) { ar(kept_); }
  const Mat3d& slope() const { return kept_; }
  void set_slope(const Mat3d& slope) { kept_ = slope; }

 private:
  Vec3d forward(const Vec3d& r, double most) const;
  void learn(const Mat3d& change);

  bool begun_ = false, goes_ = false;  ///< in a step; in a row of trials
  int tries_ = 0, stalls_ = 0, restarts_ = 0;
  double farthest_ = 0.0;  ///< that a trial goes from the last [m]
  Vec3d trial_, free_, last_trial_, last_r_;
  Mat3d slope_ = identity<double>(), kept_ = identity<double>();
};

}  // namespace glisson

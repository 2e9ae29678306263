// step_control.h — chooses the step, and keeps it below h* while the tissue stiffens.
//
// h* is computed for a level of stiffness per tissue block. While every element stays below that level the
// step is known to be stable and nothing is computed; when one rises above it, h* is computed anew with
// room to grow, so that the spectrum is visited a few times in a run, not each step. Where that takes too long
// (real time), the last h* gives a bound: for stiffness up to r times as large,
//   φ(h/r) of r K  =  (1/r) φ(h) of K  ≤ 4,   and without nodal damping φ(h/√r) of r K ≤ φ(h) of K ≤ 4.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/stable_step.h"
#include "mechanics/body.h"

namespace glisson {

class StepControl {
 public:
  /// @param nodal_damping  γ_i per vertex [kg/s]; not copied: must last until mesh_changed names another
  /// @param given  the user's step [s], none: auto
  /// @throws std::invalid_argument where `given` is not positive or above h*, unless `enforce` is false
  /// @param exact   whether an automatic step is searched for anew as tissue stiffens, or bounded from the last one
  StepControl(const Body& body, std::span<const double> nodal_damping, std::optional<double> given, bool enforce,
              bool exact, std::span<const double> stiffening);

  /// Takes in the present stiffness; lowers an automatic step where needed.
  /// @return false where a given step is above h* by now
  bool accept(std::span<const double> stiffening);

  /// After elements were removed or split from each other: h* falls to the bound that holds for any part of the body,
  /// each element with its own share of mass. A given step above that is checked against h* itself by the next
  /// accept(), which is slow.
  void mesh_changed(std::span<const double> nodal_damping);

  double step() const { return step_; }
  double stable_step() const { return stable_; }

 private:
  double stable_at(std::span<const double> stiffening);
  double bound_at(std::span<const double> stiffening) const;

  const Body& body_;
  std::span<const double> nodal_damping_;
  bool automatic_, enforce_, exact_;
  StabilityGuess guess_;
  double step_ = 0.0, stable_ = 0.0;
  double any_part_;                ///< element_bound_step at rest: holds for any part of the body [s]
  bool unchecked_ = false;         ///< a given step is above the bound of a mesh that has changed
  std::vector<double> validated_;  ///< stiffening per block up to which step_ is known to be stable
};

}  // namespace glisson

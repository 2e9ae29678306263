// step_control.h — chooses the step, and keeps it below h* while the tissue stiffens.
//
// h* is computed for a level of stiffness per tissue block. While every element stays below that level the
// step is known to be stable and nothing is computed; when one rises above it, h* is computed anew with
// room to grow, so that the spectrum is visited a few times in a run, not each step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/stable_step.h"
#include "mechanics/body.h"

namespace glisson {

class StepControl {
 public:
  /// @param given  the user's step [s], none: auto
  /// @throws std::invalid_argument where `given` is not positive or above h*, unless `enforce` is false
  StepControl(const Body& body, std::vector<double> nodal_damping, std::optional<double> given, bool enforce,
              std::span<const double> stiffening);

  /// Takes in the present stiffness; lowers an automatic step where needed.
  /// @return false where a given step is above h* by now
  bool accept(std::span<const double> stiffening);

  double step() const { return step_; }
  double stable_step() const { return stable_; }

 private:
  double stable_at(std::span<const double> stiffening);

  const Body& body_;
  std::vector<double> nodal_damping_;
  bool automatic_, enforce_;
  StabilityGuess guess_;
  double step_ = 0.0, stable_ = 0.0;
  std::vector<double> validated_;  ///< stiffening per block up to which step_ is known to be stable
};

}  // namespace glisson

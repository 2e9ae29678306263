// restraint.h — what holds a step back that the program chooses, below what the limits allow.
//
// - The stiffness in a step is known one step late: where it rises by more than the safety factor within a step, steps are shortened until
//   it does not. Exponential laws under impact need this.
// - Stiff tets of large strain may not change shape by more than a hundredth in a step, or, where a tet could be stiffer before it asked
//   for a shorter step, by what would make it so.
// - What tools made stiff lets the step grow again by no more than kRegrowth a step where it falls: a torn membrane that whips back is
//   slack at one step and a hundred times as stiff at the next.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "dynamics/step/step_limits.h"
#include "element/stiff_element.h"
#include "engine/moving_body.h"
#include "glisson/archive.h"

namespace glisson {

class Restraint {
 public:
  /// @param body  must outlive this
  Restraint(const Body& body, bool enforces);

  /// The step that is left of one that the limits allow. @param stiff  beside it  @param drag_limit  [s]
  double hold_back(double step, const StepLimits& limits, const AddedStiffness& stiff, double drag_limit) const;
  /// Stiffness has risen by that within a step.
  void rise(double rise);
  /// Limits the coming step, of h, by how fast those change shape.
  void limit_shape_change(std::span<const StiffElement> stiff, const MovingBody& moving, double h);
  void forget_shape_change() { shape_step_ = std::numeric_limits<double>::infinity(); }
  /// Lowers levels, per block, from which tets are listed, to those whose changes of shape may count.
  void list_violent(std::vector<double>& levels) const;
  /// ω² of what acts beside the tissue [1/s²].
  void add(double tools);
  void let_go_of_added();
  void start_anew(double tools);
  void archive(Archive& ar) { ar(caution_, shape_step_, held_); }

 private:
  bool is_violent(const StiffElement& element) const;
  double slack(const StiffElement& stiff, double step) const;

  const Body& body_;
  bool enforces_;
  double caution_ = 1.0;                                         ///< factor on the step while stiffness rises fast
  double shape_step_ = std::numeric_limits<double>::infinity();  ///< [s]
  double held_ = 0.0;  ///< ω² that the step is chosen for: at least as much as there is [1/s²]
};

}  // namespace glisson

// pace.h — how long the steps of a scheme are, if not every step is stable.
//
//   accept        looks at what the last step has left ──▶ step(), or no: a given step is above h* by now
//   step_made …   what a step leaves for the next
//
//   Pace ─┬─ LevelPace ─┬─ GivenPace        the step asked for, refused above h*
//         │             └─ AutomaticPace    0.9 h*, which falls as the tissue stiffens and grows again
//         └─ VariableMassPace               the step asked for, with mass where tets do not bear it
//
// While every element stays below the level of stiffness that the step was found for, it is stable and nothing is computed.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/state/active_kick.h"
#include "dynamics/state/energy_ledger.h"
#include "dynamics/step/step_limits.h"
#include "element/body_change.h"
#include "element/stiff_element.h"
#include "engine/moving_body.h"
#include "glisson/archive.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

/// What the last step has left.
struct LastStep {
  std::span<const double> stiffening;   ///< per tissue block: bound of tangent over rest stiffness [-]
  std::span<const StiffElement> stiff;  ///< elements above what list_above() said before it was evaluated
  const ActiveKick& kick;
  MovingBody& moving;
};

/// Stiffness that acts beside the tissue.
struct AddedBeside {
  double squared_frequency = 0.0;            ///< ω² on the body's masses, from above: it shortens the step [1/s²]
  double with_mass = 0.0;                    ///< the same of what gets mass in the place of a shorter step [1/s²]
  std::span<const VertexStiffness> to_bear;  ///< what that mass is for
};

class Pace {
 public:
  virtual ~Pace() = default;
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;

  /// Looks at what the last step has left, and finds the next. @return false where a given step is above h* by now
  virtual bool accept(const LastStep& last) = 0;
  virtual double step() const = 0;         ///< the next [s]
  virtual double stable_step() const = 0;  ///< h* at present, from below [s]
  /// A step of h has been made.
  virtual void step_made(double /*h*/) {}
  /// Whether a given step bears what acts beside the tissue.
  virtual bool bears() const { return true; }
  /// What is wrong with a given step that is not accepted, and the ways out.
  std::string too_large() const { return too_large(stable_step()); }

  /// Stiffness per block from which elements have to be listed for the next accept().
  std::span<const double> list_above() const { return list_above_; }
  /// Per element, from which it has to be listed where that is more; empty: none is. Valid until the next accept() or change.
  virtual std::span<const StiffLimit> single_limits() const { return {}; }

  /// Whether stiffness that acts beside the tissue can get mass in the place of a shorter step.
  virtual bool gives_mass() const { return false; }
  virtual void set_added(const AddedBeside& added) { take_added(added); }
  /// The same after a step.
  virtual void follow_added(const AddedBeside& added) { take_added(added); }
  /// The same after archive() has read.
  void added_read(const AddedBeside& added) { take_added(added); }

  /// A state is set from outside: steps are chosen as if the body had been made in it.
  virtual void state_set(const AddedBeside& added, MovingBody& moving) = 0;
  /// Makes ready for mesh_changed, which does so the first time. @param stars  must outlive this
  void prepare_changes(const detail::VertexStars& stars) { limits_.prepare_changes(stars); }
  /// After elements were removed, split from each other or reshaped: h* falls to a bound from single elements
  /// (element_step_bound.h). A given step above that is checked against h* itself by the next accept(), which is slow.
  virtual void mesh_changed(const BodyChange& change, const detail::VertexStars& stars) = 0;
  /// After tissues of the body have changed: the step is found anew. @param undeformed  whether the stiffness is that at rest
  /// @throws std::invalid_argument where a given step is above h*; nothing has changed then
  virtual void tissues_changed(std::span<const double> stiffening, bool undeformed) = 0;
  bool follows_changes() const { return limits_.follows_changes(); }
  /// The body has been read; archive comes next. @param stars  where follows_changes() was true when it was written
  virtual void body_read(const detail::VertexStars* stars) { limits_.body_read(stars); }
  virtual void archive(Archive& ar, MovingBody& moving) = 0;

 protected:
  Pace(StepLimits limits, bool enforces) : limits_(std::move(limits)), now_(limits_.rest()), enforces_(enforces) {}

  virtual void take_added(const AddedBeside& added) { tools_ = added.squared_frequency; }
  /// Whether the step has to bear that stiffness: it is left alone where it is not finite, which the step reports.
  bool has_to_bear(std::span<const double> stiffening) const;
  const Body& body() const { return limits_.body(); }
  std::string too_large(double stable) const;

  StepLimits limits_;
  StepLimits::Known now_;  ///< the present level
  bool enforces_;          ///< whether steps are to be stable
  double step_ = 0.0;      ///< [s]
  double tools_ = 0.0;     ///< ω² of what acts beside the tissue [1/s²]
  std::vector<double> list_above_;
};

/// What a pace is made of; all of it must outlive the pace.
struct PaceParts {
  BodyState& state;
  Drag drag;
  EnergyLedger& ledger;
};

/// The pace that the options ask for. @param stiffening  at rest, per tissue block [-]
/// @throws std::invalid_argument where the step given is above h*, unless stability is not enforced
std::unique_ptr<Pace> make_pace(const PaceParts& parts, std::span<const double> stiffening);

}  // namespace glisson

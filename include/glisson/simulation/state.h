// state.h — a simulation at one time, kept in memory to go back to.
//
//   State before = simulation.save_state();
//   … steps, contacts, punctures, cuts …
//   simulation.load_state(before);                    continues with the same bytes as then
//
// What seldom changes (mesh, layout in memory, tissues, the factor of a long step) is shared between the simulation and all
// its states; it is copied once, when the body is about to change. The rest is copied each time.
#pragma once

#include <memory>

namespace glisson {

/// All that changes in a simulation while it runs, as it was at one time. A copy shares the contents. It outlives changes of
/// the simulation, not its end: without its simulation it is of no use.
class State {
 public:
  /// Of no simulation: load_state refuses it.
  State() = default;
  /// Whether it is of some simulation.
  explicit operator bool() const { return contents_ != nullptr; }
  /// Simulation::time() when it was saved [s]; 0 where it is of none.
  double time() const;

 private:
  friend class Simulation;
  struct Contents;
  std::shared_ptr<const Contents> contents_;
};

}  // namespace glisson

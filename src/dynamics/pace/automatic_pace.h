// automatic_pace.h — steps of 0.9 h*, which fall as the tissue stiffens and grow again.
//
// Where an element rises above its level, h* is found again with a safety factor, so that a run needs few searches.
// Once in a window of steps the step may grow again: where the stiffest moment of the window stayed well below the
// level, h* is found for that moment. The window doubles each time, so that oscillating tissue costs no search a cycle.
// After a short peak the bound restores the step within a few steps.
//
// The level of the blocks rises where that gives a longer step than levels of single tets. Every few hundred steps the body lists all tets
// that are stiffer than at rest, and the level of the blocks is chosen again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/pace/level_pace.h"
#include "dynamics/pace/restraint.h"

namespace glisson {

class AutomaticPace final : public LevelPace {
 public:
  AutomaticPace(StepLimits limits, const SimulationOptions& options);

  double step() const override { return restraint_.hold_back(step_, limits_, stiff_, limits_.drag_limit()); }
  /// An automatic step grows again slowly where that falls (restraint.h).
  void follow_added(const AddedBeside& added) override;
  void state_set(const AddedBeside& added, MovingBody& moving) override;
  void tissues_changed(std::span<const double> stiffening, bool undeformed) override;
  void archive(Archive& ar, MovingBody& moving) override;

 private:
  using Limits = StepLimits::Limits;

  bool rises(std::span<const double> stiffening, double rise) override;
  void is_calm() override { restraint_.rise(1.0); }
  bool settles(std::span<const double> stiffening) override;
  void hold_back(const LastStep& last) override;
  void bound_fell() override;
  void list_from() override;
  void take_base(StepLimits::Known base) override;
  void take_added(const AddedBeside& added) override;
  void start_anew();
  double pace_of(const Limits& limits, const AddedStiffness& added, std::size_t above) const;
  double pace_above(std::span<const double> level, double enough);
  void choose_base(const std::vector<double>& least, bool forced);
  void probe();
  void settle();
  void relax(std::span<const double> stiffening);

  static constexpr std::uint64_t kFirstWindow = 1000, kFirstProbe = 64;  ///< [steps]
  Restraint restraint_;
  std::vector<double> seen_, lately_;  ///< largest stiffening per block in this window, in the last few steps
  std::uint64_t window_ = kFirstWindow, in_window_ = 0;
  std::uint64_t probe_ = kFirstProbe, since_probe_ = 0;  ///< [steps]
};

}  // namespace glisson

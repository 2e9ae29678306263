// given_pace.h — the step that was asked for, as long as it is stable.
#pragma once

#include <span>

#include "dynamics/pace/level_pace.h"

namespace glisson {

class GivenPace final : public LevelPace {
 public:
  /// @throws std::invalid_argument where the step is above h*, unless stability is not enforced
  GivenPace(StepLimits limits, const SimulationOptions& options);

  double step() const override { return step_; }
  bool bears() const override { return !enforces_ || step_ <= stable_step(); }
  void state_set(const AddedBeside& added, MovingBody& moving) override;
  void tissues_changed(std::span<const double> stiffening, bool undeformed) override;
  void archive(Archive& ar, MovingBody& moving) override;

 private:
  bool rises(std::span<const double> stiffening, double rise) override;
  bool settles(std::span<const double>) override { return step_ <= stable_step(); }
  void bound_fell() override;
  [[noreturn]] void refuse_above(double stable) const;
};

}  // namespace glisson

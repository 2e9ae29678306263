// taste.h — the first tenth of a second of a run, or its first step where that takes longer, from which `glisson check` says what the whole would be.
#pragma once

#include <atomic>
#include <string>

#include "cli/check_clock.h"
#include "glisson/scene/advice.h"

namespace glisson::app {

/// Stops a run at its first report of progress after a step, or when time is up, and keeps what the run knew at its start.
class Taste : public RunObserver {
 public:
  explicit Taste(CheckClock& clock) : clock_(clock) {}

  void on_start(const Variant& variant, const Simulation& simulation) override {
    name = variant.name;
    rest = VariantAtRest(variant, simulation);
  }
  void on_built(const BuiltVariant&) override { clock_.begin("the first steps of " + name); }
  void on_progress(double fraction) override { stop = fraction > 0.0 || !clock_.has_time(); }

  std::atomic<bool> stop{false};
  std::string name;
  VariantAtRest rest;

 private:
  CheckClock& clock_;
};

}  // namespace glisson::app

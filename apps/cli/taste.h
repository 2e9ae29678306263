// taste.h — the first tenth of a second of a run, or its first step where that takes longer, from which `glisson check` says what the whole would be.
#pragma once

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "cli/check_clock.h"
#include "glisson/scene/scene.h"

namespace glisson::app {

/// Stops a run at its first report of progress after a step, or when time is up, and keeps what the run knew at its start.
class Taste : public RunObserver {
  static constexpr std::size_t kFew = 20;            ///< one tet in so many is what may keep the step short alone
  static constexpr std::size_t kMostCorners = 1000;  ///< that are looked at

 public:
  explicit Taste(CheckClock& clock) : clock_(clock) {}

  void on_start(const Variant& variant, const Simulation& simulation) override {
    const double end = run_duration(variant);
    for (double t = simulation.next_corner(0.0); t < end && corners.size() < kMostCorners;
         t = simulation.next_corner(t)) {
      corners.push_back(t);
    }
    if (std::isfinite(end)) corners.push_back(end);
    name = variant.name;
    mesh = simulation.mesh();
    step_s = simulation.step_size();
    stable_step_s = simulation.stable_step();
    for (const double m : simulation.masses()) mass_kg += m;
    scaling = simulation.mass_scaling();
    if (std::isfinite(stable_step_s)) limits = simulation.limiting_tets(mesh.tets.size() / kFew + 1);
  }
  void on_built(const BuiltVariant&) override { clock_.begin("the first steps of " + name); }
  void on_progress(double fraction) override { stop = fraction > 0.0 || !clock_.has_time(); }

  std::atomic<bool> stop{false};
  std::string name;
  TetMesh mesh;
  double step_s = 0.0, stable_step_s = 0.0, mass_kg = 0.0;
  MassScaling scaling;
  std::vector<LimitingTet> limits;  ///< of an explicit step: the tets with the smallest bounds
  std::vector<double> corners;      ///< of motions and loads, and the end of the run [s]

 private:
  CheckClock& clock_;
};

}  // namespace glisson::app

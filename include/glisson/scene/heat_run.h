// heat_run.h — a scene of heat, built and run.
//
// A scene has either mechanics (scene.h: BuiltVariant, run_variant) or, where it has a [heat], heat alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "glisson/heat/heat_places.h"
#include "glisson/heat/heat_simulation.h"
#include "glisson/scene/scene.h"

namespace glisson {

/// One line of temperature.csv and of heat.csv, by their columns.
struct HeatSample {
  std::vector<double> temperatures, heat;
};

/// The body of a variant with what heats and cools it, at its start, and what is read of it.
class BuiltHeat {
 public:
  /// @throws SceneError where the variant has no [heat], or mesh, sets, tissues or places cannot be used
  BuiltHeat(const Variant& variant, const MeshLoader& load);

  HeatSimulation simulation;

  /// Of temperature.csv: `time_s`, then each sensor and region [°C].
  const std::vector<std::string>& temperature_columns() const { return temperature_columns_; }
  /// Of heat.csv: time, volumes, fronts, isotherms, the ledger.
  const std::vector<std::string>& heat_columns() const { return heat_columns_; }
  HeatSample read() const;

 private:
  struct Mean {  ///< over a region: weights of its vertices, which sum to 1
    std::vector<std::pair<std::uint32_t, double>> weights;
  };
  struct Front {
    HeatLine line;
    std::optional<double> temperature, above;
  };
  struct Isotherm {
    double temperature = 0.0;
    std::optional<int> region;
    std::optional<HeatPlane> plane;
  };
  BuiltHeat(TetMesh mesh, const Variant& variant);
  void add_sources(const Variant& variant);
  void add_sensors(const Variant& variant);
  void add_volumes(const Variant& variant);

  std::vector<std::string> temperature_columns_{"time_s"}, heat_columns_{"time_s"};
  HeatPoints points_;
  std::vector<Mean> means_;
  std::vector<char> is_mean_;  // of each column behind the time
  std::vector<Front> fronts_;
  std::vector<Isotherm> isotherms_;
  std::vector<int> regions_;  // whose dead volume is read
};

struct HeatRunSummary {
  std::size_t vertices = 0, tets = 0, steps = 0;
  double time_s = 0.0, wall_s = 0.0;
  double lowest_C = 0.0, highest_C = 0.0;  ///< of all samples
  HeatLedger ledger;
  HeatWork work;
  double limited_share_most = 0.0;
  std::uint64_t state_hash = 0;
  RunSummary::End end = RunSummary::End::finished;
  std::string trouble;  ///< why the run ended early and what to do; empty if it did not
};

/// Observes a run; called from its own thread.
class HeatObserver {
 public:
  virtual ~HeatObserver() = default;
  virtual void on_start(const Variant&, const BuiltHeat&) {}
  virtual void on_sample(const HeatSample&) {}
  virtual void on_frame(const HeatSimulation&) {}
  virtual void on_progress(double /*fraction*/) {}
  virtual void on_end(const HeatRunSummary&) {}
};

/// Builds and runs a variant to its end, or until `stop` is set. Samples are at multiples of HeatSpec::sample_every and at the end, frames
/// evenly spaced at the samples next to them, the first at the start. It ends where a temperature falls below absolute zero.
/// @throws SceneError before the first step; after it, only what the observer throws
HeatRunSummary run_heat(const Variant& variant, const MeshLoader& load, HeatObserver& observer,
                        const std::atomic<bool>& stop);

}  // namespace glisson

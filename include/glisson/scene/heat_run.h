// heat_run.h — a scene of heat, built and run.
//
// A scene has mechanics (scene.h: BuiltVariant, run_variant), or heat alone where it has a [heat], or both where that has an [heat.ice].
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "glisson/heat/heat_places.h"
#include "glisson/heat/heat_simulation.h"
#include "glisson/instruments/ice.h"
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
  BuiltHeat(TetMesh mesh, const Variant& variant);

  HeatSimulation simulation;

  /// Of temperature.csv: `time_s`, then each sensor and region [°C].
  const std::vector<std::string>& temperature_columns() const { return temperature_columns_; }
  /// Of heat.csv: time, volumes, fronts, isotherms, the ledger.
  const std::vector<std::string>& heat_columns() const { return heat_columns_; }
  /// What lies in no tet any more is not a number.
  HeatSample read() const;
  /// HeatSimulation::change_mesh, which what is read follows.
  void change_mesh(TetMesh mesh, std::span<const std::uint32_t> origins);

 private:
  struct Mean {  ///< over a region: weights of its vertices, which sum to 1
    std::vector<std::pair<std::uint32_t, double>> weights;
  };
  struct Point {
    Vec3d at{};
    HeatPoints place;  ///< empty: the tet is gone
  };
  struct Front {
    HeatFrontSpec spec;
    std::optional<HeatLine> line;  ///< none: the body is gone there
  };
  struct Isotherm {
    HeatIsothermSpec spec;
    std::optional<int> region;
    std::optional<HeatPlane> plane;
  };
  void add_sources(const Variant& variant);
  void add_sensors(const Variant& variant);
  void add_means(const Variant& variant);
  void add_volumes(const Variant& variant);
  void read_isotherms(std::span<const double> temperature, std::vector<double>& row) const;

  std::vector<std::string> temperature_columns_{"time_s"}, heat_columns_{"time_s"};
  std::vector<Point> points_;
  std::vector<std::pair<int, Mean>> means_;  // by region
  std::vector<char> is_mean_;                // of each column behind the time
  std::vector<Front> fronts_;
  std::vector<Isotherm> isotherms_;
  std::vector<int> regions_;  // whose dead volume is read
};

/// Heat beside mechanics: an interaction that lets heat go on between steps of the mechanics, in the shape that they give, and freezes
/// the tets of the body by its temperature. A tet is frozen by the mean share of ice of its vertices.
class HeatCoupling final : public Interaction {
 public:
  /// @param mesh  of the simulation it will be attached to, after its ice @throws SceneError as BuiltHeat
  HeatCoupling(const Variant& variant, const TetMesh& mesh);
  ~HeatCoupling() override;

  const BuiltHeat& heat() const;
  const std::shared_ptr<Ice>& ice() const;
  /// Why it does not go on, and how its run ends; empty and finished: it does. Steps of the mechanics are made all the same.
  const std::string& trouble() const;
  RunSummary::End end() const;

  std::string label() const override { return "heat"; }
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double, double) override { return {}; }
  int most_drag_stages() const override;
  std::string refuses_long_steps() const override { return {}; }
  bool constrains_long_steps() const override { return false; }
  void between_steps(Simulation& simulation) override;
  double next_corner(double after) const override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
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

// scene_runs.h — runs a shipped scene in a test and keeps its samples.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "support/places.h"

namespace glisson::test {

/// The samples of one variant; forces are along the tool's direction, positive when it presses.
struct RunRecord {
  RunSummary summary;
  std::vector<double> time, depth, force, elastic, viscous;
  std::vector<Energies> energies;

  /// Value of a column at a time, linear between samples.
  double at(double t, const std::vector<double>& column) const {
    for (std::size_t i = 1; i < time.size(); ++i) {
      if (time[i] >= t)
        return column[i - 1] + (column[i] - column[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
    }
    return column.back();
  }
};

/// Observer that fills a record.
class Recorder final : public RunObserver {
 public:
  explicit Recorder(RunRecord& record) : record_(record) {}
  void on_built(const BuiltVariant& built) override { tool_ = built.instruments.front(); }
  void on_sample(const Sample& s) override {
    record_.time.push_back(s.time);
    record_.depth.push_back(s.instruments.front().depth);
    record_.force.push_back(tool_->read("force_N"));
    record_.elastic.push_back(tool_->read("elastic_N"));
    record_.viscous.push_back(tool_->read("viscous_N"));
    record_.energies.push_back(s.energies);
  }

 private:
  RunRecord& record_;
  std::shared_ptr<Instrument> tool_;
};

inline Scene shipped_scene(const std::string& path, std::vector<Override> overrides = {}) {
  return load_scene(test::shipped("scenes/" + path), overrides);
}

inline RunRecord run_recorded(const Variant& variant, const MeshLoader& load = {}) {
  RunRecord record;
  Recorder recorder(record);
  const std::atomic<bool> stop{false};
  record.summary = run_variant(variant, load, recorder, stop);
  return record;
}

/// Every variant of a scene, by name.
inline std::map<std::string, RunRecord> run_all(const Scene& scene) {
  std::map<std::string, RunRecord> runs;
  for (const Variant& variant : scene.variants) runs[variant.name] = run_recorded(variant);
  return runs;
}

}  // namespace glisson::test

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
  void on_start(const Variant& variant, const Simulation&) override {
    const Vec3d d = variant.tools.front().motion.direction;
    direction_ = d * (1.0 / norm(d));
  }
  void on_sample(const Sample& s) override {
    record_.time.push_back(s.time);
    record_.depth.push_back(s.depths.front());
    record_.force.push_back(dot(s.tools.front().total(), direction_));
    record_.elastic.push_back(dot(s.tools.front().elastic, direction_));
    record_.viscous.push_back(dot(s.tools.front().viscous, direction_));
    record_.energies.push_back(s.energies);
  }

 private:
  RunRecord& record_;
  Vec3d direction_;
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

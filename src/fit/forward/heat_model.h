// heat_model.h — a scene of heat as a forward model: columns of its temperature.csv and heat.csv at the instants of the curves.
//
//   values ──▶ ParametricVariant ──▶ Variant ── as long as its curves ask for ──▶ run_heat ──▶ columns ──▶ value(t) of each curve
//
// All curves of one variant are read from the same run, which is kept for those who ask next. A run uses one thread, since a fit
// runs many side by side, and writes nothing.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fit/forward/scene_model.h"
#include "fit/model/kept_results.h"
#include "fit/model/model.h"

namespace glisson::fit {

struct HeatModelOptions {
  MeshLoader load{};
  int steps = 0;                            ///< equal ones between two samples; 0: as the scene chooses
  const std::atomic<bool>* stop = nullptr;  ///< ends runs early, with a failure
  std::size_t recordings = 256;             ///< runs that are kept, ≥ 1
};

/// Between samples of the scene, `heat.sample_every_s` apart, a value is on the line between theirs.
class HeatModel final : public Model {
 public:
  /// @param keys  of the parameters, as --set takes them @param curves  each with Measurement::heat
  /// @throws SceneError, std::invalid_argument for a text, keys or curves that cannot be used
  HeatModel(const SceneText& scene, std::span<const std::string> keys, std::vector<Curve> curves,
            HeatModelOptions options = {});
  ~HeatModel() override;
  std::size_t curves() const override { return curves_.size(); }
  Prediction predict(std::size_t curve, std::span<const double> values) const override;
  /// Looks for the columns of all curves in the scene at these values. @throws SceneError, std::invalid_argument
  void require_columns(std::span<const double> values) const;

 private:
  class Experiment;
  struct Recording;
  std::vector<Curve> curves_;
  HeatModelOptions options_;
  std::vector<std::unique_ptr<const Experiment>> experiments_;  ///< one for each variant
  std::vector<std::size_t> experiment_of_;                      ///< of each curve
  mutable KeptResults<std::pair<std::size_t, std::vector<double>>, Recording> recordings_;
};

}  // namespace glisson::fit

// heat_recorder.h — writes down one run of heat, or the tables of one beside mechanics, and keeps what the report page will show of it.
//
//   on_sample ─▶ temperature.csv, heat.csv        on_frame ─▶ frames.pvd, frames/*.vtu        on_end ─▶ summary.json
//
// Everything on the disk is valid at any moment. A disk that refuses stops the run; the reason is kept in error().
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "glisson/io.h"
#include "glisson/scene/heat_run.h"
#include "report/surface_recorder.h"
#include "report/variant_recorder.h"

namespace glisson {

class HeatRecorder : public HeatObserver {
 public:
  /// @param stop  set when the disk refuses
  HeatRecorder(Variant variant, RecorderOptions options, std::atomic<bool>& stop);

  void on_start(const Variant& variant, const BuiltHeat& built) override;
  void on_sample(const HeatSample& sample) override;
  void on_frame(const HeatSimulation& simulation) override;
  void on_end(const HeatRunSummary& summary) override;

  bool started() const { return !columns_.empty(); }
  /// Why the disk refused; empty: it did not.
  const std::string& error() const { return guarded_.error(); }
  const Variant& variant() const { return variant_; }
  const HeatRunSummary& summary() const { return summary_; }
  /// One column of temperature.csv or heat.csv by name. @throws std::out_of_range naming it
  const std::vector<double>& column(const std::string& name) const;
  const std::vector<double>* find_column(const std::string& name) const;  ///< null where there is none
  /// Adds the last value of each column but the time.
  void add_last(nlohmann::ordered_json& json) const;
  /// One CheckData for each of its checks. @param label  of the variant; may be empty
  nlohmann::json checks(const std::string& label) const;
  /// VariantData of web/src/report_data.ts: `forces` has the columns of both tables.
  nlohmann::json json() const;
  /// ChartSpec: sensors, fronts and volumes over time, each a line of its chart.
  nlohmann::json charts(bool one_variant) const;

 private:
  nlohmann::ordered_json summary_json() const;

  Variant variant_;
  RecorderOptions options_;
  GuardedWriting guarded_;
  std::vector<std::string> columns_;  ///< of temperature.csv, then of heat.csv without its time
  std::size_t temperatures_ = 0;      ///< how many are of temperature.csv
  std::vector<std::vector<double>> data_;
  std::unique_ptr<LineFile> temperature_file_, heat_file_;
  std::unique_ptr<SurfaceRecorder> surface_;  ///< from the first frame on
  std::vector<std::pair<double, std::filesystem::path>> frames_;
  HeatRunSummary summary_;
};

/// What a frame shows of heat at the vertices: temperature_C, frozen, coldest_C … below_T_C_s of each isotherm [°C].
std::vector<Field> heat_fields(const HeatSimulation& simulation, const std::vector<double>& isotherms);

/// A sentence on an end that is the numbers' doing, and one on heat beyond what the model holds; empty where there is none.
std::string heat_trouble_text(const HeatRunSummary& summary);
std::string boiling_warning(const HeatRunSummary& summary);

}  // namespace glisson

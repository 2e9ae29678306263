// variant_recorder.h — writes down one variant as it runs, and keeps what the report page will show of it.
//
//   on_sample ─▶ forces.csv, forces_<name>.csv, probes.csv,         on_end ─▶ summary.json
//                temperature.csv and heat.csv with [heat.ice]
//   on_event  ─▶ events.csv, where there are instruments
//   on_frame  ─▶ frames.pvd, frames/*.vtu, view.jsonl, surface with instruments
//
// Everything on the disk is valid at any moment. A disk that refuses stops the run; the reason is kept in error().
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "glisson/scene/advice.h"
#include "glisson/scene/scene.h"
#include "report/check_result.h"
#include "report/force_table.h"
#include "report/frame_series.h"
#include "report/guarded_writing.h"
#include "report/output_file.h"
#include "report/surface_recorder.h"
#include "report/view_file.h"

namespace glisson {

class HeatRecorder;

struct RecorderOptions {
  std::filesystem::path folder;            ///< of the variant; made at the start, replaced files are gone by then
  std::string scene;                       ///< name of the scene, for the summary
  int threads = 1;                         ///< for the summary
  std::size_t surface_bytes = 25'000'000;  ///< what its surface may take in the page
  std::vector<CheckSpec> checks{};         ///< that the run is held to, for the summary
};

/// How near a tip came to the place of a probe.
struct TipDistance {
  std::string probe, tip;
  double distance = 0.0, along = 0.0, across = 0.0;  ///< at the end [m]
  double least = 0.0;                                ///< the least distance of all samples [m]
};

class VariantRecorder : public RunObserver {
 public:
  /// @param stop  set when the disk refuses
  VariantRecorder(Variant variant, RecorderOptions options, std::atomic<bool>& stop);
  ~VariantRecorder() override;

  void on_start(const Variant& variant, const Simulation& simulation) override;
  void on_built(const BuiltVariant& built) override;
  void on_sample(const Sample& sample) override;
  void on_event(const RunEvent& event) override;
  void on_frame(const Simulation& simulation) override;
  void on_end(const RunSummary& summary) override;

  /// Whether the run got as far as its start: before that there is nothing to report.
  bool started() const { return surface_ != nullptr; }
  /// Why the disk refused; empty: it did not.
  const std::string& error() const { return guarded_.error(); }
  const Variant& variant() const { return variant_; }
  const std::string& scene() const { return options_.scene; }
  const RunSummary& summary() const { return summary_; }
  /// advise_at_rest() of the variant.
  const std::vector<Advice>& advice() const { return advice_; }
  /// rejected_poses() of its instruments.
  std::uint64_t rejected() const { return rejected_; }
  /// Columns of forces.csv and their values, column by column.
  const std::vector<std::string>& columns() const { return table_->columns(); }
  const std::vector<std::vector<double>>& data() const { return data_; }
  /// Tables of heat beside the mechanics; null: none.
  const HeatRecorder* heat() const { return heat_.get(); }
  /// One column of forces.csv, probes.csv, temperature.csv or heat.csv by name. @throws std::out_of_range naming it
  const std::vector<double>& column(const std::string& name) const;
  /// Distances of tips at the end, of the probes that name one; none of a run without samples.
  std::vector<TipDistance> tips() const;
  double intensity_max() const { return surface_ ? surface_->intensity_max() : 0.0; }
  /// VariantData of web/src/report_data.ts. @param law_reach  see law_data()
  nlohmann::json json(double law_reach) const;

 private:
  void record_probes(const Sample& sample);
  nlohmann::json events_json() const;
  nlohmann::ordered_json summary_with_tips() const;
  nlohmann::json instruments_json() const;

  Variant variant_;
  RecorderOptions options_;
  GuardedWriting guarded_;
  std::optional<ForceTable> table_;  // from on_built on
  std::vector<LineFile> files_;      // forces.csv, then forces_<name>.csv
  std::unique_ptr<LineFile> event_file_, probe_file_;
  std::vector<RunEvent> events_;
  std::unique_ptr<FrameSeries> frames_;
  std::unique_ptr<ViewFile> view_;
  std::unique_ptr<SurfaceRecorder> surface_;
  std::vector<std::vector<double>> data_;
  std::vector<std::string> names_, kinds_;                      // of the tools and instruments, in the order of the run
  std::vector<std::vector<std::vector<double>>> further_data_;  // columns of each forces_<name>.csv
  std::vector<std::string> probe_columns_;
  std::vector<std::vector<double>> probe_data_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  std::shared_ptr<HeatCoupling> coupling_;
  std::unique_ptr<HeatRecorder> heat_;
  std::atomic<bool>& stop_;
  RunSummary summary_;
  std::vector<Advice> advice_;
  std::uint64_t rejected_ = 0;
};

}  // namespace glisson

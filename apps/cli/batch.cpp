// batch.cpp — see batch.h.
#include "cli/batch.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "cli/progress.h"
#include "cli/side_by_side.h"
#include "program/interrupt.h"
#include "report/summary_json.h"

namespace glisson::app {
namespace {

/// Hands every call to the recorder, to the job's own observer and to the progress.
class Fan : public RunObserver {
 public:
  Fan(VariantRecorder& recorder, RunObserver* also, Progress& progress, std::size_t index)
      : recorder_(recorder), also_(also), progress_(progress), index_(index) {}

  void on_start(const Variant& variant, const Simulation& simulation) override {
    progress_.started(index_);
    recorder_.on_start(variant, simulation);
    if (also_ != nullptr) also_->on_start(variant, simulation);
  }
  void on_built(const BuiltVariant& built) override {
    recorder_.on_built(built);
    if (also_ != nullptr) also_->on_built(built);
  }
  void on_event(const RunEvent& event) override {
    recorder_.on_event(event);
    if (also_ != nullptr) also_->on_event(event);
  }
  void on_sample(const Sample& sample) override {
    recorder_.on_sample(sample);
    if (also_ != nullptr) also_->on_sample(sample);
  }
  void on_frame(const Simulation& simulation) override {
    recorder_.on_frame(simulation);
    if (also_ != nullptr) also_->on_frame(simulation);
  }
  void on_progress(double fraction) override { progress_.advanced(index_, fraction); }
  void on_end(const RunSummary& summary) override {
    recorder_.on_end(summary);
    if (also_ != nullptr) also_->on_end(summary);
    progress_.ended(index_, std::string(word_of(summary.end)));
  }

 private:
  VariantRecorder& recorder_;
  RunObserver* also_;
  Progress& progress_;
  std::size_t index_;
};

/// Steps a variant may need, up to a factor common to all: viscosity shortens the stable step.
double likely_cost(const Variant& variant) {
  const double viscous = 1e3 * variant.tissue.viscosity / variant.tissue.youngs_modulus;
  return run_duration(variant) * (1.0 + viscous);
}

std::vector<std::size_t> longest_first(const std::vector<Job>& jobs) {
  std::vector<std::size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return likely_cost(jobs[a].variant) > likely_cost(jobs[b].variant);
  });
  return order;
}

}  // namespace

void require_runnable(const std::vector<Job>& jobs, const MeshLoader& load) {
  for (const Job& job : jobs) {
    Variant variant = job.variant;
    variant.start = Start::rest;  // the unloaded shape is found once, when the job begins
    build_variant(variant, load);
  }
}

std::vector<std::unique_ptr<VariantRecorder>> run_batch(const std::vector<Job>& jobs, const BatchOptions& options,
                                                        const MeshLoader& load) {
  std::vector<std::unique_ptr<VariantRecorder>> recorders;
  std::vector<std::string> names;
  for (const Job& job : jobs) {
    recorders.push_back(std::make_unique<VariantRecorder>(job.variant, job.recorder, stop_flag()));
    names.push_back(job.name);
  }
  Progress progress(std::move(names), options.threads, Progress::style_for(options.quiet));
  run_side_by_side(longest_first(jobs), options.threads, [&](std::size_t i) {
    Fan observer(*recorders[i], jobs[i].also.get(), progress, i);
    run_variant(jobs[i].variant, load, observer, stop_flag());
  });
  progress.clear();
  for (const auto& recorder : recorders) {
    if (!recorder->error().empty()) throw OutputError(recorder->error());
  }
  return recorders;
}

}  // namespace glisson::app

#include "engine/drag_stage_records.h"

#include <algorithm>

#include "element/drag_stages.h"
#include "engine/stage_holds.h"

namespace glisson::engine {

DragStageRecords::DragStageRecords(int stages, const Submeshes& submeshes, const VertexRecords& records,
                                   const Kernels& kernels)
    : submeshes_(submeshes), records_(records), kernels_(kernels), tau_(drag_stages(stages)) {}

void DragStageRecords::make_room(std::size_t records) {
  const std::size_t n = tau_.size() > 1 ? records : 0;
  changes_.resize(4 * n);
  for (auto* forces : {&elastic_, &viscous_, &sums_}) forces->resize(kForceFloats * n);
}

void DragStageRecords::hold(std::span<const char> components) {
  held_.clear();
  for (std::size_t v = 0; 3 * v < components.size(); ++v) {
    const std::array axes{components[3 * v] != 0, components[3 * v + 1] != 0, components[3 * v + 2] != 0};
    if (axes != std::array{false, false, false}) held_.push_back({submeshes_.record_of_vertex[v], axes});
  }
  std::ranges::sort(held_, {}, &HeldRecord::record);
}

void DragStageRecords::begin(const RecordRun& run, const float* elastic, const float* viscous, const Kick& kick) {
  const std::size_t at = kForceFloats * run.first, floats = kForceFloats * run.size;
  if (viscous != nullptr) {
    std::copy_n(elastic, floats, elastic_.data() + at);
    std::copy_n(viscous, floats, viscous_.data() + at);
  } else {
    std::fill_n(elastic_.data() + at, floats, 0.0F);
    std::copy_n(elastic, floats, viscous_.data() + at);
  }
  run_stage(run, 0, kick, nullptr);
}

void DragStageRecords::run_stage(const RecordRun& run, std::size_t stage, const Kick& kick, const float* force) {
  const std::size_t at = kForceFloats * run.first;
  double* changes = stage + 1 < tau_.size() ? changes_.data() + 4 * run.first : nullptr;
  const double* state = records_.at(run.first);
  const DragStage here{.kick = records_.kick_from(kick, run.first),
                       .tau = tau_[stage],
                       .first = stage == 0,
                       .elastic = elastic_.data() + at,
                       .viscous = viscous_.data() + at,
                       .sum = sums_.data() + at};
  kernels_.drag(state, here, run.size, force, changes);
  if (changes == nullptr) return;
  for (const LocalVertex& w : run.active) {
    if (w.place >= outer_.size()) continue;
    const Vec3d push = outer_[w.place] * (tau_[stage] * state[kStateDoubles * w.local + 3]);
    for (std::size_t axis = 0; axis < 3; ++axis) changes[4 * w.local + axis] += push[axis];
  }
  for (auto held = std::ranges::lower_bound(held_, run.first, {}, &HeldRecord::record);
       held != held_.end() && held->record < run.first + run.size; ++held) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held->axes[axis]) changes[4 * (held->record - run.first) + axis] = 0.0;
    }
  }
}

void DragStageRecords::hold_rows(std::span<const ActiveVertex> active) {
  if (holds_ == nullptr) return;
  const std::span<const std::uint32_t> places = holds_->places();
  const auto change_at = [&](std::uint32_t place) {
    return changes_.data() + 4 * std::size_t{submeshes_.record_of_vertex[active[place].vertex]};
  };
  held_changes_.clear();
  for (const std::uint32_t place : places) held_changes_.push_back(vector_of(change_at(place)));
  holds_->project(held_changes_);
  for (std::size_t k = 0; k < places.size(); ++k) put(held_changes_[k], change_at(places[k]));
}

}  // namespace glisson::engine

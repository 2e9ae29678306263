// submesh_drag.cpp — the viscous force in stages (element/drag_stages.h). With V the force that a stage goes by, beside E, and δ what
// it changes the velocities by,
//
//   V₁ = −C v₋   ─▶   δ_k = τ_k h M⁻¹ (E + V_k)   ─▶   V_{k+1} = V_k − C δ_k   ─▶ … ─▶   viscous force of the step A = Σ τ_k V_k
//
// Where nobody asks for elastic and viscous forces apart, V and A have both in them, and E is 0.
//
//   forces at v₋, as ever ─▶ first stage ─▶ [ narrow δ → viscous stress → forces → stage ] per submesh ─▶ [ sum slots → stage ] per run
//   of the interface ─▶ … ─▶ integrate
#include <algorithm>

#include "element/flush_denormals.h"
#include "engine/stage_holds.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

/// Memory for stages, where there are several and something drags.
void SubmeshBody::make_room_for_stages() {
  const bool any = stages_.size() > 1 && std::any_of(body_.blocks.begin(), body_.blocks.end(),
                                                     [](const TissueBlock& b) { return b.tissue.viscosity > 0.0; });
  stage_changes_.resize(any ? 4 * body_.vertex_count : 0);
  for (auto* forces : {&stage_elastic_, &stage_viscous_, &stage_sums_}) {
    forces->resize(any ? kForceFloats * body_.vertex_count : 0);
  }
}

void SubmeshBody::hold_in_stages(std::span<const char> components) {
  held_.clear();
  for (std::size_t v = 0; 3 * v < components.size(); ++v) {
    const std::array axes{components[3 * v] != 0, components[3 * v + 1] != 0, components[3 * v + 2] != 0};
    if (axes != std::array{false, false, false}) held_.push_back({submeshes_.record_of_vertex[v], axes});
  }
  std::ranges::sort(held_, {}, &HeldRecord::record);
}

/// Viscous forces of a submesh at the velocities' changes, into the scratch.
void SubmeshBody::drag_elements(const Submesh& part, Scratch& scratch) const {
  if (!plans_[part.block].drags || part.local_vertices() == 0) return;
  const bool by_edges = part.edges.count > 0;
  if (by_edges) std::fill_n(scratch.states.data(), part.local_vertices() * kStateFloats, 0.0F);
  const double* changes = stage_changes_.data();
  const double* own = changes + 4 * part.first_interior;
  const double* origin = part.interior_count > 0 ? own : changes + 4 * std::size_t{part.shared[0]};
  kernels_.narrow_vectors(own, nullptr, origin, part.interior_count, scratch.states.data());
  kernels_.narrow_vectors(changes, part.shared.data(), origin, part.shared.size(),
                          scratch.states.data() + part.interior_count * kStateFloats);
  const LaneTissue& tissue = plans_[part.block].tissue;
  if (by_edges) {
    kernels_.edges_merged({.states = scratch.states.data(),
                           .index = part.edges.index.data(),
                           .tensor = part.edges.tensor.data(),
                           .batches = part.edges.count,
                           .elastic = scratch.viscous.data(),
                           .tissue = {.lambda = tissue.viscous_lambda, .mu = tissue.viscous_mu}});
    return;
  }
  const Elements elements = elements_of(part, scratch);
  for (std::size_t b = 0; b < part.chains.count; b += kBlockBatches) {
    const std::size_t batches = std::min(kBlockBatches, part.chains.count - b);
    kernels_.gather_drag(elements, b, batches, scratch.block);
    kernels_.push_viscous(elements, b, batches, scratch.block);
  }
}

/// A stage of a run of records. @param force  what the last one has added to V
void SubmeshBody::run_stage(const RecordRun& run, std::size_t stage, const Step& step, const float* force) {
  const std::size_t at = kForceFloats * run.first;
  double* changes = stage + 1 < stages_.size() ? stage_changes_.data() + 4 * run.first : nullptr;
  const double* state = records_.at(run.first);
  const DragStage here{.kick = records_.kick_from(step.kick, run.first),
                       .tau = stages_[stage],
                       .first = stage == 0,
                       .elastic = stage_elastic_.data() + at,
                       .viscous = stage_viscous_.data() + at,
                       .sum = stage_sums_.data() + at};
  kernels_.drag(state, here, run.size, force, changes);
  if (changes == nullptr) return;
  for (const LocalVertex& w : run.active) {
    if (w.place >= outer_.size()) continue;
    const Vec3d push = outer_[w.place] * (stages_[stage] * state[kStateDoubles * w.local + 3]);
    for (std::size_t axis = 0; axis < 3; ++axis) changes[4 * w.local + axis] += push[axis];
  }
  for (auto held = std::ranges::lower_bound(held_, run.first, {}, &HeldRecord::record);
       held != held_.end() && held->record < run.first + run.size; ++held) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held->axes[axis]) changes[4 * (held->record - run.first) + axis] = 0.0;
    }
  }
}

/// The first stage, from the forces at v₋. @param viscous  null: `elastic` has both
void SubmeshBody::begin_stages(const RecordRun& run, const float* elastic, const float* viscous, const Step& step) {
  const std::size_t at = kForceFloats * run.first, floats = kForceFloats * run.size;
  if (viscous != nullptr) {
    std::copy_n(elastic, floats, stage_elastic_.data() + at);
    std::copy_n(viscous, floats, stage_viscous_.data() + at);
  } else {
    std::fill_n(stage_elastic_.data() + at, floats, 0.0F);
    std::copy_n(elastic, floats, stage_viscous_.data() + at);
  }
  run_stage(run, 0, step, nullptr);
}

/// Hands out the forces of all stages and moves the vertices that are not active.
void SubmeshBody::end_stages(const RecordRun& run, bool split, const Step& step, VertexWork& work) {
  float* elastic = stage_elastic_.data() + kForceFloats * run.first;
  float* viscous = stage_sums_.data() + kForceFloats * run.first;
  if (!split) std::swap(elastic, viscous);
  active_.take_forces(run, elastic, split ? viscous : nullptr);
  if (split && !step.accounted) {
    for (std::size_t i = 0; i < kForceFloats * run.size; ++i) elastic[i] += viscous[i];
  }
  integrate(run, elastic, viscous, step, work);
}

/// What the last changes of the velocities add to the viscous forces: of interior vertices in the scratch, of others in the slots.
void SubmeshBody::drag_submesh(const Submesh& part, Scratch& scratch) {
  std::fill_n(scratch.viscous.data(), force_floats(part.local_vertices()), 0.0F);
  drag_elements(part, scratch);
  std::copy_n(scratch.viscous.data() + part.interior_count * kForceFloats, part.shared.size() * kForceFloats,
              slots_viscous_.data() + part.first_slot * kForceFloats);
}

/// Takes what instruments hold from the changes of the last stage.
void SubmeshBody::hold_rows() {
  if (holds_ == nullptr) return;
  const std::span<const std::uint32_t> places = holds_->places();
  const auto change_at = [&](std::uint32_t place) {
    return stage_changes_.data() + 4 * std::size_t{record_of(active_.active()[place].vertex)};
  };
  held_changes_.clear();
  for (const std::uint32_t place : places) {
    const double* change = change_at(place);
    held_changes_.push_back({change[0], change[1], change[2]});
  }
  holds_->project(held_changes_);
  for (std::size_t k = 0; k < places.size(); ++k) put(held_changes_[k], change_at(places[k]));
}

/// All stages but the first, and the end of the step. Interior changes are read by their own submesh alone, and those of the
/// interface are written when all submeshes are done.
void SubmeshBody::run_drag_stages(const Step& step) {
  const Interface& shared = submeshes_.interface;
  for (std::size_t stage = 1; stage < stages_.size(); ++stage) {
    const bool last = stage + 1 == stages_.size();
    hold_rows();
    pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t thread) {
      const FlushDenormals flush;
      const RecordRun run = active_.interior(s);
      drag_submesh(submeshes_.parts[s], *scratch_[thread]);
      run_stage(run, stage, step, scratch_[thread]->viscous.data());
      if (last) end_stages(run, splits(s, step.accounted), step, found_[s].work);
    });
    pool_.run(active_.chunks(), [&](std::size_t chunk, std::size_t thread) {
      const FlushDenormals flush;
      const RecordRun run = active_.interface(chunk);
      float* force = scratch_[thread]->viscous.data();
      kernels_.sum_slots(slots_viscous_.data(), shared.slot_begin.data() + chunk * kInterfaceChunk, shared.slots.data(),
                         run.size, force);
      run_stage(run, stage, step, force);
      if (last) end_stages(run, any_split_, step, interface_found_[chunk].work);
    });
  }
}

}  // namespace glisson::engine

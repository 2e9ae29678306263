// submesh_step.cpp — one step of a body of submeshes: the tasks drawn in submesh_body.h.
#include <algorithm>
#include <utility>

#include "element/flush_denormals.h"
#include "engine/submesh_body.h"

namespace glisson::engine {

/// Whether elastic and viscous forces of a submesh are kept apart.
bool SubmeshBody::splits(std::size_t s, bool accounted) const {
  return forces_.plan(submeshes_.parts[s].block).viscous && (accounted || active_.asks_apart(s));
}

void SubmeshBody::spread_volume(std::size_t s, SubmeshScratch& scratch) {
  const Submesh& part = submeshes_.parts[s];
  if (!volumes_.shares(part)) return;
  forces_.spread_volume_changes(part, scratch, volumes_.sums(s));
  volumes_.spread(s);
}

void SubmeshBody::fill_slots(const Submesh& part, bool split, const SubmeshScratch& scratch) {
  const std::size_t from = part.interior_count * kForceFloats, n = part.shared.size() * kForceFloats;
  std::copy_n(scratch.elastic.data() + from, n, slots_elastic_.data() + part.first_slot * kForceFloats);
  if (!any_split_) return;
  float* viscous = slots_viscous_.data() + part.first_slot * kForceFloats;
  if (split) {
    std::copy_n(scratch.viscous.data() + from, n, viscous);
  } else {
    std::fill_n(viscous, n, 0.0F);
  }
}

/// Kick and drift of the vertices between those active. @param viscous  what is to be booked apart from `elastic` where the step is
/// accounted; else `elastic` is the whole force. Null: there is none
void SubmeshBody::integrate(const RecordRun& run, const float* elastic, const float* viscous, const Step& step,
                            VertexWork& work) {
  std::size_t from = 0;
  const auto run_to = [&](std::size_t end) {
    double* state = records_.at(run.first + from);
    const float* f = elastic + from * kForceFloats;
    const Kick kick = records_.kick_from(step.kick, run.first + from);
    if (step.accounted) {
      const float* beside = viscous != nullptr ? viscous + from * kForceFloats : nullptr;
      kernels_.integrate_accounted(state, f, beside, end - from, kick, work);
    } else {
      kernels_.integrate(state, f, end - from, kick);
    }
  };
  for (const LocalVertex& active : run.active) {
    run_to(active.local);
    from = active.local + 1;
  }
  run_to(run.size);
}

void SubmeshBody::run_submesh(std::size_t s, const Step& step, SubmeshScratch& scratch) {
  const FlushDenormals flush;
  const Submesh& part = submeshes_.parts[s];
  const std::size_t floats = force_floats(part.local_vertices());
  const bool split = splits(s, step.accounted);
  float *elastic = scratch.elastic.data(), *viscous = scratch.viscous.data();
  work_[s] = {};
  forces_.evaluate(s, split, volumes_.shares(part) ? volumes_.join(s) : nullptr, scratch, found_[s]);
  if (!found_[s].finite) return;
  fill_slots(part, split, scratch);
  const RecordRun run = active_.interior(s);
  if (!split) viscous = nullptr;
  if (in_stages()) return stages_.begin(run, elastic, viscous, step.kick);
  active_.take_forces(run, elastic, viscous);
  if (split && !step.accounted) kernels_.add(elastic, viscous, floats);
  integrate(run, elastic, viscous, step, work_[s]);
}

void SubmeshBody::run_interface(std::size_t chunk, const Step& step, SubmeshScratch& scratch) {
  const FlushDenormals flush;
  const Interface& shared = submeshes_.interface;
  const RecordRun run = active_.interface(chunk);
  const std::uint32_t* slot_begin = shared.slot_begin.data() + chunk * kInterfaceChunk;
  float *elastic = scratch.elastic.data(), *viscous = scratch.viscous.data();
  kernels_.sum_slots(slots_elastic_.data(), slot_begin, shared.slots.data(), run.size, elastic);
  if (any_split_) {
    kernels_.sum_slots(slots_viscous_.data(), slot_begin, shared.slots.data(), run.size, viscous);
  } else {
    viscous = nullptr;
  }
  VertexWork& work = work_of_chunk(chunk);
  work = {};
  if (in_stages()) return stages_.begin(run, elastic, viscous, step.kick);
  active_.take_forces(run, elastic, viscous);
  if (!step.accounted && any_split_) kernels_.add(elastic, viscous, force_floats(run.size));
  integrate(run, elastic, viscous, step, work);
}

/// Hands out the forces of all stages and moves the vertices that are not active.
void SubmeshBody::end_stages(const RecordRun& run, bool split, const Step& step, VertexWork& work) {
  float *elastic = split ? stages_.elastic(run.first) : stages_.sums(run.first),
        *viscous = split ? stages_.sums(run.first) : nullptr;
  active_.take_forces(run, elastic, viscous);
  if (split && !step.accounted) {
    for (std::size_t i = 0; i < kForceFloats * run.size; ++i) elastic[i] += viscous[i];
  }
  integrate(run, elastic, viscous, step, work);
}

/// All stages but the first, and the end of the step. Interior changes are read by their own submesh alone, and those of the
/// interface are written when all submeshes are done.
void SubmeshBody::run_drag_stages(const Step& step) {
  const Interface& shared = submeshes_.interface;
  for (std::size_t stage = 1; stage < stages_.count(); ++stage) {
    const bool last = stage + 1 == stages_.count();
    stages_.hold_rows(active_.active());
    pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t thread) {
      const FlushDenormals flush;
      const Submesh& part = submeshes_.parts[s];
      const RecordRun run = active_.interior(s);
      forces_.drag(part, stages_.changes(), *scratch_[thread]);
      const float* force = scratch_[thread]->viscous.data();
      std::copy_n(force + part.interior_count * kForceFloats, part.shared.size() * kForceFloats,
                  slots_viscous_.data() + part.first_slot * kForceFloats);
      stages_.run_stage(run, stage, step.kick, force);
      if (last) end_stages(run, splits(s, step.accounted), step, work_[s]);
    });
    pool_.run(active_.chunks(), [&](std::size_t chunk, std::size_t thread) {
      const FlushDenormals flush;
      const RecordRun run = active_.interface(chunk);
      float* force = scratch_[thread]->viscous.data();
      kernels_.sum_slots(slots_viscous_.data(), shared.slot_begin.data() + chunk * kInterfaceChunk, shared.slots.data(),
                         run.size, force);
      stages_.run_stage(run, stage, step.kick, force);
      if (last) end_stages(run, any_split_, step, work_of_chunk(chunk));
    });
  }
}

/// Adds up what the tasks found, in their order.
void SubmeshBody::gather_findings(bool accounted) {
  advance_.finite = true;
  advance_.inverted.clear(), advance_.stiff.clear();
  advance_.stiffening.assign(body_.blocks.size(), 0.0);
  advance_.work = {};
  const auto book = [&](const VertexWork& w) {
    KickWork& sum = advance_.work;
    sum.before.elastic += w.elastic_before, sum.after.elastic += w.elastic_after;
    sum.before.viscous += w.viscous_before, sum.after.viscous += w.viscous_after;
    sum.before.damping += w.damping_before, sum.after.damping += w.damping_after;
    sum.before.loads += w.loads_before, sum.after.loads += w.loads_after;
    sum.kinetic += w.kinetic;
  };
  for (std::size_t s = 0; s < found_.size(); ++s) {
    const ElementFindings& found = found_[s];
    advance_.finite = advance_.finite && found.finite;
    advance_.inverted.insert(advance_.inverted.end(), found.inverted.begin(), found.inverted.end());
    double& r = advance_.stiffening[submeshes_.parts[s].block];
    r = std::max(r, found.stiffening);
    advance_.stiff.insert(advance_.stiff.end(), found.stiff.begin(), found.stiff.end());
  }
  if (accounted) std::for_each(work_.begin(), work_.end(), book);
  std::sort(advance_.inverted.begin(), advance_.inverted.end());
}

/// Ends a step of adaptive precision: with the next one some submeshes go by their linear law, others by their own again.
void SubmeshBody::change_laws(double h) {
  PrecisionChoice& precision = forces_.precision();
  for (Submesh& part : submeshes_.parts) part.linear.since += h;
  const std::vector<std::size_t>& changed = precision.end_step();
  pool_.run(changed.size(), [&](std::size_t i, std::size_t) {
    Submesh& part = submeshes_.parts[changed[i]];
    forces_.prepare_linear(part);
    if (part.linear.alone()) memory_.enter_linear(part, h);
    if (!part.linear.wanted) memory_.leave_linear(part, h);
  });
  advance_.brought_in = precision.brought_in() + std::exchange(brought_in_, 0.0);
}

const Advance& SubmeshBody::advance(double h, const Vec3d& gravity, bool accounted) {
  records_.set_step(h);
  forces_.begin_step(h, steps_, memory_.since(), accounted);
  any_split_ = false;
  for (std::size_t s = 0; s < submeshes_.parts.size(); ++s) any_split_ = any_split_ || splits(s, accounted);
  if (volumes_.any()) {
    pool_.run(submeshes_.parts.size(), [&](std::size_t s, std::size_t thread) { spread_volume(s, *scratch_[thread]); });
  }
  const Step step{{h, {gravity.x, gravity.y, gravity.z, 0.0}}, accounted};
  pool_.run(submeshes_.parts.size(),
            [&](std::size_t s, std::size_t thread) { run_submesh(s, step, *scratch_[thread]); });
  const bool finite = std::all_of(found_.begin(), found_.end(), [](const ElementFindings& f) { return f.finite; });
  if (finite) {
    pool_.run(active_.chunks(), [&](std::size_t c, std::size_t thread) { run_interface(c, step, *scratch_[thread]); });
    if (in_stages()) run_drag_stages(step);
  }
  ++steps_;
  if (h > 0.0) memory_.passed(h);
  gather_findings(accounted);
  advance_.brought_in = 0.0;
  if (finite && h > 0.0 && forces_.precision().on()) change_laws(h);
  return advance_;
}

}  // namespace glisson::engine

// drag_stage_records.h — the viscous force in stages (element/drag_stages.h), a record for each of the state. With V the force that
// a stage goes by, beside E, and δ what it changes the velocities by,
//
//   V₁ = −C v₋   ─▶   δ_k = τ_k h M⁻¹ (E + V_k)   ─▶   V_{k+1} = V_k − C δ_k   ─▶ … ─▶   viscous force of the step A = Σ τ_k V_k
//
// Where nobody asks for elastic and viscous forces apart, V and A have both in them, and E is 0.
//
//   forces at v₋, as ever ─▶ first stage ─▶ [ narrow δ → viscous stress → forces → stage ] per submesh ─▶ [ sum slots → stage ] per run
//   of the interface ─▶ … ─▶ integrate
#pragma once

#include "engine/active_vertices.h"
#include "engine/kernels/kernels.h"

namespace glisson::engine {

class StageHolds;

class DragStageRecords {
 public:
  /// @param stages  SimulationOptions::drag_stages @param submeshes, @param records, @param kernels  must outlive this
  DragStageRecords(int stages, const Submeshes& submeshes, const VertexRecords& records, const Kernels& kernels);

  /// Memory for so many records; none, where there is one stage.
  void make_room(std::size_t records);
  /// Whether the viscous force is taken in several stages a step.
  bool in_use() const { return !sums_.empty(); }
  std::size_t count() const { return tau_.size(); }

  /// MovingBody::hold_in_stages, push_in_stages, project_stages
  void hold(std::span<const char> components);
  void push(std::span<const Vec3d> outer) { outer_.assign(outer.begin(), outer.end()); }
  void project(StageHolds* holds) { holds_ = holds; }

  /// The first stage, from the forces at v₋. @param viscous  null: `elastic` has both
  void begin(const RecordRun& run, const float* elastic, const float* viscous, const Kick& kick);
  /// A stage. @param force  what the last one has added to V
  void run_stage(const RecordRun& run, std::size_t stage, const Kick& kick, const float* force);
  /// Takes what instruments hold from the changes of the last stage.
  void hold_rows(std::span<const ActiveVertex> active);

  /// δ of the last stage, four numbers a record [m/s].
  const double* changes() const { return changes_.data(); }
  /// E and, after the last stage, A of the records from one on [N].
  float* elastic(std::size_t record) { return elastic_.data() + kForceFloats * record; }
  float* sums(std::size_t record) { return sums_.data() + kForceFloats * record; }

 private:
  /// A record whose velocity stages leave as it is.
  struct HeldRecord {
    std::uint32_t record;
    std::array<bool, 3> axes;
  };

  const Submeshes& submeshes_;
  const VertexRecords& records_;
  const Kernels& kernels_;
  std::vector<double> tau_;                     ///< shares of a step
  LaneVector<double> changes_;                  ///< δ
  LaneVector<float> elastic_, viscous_, sums_;  ///< E, V, A
  std::vector<HeldRecord> held_;                ///< ascending
  std::vector<Vec3d> outer_;                    ///< on each active vertex, in the last step [N]
  StageHolds* holds_ = nullptr;
  std::vector<Vec3d> held_changes_;
};

}  // namespace glisson::engine

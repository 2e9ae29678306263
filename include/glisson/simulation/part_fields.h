// part_fields.h — fields of some tets at an instant, computed apart from the simulation while it goes on: by another thread.
//
//   thread that steps:  u = displacement(), v = velocity(), BranchRecord(simulation) ──┐   copies
//   another:            PartFields(mesh, tissues, tets) ───────────────────────────────┴─▶ fields(u, v, record)
//
// A picture of a surface needs the stress of the tets there, some times a second, and may take longer for it than a step takes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "glisson/material/tissue.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/tet_fields.h"

namespace glisson {

class Simulation;

/// What the stress of a simulation follows from besides displacement, velocity and tissues: what Maxwell branches hold, and where
/// a linear law acts (Precision::adaptive). Copies share it, and any thread may read it.
class BranchRecord {
 public:
  /// All branches have relaxed, or there are none.
  BranchRecord() = default;
  /// Of the present state. Cost: a copy of the branches' stresses, 56 bytes a tet and branch; nothing where there are none.
  explicit BranchRecord(const Simulation& simulation);

 private:
  friend class PartFields;
  struct Copy;
  std::shared_ptr<const Copy> copy_;
};

/// Some tets of a body. Its functions may be called by any thread, one at a time.
class PartFields {
 public:
  /// @param mesh     at rest: Simulation::mesh(); or present_mesh() of a simulation without removed tets
  /// @param tissues  by region number, those of the body now
  /// @param tets     of the mesh; none twice
  /// @throws std::invalid_argument naming a tet that is not there or given twice, the region without a tissue, or what is wrong
  /// with mesh or tissue
  /// Cost: a pass over the mesh, and some µs a tet.
  PartFields(const TetMesh& mesh, const std::map<int, Tissue>& tissues, std::vector<std::uint32_t> tets);
  ~PartFields();
  PartFields(PartFields&&) noexcept;
  PartFields& operator=(PartFields&&) noexcept;

  /// Fields of the tets, in their order: those that Simulation::tet_fields() has.
  /// @param displacement  per vertex of the mesh [m]; vertices that came later may follow
  /// @param velocity      likewise [m/s]
  /// @param record        of the same instant
  /// @throws std::invalid_argument for less than one displacement or velocity a vertex
  /// Cost: that of the tets; where tissues share volume changes (VolumeChange::average_nodal), of those that touch them, too.
  TetFields fields(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity,
                   const BranchRecord& record = {}) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace glisson

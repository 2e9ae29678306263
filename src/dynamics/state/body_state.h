// body_state.h — what every integrator advances: a body, what holds and loads it, and where in time it is.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/state/constraints.h"
#include "dynamics/state/loads.h"
#include "element/body_change.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// What a body state has that only changes of body and tissues alter: to go back to.
struct BodyVersion {
  Body body;
  MassScaling mass_scaling;
  std::vector<double> gamma;
  Constraints constraints;
  Loads loads;
  std::vector<std::uint32_t> copies;
  std::uint64_t changes = 0;
  std::optional<std::vector<Triangle>>
      closed;  ///< faces that are split and closed still; none: nothing was changed yet
};

/// Copies share what follows changes: they are for going back, one lives at a time.
struct BodyState {
  /// @throws std::invalid_argument as Simulation's constructor
  BodyState(Body body, const SimulationOptions& options);

  SimulationOptions options;
  Body body;
  MassScaling mass_scaling;
  std::vector<double> gamma;  ///< nodal damping [kg/s]
  Constraints constraints;
  std::vector<std::vector<Vec3d>> base;  ///< per constraint: displacement its motion counts from [m]; empty: not yet
  Loads loads;
  std::vector<std::uint32_t> copies;  ///< the last vertices are copies of these, all splits together
  std::uint64_t changes = 0;          ///< of mesh and tissues so far
  std::uint64_t editions = 0;         ///< the same, but going back counts too: never the same for two bodies
  double time = 0.0;                  ///< [s]
  std::uint64_t steps = 0;

  /// Made when something changes, or when it is first asked for. Cost then: as BodyChanger.
  BodyChanger& changer();
  bool is_removed(std::uint32_t mesh_tet) const { return changer_ != nullptr && changer_->is_removed(mesh_tet); }
  void note_change() { ++changes, ++editions; }
  /// Follows masses that have changed at some vertices, new ones among them, or at all.
  void damp(std::span<const std::uint32_t> vertices);
  void masses_changed();

  Vec3d gravity_at(double time) const;
  /// Forces of loads at time t [N], one per vertex. @param u  displacements; only read where Loads::depends_on_state()
  std::span<const Vec3d> loads_at(double t, std::span<const Vec3d> u) { return loads.at(t, body, u); }
  /// Damping of a vertex with its dashpots, along x, y, z [kg/s].
  Vec3d damping(std::size_t vertex) const {
    const double g = gamma[vertex];
    return Vec3d{g, g, g} + loads.dashpot(vertex);
  }
  /// The same under statics, which has no nodal damping.
  Vec3d damping(std::size_t vertex, bool statics) const { return statics ? loads.dashpot(vertex) : damping(vertex); }
  bool holds(std::size_t constraint) const { return !base[constraint].empty(); }
  /// Per component: 1 where a constraint that holds by now has it, or where the vertex is in no tet.
  std::vector<char> held_components() const;

  BodyVersion version() const;
  void go_to(const BodyVersion& version);

  /// The body is written as far as it is not as it was made; what holds and loads it by the vertices that came with splits.
  /// @throws std::runtime_error where what is read did not come from the same body, or has less changes than there are here
  void archive(Archive& ar);

 private:
  double damping_of(std::size_t vertex) const;  ///< without dashpots [kg/s]
  void archive_changes(Archive& ar, bool as_here);
  void archive_tissues(Archive& ar);
  void check_corners(const Archive& ar, const std::vector<Tet>& before) const;
  void measure(const Archive& ar, const std::vector<std::uint32_t>& gone);

  std::shared_ptr<BodyChanger> changer_;  ///< of this body; shared with what the body was before something was read
};

}  // namespace glisson

// simulation_parts.h — the inside of a simulation, for what the library itself builds upon it.
#pragma once

#include "dynamics/schemes/scheme.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

struct SimulationParts {
  using Inside = Simulation::Impl;  ///< stays where it is while the Simulation is moved
  static Inside& inside(Simulation& simulation) { return simulation.inside(); }
  static Scheme& scheme(Inside& inside);
  static Scheme& scheme(Simulation& simulation) { return scheme(inside(simulation)); }
  static const Scheme& scheme(const Simulation& simulation);
  /// For reading it as long as the simulation lives.
  static std::weak_ptr<const Scheme> weak_scheme(const Simulation& simulation);
  static const TetMesh& mesh(const Inside& inside);
  /// Simulation::fix or drive, with courses that other constraints may share. @throws what they throw, and Contradiction
  static ConstraintId add_constraint(Simulation& simulation, Constraint constraint);
  /// @param name  of what would change something @param between_steps  whether Interaction::between_steps may call it
  /// @throws std::logic_error inside a step
  static void refuse_inside_step(const Inside& inside, const char* name, bool between_steps = true);
  static SplitReport split_faces(Inside& inside, std::span<const Triangle> faces, std::span<const VertexMove> moves);
};

}  // namespace glisson

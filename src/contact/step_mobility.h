// step_mobility.h — how far impulses within a long step move the vertices at its end: columns of the inverse of the step's matrix.
//
// In a short step an impulse moves its own vertex alone, by InteractionStep::mobility.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "glisson/simulation/interaction.h"

namespace glisson {

class StepMobility {
 public:
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  using Mean = std::vector<VertexWeight>;
  virtual ~StepMobility() = default;
  /// Displacements of all components of the body by a unit force on each mean along each axis [m/N]. Cost: three solves for each mean
  /// that this factor was not asked for before. The columns stay where they are as long as the factor.
  virtual std::vector<const Column*> columns(std::span<const Mean> means) = 0;
  /// Whether the work is to end: the program has asked for it.
  virtual bool stops() = 0;
  /// Sets the velocities of the active vertices to those with these impulses alone. @param impulses  per place [N s]
  virtual void set_velocities(std::span<const Vec3d> impulses, std::span<ActiveVertex> vertices) = 0;
};

}  // namespace glisson

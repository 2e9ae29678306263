// stiff_masses.h — the mass that variable mass scaling gives to vertices, and what it does to the motion.
//
// Velocities stay where mass comes and goes, and kinetic energy changes by ½ Δm v², as long as what comes is paid for: by what has
// gone, and a little of the work of tools and loads. Where it is not, velocities fall to what leaves the energy as it is: mass that
// comes where tissue swings through, and goes where it turns, would feed the swing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/state/active_kick.h"
#include "dynamics/state/body_state.h"
#include "dynamics/step/mass_levels.h"
#include "engine/moving_body.h"
#include "glisson/archive.h"

namespace glisson {

class StiffMasses {
 public:
  /// @param state  must outlive this
  explicit StiffMasses(BodyState& state) : state_(state) {}

  /// Gives vertices this mass beside their own, and all others none. @param wanted  ascending
  /// @return the kinetic energy that has come with it [J]
  double take(std::span<const VertexMass> wanted, MovingBody& moving);
  /// @param outer  what acted on the body in the last step
  /// @return Σ Δm |a| over the largest Σ |F| of late [-]
  double weigh(const ActiveKick::Outer& outer, const MovingBody& moving);
  void step_made(double h) { last_step_ = h; }
  /// A state was set from outside.
  void state_set() { largest_force_ = last_step_ = energy_ = 0.0; }
  void archive(Archive& ar, MovingBody& moving);

 private:
  double change(MovingBody& moving);

  BodyState& state_;
  std::vector<std::uint32_t> heavy_;            ///< vertices with such mass, ascending
  std::vector<Vec3d> velocities_;               ///< theirs, when they were weighed last
  std::vector<Vec3d> now_;                      ///< of the present weigh() or take()
  std::vector<std::uint32_t> known_, changed_;  ///< of the present take()
  std::vector<double> changes_;                 ///< of the mass of those changed [kg]
  double largest_force_ = 0.0;                  ///< [N]
  double last_step_ = 0.0;                      ///< [s]
  double energy_ = 0.0;                         ///< that mass may bring [J]
};

}  // namespace glisson

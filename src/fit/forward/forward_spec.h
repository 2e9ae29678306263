// forward_spec.h — how a fit computes forces, and of which specimen: what [forward] and [specimen] of a FIT.toml say.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "glisson/simulation/integrator.h"
#include "lab/grip.h"

namespace glisson::fit {

/// Which forward model a fit takes.
enum class ForwardKind {
  automatic,  ///< the cheapest that stays within `tolerance` of the scene (forward/ladder.h)
  uniaxial,   ///< a homogeneous specimen between smooth plates
  scene       ///< the scene as it is written
};

struct ForwardSpec {
  ForwardKind kind = ForwardKind::automatic;
  std::optional<Integrator> integrator;  ///< in place of the scene's; then it is the one to compare with
  double tolerance = 0.3;  ///< largest rms difference from the scene, over the noise of the curve [-], > 0
  int points = 3;          ///< places beside the start where models are compared, 0 … 100
  std::string tool;        ///< the tool or instrument that follows the curves; empty: the only one
  std::string force;       ///< whose force was measured; empty: that tool's
  double approach = 0.0;   ///< way of an instrument in the scene before it touches the tissue [m], ≥ 0
};

enum class SpecimenShape { cylinder, block, point, layer };

/// A specimen of a laboratory, in place of a scene.
struct SpecimenSpec {
  SpecimenShape shape = SpecimenShape::cylinder;
  lab::Faces faces = lab::Faces::smooth;            ///< of a cylinder
  lab::Grip grip;                                   ///< of its faces
  double diameter = 0.05;                           ///< of a cylinder [m], > 0
  double width = 0.02, depth = 0.02;                ///< of a block [m], > 0
  double height = 0.03;                             ///< [m], > 0
  std::optional<double> thickness, layer_diameter;  ///< of a layer [m], > 0; none: a half-space, wide
  bool bonded_floor = true;                         ///< of a layer
  std::array<int, 3> cells{1, 1, 2};                ///< of the body that it is compared with
};

}  // namespace glisson::fit

// section_forward.h — [forward] and [specimen] of a FIT.toml: how forces are computed.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "fit/forward/barrel_model.h"
#include "fit/forward/specimen_model.h"
#include "glisson/indentation.h"
#include "glisson/simulation/simulation.h"
#include "scene/parse/schema.h"

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

const scene::SectionSpec& forward_section();   ///< fills ForwardSpec
const scene::SectionSpec& specimen_section();  ///< fills SpecimenSpec

/// None where the specimen is no layer.
std::optional<Layer> layer_of(const SpecimenSpec& spec);
/// A point has an area of 1 m² and a height of 1 m: its forces are stresses, its displacements strains. So has a layer, whose
/// forces and displacements stay what they are.
Specimen specimen_of(const SpecimenSpec& spec);
/// None where the plates are smooth.
std::optional<Plates> plates_of(const SpecimenSpec& spec);

/// A scene of the specimen without a [tissue]: a block with the area of its face, its floor and two sides held across
/// themselves, its top pressed by a tool called "plate", sideways free. The state is the same all over, and a cylinder's
/// force that of a block of its area.
std::string specimen_scene(const SpecimenSpec& spec);

}  // namespace glisson::fit

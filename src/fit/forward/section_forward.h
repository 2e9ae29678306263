// section_forward.h — the sections [forward] and [specimen] of a FIT.toml, and the models that they ask for.
#pragma once

#include <optional>
#include <string>

#include "fit/forward/barrel_model.h"
#include "fit/forward/forward_spec.h"
#include "fit/forward/specimen_model.h"
#include "glisson/indentation.h"
#include "scene/parse/schema.h"

namespace glisson::fit {

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

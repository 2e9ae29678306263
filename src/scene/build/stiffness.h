// stiffness.h — tissues of tets by images of elastography: a region becomes several, each with a modulus of its own.
#pragma once

#include <map>

#include "glisson/scene/variant.h"

namespace glisson::scene {

/// Splits the regions that images of stiffness are of into bands of like modulus, named "liver 5.01 kPa".
/// @throws std::invalid_argument, ImageError  naming the image: it cannot be read, no tet has a value in it, no such region
void split_by_stiffness(const Variant& variant, TetMesh& mesh);

/// Gives the bands of a mesh that was split the tissues of their regions, with modulus and viscosity of the images.
void set_band_tissues(const Variant& variant, const TetMesh& mesh, std::map<int, Tissue>& tissues);

}  // namespace glisson::scene

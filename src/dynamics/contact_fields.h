// contact_fields.h — nodal forces of contact over nodal areas of the present surface.
#pragma once

#include <memory>
#include <span>

#include "glisson/mesh.h"
#include "glisson/simulation/contact_fields.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

/// @param present  the mesh without removed tets @param positions  of its vertices [m]
/// @return empty where no interaction presses on the surface
ContactFields contact_fields(const TetMesh& present, std::span<const Vec3d> positions,
                             std::span<const std::shared_ptr<Interaction>> interactions);

}  // namespace glisson

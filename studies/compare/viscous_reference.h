// viscous_reference.h — the reference of a comparison whose scene's tissue is viscous: the tissue itself in motion, not its equilibrium.
#pragma once

#include "compare/comparison.h"

namespace glisson::app {

/// The scene's own tissue in double precision, with inertia and all of its viscosity: by implicit steps so short that twice as long ones
/// change the forces on the coarsest mesh by less than 0.3 % of the largest, or by explicit ones where they are cheaper. The words say which,
/// and by how much the others differ. Each station's
/// force is extrapolated to the limit of fine meshes for itself: tissue that has relaxed is less compressible, and coarse meshes are stiffer.
/// @param problems  the same experiment from the coarsest mesh to the finest
/// @param order  the highest that the body's edges allow (convergence_order.h)
/// @throws SceneError where no balance of forces is found
Reference make_viscous_reference(const std::vector<models::Problem>& problems, double order,
                                 const std::atomic<bool>& stop, const std::function<void(const std::string&)>& say);

}  // namespace glisson::app

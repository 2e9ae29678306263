// smooth_vertex.h — moves one vertex to where the worst of its tets is best.
#pragma once

#include "mesh/lattice/workspace.h"

namespace glisson::lattice {

/// Climbs the least quality of the tets at a vertex, inside a region freely, else along its surfaces: the direction is the
/// shortest vector in the convex hull of the gradients of the worst tets.             [FreitagOllivierGooch1997]
/// A vertex where three surfaces meet stays.
/// @param loose  the vertex may leave its surfaces by this share of the edge: for tets that nothing else helps; 0: it may not
/// @return whether it moved; the least quality of its tets has then grown
bool smooth_vertex(Workspace& w, std::uint32_t vertex, double loose = 0.0);

/// Moves a vertex to the middle of its neighbours (on a surface: of those on it), as far as no tet falls below `floor`.
/// @return whether it moved
bool centre_vertex(Workspace& w, std::uint32_t vertex, double floor);

}  // namespace glisson::lattice

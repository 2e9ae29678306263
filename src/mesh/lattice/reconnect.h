// reconnect.h — other tets in the place of those around an edge or at a face.
#pragma once

#include "mesh/lattice/workspace.h"

namespace glisson::lattice {

/// Takes an edge out: the polygon around it, or the two on both sides of an interface, is divided into triangles, each joined
/// to both ends of the edge. The division with the best worst tet is found by dynamic programming.
///                                                    [FreitagOllivierGooch1997]
/// @return whether the edge went; the least quality of the tets there has then grown
bool remove_edge(Workspace& w, std::uint32_t u, std::uint32_t v);

/// Three tets about a new edge in the place of two with a common face inside a region.
/// @return whether that was done; the least quality of the tets there has then grown
bool remove_face(Workspace& w, std::uint32_t tet, std::size_t corner);

}  // namespace glisson::lattice

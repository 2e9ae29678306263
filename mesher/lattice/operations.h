// operations.h — changes of a labelled mesh that make its tets better: each is tried at one place and kept where it helps.
//
//   smooth, centre   a vertex moves          relabel       a thin tet changes sides
//   remove           others take the place   contract      a vertex is drawn into a neighbour
//   of the tets at an edge or a face         keep_volume   surfaces bulge to what they replace
#pragma once

#include "mesher/lattice/workspace.h"

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

/// Takes an edge out: the polygon around it, or the two on both sides of an interface, is divided into triangles, each joined
/// to both ends of the edge. The division with the best worst tet is found by dynamic programming.
///                                                    [FreitagOllivierGooch1997]
/// @return whether the edge went; the least quality of the tets there has then grown
bool remove_edge(Workspace& w, std::uint32_t u, std::uint32_t v);

/// Three tets about a new edge in the place of two with a common face inside a region.
/// @return whether that was done; the least quality of the tets there has then grown
bool remove_face(Workspace& w, std::uint32_t tet, std::size_t corner);

/// Draws vertex `from` into `into`, where no region is torn or joined by it and interfaces stay within a tenth of an edge.
/// Tets become no worse than `floor`.
/// @return whether it was done
bool contract_edge(Workspace& w, std::uint32_t from, std::uint32_t into, double floor);

/// A tet with two or three faces on one interface, flat enough that the interface stays within a tenth of an edge, takes the
/// label across; at the surface of the body it is removed. Masks of its vertices follow.
/// @return whether that was done
bool relabel(Workspace& w, std::uint32_t tet);

/// Flat faces with all vertices on a ball lie inside it: a volume 1.5 % too small at ten edges across. Each vertex of a smooth
/// surface moves along its normal by the mean distance of the middles of its edges from the surface, which makes the error
/// of a face that of fourth order. No tet falls below `floor` by that.
void keep_volume(Workspace& w, double floor);

}  // namespace glisson::lattice

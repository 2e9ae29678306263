// convergence_order.h — the highest order by which a force can converge, from the singular edges of a body, its supports and tools.
//
// Displacements near an edge grow as r^λ across it. Their energy, and with it the force of a tool that is driven, has an error of
// the order 2 λ in the size of cells, at most 2 for linear tets. λ follows from the angle ω of the body at the edge and from what
// is held on its two faces [Williams1952]:
//
//    free | bonded          κ sin² λω = ((κ + 1)/2)² − λ² sin² ω,  κ = 3 − 4ν     90°: 0.71 at ν = 0.3, 0.60 at ½; 180°: ½
//    free | without friction    sin 2λω = −λ sin 2ω, the wedge and its image      90°: 1; 180°: ½
//    both alike                 sin λω = −λ sin ω                                 270°: 0.54
//
// An edge is one between two triangles of the surface. Where only one component can move, as in antiplane shear, λ is π/(2 ω) of a
// face held beside a free one and π/ω of two alike.
#pragma once

#include "glisson/scene/scene.h"

namespace glisson {

/// λ between a free face and a bonded one. @param angle  of the body [rad], in (0, π]; π and more: ½
double bonded_edge_exponent(double angle, double poisson_ratio);
/// λ at an edge of a body whose two faces are free, 1 up to π. @param angle  of the body [rad], in (0, 2π]
double free_edge_exponent(double angle);

/// The order 2 λ of the worst edge, in [1, 2]; 1 where instruments or capsules act, whose edges are not known.
/// Cost: that of the surface.
double largest_order(const Variant& variant, const TetMesh& mesh);

}  // namespace glisson

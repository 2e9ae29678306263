// element_shape.h — what a tet of a body adds to its tissue: volume, edges, fibre direction.
#pragma once

#include "element/body.h"
#include "material/response.h"

namespace glisson {

/// Σ l lᵀ over the six rest edges [m²].
EdgeMetric<double> edge_metric(const Body& body, std::size_t element);

/// The rotation of a regular tetrahedron (material/edge_measure.h) that brings it closest to an element at rest: R of the
/// polar decomposition of the map between the two.
Mat3d regular_turn(const Body& body, std::size_t element);

/// @param tissue  of the element
ElementShape element_shape(const Body& body, const Tissue& tissue, std::size_t element);

}  // namespace glisson

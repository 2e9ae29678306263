// edge_batches.h — assembles the edges of a linear submesh and lays them out in batches.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/submesh.h"
#include "mesh/vertex_stars.h"

namespace glisson::engine {

/// @param elements  of the body, all of the block's tissue
/// @param local     local vertices of each of these elements, in its corner order
EdgeBatches make_edge_batches(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                              std::span<const Tet> local, std::size_t lanes);

/// Assembles the six edges of an element anew, from the elements of the submesh that hold them still.
/// @param in_submesh  whether an element belongs to the submesh
/// @param local       local vertex of a vertex of the mesh
void reassemble_edges(const Body& body, const TissueBlock& block, std::uint32_t element,
                      const detail::VertexStars& stars, const std::function<bool(std::uint32_t)>& in_submesh,
                      const std::function<std::uint32_t(std::uint32_t)>& local, EdgeBatches& edges, std::size_t lanes);

}  // namespace glisson::engine

// edge_batches.h — assembles the edges of a linear submesh and lays them out in batches.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/layout/submesh.h"
#include "mesh/topology/vertex_stars.h"

namespace glisson::engine {

/// @param elements  of the body, all of the block's tissue
/// @param local     local vertices of each of these elements, in its corner order
EdgeBatches make_edge_batches(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                              std::span<const Tet> local, std::size_t lanes);

/// Which elements belong to a submesh.
struct InSubmesh {
  std::span<const std::uint32_t> of_element;  ///< submesh of each element of the body
  std::uint32_t number = 0;
};

/// Assembles the six edges of an element anew, from the elements of the submesh that hold them still.
/// @param local  local vertex of a vertex of the mesh
void reassemble_edges(const Body& body, const TissueBlock& block, std::uint32_t element,
                      const detail::VertexStars& stars, const InSubmesh& submesh,
                      const std::function<std::uint32_t(std::uint32_t)>& local, EdgeBatches& edges, std::size_t lanes);

}  // namespace glisson::engine

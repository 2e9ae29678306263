// edge_batches.h — assembles the edges of a linear submesh and lays them out in batches.
#pragma once

#include <cstdint>
#include <span>

#include "engine/submesh.h"

namespace glisson::engine {

/// @param elements  of the body, all of the block's tissue
/// @param local     local vertices of each of these elements, in its corner order
EdgeBatches make_edge_batches(const Body& body, const TissueBlock& block, std::span<const std::uint32_t> elements,
                              std::span<const Tet> local, std::size_t lanes);

}  // namespace glisson::engine

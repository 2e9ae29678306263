// response_batches.h — what tissues beyond the paper's keep of each tet, in the lanes of its chain.
#pragma once

#include "engine/submesh.h"

namespace glisson::engine {

/// Fills the fibre directions of a submesh, and its Maxwell memory with that of the same elements before.
/// @param before  the batches in whose lanes the memory lies; none: nothing is remembered yet
void lay_out_response(const Body& body, const Tissue& tissue, const ChainBatches& before, Submesh& part,
                      std::size_t lanes);

/// Numbers that the memory of one element takes: six for each branch.
inline std::size_t memory_numbers(const Tissue& tissue) { return 6 * tissue.maxwell.size(); }

}  // namespace glisson::engine

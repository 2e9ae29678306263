// chain_batches.h — lays the tets of a submesh out in batches of chains.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/submesh.h"

namespace glisson::engine {

/// @param elements  of the body
/// @param local     local vertices of each of these elements, in its corner order
ChainBatches make_chain_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                                std::size_t lanes);

/// Takes an element out: its gradients and volume become 0, so that it carries no force ever after.
/// @return whether it was there
bool clear_element(ChainBatches& chains, std::uint32_t element, std::size_t lanes);

/// Largest Σ |s_a| over three edges of an element [1/m].
float gradient_reach(const Body& body, std::span<const std::uint32_t> elements);

}  // namespace glisson::engine

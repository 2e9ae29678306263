// chain_batches.h — lays the tets of a submesh out in batches of chains.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/layout/submesh.h"

namespace glisson::engine {

/// @param elements  of the body
/// @param local     local vertices of each of these elements, in its corner order
ChainBatches make_chain_batches(const Body& body, std::span<const std::uint32_t> elements, std::span<const Tet> local,
                                std::size_t lanes);

/// Takes an element out: its gradients and volume become 0, so that it carries no force ever after.
/// @return whether it was there
bool clear_element(ChainBatches& chains, std::uint32_t element, std::size_t lanes);

/// Place of an element in ChainBatches::element; its size where it is not there.
std::size_t place_of_element(const ChainBatches& chains, std::uint32_t element);

/// The elements of the chain that has the element at this place.
std::vector<std::uint32_t> elements_of_chain(const ChainBatches& chains, std::size_t place, std::size_t lanes);

/// Writes the rest data of an element anew where it lies.
/// @param local  its local vertices, in its corner order, the same as before
void rewrite_element(const Body& body, ChainBatches& chains, std::size_t place, const Tet& local, std::size_t lanes);

/// Adds elements in chains of their own: in lanes that are free in batches from `first_batch` on, then in new batches.
/// @param local  local vertices of each, in its corner order
void add_chains(const Body& body, ChainBatches& chains, std::span<const std::uint32_t> elements,
                std::span<const Tet> local, std::size_t lanes, std::size_t first_batch);

/// Largest Σ |s_a| over three edges of an element [1/m].
float gradient_reach(const Body& body, std::span<const std::uint32_t> elements);

}  // namespace glisson::engine

// patch_chains.h — carries elements that have changed into the chains of a submesh, without laying out the others.
//
//   batches  │ as laid out:  ░ emptied lanes ░     │ added: chains of elements whose corners have changed │
//
// Laying out a submesh takes a millisecond, most of it to find chains; a cut changes some ten elements of it at a time.
#pragma once

#include <span>

#include "engine/layout/submesh.h"

namespace glisson::engine {

/// What has changed of a submesh's elements, ascending.
struct ChangedElements {
  std::vector<std::uint32_t> turned;    ///< elements with other vertices
  std::vector<std::uint32_t> reshaped;  ///< elements of another shape at rest
};

/// @return false where the submesh must be laid out anew: it has edges, or too much of it lies in added batches, or its
///         new vertices do not come last; nothing is changed then
bool patch_chains(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, const ChangedElements& changed,
                  Submesh& part, std::size_t lanes);

}  // namespace glisson::engine

// contract.h — takes a vertex out by drawing it into a neighbour.
#pragma once

#include "mesh/lattice/workspace.h"

namespace glisson::lattice {

/// Draws vertex `from` into `into`, where no region is torn or joined by it and interfaces stay within a tenth of an edge.
/// Tets become no worse than `floor`.
/// @return whether it was done
bool contract_edge(Workspace& w, std::uint32_t from, std::uint32_t into, double floor);

}  // namespace glisson::lattice

// tissue_change.h — other tissues for some blocks of a body, on their way into a scheme.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "element/body.h"

namespace glisson {

/// A tissue for each of some blocks.
using BlockTissues = std::vector<std::pair<std::size_t, Tissue>>;

/// What a scheme is told when the tissues of its body have changed.
struct TissueChange {
  std::vector<std::size_t> blocks;
  /// Per changed block: stress of each element and branch of its new tissue [Pa].
  std::vector<std::vector<Sym3<double>>> branch_stresses;
  std::vector<double> past;  ///< where a change is taken back: MovingBody::past before it
};

/// Stresses of branches that go on, by their place in the list; 0 for those that are new.
/// @param before, @param after  number of branches
std::vector<Sym3<double>> carried_stresses(std::span<const Sym3<double>> stresses, std::size_t elements,
                                           std::size_t before, std::size_t after);

/// Whether the difference is one of numbers alone: the same kinds of laws, kinematics and measure, viscosity and branches
/// in the same places.
bool differ_by_values(const Tissue& a, const Tissue& b);

}  // namespace glisson

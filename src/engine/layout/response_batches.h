// response_batches.h — what tissues beyond the paper's keep of each tet, in the lanes of its chain.
#pragma once

#include "engine/layout/submesh.h"

namespace glisson::engine {

/// Fills the fibre directions of a submesh, and its Maxwell memory with that of the same elements before.
/// @param before  the batches in whose lanes the memory lies; none: nothing is remembered yet
void lay_out_response(const Body& body, const Tissue& tissue, const ChainBatches& before, Submesh& part,
                      std::size_t lanes);

/// Numbers that the memory of one element takes: six for each branch (viscous_response-inl.h). Where times of branches follow
/// the deformation they are its overstress S − q, and S and the branches' paces 1/τ lie behind them (branch_pace-inl.h).
inline std::size_t memory_numbers(const Tissue& tissue) {
  const std::size_t n = tissue.maxwell.size();
  return 6 * n + (tissue.relaxation_follows() ? 6 + n : 0);
}

/// Calls `visit(element, numbers)` for each element of a submesh with Maxwell memory, `numbers` a function from the number's
/// place, 0 … memory_numbers − 1, to where it lies.
template <class Part, class Visit>
void for_memory(Part& part, const Tissue& tissue, std::size_t lanes, const Visit& visit) {
  const std::size_t n = memory_numbers(tissue);
  for (std::size_t k = 0; n > 0 && k < part.chains.element.size(); ++k) {
    if (part.chains.element[k] == kNoElement) continue;
    auto* first = part.memory.data() + k / lanes * n * lanes + k % lanes;
    visit(part.chains.element[k], [=](std::size_t i) { return first + i * lanes; });
  }
}

/// The same of a submesh that is linear (LinearForm): `visit(element, numbers, stress)`, `stress` where the six of S lie.
template <class Part, class Visit>
void for_linear_memory(Part& part, const Tissue& tissue, std::size_t lanes, const Visit& visit) {
  std::size_t k = 0;
  for_memory(part, tissue, lanes, [&](std::uint32_t e, const auto& number) {
    while (part.chains.element[k] != e) ++k;
    auto* first = part.linear.stress.data() + k / lanes * 6 * lanes + k % lanes;
    visit(e, number, [=](std::size_t i) { return first + i * lanes; });
  });
}

}  // namespace glisson::engine

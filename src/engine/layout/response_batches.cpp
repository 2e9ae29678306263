#include "engine/layout/response_batches.h"

#include <map>

#include "element/element_shape.h"

namespace glisson::engine {
namespace {

/// Calls `f(element, at)` for each element of batches, `at` the place of its first number of `numbers` a tet.
template <class F>
void for_elements(const ChainBatches& chains, std::size_t lanes, std::size_t numbers, const F& f) {
  for (std::size_t k = 0; k < chains.element.size(); ++k) {
    if (chains.element[k] != kNoElement) f(chains.element[k], k / lanes * numbers * lanes + k % lanes);
  }
}

}  // namespace

void lay_out_response(const Body& body, const Tissue& tissue, const ChainBatches& before, Submesh& part,
                      std::size_t lanes) {
  if (tissue.fibres) {
    part.fibre.assign(part.chains.element.size() * 3, 0.0F);
    for_elements(part.chains, lanes, 3, [&](std::uint32_t e, std::size_t at) {
      const Vec3d a = element_shape(body, tissue, e).fibre;
      for (std::size_t i = 0; i < 3; ++i) part.fibre[at + i * lanes] = static_cast<float>(a[i]);
    });
  }
  const std::size_t numbers = memory_numbers(tissue);
  if (numbers == 0) return;
  const LaneVector<float> past = std::move(part.memory);
  std::map<std::uint32_t, std::size_t> place;
  for_elements(before, lanes, numbers, [&](std::uint32_t e, std::size_t at) { place[e] = at; });
  part.memory.assign(part.chains.element.size() * numbers, 0.0F);
  for_elements(part.chains, lanes, numbers, [&](std::uint32_t e, std::size_t at) {
    const auto was = place.find(e);
    if (was == place.end()) return;
    for (std::size_t i = 0; i < numbers; ++i) part.memory[at + i * lanes] = past[was->second + i * lanes];
  });
}

}  // namespace glisson::engine

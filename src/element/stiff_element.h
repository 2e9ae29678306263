// stiff_element.h — an element that is stiffer than what the stable step is known for, as whoever evaluates it tells it.
#pragma once

#include <cstdint>

namespace glisson {

struct StiffElement {
  std::uint32_t element = 0;
  double ratio = 1.0;  ///< r with tangent ≤ r times that at rest
  double norm = 1.0;   ///< λ_max of the tangent over that at rest, both as tensors of ∂P/∂F
  void archive(auto& ar) { ar(element, ratio, norm); }
};

/// What an element may come to before it is listed, where that is more than the limit of its block.
struct StiffLimit {
  float ratio = 0.0F, norm = 0.0F;
  bool covers(const StiffElement& s) const { return !(s.ratio > double(ratio) || s.norm > double(norm)); }
};

}  // namespace glisson

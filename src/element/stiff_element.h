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

}  // namespace glisson

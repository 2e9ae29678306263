// payload.h — what follows the head of a command.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace glisson::view {

/// A number, where `index` is set, then values.
struct Payload {
  bool index = false;
  std::size_t values = 0;
  std::uint32_t most_index = std::numeric_limits<std::uint32_t>::max();
  float least = std::numeric_limits<float>::lowest(), largest = std::numeric_limits<float>::max();  ///< of each value

  constexpr std::size_t bytes() const { return (index ? 4 : 0) + 4 * values; }
};

/// The least number above 0.
inline constexpr float kAbove0 = std::numeric_limits<float>::denorm_min();

}  // namespace glisson::view

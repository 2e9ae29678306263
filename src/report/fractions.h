// fractions.h — numbers as whole fractions of the largest of them, one or two bytes each, as pages draw surfaces.
//
// The report and the live view send the same pictures: what a page decodes (web/src/mesh3d) is written here once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glisson {

/// value / scale in steps of 1/32767; a value that is not finite, and any with scale 0, is 0.
inline std::int16_t fraction16(double value, double scale) {
  const double f = scale > 0.0 ? value / scale * 32767.0 : 0.0;
  return std::isfinite(f) ? static_cast<std::int16_t>(std::lround(std::clamp(f, -32767.0, 32767.0))) : std::int16_t{0};
}

/// value / scale in steps of 1/255; a value that is not finite is 1, any with scale 0 is 0.
inline std::uint8_t fraction8(double value, double scale) {
  const double f = scale > 0.0 ? value / scale * 255.0 : 0.0;
  return std::isfinite(f) ? static_cast<std::uint8_t>(std::lround(std::clamp(f, 0.0, 255.0))) : std::uint8_t{255};
}

}  // namespace glisson

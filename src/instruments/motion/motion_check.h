// motion_check.h — refusing an option of a motion, with its name, value and allowed range.
#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "glisson/math.h"

namespace glisson {

/// Which numbers an option may take.
enum class Sign { positive, not_negative };

/// @param what  e.g. "sine motion: frequency [Hz]" @throws std::invalid_argument
inline void require_number(const char* what, double value, Sign sign) {
  const bool ok = std::isfinite(value) && (sign == Sign::positive ? value > 0.0 : value >= 0.0);
  if (ok) return;
  std::ostringstream text;
  text << what << " = " << value << " is outside the allowed range, " << (sign == Sign::positive ? "> 0" : ">= 0");
  throw std::invalid_argument(text.str());
}

/// @throws std::invalid_argument where the direction has no length
inline Vec3d unit_of(const char* what, const Vec3d& direction) {
  const double length = norm(direction);
  if (length > 0.0 && std::isfinite(length)) return direction * (1.0 / length);
  throw std::invalid_argument(std::string(what) + ": the direction has no length; give a vector such as (0, 0, -1)");
}

}  // namespace glisson

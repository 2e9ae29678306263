// option_check.h — refusal of a generator's option, always as: function, option, value, allowed range.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/text.h"

namespace glisson::detail {

[[noreturn]] inline void refuse_option(const std::string& option, const std::string& value, const std::string& range) {
  throw std::invalid_argument(option + " = " + value + " is out of range: it must be " + range);
}

/// @throws std::invalid_argument unless value is finite and > 0
inline void require_positive(const std::string& option, double value, const std::string& unit) {
  if (!(std::isfinite(value) && value > 0.0)) {
    refuse_option(option, number_text(value), "finite and greater than 0 " + unit);
  }
}

/// @throws std::invalid_argument unless low ≤ value ≤ high
inline void require_count(const std::string& option, int value, int low, int high) {
  if (value < low || value > high) {
    refuse_option(option, std::to_string(value), "from " + std::to_string(low) + " to " + std::to_string(high));
  }
}

}  // namespace glisson::detail

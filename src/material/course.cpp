#include "material/course.h"

#include <cmath>
#include <stdexcept>

#include "base/text.h"

namespace glisson {

void Course::require_valid(const std::string& what) const {
  const auto fail = [&](const std::string& why) { throw std::invalid_argument(what + ": " + why); };
  if (times.empty() || times.size() != values.size()) {
    fail(std::to_string(times.size()) + " times and " + std::to_string(values.size()) +
         " values; give as many of both, one or more");
  }
  if (between < 1) fail("between = 0 is outside the allowed range, ≥ 1");
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (std::isfinite(times[k]) && (k == 0 ? times[k] >= 0.0 : times[k] > times[k - 1])) continue;
    fail("time " + std::to_string(k + 1) + " = " + detail::number_text(times[k]) +
         (k == 0 ? " s is outside the allowed range, ≥ 0" : " s is not later than the one before it"));
  }
}

}  // namespace glisson

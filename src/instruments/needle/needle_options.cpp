// needle_options.cpp — what must hold between the options of a needle.
#include "base/text.h"
#include "glisson/instruments/needle.h"

namespace glisson {

Fault Rupture::check() const {
  return force && toughness ? Fault{"is given in addition to a force; give one of the two", "toughness"} : Fault{};
}

Fault NeedleOptions::check() const {
  for (std::size_t i = 1; i < membranes.size(); ++i) {
    const double before = membranes[i - 1].depth, depth = membranes[i].depth;
    if (depth > before) continue;
    return {"number " + std::to_string(i + 1) + ", at " + detail::number_text(1e3 * depth) +
                " mm, is not below the one before it, at " + detail::number_text(1e3 * before) +
                " mm; give them by ascending depth",
            "membranes"};
  }
  if (inner_diameter < diameter) return {};
  return {detail::number_text(1e3 * inner_diameter) + " mm is not below the diameter, " +
              detail::number_text(1e3 * diameter) + " mm",
          "inner_diameter"};
}

}  // namespace glisson

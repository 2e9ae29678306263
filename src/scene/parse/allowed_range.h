// allowed_range.h — the numbers that a key allows: its own range, with the ends of its unit (base/unit_range.h).
#pragma once

#include "base/unit_range.h"
#include "scene/parse/schema.h"

namespace glisson::scene {

/// A number without a unit is a pure one.
inline Range allowed_range(const KeySpec& key) {
  return key.type == ValueType::number ? detail::within_unit(key.range, key.unit.empty() ? "-" : key.unit) : key.range;
}

}  // namespace glisson::scene

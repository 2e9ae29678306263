// unit_range.h — the two ends of every number: beyond those of its unit, arithmetic overflows or loses its digits.
//
// A field says what its own meaning allows (glisson/field.h): `above(0)`. What no field says, and all of a unit share, is
// written here once: a modulus is at most 1e12 Pa, a coordinate at most 10 km. Messages, the schema and Python show the range of
// both. docs/conventions.md has the table with the reasons.
#pragma once

#include <span>
#include <string_view>

#include "glisson/field.h"

namespace glisson::detail {

/// The numbers that a unit allows, in SI.
struct UnitRange {
  std::string_view unit;
  double largest = 0.0;   ///< of either sign
  double smallest = 0.0;  ///< of numbers that are to be above 0; 0: any
};
/// All of them, units in SI or in degrees.
std::span<const UnitRange> unit_ranges();

/// A vector without a component of this size has no direction: its length is lost in the squares.
inline constexpr double kShortestDirection = 1e-100;

/// A range in a unit with the unit's ends where it has none of its own; unchanged for a unit that is not in the table.
/// @param unit  as of a field: "mm" is a thousandth of "m"
Range within_unit(Range range, std::string_view unit);

/// What a field allows, in its own unit.
inline Range allowed(const FieldText& field) { return within_unit(field.range, field.unit); }

}  // namespace glisson::detail

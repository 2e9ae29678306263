// units.h — the units in which laboratories write what they measure.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/text.h"

namespace glisson::fit {

enum class Quantity {
  time,
  length,
  force,
  stress,
  strain,
  stretch,
  angle,
  torque,
  frequency,
  temperature,
  area,
  volume
};

struct Unit {
  std::string name;
  double factor;  ///< SI value of one
};

/// The customary units of a quantity, the first of them first.
std::span<const Unit> units_of(Quantity quantity);
/// `s, ms, min`: the customary ones.
std::string unit_names(Quantity quantity);
/// A customary unit, one composed of them (a force over a squared length, a force times a length) or one of the less usual;
/// nullptr where there is no such unit. Letters count as written: mPa is no MPa. `um` is µm, `N/mm^2` is N/mm².
const Unit* find_unit(Quantity quantity, std::string_view text);
/// Whether any quantity has this unit, or it is one of a rate: `1/s`, `s⁻¹`, `mm/s`, `%/s`.
bool is_unit(std::string_view text);
/// Whether a unit is one over a second, `1/s`, `s^-1`, `s⁻¹`: as a frequency it is Hz to some and rad/s to others.
bool is_per_second(std::string_view text);
/// Whether numbers in this unit may be of a quantity: of a frequency also those per second, of which the column's name has to say more.
bool may_be(Quantity quantity, std::string_view unit);

/// The name of a column and the unit that stands with it.
struct Title {
  std::string name, unit;
};
/// `Load (N)`, `Strain [-]`, `Force/kN`, `depth_mm`, `Fz, gf`, `Kraft in N` → name and unit; without a unit the whole is the
/// name. A unit without brackets counts only where it is one of any quantity.
Title split_title(std::string_view title);

/// A few significant digits, for messages.
inline std::string brief(double value, int digits = 4) { return detail::number_text(value, digits); }

/// A measured number with its unit, for messages: `0.31 N`, `1.2 kPa`; without a unit a part, `2.1 %`.
std::string measured_text(double value, std::string_view unit, int digits = 3);

}  // namespace glisson::fit

#include "fit/data/units.h"

#include <array>
#include <cmath>
#include <numbers>

namespace glisson::fit {
namespace {

constexpr std::array kTime{Unit{"s", 1.0}, Unit{"ms", 1e-3}, Unit{"min", 60.0}, Unit{"sec", 1.0}};
constexpr std::array kLength{Unit{"mm", 1e-3}, Unit{"m", 1.0},   Unit{"cm", 1e-2},
                             Unit{"µm", 1e-6}, Unit{"um", 1e-6}, Unit{"in", 0.0254}};
constexpr double kGravity = 9.80665;
constexpr double kPoundForce = 0.45359237 * kGravity;
constexpr std::array kForce{Unit{"N", 1.0},        Unit{"mN", 1e-3},
                            Unit{"kN", 1e3},       Unit{"gf", 1e-3 * kGravity},
                            Unit{"kgf", kGravity}, Unit{"lbf", kPoundForce}};
constexpr std::array kStress{Unit{"kPa", 1e3}, Unit{"Pa", 1.0}, Unit{"MPa", 1e6}};
constexpr std::array kStrain{Unit{"-", 1.0}, Unit{"%", 1e-2}, Unit{"mm/mm", 1.0}};
constexpr std::array kStretch{Unit{"-", 1.0}, Unit{"%", 1e-2}};
constexpr std::array kAngle{Unit{"rad", 1.0}, Unit{"deg", std::numbers::pi / 180.0},
                            Unit{"°", std::numbers::pi / 180.0}, Unit{"mrad", 1e-3}};
constexpr std::array kTorque{Unit{"N m", 1.0},   Unit{"N·m", 1.0},   Unit{"Nm", 1.0},    Unit{"mN m", 1e-3},
                             Unit{"mN·m", 1e-3}, Unit{"mNm", 1e-3},  Unit{"N mm", 1e-3}, Unit{"Nmm", 1e-3},
                             Unit{"µN m", 1e-6}, Unit{"µN·m", 1e-6}, Unit{"µNm", 1e-6},  Unit{"uNm", 1e-6}};
constexpr std::array kFrequency{Unit{"Hz", 1.0}, Unit{"rad/s", 0.5 / std::numbers::pi}, Unit{"kHz", 1e3}};
constexpr std::array kQuantities{Quantity::time,   Quantity::length, Quantity::force,
                                 Quantity::stress, Quantity::strain, Quantity::stretch,
                                 Quantity::angle,  Quantity::torque, Quantity::frequency};

bool is_unit(std::string_view text) {
  for (const Quantity q : kQuantities) {
    if (find_unit(q, text)) return true;
  }
  return false;
}

/// `Load (N)`: what the last pair of brackets holds, where the title ends with it.
Title bracketed(std::string_view title) {
  if (title.empty() || (title.back() != ')' && title.back() != ']')) return {};
  const std::size_t open = title.rfind(title.back() == ')' ? '(' : '[');
  if (open == std::string_view::npos) return {};
  return {std::string(detail::trimmed(title.substr(0, open))),
          std::string(detail::trimmed(title.substr(open + 1, title.size() - open - 2)))};
}

}  // namespace

std::span<const Unit> units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::time:
      return kTime;
    case Quantity::length:
      return kLength;
    case Quantity::force:
      return kForce;
    case Quantity::stress:
      return kStress;
    case Quantity::strain:
      return kStrain;
    case Quantity::stretch:
      return kStretch;
    case Quantity::angle:
      return kAngle;
    case Quantity::torque:
      return kTorque;
    case Quantity::frequency:
      return kFrequency;
  }
  return {};
}

std::string unit_names(Quantity quantity) {
  std::string text;
  for (const Unit& unit : units_of(quantity)) text.append(text.empty() ? "" : ", ").append(unit.name);
  return text;
}

const Unit* find_unit(Quantity quantity, std::string_view text) {
  constexpr std::string_view kGreekMu = "μm";  // U+03BC, where the list has the sign U+00B5
  text = detail::trimmed(text);
  if (text == kGreekMu) text = "µm";
  for (const Unit& unit : units_of(quantity)) {
    if (unit.name == text) return &unit;
  }
  return nullptr;
}

Title split_title(std::string_view title) {
  title = detail::trimmed(title);
  if (Title found = bracketed(title); !found.name.empty()) return found;
  for (const char mark : {'/', '_'}) {
    const std::size_t at = title.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view unit = detail::trimmed(title.substr(at + 1));
    if (is_unit(unit)) return {std::string(detail::trimmed(title.substr(0, at))), std::string(unit)};
  }
  return {std::string(title), {}};
}

std::string measured_text(double value, std::string_view unit, int digits) {
  if (unit.empty()) return brief(100.0 * value, digits) + " %";
  if (unit == "Pa" && std::abs(value) >= 100.0) return brief(1e-3 * value, digits) + " kPa";
  return brief(value, digits) + (unit == "-" ? "" : " " + std::string(unit));
}

}  // namespace glisson::fit

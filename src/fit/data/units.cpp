#include "fit/data/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace glisson::fit {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kPoundForce = 0.45359237 * kGravity;
constexpr double kInch = 0.0254;
constexpr double kDegree = std::numbers::pi / 180.0;

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

/// One spelling of the signs: µ is U+00B5, a square is ², factors stand together.
std::string spelled(std::string_view text) {
  std::string unit(detail::trimmed(text));
  replace_all(unit, "\u03BC", "µ");
  for (const std::string_view square : {"^2", "**2"}) replace_all(unit, square, "²");
  if (unit.find('/') != std::string::npos && unit.ends_with('2')) unit.replace(unit.size() - 1, 1, "²");
  for (const std::string_view times : {"\u00B7", "\u22C5", "*", " "}) replace_all(unit, times, "");
  return unit;
}

/// Units of a quantity. The customary ones are those that messages list and suggest.
struct UnitTable {
  std::vector<Unit> customary;
  std::vector<Unit> others{};
  std::map<std::string, const Unit*> by_name{};  ///< as `spelled` has it

  void add_names() {
    for (const auto* units : {&customary, &others}) {
      for (const Unit& unit : *units) by_name.emplace(spelled(unit.name), &unit);
    }
  }
};

/// Forces over squared lengths: kN/m², N/mm², kgf/cm².
std::vector<Unit> force_over_area(const UnitTable& forces, const UnitTable& lengths) {
  std::vector<Unit> units;
  for (const auto* some : {&forces.customary, &forces.others}) {
    for (const Unit& force : *some) {
      for (const Unit& length : lengths.customary)
        units.push_back({force.name + "/" + length.name + "²", force.factor / (length.factor * length.factor)});
    }
  }
  return units;
}

/// Forces times lengths, as `find_unit` looks for them: Nm, mNm, kgfcm.
std::vector<Unit> force_times_length(const UnitTable& forces, const UnitTable& lengths) {
  std::vector<Unit> units;
  for (const auto* some : {&forces.customary, &forces.others}) {
    for (const Unit& force : *some) {
      for (const Unit& length : lengths.customary)
        units.push_back({force.name + length.name, force.factor * length.factor});
    }
  }
  return units;
}

struct UnitTables {
  UnitTable time{{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}},
                 {{"sec", 1.0},
                  {"Sec", 1.0},
                  {"sec.", 1.0},
                  {"second", 1.0},
                  {"seconds", 1.0},
                  {"Sekunden", 1.0},
                  {"secondes", 1.0},
                  {"µs", 1e-6},
                  {"msec", 1e-3},
                  {"h", 3600.0}}};
  UnitTable length{{{"mm", 1e-3}, {"m", 1.0}, {"cm", 1e-2}, {"µm", 1e-6}, {"nm", 1e-9}, {"in", kInch}},
                   {{"inch", kInch}, {"inches", kInch}, {"micron", 1e-6}, {"microns", 1e-6}, {"ft", 12.0 * kInch}}};
  UnitTable force{{{"N", 1.0},
                   {"mN", 1e-3},
                   {"kN", 1e3},
                   {"µN", 1e-6},
                   {"nN", 1e-9},
                   {"gf", 1e-3 * kGravity},
                   {"kgf", kGravity},
                   {"lbf", kPoundForce}},
                  {{"cN", 1e-2},
                   {"daN", 10.0},
                   {"MN", 1e6},
                   {"pN", 1e-12},
                   {"g", 1e-3 * kGravity},
                   {"kg", kGravity},
                   {"p", 1e-3 * kGravity},
                   {"kp", kGravity},
                   {"lb", kPoundForce},
                   {"ozf", kPoundForce / 16.0},
                   {"dyn", 1e-5},
                   {"Newton", 1.0},
                   {"newton", 1.0},
                   {"newtons", 1.0}}};
  UnitTable stress{{{"kPa", 1e3},
                    {"Pa", 1.0},
                    {"MPa", 1e6},
                    {"N/mm²", 1e6},
                    {"N/cm²", 1e4},
                    {"kgf/cm²", 1e4 * kGravity},
                    {"psi", kPoundForce / (kInch * kInch)}},
                   {{"mPa", 1e-3},
                    {"hPa", 1e2},
                    {"GPa", 1e9},
                    {"bar", 1e5},
                    {"mbar", 1e2},
                    {"mmHg", 133.322387415},
                    {"ksi", 1e3 * kPoundForce / (kInch * kInch)}}};
  UnitTable strain{{{"-", 1.0}, {"%", 1e-2}, {"mm/mm", 1.0}},
                   {{"1", 1.0}, {"m/m", 1.0}, {"in/in", 1.0}, {"‰", 1e-3}, {"µm/m", 1e-6}}};
  UnitTable stretch{{{"-", 1.0}, {"%", 1e-2}}, {{"1", 1.0}, {"mm/mm", 1.0}, {"m/m", 1.0}}};
  UnitTable angle{{{"rad", 1.0}, {"deg", kDegree}, {"°", kDegree}, {"mrad", 1e-3}},
                  {{"degrees", kDegree}, {"Grad", kDegree}, {"µrad", 1e-6}}};
  UnitTable torque{{{"N m", 1.0}, {"mN m", 1e-3}, {"µN m", 1e-6}, {"N mm", 1e-3}}};
  UnitTable frequency{{{"Hz", 1.0}, {"rad/s", 0.5 / std::numbers::pi}, {"kHz", 1e3}},
                      {{"mHz", 1e-3}}};  // 1/s is not here: it may be Hz or rad/s (is_per_second)

  UnitTable temperature{{{"°C", 1.0}}, {{"C", 1.0}, {"degC", 1.0}, {"deg C", 1.0}, {"Celsius", 1.0}}};
  UnitTable area{{{"mm²", 1e-6}, {"cm²", 1e-4}, {"m²", 1.0}}, {{"mm2", 1e-6}, {"cm2", 1e-4}, {"m2", 1.0}}};
  UnitTable volume{{{"mm³", 1e-9}, {"cm³", 1e-6}, {"mL", 1e-6}, {"m³", 1.0}},
                   {{"mm3", 1e-9}, {"cm3", 1e-6}, {"ml", 1e-6}, {"m3", 1.0}, {"L", 1e-3}, {"l", 1e-3}}};

  UnitTables() {
    for (Unit& unit : force_over_area(force, length)) stress.others.push_back(std::move(unit));
    torque.others = force_times_length(force, length);
    for (UnitTable* table : {&time, &length, &force, &stress, &strain, &stretch, &angle, &torque, &frequency,
                             &temperature, &area, &volume})
      table->add_names();
  }

  const UnitTable& of(Quantity quantity) const {
    switch (quantity) {
      case Quantity::time:
        return time;
      case Quantity::length:
        return length;
      case Quantity::force:
        return force;
      case Quantity::stress:
        return stress;
      case Quantity::strain:
        return strain;
      case Quantity::stretch:
        return stretch;
      case Quantity::angle:
        return angle;
      case Quantity::torque:
        return torque;
      case Quantity::temperature:
        return temperature;
      case Quantity::area:
        return area;
      case Quantity::volume:
        return volume;
      case Quantity::frequency:
        break;
    }
    return frequency;
  }
};

const UnitTables& tables() {
  static const UnitTables made;
  return made;
}

constexpr std::array kQuantities{Quantity::time,      Quantity::length,      Quantity::force, Quantity::stress,
                                 Quantity::strain,    Quantity::stretch,     Quantity::angle, Quantity::torque,
                                 Quantity::frequency, Quantity::temperature, Quantity::area,  Quantity::volume};

/// Units of speeds and rates, which no column of a test is read in: machines write them beside the others.
bool is_rate(std::string_view unit) {
  constexpr std::array<std::string_view, 11> kNames{"1/min", "min⁻¹",  "mm/s", "mm/min", "m/s", "cm/s",
                                                    "µm/s",  "in/min", "%/s",  "%/min",  "N/s"};
  return is_per_second(unit) || std::find(kNames.begin(), kNames.end(), unit) != kNames.end();
}

/// `Load (N)`: what the last pair of brackets holds, where the title ends with it.
Title bracketed(std::string_view title) {
  if (title.empty() || (title.back() != ')' && title.back() != ']')) return {};
  const std::size_t open = title.rfind(title.back() == ')' ? '(' : '[');
  if (open == std::string_view::npos) return {};
  return {std::string(detail::trimmed(title.substr(0, open))),
          std::string(detail::trimmed(title.substr(open + 1, title.size() - open - 2)))};
}

/// Whether the last word about a slash is a unit itself, `1/s` of `Shear rate 1/s`, and no name and its unit, `Force/kN`.
bool splits_a_unit(std::string_view title, std::size_t slash) {
  const std::size_t word = title.find_last_of(" ,_", slash);
  return word != std::string_view::npos && is_rate(spelled(title.substr(word + 1)));
}

/// What may as well be a word or a number of the name: `run 1`, `mode in`.
bool is_word(std::string_view unit, std::string_view mark) {
  if (unit == "1" || unit == "p") return true;
  return mark == " " && (unit == "in" || unit == "h" || unit == "-");
}

}  // namespace

std::span<const Unit> units_of(Quantity quantity) { return tables().of(quantity).customary; }

std::string unit_names(Quantity quantity) {
  std::string text;
  for (const Unit& unit : units_of(quantity)) text.append(text.empty() ? "" : ", ").append(unit.name);
  return text;
}

const Unit* find_unit(Quantity quantity, std::string_view text) {
  const std::string unit = spelled(text);
  const std::string with_mu = unit.starts_with('u') ? "µ" + unit.substr(1) : std::string{};
  const UnitTable& table = tables().of(quantity);
  for (const std::string& name : {unit, with_mu}) {
    if (const auto found = table.by_name.find(name); found != table.by_name.end()) return found->second;
  }
  return nullptr;
}

bool is_unit(std::string_view text) {
  const auto has = [&](Quantity q) { return find_unit(q, text) != nullptr; };
  return is_rate(spelled(text)) || std::any_of(kQuantities.begin(), kQuantities.end(), has);
}

bool is_per_second(std::string_view text) {
  constexpr std::array<std::string_view, 4> kNames{"1/s", "s⁻¹", "s^-1", "s-1"};
  return std::find(kNames.begin(), kNames.end(), spelled(text)) != kNames.end();
}

bool may_be(Quantity quantity, std::string_view unit) {
  return find_unit(quantity, unit) || (quantity == Quantity::frequency && is_per_second(unit));
}

Title split_title(std::string_view title) {
  title = detail::trimmed(title);
  if (Title found = bracketed(title); !found.name.empty()) return found;
  for (const std::string_view mark : {",", " in ", "/", "_", " "}) {
    const std::size_t at = title.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view unit = detail::trimmed(title.substr(at + mark.size()));
    const bool over = mark == "/" && splits_a_unit(title, at);  // `Shear rate 1/s`: the blank before it is the mark
    if (!over && !is_word(unit, mark) && is_unit(unit))
      return {std::string(detail::trimmed(title.substr(0, at))), std::string(unit)};
  }
  return {std::string(title), {}};
}

std::string measured_text(double value, std::string_view unit, int digits) {
  if (unit.empty()) return brief(100.0 * value, digits) + " %";
  if (unit == "Pa" && std::abs(value) >= 100.0) return brief(1e-3 * value, digits) + " kPa";
  return brief(value, digits) + (unit == "-" ? "" : " " + std::string(unit));
}

}  // namespace glisson::fit

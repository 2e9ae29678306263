#include "glisson/field.h"

#include "base/text.h"

namespace glisson {
namespace {

/// "kg/m³" as a part of a key: "kg_m3".
std::string key_of_unit(std::string_view unit) {
  if (unit == "1/s") return "per_s";
  if (unit == "1/K") return "per_K";
  if (unit == "Hz") return "hz";
  if (unit == "°") return "deg";
  std::string key;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit[i] == '(' || unit[i] == ')') continue;  // "W/(m K)": W_m_K
    const std::string_view two = unit.substr(i, 2);
    const char in_key = two == "²"                                       ? '2'
                        : two == "³"                                     ? '3'
                        : two == "·" || unit[i] == ' ' || unit[i] == '/' ? '_'
                                                                         : unit[i];
    if (two == "²" || two == "³" || two == "·") ++i;
    key += in_key;
  }
  return key;
}

}  // namespace

bool Range::bounded() const {
  return min > -std::numeric_limits<double>::infinity() || max < std::numeric_limits<double>::infinity();
}

std::string Range::text() const {
  using detail::show;
  const bool low = min > -std::numeric_limits<double>::infinity();
  const bool high = max < std::numeric_limits<double>::infinity();
  if (low && high && !min_open && !max_open) return show(min) + " to " + show(max);
  std::string text = low ? (min_open ? "> " : "≥ ") + show(min) : "";
  if (low && high) text += " and ";
  if (high) text += (max_open ? "< " : "≤ ") + show(max);
  return text;
}

std::string FieldText::key() const {
  if (!own_key.empty()) return std::string(own_key);
  std::string key(name);
  if (!unit.empty() && unit != "-") key += "_" + key_of_unit(unit);
  return key;
}

std::string FieldText::si_unit() const {
  if (unit == "°") return "rad";
  return std::string(unit.substr(unit.starts_with("mm") ? 1 : 0));
}

}  // namespace glisson

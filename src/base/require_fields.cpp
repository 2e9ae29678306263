#include "base/require_fields.h"

#include <cmath>
#include <stdexcept>

#include "base/text.h"
#include "base/unit_range.h"

namespace glisson::detail {

void refuse(const std::string& where, std::string name, const std::string& what) {
  if (name.ends_with('.')) name.pop_back();
  throw std::invalid_argument(where + ": " + name + (name.empty() ? "" : ": ") + what);
}

void refuse_enumerator(const std::string& where, const std::string& name, long long number,
                       const std::vector<std::string_view>& words) {
  std::string all;
  for (const std::string_view word : words) all += (all.empty() ? "" : ", ") + std::string(word);
  throw std::invalid_argument(where + ": " + name + " = " + std::to_string(number) + " is none of its values: " + all);
}

void require_number(const std::string& where, const std::string& name, const FieldText& field, double value) {
  Range range = allowed(field);
  range.min *= field.scale(), range.max *= field.scale();
  if (range.contains(value) && std::isfinite(value)) return;
  if (!field.infinite.empty() && std::isinf(value) && field.range.contains(value)) return;
  const std::string unit = field.si_unit();
  std::string text = where + ": " + name + (unit.empty() || unit == "-" ? "" : " [" + unit + "]") + " = " +
                     show(value) + " is outside the allowed range, ";
  text += range.bounded() ? range.text() : "any finite number";
  if (!field.infinite.empty()) text += "; infinite: " + std::string(field.infinite);
  if (field.infinite.empty() && range.bounded() && std::isinf(range.max)) text += " and finite";
  if (!field.advice.empty()) text += "; " + std::string(field.advice);
  throw std::invalid_argument(text);
}

void require_vector(const std::string& where, const std::string& name, const FieldText& field, const Vec3d& v) {
  for (std::size_t i = 0; i < 3; ++i) require_number(where, name + "." + "xyz"[i], field, v[i]);
  if (field.is_direction && !(norm(v) > kShortestDirection))
    refuse(where, name,
           "(" + show(v.x) + ", " + show(v.y) + ", " + show(v.z) +
               ") has no length; give a vector that is not zero, such as (0, 0, -1)");
}

}  // namespace glisson::detail

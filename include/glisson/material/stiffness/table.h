// table.h — the modulus read off a measured table.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// M(x) by straight lines between the points (x_i, M_i), constant beyond the first and the last.
/// The base modulus serves the viscous tensor and the stable step only.
struct TableLaw {
  std::vector<double> arguments;  ///< x_i, strictly increasing [-]
  std::vector<double> moduli;     ///< M_i [Pa], as many

  static constexpr std::string_view kName = "table";
  static constexpr std::string_view kHelp = "M(x) by straight lines between points, constant outside them";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("arguments", &TableLaw::arguments, "-", "x_i, strictly increasing").must(),
                field("moduli", &TableLaw::moduli, "Pa", at_least(0), "modulus at each x_i").must());
  }

  /// x_i, M_i and the slope to the right of x_i, point by point
  std::vector<double> numbers(double /*base*/) const {
    std::vector<double> c;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const bool last = i + 1 == arguments.size();
      c.push_back(arguments[i]), c.push_back(moduli[i]);
      c.push_back(last ? 0.0 : (moduli[i + 1] - moduli[i]) / (arguments[i + 1] - arguments[i]));
    }
    return c;
  }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);
  std::string check() const {
    if (arguments.size() < 2) return "`arguments` needs at least two numbers";
    if (arguments.size() != moduli.size()) return "`arguments` and `moduli_Pa` must be equally long";
    const bool increasing =
        std::adjacent_find(arguments.begin(), arguments.end(), std::greater_equal<>{}) == arguments.end();
    return increasing ? std::string{} : "`arguments` must be strictly increasing";
  }

  bool operator==(const TableLaw&) const = default;
};

}  // namespace glisson

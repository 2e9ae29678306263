// table.h — the modulus read off a measured table.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/material/stiffness/law_field.h"

namespace glisson {

/// M(x) by straight lines between the points (x_i, M_i), constant beyond the first and the last.
/// The base modulus serves the viscous tensor and the stable step only.
struct TableLaw {
  std::vector<double> arguments;  ///< x_i, strictly increasing [-]
  std::vector<double> moduli;     ///< M_i [Pa], ≥ 0, as many

  static constexpr std::string_view kName = "table";
  static constexpr std::string_view kHelp = "M(x) by straight lines between points, constant outside them";
  static constexpr std::array<LawField<TableLaw>, 2> kFields{
      {{.key = "arguments", .member = &TableLaw::arguments, .unit = "-", .help = "x_i, strictly increasing"},
       {.key = "moduli_Pa",
        .member = &TableLaw::moduli,
        .unit = "Pa",
        .min = 0.0,
        .max = std::numeric_limits<double>::infinity(),
        .help = "modulus at each x_i"}}};

  template <class T>
  T value(T /*base*/, T x) const {
    const std::size_t i = segment(x);
    if (i == 0) return T(moduli.front());
    if (i == arguments.size()) return T(moduli.back());
    return T(moduli[i - 1]) + slope<T>(i) * (x - T(arguments[i - 1]));
  }
  template <class T>
  T derivative(T /*base*/, T x) const {
    const std::size_t i = segment(x);
    return i == 0 || i == arguments.size() ? T(0) : slope<T>(i);
  }
  std::string check() const {
    if (arguments.size() < 2) return "`arguments` needs at least two numbers";
    if (arguments.size() != moduli.size()) return "`arguments` and `moduli_Pa` must be equally long";
    const bool increasing =
        std::adjacent_find(arguments.begin(), arguments.end(), std::greater_equal<>{}) == arguments.end();
    return increasing ? std::string{} : "`arguments` must be strictly increasing";
  }

  bool operator==(const TableLaw&) const = default;

 private:
  /// Number of points at or left of x: 0 before the first, size() after the last.
  template <class T>
  std::size_t segment(T x) const {
    return static_cast<std::size_t>(std::upper_bound(arguments.begin(), arguments.end(), static_cast<double>(x)) -
                                    arguments.begin());
  }
  template <class T>
  T slope(std::size_t i) const {
    return T((moduli[i] - moduli[i - 1]) / (arguments[i] - arguments[i - 1]));
  }
};

}  // namespace glisson

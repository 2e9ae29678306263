// time_law.h — the one list of laws that the time of a Maxwell branch can follow.
//
//   τ(x) = τ φ(x),   least ≤ φ ≤ most
//
// x is the tissue's measure of deformation. A law is given by ln φ, which is what its formula works out (src/material/
// time_formulas.h): one exponential then turns it into the branch's pace 1/τ(x), in doubles, duals and lanes alike. The clamp
// keeps the time of a tetrahedron that is inverted, or still at rest, above 0 and finite.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <variant>

#include "glisson/field.h"
#include "glisson/material/scalar.h"

namespace glisson {

/// φ(x) = exp(a x), between `least` and `most`.
struct ExponentialTime {
  double rate = 0.0;     ///< a, per unit of the measure [-]; above 0 the branch slows down as the tissue deforms
  double least = 1e-3;   ///< smallest φ [-]
  double most = 1000.0;  ///< largest φ [-]

  static constexpr std::string_view kName = "exponential";
  static constexpr std::string_view kHelp = "τ(x) = τ exp(a x)";
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("rate", &ExponentialTime::rate, "-", between(-1000, 1000),
              "a, growth of ln τ per unit of the measure; above 0 the branch slows down as the tissue deforms")
            .must(),
        field("least", &ExponentialTime::least, "-", between(1e-9, 1), "factor on τ below which it does not fall"),
        field("most", &ExponentialTime::most, "-", between(1, 1e9), "factor on τ above which it does not rise"));
  }

  /// a, ln least, ln most
  std::array<double, 3> numbers() const { return {rate, std::log(least), std::log(most)}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const ExponentialTime&) const = default;
};

/// φ(x) = (x/x₀)ⁿ, between `least` and `most`: τ is the time at x = x₀.
struct PowerTime {
  double exponent = 1.0;   ///< n [-]
  double reference = 0.1;  ///< x₀, in units of the measure [-]
  double least = 1e-3;     ///< smallest φ [-]
  double most = 1000.0;    ///< largest φ [-]

  static constexpr std::string_view kName = "power";
  static constexpr std::string_view kHelp = "τ(x) = τ (x/x₀)ⁿ";
  static constexpr double kSmallestMeasure = 1e-12;  ///< below which x counts as this
  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("exponent", &PowerTime::exponent, "-", between(-20, 20),
                      "n; above 0 the branch slows down as the tissue deforms")
                    .must(),
                field("reference", &PowerTime::reference, "-", between(1e-6, 10),
                      "x₀, value of the measure at which the time is τ"),
                field("least", &PowerTime::least, "-", between(1e-9, 1), "factor on τ below which it does not fall"),
                field("most", &PowerTime::most, "-", between(1, 1e9), "factor on τ above which it does not rise"));
  }

  /// n, ln x₀, ln least, ln most
  std::array<double, 4> numbers() const { return {exponent, std::log(reference), std::log(least), std::log(most)}; }
  template <class C, class T>
  static ValueSlope<T> at(const C& numbers, T x);

  bool operator==(const PowerTime&) const = default;
};

using TimeLaw = std::variant<ExponentialTime, PowerTime>;

inline std::string_view law_name(const TimeLaw& law) {
  return std::visit([](const auto& l) { return l.kName; }, law);
}

/// φ at measure x: what a branch's time is multiplied by [-].
double time_factor(const TimeLaw& law, double x);

}  // namespace glisson

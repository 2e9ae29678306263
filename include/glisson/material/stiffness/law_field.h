// law_field.h — how a law describes its parameters to the scene reader and the documentation.
#pragma once

#include <limits>
#include <string_view>
#include <variant>
#include <vector>

namespace glisson {

/// One parameter of law `Law`: its key in a scene, the member it sets, unit, allowed range and meaning.
template <class Law>
struct LawField {
  std::string_view key;  ///< with its unit, e.g. "slope_Pa"
  std::variant<double Law::*, std::vector<double> Law::*> member;
  std::string_view unit;                                  ///< "Pa" makes it a modulus, which scales with the law
  double min = -std::numeric_limits<double>::infinity();  ///< inclusive
  double max = std::numeric_limits<double>::infinity();   ///< inclusive
  bool required = true;
  std::string_view help;
};

/// The smallest modulus that a law takes where it must be above 0 [Pa].
inline constexpr double kSmallestModulus = 1e-6;

/// κ of the hyperelastic laws, which all share κ/2 (J − 1)².
template <class Law>
constexpr LawField<Law> bulk_modulus_field() {
  return {.key = "bulk_modulus_Pa",
          .member = &Law::bulk_modulus,
          .unit = "Pa",
          .min = kSmallestModulus,
          .help = "κ; ν = (3κ − 2μ)/(6κ + 2μ), with κ = 50 μ nearly incompressible"};
}

}  // namespace glisson

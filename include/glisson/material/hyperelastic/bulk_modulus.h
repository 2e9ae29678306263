// bulk_modulus.h — κ of the hyperelastic laws, which all share κ/2 (J − 1)².
#pragma once

#include "glisson/field.h"

namespace glisson {

/// The smallest modulus that a law takes where it must be above 0 [Pa].
inline constexpr double kSmallestModulus = 1e-6;

template <class Law>
constexpr auto bulk_modulus_field() {
  return field("bulk_modulus", &Law::bulk_modulus, "Pa", at_least(kSmallestModulus),
               "κ; ν = (3κ − 2μ)/(6κ + 2μ), with κ = 50 μ nearly incompressible")
      .must();
}

}  // namespace glisson

// hyperelastic_law.h — the one list of laws that derive the stress from an energy of large deformation.
//
// Each is one file under hyperelastic/ with `kName`, `kHelp`, `fields` (its scene keys and messages), `check`,
// `shear_modulus`, and its energy W without κ/2 (J − 1)², as a function
//   of Ī₁ − 3 and Ī₂ − 3, Ī₁ = J^(−⅔) I₁ and Ī₂ = J^(−4/3) I₂:   energy(i1, i2), slopes(i1, i2)
//   or of the logarithms of λ̄_i = J^(−⅓) λ_i (Ogden):            energy(l), slopes(l)
// in a scalar T: double, or a number that carries a derivative (src/material/dual.h); the slopes of a law of the invariants
// in vectors of lanes too. These formulas are in src/material/hyperelastic_formulas.h.
#pragma once

#include <string_view>
#include <variant>

#include "glisson/material/hyperelastic/fung.h"
#include "glisson/material/hyperelastic/gent.h"
#include "glisson/material/hyperelastic/invariants.h"
#include "glisson/material/hyperelastic/mooney_rivlin.h"
#include "glisson/material/hyperelastic/neo_hookean.h"
#include "glisson/material/hyperelastic/ogden.h"
#include "glisson/material/hyperelastic/veronda_westmann.h"
#include "glisson/material/hyperelastic/yeoh.h"

namespace glisson {

using HyperelasticLaw = std::variant<NeoHookean, MooneyRivlin, Yeoh, Fung, VerondaWestmann, Ogden, Gent, Invariants>;

/// A law of the stretches; the others are of the invariants.
template <class Law>
concept StretchLaw = !requires {
  Law::kSecond;
};

inline std::string_view law_name(const HyperelasticLaw& law) {
  return std::visit([](const auto& l) { return l.kName; }, law);
}
/// μ at rest [Pa].
inline double shear_modulus(const HyperelasticLaw& law) {
  return std::visit([](const auto& l) { return l.shear_modulus(); }, law);
}
/// κ [Pa].
inline double bulk_modulus(const HyperelasticLaw& law) {
  return std::visit([](const auto& l) { return l.bulk_modulus; }, law);
}

}  // namespace glisson

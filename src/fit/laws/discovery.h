// discovery.h — laws of few terms, from which a fit finds the shortest that the data carry.
//
// Terms of both invariants (Invariants of glisson/material) with moduli ≥ 0, and principal stretches by Ogden's terms:
//
//   x₁, x₁², x₁³, exp x₁, exp x₁²,  x₂, x₂², exp x₂, exp x₂²,  x₁ x₂      every subset that has a modulus at rest
//   λ^α                                                                  one term, two, three
//
// Best subsets of each size, not a path of penalties: with so few terms all are fitted [LinkaKuhl2023] [Flaschel2021].
#pragma once

#include <string>
#include <vector>

#include "fit/spec/fit_spec.h"

namespace glisson::fit {

/// A law of the library.
struct TermLaw {
  int terms = 0;
  bool stretches = false;  ///< Ogden's terms; else of the invariants
  LawSpec law;
};

/// All laws of at most so many terms, short ones first. @param modulus  of the size of Young's at small strain [Pa], > 0
std::vector<TermLaw> term_laws(double modulus, int most_terms);

}  // namespace glisson::fit

// law_candidates.h — the laws that `--laws` knows by name, with bounds around the stiffness that the curves show.
#pragma once

#include <string>
#include <vector>

#include "fit/spec/fit_spec.h"

namespace glisson::fit {

/// What a law is called and what it is.
struct LawName {
  std::string name, what;
};
const std::vector<LawName>& known_laws();

/// A law by name as a candidate of a fit.
/// @param modulus  of the size of Young's modulus of the tissue at small strain [Pa], > 0; the bounds lie around it
/// @param specimen  homogeneous: a hyperelastic law may be as good as incompressible
/// @throws std::invalid_argument for a name that is not known, with the known ones
LawSpec law_candidate(const std::string& name, double modulus, bool specimen);

}  // namespace glisson::fit

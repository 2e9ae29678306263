// tissue_of_fit.h — the tissue before and after a fit: what its law is called, how stiff it is, the file that scenes take.
#pragma once

#include <string>

#include "fit/laws/law_search.h"
#include "glisson/fit.h"

namespace glisson::fit {

/// What the law of the fit's own parameters is called: the kind of the tissue's law.
std::string own_law_name(const FitSpec& spec);

/// Young's modulus at small strain of the fit's tissue as it is written [Pa].
double own_modulus(const FitSpec& spec);

/// The tissue with the fitted numbers.
Tissue fitted_tissue(const LawSearch& search);

/// keys.toml of a fit of heat: keys of the scene with the fitted numbers, and the same comments.
std::string keys_of_fit(const LawSearch& search, const FitResult& result, const FitSpec& spec);

/// tissue.toml: [tissue] with the fitted numbers, and comments that say what they were fitted to and how sure they are.
std::string tissue_of_fit(const LawSearch& search, const FitResult& result, const FitSpec& spec);

}  // namespace glisson::fit

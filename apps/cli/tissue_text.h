// tissue_text.h — a tissue's law in one line, for `glisson tissues` and `glisson check`.
#pragma once

#include <string>

#include "glisson/material/tissue.h"

namespace glisson::app {

/// `E = 3600 Pa, ν = 0.4, law: step, corotational, η = 1000 Pa·s`, or `ogden: mu_Pa = [842], …` with its relaxation.
std::string law_text(const Tissue& tissue);

}  // namespace glisson::app

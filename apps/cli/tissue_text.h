// tissue_text.h — tissues as texts: a law in one line for `glisson tissues` and `glisson check`, a tissue.toml read.
#pragma once

#include <filesystem>
#include <string>

#include "glisson/material/tissue.h"

namespace glisson::app {

/// `E = 3600 Pa, ν = 0.4, law: step, corotational, η = 1000 Pa·s`, or `ogden: mu_Pa = [842], …` with its relaxation.
std::string law_text(const Tissue& tissue);

/// The tissue of a scene's first variant; a text with [tissue] alone, as a fit writes it, will do.
/// @param name    of the file, for messages
/// @param folder  that files of the text are relative to
/// @throws as parse_scene
Tissue tissue_of_toml(std::string text, const std::string& name, const std::filesystem::path& folder);

}  // namespace glisson::app

// section_fit.h — the sections of FIT.toml.
#pragma once

#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "scene/parse/schema.h"

namespace glisson::fit {

const scene::SectionSpec& parameter_section();   ///< fills ParameterSpec
const scene::SectionSpec& search_section();      ///< fills SearchSpec
const scene::SectionSpec& proof_section();       ///< fills ProofSpec
const scene::SectionSpec& fit_law_section();     ///< fills LawSpec
const scene::SectionSpec& experiment_section();  ///< fills ExperimentSpec
const scene::SectionSpec& insertion_section();   ///< fills InsertionSpec
const scene::SectionSpec& fit_section();         ///< the whole file; fills FitSpec

/// The keys and values of a table as overrides of a scene. Nested tables become one override each.
std::vector<Override> overrides_of(const scene::Node& table, const std::string& prefix);

}  // namespace glisson::fit

// load_curves.h — the curves of a [[data]] section.
#pragma once

#include <filesystem>
#include <vector>

#include "fit/data/data_spec.h"
#include "fit/data/prepare.h"

namespace glisson::fit {

/// Reads, checks and prepares all files of a section.
/// @param size  of the specimens, where the section says none @param base  relative files start here
/// @return one for each file, in their order
/// @throws SceneError with what is wrong with any of the files, all of it, a line for each
std::vector<PreparedCurve> load_curves(const DataSpec& spec, const SpecimenSize& size,
                                       const std::filesystem::path& base);

}  // namespace glisson::fit

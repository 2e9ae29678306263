// load_curves.h — the curves of [[data]] sections, with one decision about contact for all sections of a test.
#pragma once

#include <filesystem>
#include <span>
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

/// Whether sections are of one test, fitted or held out: alike in what is done and measured, and in what is asked of contact.
bool of_one_test(const DataSpec& a, const DataSpec& b);

/// The curves of sections of one test. Where a curve's baseline has a slope, all of them are placed on one; where one begins
/// in contact, all are carried to zero alike. @return one list for each section @throws SceneError as above
std::vector<std::vector<PreparedCurve>> load_test(std::span<const DataSpec> tables, const SpecimenSize& size,
                                                  const std::filesystem::path& base);

}  // namespace glisson::fit

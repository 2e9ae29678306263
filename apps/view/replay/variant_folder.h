// variant_folder.h — where the frames of a variant are in what `glisson run` left.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glisson::view {

struct VariantFolder {
  std::filesystem::path path;         ///< holds frames.pvd
  std::string variant;                ///< its name
  std::vector<std::string> variants;  ///< that the run's folder holds
};

/// The folder of a variant: of the run that a folder holds, or the folder itself where it is that of a variant.
/// @param wanted  empty: the first that has frames
/// @throws std::invalid_argument with the way out where there is none
VariantFolder variant_folder(const std::filesystem::path& folder, const std::string& wanted);

}  // namespace glisson::view

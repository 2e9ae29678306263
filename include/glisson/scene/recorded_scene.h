// recorded_scene.h — one experiment of a scene as a scene of its own, whose tools go ways that were recorded.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson {

struct RecordedPaths {
  std::string head;                ///< comment lines for the top, without their #
  std::vector<std::string> files;  ///< of each tool, then of each instrument: a .csv as load_record reads it
  double duration = 0.0;           ///< [s]
  double sample_rate = 1000.0;     ///< [Hz]
};

/// The scene as TOML: variant and overrides laid out, motions replaced, the numbers of tissues those of `variant`.
/// @param text  of the scene @param name  stands for its file in messages @param base  where its relative paths start
/// @param variant  the experiment as it stands; its name tells which, its tissues what they are now
/// @throws SceneError for a scene that cannot be read
std::string recorded_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                           std::span<const Override> overrides, const Variant& variant, const RecordedPaths& ways);

}  // namespace glisson

// image_scene.h — the scene of an organ from a labelled image, as commented TOML.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glisson::app {

/// How the patient lies or stands.
enum class Posture { supine, prone, left, right, upright };

struct ImageSceneOptions {
  std::filesystem::path image;
  std::string organ = "liver";        ///< a word of [mesh] labels
  std::vector<std::string> labels;    ///< further regions of the body
  std::vector<std::string> implants;  ///< as [mesh] has them
  std::vector<std::string> beside;    ///< supports as [mesh] beside has them; empty: those known by their names
  Posture posture = Posture::supine;
  std::optional<double> press_mm;  ///< a finger presses so deep
  std::optional<double> edge_mm;   ///< none: three voxels
  double beside_mm = 10.0;
};

/// The text of a scene in a folder, from which the path of the image starts.
/// @throws std::invalid_argument for words without a label, numbers out of range, and an organ that nothing holds
std::string image_scene(const ImageSceneOptions& options, const std::filesystem::path& folder);

}  // namespace glisson::app

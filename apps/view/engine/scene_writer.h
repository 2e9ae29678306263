// scene_writer.h — a recording as files that `glisson run` goes again: the scene with ways in place of motions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/state/recording.h"
#include "view/state/snapshot.h"

namespace glisson::view {

/// @param scene     as it was opened; its source is what is written again
/// @param variant   the one that is shown
/// @param tools     of the source that is recorded
RecordingWriter recording_writer(Scene scene, Variant variant, std::vector<Override> overrides,
                                 std::vector<ToolInfo> tools);

/// The files of such an archive.
std::vector<ZipFile> recording_files(const Scene& scene, const Variant& variant, const std::vector<Override>& overrides,
                                     const std::vector<ToolInfo>& tools, std::shared_ptr<const Recording> recording,
                                     const std::vector<double>& parameters);

}  // namespace glisson::view

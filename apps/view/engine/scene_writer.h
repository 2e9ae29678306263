// scene_writer.h — a recording as files that `glisson run` goes again: the scene with ways in place of motions.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/engine/recording.h"
#include "view/engine/snapshot.h"

namespace glisson::view {

/// Names the files of a recording's archive: scene.toml, a way of each tool, forces.csv. Their contents are made when they are
/// asked for, by any thread. @param parameters  as the body has them now
using RecordingWriter =
    std::function<std::vector<ZipFile>(std::shared_ptr<const Recording>, const std::vector<double>& parameters)>;

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

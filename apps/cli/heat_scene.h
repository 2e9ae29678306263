// heat_scene.h — glisson run and glisson check of a scene of heat.
#pragma once

#include <filesystem>

#include "glisson/scene/scene.h"

namespace glisson::app {

/// Whether it is one of heat alone.
bool is_heat_scene(const Scene& scene);

/// Runs its variants, writes their files and the report into a folder that is ready, and says how they ended. @return the exit code
int run_heat_scene(const Scene& scene, const std::filesystem::path& folder, int threads, bool quiet,
                   const MeshLoader& load);

/// Builds its variants and says what they hold; nothing runs. @throws SceneError @return the exit code
int check_heat_scene(const Scene& scene, const MeshLoader& load);

}  // namespace glisson::app

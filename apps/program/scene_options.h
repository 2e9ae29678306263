// scene_options.h — the command-line options that say which scene is meant and what is changed in it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::app {

struct SceneOptions {
  std::string scene;
  std::vector<std::string> set;       ///< key=value each
  std::string mesh;                   ///< replaces the scene's mesh; empty: it does not
  std::vector<std::string> variants;  ///< the ones to run; empty: all
};

void add_scene_options(CLI::App& command, SceneOptions& options);

/// What --set and --mesh lay over a scene; the path of a mesh is absolute. @throws std::invalid_argument naming the option
std::vector<Override> overrides_of(const SceneOptions& options);

/// The scene with everything the options change in it; its source says so in a first comment.
/// @throws SceneError, std::invalid_argument naming the option
Scene open_scene(const SceneOptions& options);

/// Adds `--threads N`; the default is one per core.
void add_threads_option(CLI::App& command, int& threads);

}  // namespace glisson::app

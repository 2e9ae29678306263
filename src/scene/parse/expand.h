// expand.h — from one scene to its complete experiments as trees, and from such a tree to a Variant.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "glisson/scene/scene.h"
#include "scene/parse/document.h"
#include "scene/parse/problems.h"

namespace glisson::scene {

struct Expanded {
  Node scene;                  ///< the keys a scene has once
  Node base;                   ///< what all variants share; perhaps incomplete by itself
  std::vector<Node> variants;  ///< base, then the variant, then --set; one or more
};

/// Lays variants and overrides over the scene. In the result presets and files of tissues are what they stand for, and regions inherit
/// from [tissue].
/// @param base  folder that files of tissues are relative to
Expanded expand(const Node& root, std::span<const Override> overrides, const std::filesystem::path& base,
                Problems& problems);

/// Checks and reads one of these experiments; what is wrong goes to `problems`. In src/scene/scene.cpp.
/// @param base  where relative paths start
Variant read_variant(const Node& experiment, const std::filesystem::path& base, Problems& problems);

}  // namespace glisson::scene

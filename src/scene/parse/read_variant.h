// read_variant.h — from the tree of one experiment to a Variant; src/scene/scene.cpp.
#pragma once

#include <filesystem>

#include "glisson/scene/scene.h"
#include "scene/parse/problems.h"

namespace glisson::scene {

/// Checks and reads an experiment of expand(); what is wrong goes to `problems`.
/// @param base  where relative paths start
Variant read_variant(const Node& experiment, const std::filesystem::path& base, Problems& problems);

}  // namespace glisson::scene

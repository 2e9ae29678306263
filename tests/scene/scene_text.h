// scene_text.h — the small scene that tests start from, and what parsing it says.
#pragma once

#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::test {

/// A box pressed at its top: the least that is a scene, with nothing said twice.
inline const std::string kSmallScene = R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]

[sets.top]
side = { axis = "z", end = "upper", depth_m = 0 }

[[fixed]]
set = "z_min"

[[tool]]
name = "press"
set = "top"
depth_mm = 1
)";

inline Scene parse(const std::string& text, const std::vector<Override>& overrides = {}) {
  return parse_scene(text, "s.toml", "/scenes", overrides);
}

/// What is wrong with a scene; empty where nothing is.
inline std::string complaint(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    parse(text, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

}  // namespace glisson::test

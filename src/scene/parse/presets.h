// presets.h — tissues with a source, as trees of a scene's own keys.
//
//   preset_list.toml ─ text ─ trees ─┬─ the words of `tissue.preset`, before the tissue's section exists
//                                    ├─ what a table that names one starts from (expand.cpp)
//                                    └─ read by that section: tissue_presets() of glisson/scene/tissue_presets.h
#pragma once

#include <string_view>
#include <vector>

#include "scene/parse/schema.h"

namespace glisson::scene {

/// The text of preset_list.toml.
extern const std::string_view kPresetList;

/// What `tissue.preset` may be, each with what it is.
const std::vector<AllowedWord>& preset_words();

/// The tissue that a table means which names a preset: the preset's keys, and over them its own. The preset's name is
/// the tissue's where `named` and none is given. A table without a preset, or with one that does not exist, is left
/// as it is; the checker says what is wrong with it. Complains of a key that would drop the preset's hyperelastic law.
Node with_preset(const Node& tissue, bool named, const Place& place);

/// The same of `heat.tissue.preset`.
const std::vector<AllowedWord>& thermal_preset_words();
Node with_thermal_preset(const Node& tissue, const Place& place);

}  // namespace glisson::scene

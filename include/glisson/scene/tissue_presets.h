// tissue_presets.h — tissues with a source: the measurement, its method, and its validity.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "glisson/heat/thermal_tissue.h"
#include "glisson/material/tissue.h"

namespace glisson {

/// A tissue to start from, `[tissue] preset = "NAME"` in a scene.
struct TissuePreset {
  std::string name, what;  ///< one word, and what it is
  std::string source;      ///< the work, "[Key]: …", Key of docs/references.bib
  std::string fitted_to;   ///< the measurement: test, range, rate, result
  std::string validity;    ///< where it holds, and what the source leaves open
  std::string confirmed;   ///< the source that was checked
  Tissue tissue;
  std::string toml;  ///< the tissue as a scene's [tissue] table
};

/// All presets, in the order of the list.
const std::vector<TissuePreset>& tissue_presets();

/// The preset of that name. @throws std::invalid_argument naming the nearest one, or all
const TissuePreset& tissue_preset(std::string_view name);

/// What a tissue is to heat, `preset = "NAME"` of a [[heat.tissue]].
struct ThermalPreset {
  std::string name, what, source, confirmed;  ///< as above
  ThermalTissue tissue;
};

/// All of them, in the order of the list.
const std::vector<ThermalPreset>& thermal_presets();

/// The thermal tissue of that name. @throws std::invalid_argument naming all
const ThermalTissue& thermal_preset(std::string_view name);

}  // namespace glisson

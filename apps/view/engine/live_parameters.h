// live_parameters.h — the numbers of a variant's tissues that a page may change: E, ν, η, and what laws, fibres and Maxwell
// branches have by their own description.
//
// Each tissue has its own: that of the body and those of regions. A number keeps to a range about what the scene says.
#pragma once

#include <functional>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/state/snapshot.h"

namespace glisson::view {

struct TissueParameter {
  ParameterInfo info;
  std::size_t tissue = 0;                 ///< 0: the body's, else that of region tissue − 1
  std::function<double*(Tissue&)> place;  ///< of the number in a tissue of this kind
};

/// All of a variant, those of the body first.
std::vector<TissueParameter> tissue_parameters(const Variant& variant);

/// Writes a number, kept within its range, into the variant it is of. @return what was written
double set_parameter(Variant& variant, const TissueParameter& parameter, double value);

}  // namespace glisson::view

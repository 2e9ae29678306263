// law_data.h — what a tissue's law says, as the report plots it: moduli against deformation, stress against stretch and shear.
#pragma once

#include <nlohmann/json.hpp>

#include "glisson/scene/scene.h"

namespace glisson {

/// LawData[] of web/src/report_data.ts: E(x), or λ(x) and μ(x), of the tissue and of every region, then their stresses.
/// @param reach  largest measure worth showing [-], > 0; widened where a law's own points lie beyond it
nlohmann::json law_data(const Variant& variant, double reach);

/// LawData[] of one tissue: nominal stress against stretch along z with free sides, and against the amount of simple shear; at
/// once and, with Maxwell branches, relaxed. Empty where the tissue's measure depends on the mesh.
nlohmann::json stress_data(const Tissue& tissue);

/// The measure up to which this variant's laws have something to show [-]: beyond a threshold, a table's last point.
double law_reach(const Variant& variant);

}  // namespace glisson

// law_data.h — the moduli of a variant against its measure of deformation, as the report plots them.
#pragma once

#include <nlohmann/json.hpp>

#include "glisson/scene/scene.h"

namespace glisson {

/// LawData of web/src/report_data.ts: E(x), or λ(x) and μ(x), of the tissue and of every region.
/// @param reach  largest measure worth showing [-], > 0; widened where a law's own points lie beyond it
nlohmann::json law_data(const Variant& variant, double reach);

/// The measure up to which this variant's laws have something to show [-]: beyond a threshold, a table's last point.
double law_reach(const Variant& variant);

}  // namespace glisson

// field_values.h — numbers that colour a body in pages: scalars of the stress, means at vertices, a field as bytes.
//
// The report, frames and the live view show the same fields; what a number of a picture means is written here once.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// p = −⅓ tr σ of each tet [Pa]: positive in compression. @param stress  xx, yy, zz, xy, yz, zx of each tet [Pa]
std::vector<double> pressure_of(std::span<const double> stress);
/// Von Mises' stress of each tet [Pa].
std::vector<double> von_mises_of(std::span<const double> stress);

/// The mean of `values` over the tets around each vertex; 0 at one without tets. @param removed  whether a tet is gone
std::vector<double> vertex_means(const TetMesh& mesh, std::span<const double> values,
                                 const std::function<bool(std::uint32_t)>& removed);

/// FieldData of web/src/report_data.ts: values as 8-bit fractions of their range, in which 0 lies.
nlohmann::json field_json(std::span<const double> values);

}  // namespace glisson

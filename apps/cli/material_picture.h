// material_picture.h — the curve of a tissue as a page with charts.
#pragma once

#include <string>

#include "cli/material_tests.h"

namespace glisson::app {

/// SceneData of web/src/report_data.ts made into the report page: charts, and the table under them where it is not long.
std::string material_page(const MaterialOptions& options, const Tissue& tissue, const MaterialResult& result);

}  // namespace glisson::app

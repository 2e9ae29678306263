// scene_checks.h — the checks of a scene, held against its runs; and the places of its maps.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "report/check_result.h"
#include "report/variant_recorder.h"

namespace glisson {

/// CheckData of web/src/report_data.ts.
nlohmann::json check_json(const std::string& what, const std::string& measured, const std::string& expected, bool pass);

/// @param of  label of the variant; may be empty
nlohmann::json check_json(const CheckResult& result, const std::string& of);

/// One CheckData for each check and variant that it names; a run that has not finished does not pass, nor a column that is not there.
nlohmann::json scene_checks(const Scene& scene, const std::vector<const VariantRecorder*>& variants);

/// MapData of web/src/report_data.ts: of each variant the places (x, y), told apart to 0.1 mm (or 1e-4 of another unit), and the
/// largest value at each, those left out where it is never above 0; in display units.
nlohmann::json map_json(const ChartSpec& chart, const std::vector<const VariantRecorder*>& variants);

}  // namespace glisson

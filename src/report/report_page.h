// report_page.h — report.html: one self-contained page made of the built template and the data of the runs.
//
// The data follow web/src/report_data.ts. Text of users (titles, scene sources) cannot leave its place in the
// page: every "<" of the JSON is written as \u003c.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/scene/scene.h"
#include "report/variant_recorder.h"

namespace glisson {

/// Where the JSON goes in the template; it occurs once.
inline constexpr std::string_view kDataToken = "/*GLISSON_DATA*/";

/// ChartSpec of web/src/report_data.ts.
nlohmann::json chart_json(const ChartSpec& chart);

/// What a page says of a scene beyond its runs and its own charts; JSON as in web/src/report_data.ts.
struct SceneExtras {
  nlohmann::json first_charts = nlohmann::json::array();  ///< before the scene's own
  nlohmann::json charts = nlohmann::json::array();        ///< after them
  nlohmann::json tables = nlohmann::json::array();
  nlohmann::json checks = nlohmann::json::array();
};

/// SceneData: the scene and those of its variants that were started.
nlohmann::json scene_json(const Scene& scene, const std::vector<const VariantRecorder*>& variants,
                          const SceneExtras& extras = {});

/// The same of variants and charts that are JSON already, whatever kind of runs they are of.
nlohmann::json scene_json(const Scene& scene, nlohmann::json variants, nlohmann::json charts,
                          const SceneExtras& extras);

/// ReportData with the version, the time and the machine filled in.
nlohmann::json report_json(const std::string& title, const std::string& subtitle, nlohmann::json scenes);

/// The page: the template with the data in place of its token.
/// @throws std::logic_error where the template does not hold the token exactly once (a broken build)
std::string report_page(std::string_view page_template, const nlohmann::json& report);

/// e.g. "2 × AMD EPYC 9R14".
std::string machine_text();

}  // namespace glisson

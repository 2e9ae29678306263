// report_page.cpp — see report_page.h.
#include "report/report_page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "glisson/version.h"
#include "report/heat_recorder.h"
#include "report/json_text.h"
#include "report/law_data.h"
#include "report/scene_checks.h"
#include "report/summary_json.h"

namespace glisson {
namespace {

constexpr double kLawReachAtLeast = 0.3;  // of the law's plot where the tissue was hardly deformed [-]

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos && colon + 2 < line.size()) return line.substr(colon + 2);
  }
  return "processor";
}

/// One plot for all variants of a scene: as far as the most deformed tissue or the farthest law goes.
double common_law_reach(const std::vector<const VariantRecorder*>& variants) {
  double reach = kLawReachAtLeast;
  for (const VariantRecorder* v : variants) {
    reach = std::max({reach, 1.1 * v->intensity_max(), law_reach(v->variant())});
  }
  return std::min(reach, 1.2);  // s cannot exceed √1.5
}

/// AdviceData of web/src/report_data.ts: what is said of several variants alike stands once, warnings first.
nlohmann::json scene_advice(const Scene& scene, const std::vector<const VariantRecorder*>& variants) {
  std::vector<nlohmann::json> all;
  const auto add = [&](const Advice& advice, const std::string& label) {
    nlohmann::json one(advice_json(advice));
    for (const char* key : {"about", "name"}) one.erase(key);
    auto same = std::find_if(all.begin(), all.end(), [&](const nlohmann::json& x) { return x["text"] == one["text"]; });
    if (same == all.end()) {
      one["variants"] = nlohmann::json::array();
      same = all.insert(all.end(), std::move(one));
    }
    if (!label.empty()) (*same)["variants"].push_back(label);
  };
  for (const VariantRecorder* v : variants) {
    for (const Advice& one : v->advice()) add(one, v->variant().label.empty() ? v->variant().name : v->variant().label);
  }
  for (const Advice& one : advise_on_laws(scene.variants)) add(one, "");
  std::stable_partition(all.begin(), all.end(), [](const nlohmann::json& x) { return x["kind"] == "warning"; });
  return all;
}

nlohmann::json axis_json(const AxisSpec& axis) {
  return {{"column", axis.column}, {"label", axis.label}, {"scale", axis.scale}};
}

}  // namespace

nlohmann::json chart_json(const ChartSpec& chart) {
  nlohmann::json json{
      {"title", chart.title}, {"x", axis_json(chart.x)}, {"y", axis_json(chart.y)}, {"variants", nullptr}};
  if (!chart.variants.empty()) json["variants"] = chart.variants;
  for (const MeasuredSpec& m : chart.measured) json["points"].push_back({{"label", m.label}, {"x", m.xs}, {"y", m.ys}});
  return json;
}

std::string machine_text() {
  return fmt::format("{} × {}", std::max(1u, std::thread::hardware_concurrency()), processor_name());
}

nlohmann::json scene_json(const Scene& scene, nlohmann::json variants, nlohmann::json charts,
                          const SceneExtras& extras) {
  const std::string name = scene.file.stem().string();
  return {{"name", name},
          {"title", scene.title.empty() ? name : scene.title},
          {"description", scene.description},
          {"notes", scene.notes},
          {"advice", nlohmann::json::array()},
          {"source", scene.source},
          {"variants", std::move(variants)},
          {"charts", std::move(charts)},
          {"tables", extras.tables},
          {"checks", extras.checks}};
}

nlohmann::json scene_json(const Scene& scene, const std::vector<const VariantRecorder*>& variants,
                          const SceneExtras& extras) {
  const double reach = common_law_reach(variants);
  nlohmann::json list = nlohmann::json::array();
  for (const VariantRecorder* v : variants) list.push_back(v->json(reach));
  nlohmann::json charts = extras.first_charts;
  for (const ChartSpec& chart : scene.charts) {
    charts.push_back(chart_json(chart));
    if (!chart.value.column.empty()) charts.back()["map"] = map_json(chart, variants);
  }
  for (const nlohmann::json& chart : extras.charts) charts.push_back(chart);
  for (const VariantRecorder* v : variants) {
    if (v->heat() == nullptr) continue;
    for (const nlohmann::json& chart : v->heat()->charts(variants.size() == 1)) charts.push_back(chart);
  }
  nlohmann::json page = scene_json(scene, std::move(list), std::move(charts), extras);
  page["advice"] = scene_advice(scene, variants);
  return page;
}

nlohmann::json report_json(const std::string& title, const std::string& subtitle, nlohmann::json scenes) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"format", 1},
          {"title", title},
          {"subtitle", subtitle},
          {"version", GLISSON_VERSION},
          {"created", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))},
          {"machine", machine_text()},
          {"scenes", std::move(scenes)}};
}

std::string report_page(std::string_view page_template, const nlohmann::json& report) {
  const std::size_t at = page_template.find(kDataToken);
  if (at == std::string_view::npos || page_template.find(kDataToken, at + 1) != std::string_view::npos) {
    throw std::logic_error("the report template of this build does not hold its data token exactly once");
  }
  const std::string data = json_text(report);
  std::string page;
  page.reserve(page_template.size() + data.size() + data.size() / 64);
  page += page_template.substr(0, at);
  for (const char c : data) {
    if (c == '<')
      page += "\\u003c";
    else
      page += c;
  }
  page += page_template.substr(at + kDataToken.size());
  return page;
}

}  // namespace glisson

// scene_checks.cpp — see scene_checks.h.
#include "report/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace glisson {
namespace {

constexpr double kPlaces = 1e-4;  // places of a map closer than this are one, in the unit of its columns

bool is_meant(const std::vector<std::string>& names, const VariantRecorder& run) {
  return names.empty() || std::find(names.begin(), names.end(), run.variant().name) != names.end();
}

}  // namespace

nlohmann::json check_json(const std::string& what, const std::string& measured, const std::string& expected,
                          bool pass) {
  return {{"what", what}, {"measured", measured}, {"expected", expected}, {"pass", pass}};
}

nlohmann::json check_json(const CheckResult& result, const std::string& of) {
  return check_json(of.empty() ? result.name : of + ": " + result.name, result.measured_text, result.expected_text,
                    result.ok);
}

nlohmann::json scene_checks(const Scene& scene, const std::vector<const VariantRecorder*>& variants) {
  nlohmann::json list = nlohmann::json::array();
  for (const CheckSpec& check : scene.checks) {
    for (const VariantRecorder* run : variants) {
      if (!is_meant(check.variants, *run)) continue;
      const auto column = [run](const std::string& name) -> const std::vector<double>& { return run->column(name); };
      list.push_back(check_json(check_result(check, run->summary().end == RunSummary::End::finished, column),
                                scene.variants.size() == 1 ? "" : run->variant().label));
    }
  }
  return list;
}

nlohmann::json map_json(const ChartSpec& chart, const std::vector<const VariantRecorder*>& variants) {
  nlohmann::json maps = nlohmann::json::array();
  for (const VariantRecorder* run : variants) {
    if (!is_meant(chart.variants, *run)) continue;
    const std::vector<double>&x = run->column(chart.x.column), &y = run->column(chart.y.column),
          &value = run->column(chart.value.column);
    std::map<std::pair<long long, long long>, std::size_t> largest;  // the sample that is it, by its place
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!(value[i] > 0.0)) continue;
      const auto [at, fresh] = largest.try_emplace({std::llround(x[i] / kPlaces), std::llround(y[i] / kPlaces)}, i);
      if (!fresh && value[i] > value[at->second]) at->second = i;
    }
    nlohmann::json::array_t xs, ys, values;
    for (const auto& [place, i] : largest) {
      xs.push_back(x[i] * chart.x.scale);
      ys.push_back(y[i] * chart.y.scale);
      values.push_back(value[i] * chart.value.scale);
    }
    maps.push_back({{"variant", run->variant().name},
                    {"label", run->variant().label.empty() ? run->variant().name : run->variant().label},
                    {"x", std::move(xs)},
                    {"y", std::move(ys)},
                    {"value", std::move(values)}});
  }
  return {{"label", chart.value.label}, {"of", std::move(maps)}};
}

}  // namespace glisson

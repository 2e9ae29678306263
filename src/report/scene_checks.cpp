// scene_checks.cpp — see scene_checks.h.
#include "report/scene_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace glisson {
namespace {

constexpr double kPlaces = 1e-4;  // places of a map closer than this are one, in the unit of its columns

bool is_meant(const std::vector<std::string>& names, const VariantRecorder& run) {
  return names.empty() || std::find(names.begin(), names.end(), run.variant().name) != names.end();
}

double value_at(CheckSpec::At at, const std::vector<double>& values) {
  switch (at) {
    case CheckSpec::At::end:
      return values.back();
    case CheckSpec::At::largest:
      return *std::max_element(values.begin(), values.end());
    case CheckSpec::At::least:
      return *std::min_element(values.begin(), values.end());
    case CheckSpec::At::peak:
      break;
  }
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return std::abs(*std::max_element(values.begin(), values.end(), smaller));
}

std::string bounds_text(const CheckSpec& check) {
  if (check.at_least && check.at_most) return fmt::format("{:.4g} to {:.4g}", *check.at_least, *check.at_most);
  return check.at_least ? fmt::format("at least {:.4g}", *check.at_least)
                        : fmt::format("at most {:.4g}", *check.at_most);
}

nlohmann::json checked(const CheckSpec& check, const VariantRecorder& run, bool one) {
  const std::string what = one ? check.what : run.variant().label + ": " + check.what;
  const std::string expected = bounds_text(check);
  if (run.summary().end != RunSummary::End::finished)
    return check_json(what, "the run did not finish", expected, false);
  try {
    const std::vector<double>& values = run.column(check.column);
    if (values.empty()) return check_json(what, check.column + " has no values", expected, false);
    const double value = value_at(check.at, values);
    const bool pass = (!check.at_least || value >= *check.at_least) && (!check.at_most || value <= *check.at_most);
    return check_json(what, fmt::format("{:.4g} ({}, {})", value, check.column, word_of(check.at)), expected, pass);
  } catch (const std::out_of_range& error) {
    return check_json(what, error.what(), expected, false);
  }
}

}  // namespace

nlohmann::json check_json(const std::string& what, const std::string& measured, const std::string& expected,
                          bool pass) {
  return {{"what", what}, {"measured", measured}, {"expected", expected}, {"pass", pass}};
}

nlohmann::json scene_checks(const Scene& scene, const std::vector<const VariantRecorder*>& variants) {
  nlohmann::json list = nlohmann::json::array();
  for (const CheckSpec& check : scene.checks) {
    for (const VariantRecorder* run : variants) {
      if (is_meant(check.variants, *run)) list.push_back(checked(check, *run, scene.variants.size() == 1));
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

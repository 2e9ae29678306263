#include "cli/material_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/tissue_text.h"
#include "program/embedded.h"
#include "report/report_page.h"

namespace glisson::app {
namespace {

constexpr std::size_t kLongTable = 200;  // lines; more are for --csv

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  if (name.starts_with("cauchy")) name.front() = 'C';
  return name;
}

/// A unit in which numbers read well, and what one SI unit is in it.
struct Display {
  std::string unit;
  double factor = 1.0;
};

Display display_of(const std::string& unit, double largest) {
  if (unit != "Pa" && unit != "N" && unit != "N m") return {unit};
  constexpr std::pair<double, const char*> kPrefixes[] = {{1e6, "M"},  {1e3, "k"},  {1.0, ""},
                                                          {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  for (const auto& [size, prefix] : kPrefixes) {
    if (largest >= 0.9995 * size) return {prefix + unit, 1.0 / size};
  }
  return {unit};
}

Display display_of(const MaterialResult& result, std::span<const std::size_t> columns) {
  double largest = 0.0;
  for (const std::size_t k : columns) {
    for (const double x : result.columns[k].values) largest = std::max(largest, std::abs(x));
  }
  return display_of(result.columns[columns.front()].unit, largest);
}

std::vector<double> scaled(const Column& column, double factor, bool from_rest) {
  std::vector<double> values;
  if (from_rest) values.push_back(factor * column.rest);
  std::transform(column.values.begin(), column.values.end(), std::back_inserter(values),
                 [factor](double x) { return factor * x; });
  return values;
}

nlohmann::json axis_json(const std::string& name, const Display& display) {
  return {{"column", name}, {"label", name + " [" + (display.unit.empty() ? "-" : display.unit) + "]"}, {"scale", 1.0}};
}

/// ChartSpec.
nlohmann::json chart_json(const MaterialChart& chart, const MaterialResult& result) {
  const Display x = display_of(result, {&chart.x, 1}), y = display_of(result, chart.y);
  nlohmann::json lines = nlohmann::json::array();
  for (const std::size_t k : chart.y) {
    const Column& column = result.columns[k];
    lines.push_back({{"label", words(column.name)},
                     {"x", scaled(result.columns[chart.x], x.factor, chart.from_rest)},
                     {"y", scaled(column, y.factor, chart.from_rest)}});
  }
  return {{"title", chart.title},
          {"x", axis_json(words(result.columns[chart.x].name), x)},
          {"y", axis_json(chart.y.size() == 1 ? words(result.columns[chart.y.front()].name) : chart.y_name, y)},
          {"variants", nlohmann::json::array()},
          {"lines", std::move(lines)},
          {"log_x", chart.log_x}};
}

/// TableData.
nlohmann::json table_json(const MaterialResult& result) {
  nlohmann::json names = nlohmann::json::array(), rows = nlohmann::json::array();
  for (const Column& c : result.columns) names.push_back(words(c.name) + (c.unit.empty() ? "" : " [" + c.unit + "]"));
  for (std::size_t row = 0; row < result.columns.front().values.size(); ++row) {
    nlohmann::json cells = nlohmann::json::array();
    for (const Column& c : result.columns) cells.push_back(c.values[row]);
    rows.push_back(std::move(cells));
  }
  return {{"title", "Numbers"}, {"columns", std::move(names)}, {"rows", std::move(rows)}, {"note", result.trouble}};
}

}  // namespace

std::string material_page(const MaterialOptions& options, const Tissue& tissue, const MaterialResult& result) {
  nlohmann::json charts = nlohmann::json::array(), tables = nlohmann::json::array();
  for (const MaterialChart& chart : result.charts) charts.push_back(chart_json(chart, result));
  if (result.columns.front().values.size() <= kLongTable) tables.push_back(table_json(result));
  const std::string title = tissue.name + ": " + words(options.test);
  nlohmann::json scene{{"name", tissue.name},
                       {"title", title},
                       {"description", law_text(tissue) + (result.words.empty() ? "" : "\n\n" + result.words)},
                       {"notes", nlohmann::json::array()},
                       {"source", ""},
                       {"variants", nlohmann::json::array()},
                       {"charts", std::move(charts)},
                       {"tables", std::move(tables)},
                       {"checks", nlohmann::json::array()}};
  return report_page(report_template(), report_json(title, "a test of the material", {std::move(scene)}));
}

}  // namespace glisson::app

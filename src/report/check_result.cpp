#include "report/check_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace glisson {
namespace {

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
  if (check.expected) return fmt::format("{:.6g} ± {:.3g}", *check.expected, *check.tolerance);
  if (check.at_least && check.at_most) return fmt::format("{:.4g} to {:.4g}", *check.at_least, *check.at_most);
  return check.at_least ? fmt::format("at least {:.4g}", *check.at_least)
                        : fmt::format("at most {:.4g}", *check.at_most);
}

CheckResult what_is_expected(const CheckSpec& check) {
  CheckResult result;
  result.name = check.what, result.expected_text = bounds_text(check);
  if (check.expected) {
    result.bound = "within", result.expected = *check.expected, result.tolerance = check.tolerance;
  } else if (check.at_least && check.at_most) {
    result.bound = "within", result.expected = std::midpoint(*check.at_least, *check.at_most);
    result.tolerance = 0.5 * (*check.at_most - *check.at_least);
  } else {
    result.bound = check.at_least ? "at_least" : "at_most";
    result.expected = check.at_least ? *check.at_least : *check.at_most;
  }
  return result;
}

}  // namespace

CheckResult check_result(const CheckSpec& check, bool finished, const ColumnOf& column) {
  CheckResult result = what_is_expected(check);
  if (!finished) {
    result.measured_text = "the run did not finish";
    return result;
  }
  try {
    std::vector<double> values = column(check.column);
    std::string name = check.column;
    if (!check.over.empty()) {
      const std::vector<double>& over = column(check.over);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] /= over[i];
      name += " / " + check.over;
    }
    if (values.empty()) {
      result.measured_text = name + " has no values";
      return result;
    }
    const double value = value_at(check.at, values);
    result.measured = value;
    result.measured_text = fmt::format("{:.4g} ({}, {})", value, name, word_of(check.at));
    result.ok = (!check.at_least || value >= *check.at_least) && (!check.at_most || value <= *check.at_most);
  } catch (const std::out_of_range& error) {
    result.measured_text = error.what();
  }
  return result;
}

std::vector<CheckSpec> checks_of(const Scene& scene, const std::string& variant) {
  std::vector<CheckSpec> checks;
  for (const CheckSpec& check : scene.checks) {
    const auto& names = check.variants;
    if (names.empty() || std::find(names.begin(), names.end(), variant) != names.end()) checks.push_back(check);
  }
  return checks;
}

nlohmann::ordered_json checks_json(const std::vector<CheckSpec>& checks, bool finished, const ColumnOf& column) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CheckSpec& check : checks) {
    const CheckResult result = check_result(check, finished, column);
    nlohmann::ordered_json one{{"name", result.name}, {"measured", nullptr}, {"expected", result.expected}};
    if (result.measured && std::isfinite(*result.measured)) one["measured"] = *result.measured;
    one["tolerance"] = nullptr;
    if (result.tolerance) one["tolerance"] = *result.tolerance;
    one["bound"] = result.bound;
    one["ok"] = result.ok;
    if (!result.measured) one["trouble"] = result.measured_text;
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace glisson

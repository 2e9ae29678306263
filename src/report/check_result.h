// check_result.h — a [[check]] of a scene held against a run: as numbers for summary.json, in words for the page and the terminal.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson {

struct CheckResult {
  std::string name;                 ///< CheckSpec::what
  std::optional<double> measured;   ///< none: the run did not finish, or has no such column
  double expected = 0.0;            ///< the middle of two bounds, or the one bound
  std::optional<double> tolerance;  ///< to both sides; none: there is one bound
  std::string bound;                ///< "within", "at_least", "at_most"
  bool ok = false;
  std::string measured_text, expected_text;
};

/// The values of a column of a run. @throws std::out_of_range naming one that is not there
using ColumnOf = std::function<const std::vector<double>&(const std::string& name)>;

CheckResult check_result(const CheckSpec& check, bool finished, const ColumnOf& column);

/// The checks of a scene that a variant is held to.
std::vector<CheckSpec> checks_of(const Scene& scene, const std::string& variant);

/// `checks` of summary.json.
nlohmann::ordered_json checks_json(const std::vector<CheckSpec>& checks, bool finished, const ColumnOf& column);

}  // namespace glisson

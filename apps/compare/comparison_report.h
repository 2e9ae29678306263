// comparison_report.h — a comparison as text, JSON and a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/comparison.h"

namespace glisson::app {

/// A row a run, then what the target's error costs each model.
std::string comparison_table(const Comparison& comparison);
nlohmann::ordered_json comparison_json(const Comparison& comparison, const std::string& scene);
std::string comparison_page(const Comparison& comparison);

/// What a row has no error of, and why.
std::string note_of(const ComparedRow& row);

}  // namespace glisson::app

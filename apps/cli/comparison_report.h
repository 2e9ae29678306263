// comparison_report.h — a comparison as text, JSON and a page.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "compare/comparison.h"

namespace glisson::app {

/// Of each variant a row a run and what the target's error costs each model; of several, a row a model with the errors of all.
std::string comparison_table(std::span<const Comparison> comparisons);
nlohmann::ordered_json comparison_json(std::span<const Comparison> comparisons, const std::string& scene);
std::string comparison_page(std::span<const Comparison> comparisons);

/// What a row has no error of, and why.
std::string note_of(const ComparedRow& row);

}  // namespace glisson::app

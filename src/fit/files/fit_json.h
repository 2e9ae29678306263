// fit_json.h — fit.json, and the same for the report page: FitData of web/src/report_data.ts.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "glisson/fit.h"

namespace glisson {

/// What the page says of a fit beside its numbers.
struct FitHeading {
  std::string name, title, description;
  std::vector<std::string> notes;
  std::string source;  ///< FIT.toml
};

/// The object of fit.json; numbers that could not be found are null.
nlohmann::ordered_json fit_json(const fit::FitResult& result, const FitHeading& heading);

}  // namespace glisson

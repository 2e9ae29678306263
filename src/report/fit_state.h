// fit_state.h — fit.state.json: what an interrupted fit knows, so that it goes on where it was.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fit/run_fit.h"

namespace glisson {

/// A number for everything a fit's steps depend on: description, scene, curves, laws, version.
std::string fit_fingerprint(const fit::FitSpec& spec, const fit::FitOptions& options);

/// Replaces the file in one move. @throws OutputError
void write_fit_state(const std::filesystem::path& file, const std::string& fingerprint, const fit::FitMemory& memory);

/// None where there is no such file, it cannot be read, or it is of another fit.
std::optional<fit::FitMemory> read_fit_state(const std::filesystem::path& file, const std::string& fingerprint);

}  // namespace glisson

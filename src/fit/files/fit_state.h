// fit_state.h — fit.state.json: what an interrupted fit knows, so that it goes on where it was.
//
//   {"format": 2, "fingerprint": of the fit, "laws": {NAME: {"starts": […], "forward", "speedup"}}, "checksum": FNV-1a}
//
// What it says becomes part of the result, so it is believed only as far as it is what was written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fit/spec/fit_run.h"
#include "fit/spec/fit_spec.h"

namespace glisson {

/// A number for everything a fit's steps depend on: description, scene, curves, laws, version.
std::string fit_fingerprint(const fit::FitSpec& spec, const fit::FitRun& options);

/// Replaces the file in one move. @throws OutputError
void write_fit_state(const std::filesystem::path& file, const std::string& fingerprint, const fit::FitMemory& memory);

/// None where there is no such file, or it is of another fit or version.
/// @throws std::invalid_argument where it is damaged: it cannot be read, its checksum is wrong, a list is missing or of another
/// length; says what to do
std::optional<fit::FitMemory> read_fit_state(const std::filesystem::path& file, const std::string& fingerprint);

}  // namespace glisson

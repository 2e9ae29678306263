// option_check.h — values of options within a range or a list, and what is said of others: as of the keys of a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "glisson/field.h"

namespace glisson::app {

enum class Numbers { whole, all };

/// `80000 is outside the allowed range, 0 to 65535; 0 takes any free port`.
/// @param way_out  what to do about another value; empty: the range says it
CLI::Validator within(const Range& range, Numbers numbers, const std::string& way_out = {});

/// `"avx9" is none of avx2, sse4; did you mean avx2?`.
CLI::Validator one_of(std::vector<std::string> words);

/// What is wrong with a command line, with the command's help as the way out: for CLI::App::failure_message.
std::string option_fault(const CLI::App* program, const CLI::Error& error);

}  // namespace glisson::app

// json_option.h — `--json FILE`, checked before minutes of measuring are spent.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace glisson::app {

/// Adds the option; a folder that does not exist is an error of the command line.
void add_json_option(CLI::App& command, std::string& file);

/// Of a file that will be written: what is wrong with its place, or an empty text.
std::string file_place(const std::string& file);

/// Replaces the file in one move; nothing where `file` is empty. @throws OutputError
void keep_json(const std::string& file, const nlohmann::ordered_json& json);
/// The same, and says so.
void write_json(const std::string& file, const nlohmann::ordered_json& json);

}  // namespace glisson::app

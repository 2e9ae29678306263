// json_option.cpp — see json_option.h.
#include "program/json_option.h"

#include <fmt/format.h>

#include <filesystem>

#include "program/standard_streams.h"
#include "report/json_text.h"
#include "report/output_file.h"

namespace glisson::app {
namespace fs = std::filesystem;

std::string file_place(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  if (fs::is_directory(file)) return fmt::format("{} is a folder; name a file in it", file);
  if (folder.empty() || fs::is_directory(folder)) return {};
  return fmt::format("the folder {} does not exist; create it first", folder.string());
}

void add_json_option(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "write the result to this file too")->type_name("FILE")->check(file_place);
}

void keep_json(const std::string& file, const nlohmann::ordered_json& json) {
  if (!file.empty()) write_whole(file, json_text(json, 2) + "\n");
}

void write_json(const std::string& file, const nlohmann::ordered_json& json) {
  keep_json(file, json);
  if (!file.empty()) say("written: {}\n", file);
}

}  // namespace glisson::app

#include "scene/parse/result_names.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace glisson::scene {
namespace {

constexpr std::size_t kLongestName = 80;

constexpr std::array<std::string_view, 18> kResults{
    ".glisson",       "report.html", "scene.toml",      "fit.toml",   "compare.json", "fit.json",
    "fit.state.json", "tissue.toml", "summary.json",    "forces.csv", "probes.csv",   "events.csv",
    "frames.pvd",     "view.jsonl",  "temperature.csv", "heat.csv",   "keys.toml",    "membranes.toml"};

bool is_around(std::string_view name, std::string_view begin, std::string_view end) {
  return name.size() > begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end);
}

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_frame(std::string_view name) {
  constexpr std::string_view kBegin = "frame_", kEnd = ".vtu";
  return is_around(name, kBegin, kEnd) &&
         is_number(name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size()));
}

/// The surface of an instrument beside a frame, `tool_NAME_0001.vtp`, or their collection, `tool_NAME.pvd`.
bool is_tool_surface(std::string_view name) {
  constexpr std::string_view kBegin = "tool_", kEnd = ".vtp";
  if (is_around(name, kBegin, ".pvd")) return true;
  if (!is_around(name, kBegin, kEnd)) return false;
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  const std::size_t number = name.rfind('_');
  return number != std::string_view::npos && number > 0 && is_number(name.substr(number + 1));
}

/// A complaint about a name that a run's own file or folder may have; else empty.
std::string reserved(const std::string& name) {
  if (!is_result_file(folded(name)) && folded(name) != "frames") return {};
  return "\"" + name + "\" is the name of a file or folder that glisson itself writes; choose another";
}

std::string of_wrong_length(const std::string& name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestName) return "is longer than " + std::to_string(kLongestName) + " characters";
  return {};
}

}  // namespace

std::string folded(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool is_result_file(std::string_view name) {
  const bool fixed = std::find(kResults.begin(), kResults.end(), name) != kResults.end();
  return fixed || is_around(name, "forces_", ".csv") || is_frame(name) || is_tool_surface(name) ||
         is_around(name, "", ".part");
}

std::string unfit_as_folder(const std::string& name) {
  const auto plain = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-' || c == '.'); };
  if (std::string length = of_wrong_length(name); !length.empty()) return length;
  if (!std::all_of(name.begin(), name.end(), plain) || name.front() == '.' || name.front() == '-') {
    return "\"" + name + "\" cannot be a folder; use letters, digits, `_`, `-` and `.`, a letter or digit first";
  }
  if (name.back() == '.') return "\"" + name + "\" ends with a dot, which some file systems drop; choose another";
  return reserved(name);
}

std::string unfit_as_table(const std::string& name) {
  constexpr std::string_view kUnfit = "/\\:*?\"<>|,";
  if (std::string length = of_wrong_length(name); !length.empty()) return length;
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
    return "holds a control character, and it becomes part of a file's name; use letters, digits, blanks, `_`, `-`";
  if (name.find_first_of(kUnfit) != std::string::npos || name == "." || name == "..")
    return "\"" + name +
           "\" cannot be part of a file's name and of a row of events.csv; leave out / \\ : * ? \" < > | ,";
  return reserved(name);
}

}  // namespace glisson::scene

#include "scene/describe/reference_sections.h"

#include "scene/parse/allowed_range.h"

namespace glisson::scene {
namespace {

std::string code(const std::string& text) {
  std::string result("`");
  return result.append(text).append("`");
}

std::string type_of(const KeySpec& key) {
  if (key.type == ValueType::table) {
    return key.shape == Shape::list ? "tables" : (key.shape == Shape::named ? "a table for each name" : "table");
  }
  std::string one = key.type == ValueType::integer ? "whole number" : key.type == ValueType::number ? "number" : "text";
  if (key.type == ValueType::boolean) one = "true or false";
  if (!key.words.empty()) one = "word";
  if (key.accepts_auto) one += " or \"auto\"";
  if (key.shape == Shape::three) return "three " + one + "s";
  return key.shape == Shape::list ? "list of " + one + "s" : one;
}

/// The largest whole number that is stored says nothing to a reader.
std::string range_of(const KeySpec& key) {
  constexpr double kTechnicalLimit = 2147483647.0;
  Range range = allowed_range(key);
  if (range.max >= kTechnicalLimit && key.type == ValueType::integer) range.max = Range{}.max;
  return range.bounded() ? range.text() : "";
}

std::string default_of(const KeySpec& key) {
  if (key.required) return "**required**";
  if (key.default_text.empty()) return "";
  const bool toml = std::string_view("\"[{0123456789-tf").find(key.default_text.front()) != std::string_view::npos &&
                    key.default_text.find("the ") != 0;
  return toml ? code(key.default_text) : key.default_text;
}

std::string row(const KeySpec& key) {
  std::string text("| ");
  text.append(code(key.name)).append(" | ").append(type_of(key)).append(" | ");
  text.append(key.unit.empty() ? "" : key.unit).append(" | ").append(range_of(key)).append(" | ");
  return text.append(default_of(key)).append(" | ").append(key.help).append(" |\n");
}

std::string group_text(const std::vector<std::string>& group) {
  std::string text;
  for (const std::string& key : group) text.append(text.empty() ? "" : " and ").append(code(key));
  return text;
}

std::string exclusion_text(const Exclusion& exclusion) {
  std::string text;
  for (const auto& group : exclusion.groups) text.append(text.empty() ? "" : ", or ").append(group_text(group));
  return (exclusion.one_needed ? "Give exactly one of: " : "Give only one of: ") + text + ".\n\n";
}

}  // namespace

std::string key_table(const SectionSpec& section) {
  if (section.keys.empty()) return {};
  std::string text = "| key | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const KeySpec& key : section.keys) text += row(key);
  return text + "\n";
}

std::string word_list(const SectionSpec& section) {
  std::string text;
  for (const KeySpec& key : section.keys) {
    std::string words;
    bool explained = false;
    for (const AllowedWord& w : key.words) {
      words.append(words.empty() ? "" : (w.alias ? " (also " : "; ")).append(code("\"" + w.word + "\""));
      if (w.alias) words.append(")");
      if (!w.help.empty()) words.append(" ").append(w.help);
      explained = explained || !w.help.empty();
    }
    if (!words.empty())
      text.append("- ").append(code(key.name)).append(": ").append(words).append(explained ? ".\n" : "\n");
  }
  return text.empty() ? text : text + "\n";
}

std::string section_text(const SectionSpec& section, const std::string& heading) {
  std::string text("### ");
  text.append(heading).append("\n\n").append(section.help).append("\n\n");
  text += key_table(section) + word_list(section);
  for (const Exclusion& exclusion : section.exclusions) text += exclusion_text(exclusion);
  for (const KindSpec& kind : section.kinds) {
    text.append("**").append(code("kind = \"" + kind.section.name + "\"")).append("**: ").append(kind.section.help);
    text += "\n\n" + key_table(kind.section) + word_list(kind.section);
  }
  return text;
}

}  // namespace glisson::scene

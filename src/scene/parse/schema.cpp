#include "scene/parse/schema.h"

#include <algorithm>

namespace glisson::scene {
namespace {

std::string with_unit(const KeySpec& key) { return key.unit.empty() || key.unit == "-" ? "" : " [" + key.unit + "]"; }

std::string expected_words(const KeySpec& key) {
  std::string text;
  for (const AllowedWord& w : key.words) {
    if (!w.alias) text += (text.empty() ? "one of \"" : ", \"") + w.word + "\"";
  }
  return text;
}

std::string expected_table(const KeySpec& key) {
  if (key.shape == Shape::list) return "a list of tables, each headed [[" + key.name + "]]";
  if (key.shape == Shape::named) return "a table for each name, headed [" + key.name + ".NAME]";
  return "a table";
}

std::string singular(const KeySpec& key) {
  switch (key.type) {
    case ValueType::boolean:
      return "true or false";
    case ValueType::integer:
      return "a whole number" + with_unit(key);
    case ValueType::number:
      return "a number" + with_unit(key);
    case ValueType::text:
      return "text in quotes";
    case ValueType::table:
      return "a table";
  }
  return {};
}

std::string plural(const KeySpec& key) {
  switch (key.type) {
    case ValueType::integer:
      return "whole numbers" + with_unit(key);
    case ValueType::number:
      return "numbers" + with_unit(key);
    default:
      return "texts in quotes";
  }
}

}  // namespace

const KeySpec* SectionSpec::find(std::string_view key) const {
  const auto it = std::find_if(keys.begin(), keys.end(), [&](const KeySpec& k) { return k.name == key; });
  return it == keys.end() ? nullptr : &*it;
}

const KindSpec* SectionSpec::kind(std::string_view word) const {
  const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const KindSpec& k) { return k.section.name == word; });
  return it == kinds.end() ? nullptr : &*it;
}

std::string expected(const KeySpec& key) {
  if (key.type == ValueType::table) return expected_table(key);
  if (!key.words.empty()) return expected_words(key);
  if (key.shape == Shape::three) return "a list of three " + plural(key);
  if (key.shape == Shape::list) return "a list of " + plural(key);
  return singular(key) + (key.accepts_auto ? " or \"auto\"" : "");
}

}  // namespace glisson::scene

// json_field.cpp — see json_field.h.
#include "report/json_field.h"

namespace glisson {
namespace {

constexpr std::size_t kShownText = 40;

std::string shown(const nlohmann::json& value) {
  if (value.is_array()) return "a list of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  const std::string text = json_text(value);
  return text.size() > kShownText ? valid_utf8(text.substr(0, kShownText)) + "…" : text;
}

}  // namespace

void JsonField::refuse(const std::string& expected) const {
  throw JsonError((place_.empty() ? "" : place_ + ": ") + "expected " + expected + ", found " + shown(value_));
}

std::optional<JsonField> JsonField::find(const std::string& key) const {
  if (!value_.is_object()) refuse("an object");
  const auto found = value_.find(key);
  if (found == value_.end()) return {};
  return JsonField(*found, place_.empty() ? key : place_ + "." + key);
}

JsonField JsonField::at(const std::string& key) const {
  if (const std::optional<JsonField> found = find(key)) return *found;
  throw JsonError((place_.empty() ? "" : place_ + ": ") + "no key \"" + key + "\"");
}

JsonField JsonField::at(std::size_t number) const {
  if (number >= size()) refuse("a list of " + std::to_string(number + 1) + " or more");
  return JsonField(value_[number], place_ + "[" + std::to_string(number) + "]");
}

std::size_t JsonField::size() const {
  if (!value_.is_array()) refuse("a list");
  return value_.size();
}

std::string JsonField::text() const {
  if (!value_.is_string()) refuse("a text");
  return value_.get<std::string>();
}

double JsonField::number() const {
  if (!value_.is_number()) refuse("a number");
  return value_.get<double>();
}

bool JsonField::truth() const {
  if (!value_.is_boolean()) refuse("true or false");
  return value_.get<bool>();
}

}  // namespace glisson

// json_text.cpp — see json_text.h.
#include "report/json_text.h"

#include <nlohmann/json.hpp>

namespace glisson {
namespace {

using nlohmann::json;

constexpr auto kReplace = json::error_handler_t::replace;

/// Stops the reader before anything that recurses over the value meets it.
bool within_depth(int depth, json::parse_event_t, json&) {
  if (depth <= kDeepestJson) return true;
  throw JsonError("nested deeper than " + std::to_string(kDeepestJson) + " levels");
}

}  // namespace

std::string json_text(const json& value, int indent) { return value.dump(indent, ' ', false, kReplace); }

std::string json_text(const nlohmann::ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string valid_utf8(std::string_view text) { return json::parse(json_text(json(text))).get<std::string>(); }

json parse_json(std::string_view text) {
  try {
    return json::parse(text, within_depth);
  } catch (const json::parse_error& error) {
    throw JsonError("not valid JSON at byte " + std::to_string(error.byte));
  } catch (const json::exception&) {
    throw JsonError("not valid JSON: a number is out of range");
  }
}

}  // namespace glisson

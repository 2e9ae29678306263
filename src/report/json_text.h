// json_text.h — JSON as text, in and out, where words of outsiders are in it: file names, titles, tables of other programs.
//
// JSON is UTF-8, file names and options need not be. The library refuses to write other bytes by an exception that would end the
// program, so every text is written here: what is no UTF-8 becomes U+FFFD, the mark of a character that could not be read.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glisson {

/// Lists and objects in one another; what glisson writes has 7.
inline constexpr int kDeepestJson = 64;

/// A text that is not the JSON it should be: what() says where and how, without a word of the library's.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Valid UTF-8 whatever the strings hold. @param indent  spaces a level; −1: all on one line
std::string json_text(const nlohmann::json& json, int indent = -1);
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// A text with U+FFFD in place of what is no UTF-8.
std::string valid_utf8(std::string_view text);

/// Reads what came from outside. @throws JsonError where it is none, or deeper than kDeepestJson
nlohmann::json parse_json(std::string_view text);

}  // namespace glisson

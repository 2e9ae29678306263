#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace glisson::detail {

std::string number_text(double value, int digits) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::string show(double value) {
  constexpr double kPlainWholeNumbers = 1e7;  // shorter forms such as 1e+05 are harder to read
  if (value == std::trunc(value) && std::abs(value) < kPlainWholeNumbers) return std::to_string(std::int64_t(value));
  char buffer[64];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string count_text(std::size_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  const auto first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string index_list(std::span<const std::uint32_t> indices, std::size_t shown) {
  std::string text;
  const std::size_t n = std::min(shown, indices.size());
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) text += ", ";
    text += std::to_string(indices[i]);
  }
  if (indices.size() > n) text += " and " + std::to_string(indices.size() - n) + " more";
  return text;
}

}  // namespace glisson::detail

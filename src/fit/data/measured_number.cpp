#include "fit/data/measured_number.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "base/text.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kGroup = 3;  // digits
// blank, no-break space, thin space, narrow no-break space, apostrophes; and the one of `.` and `,` that is not decimal
constexpr std::array<std::string_view, 6> kMarks{" ", "\u00A0", "\u2009", "\u202F", "'", "’"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end - at;
}

/// The mark of thousands that stands here; empty: none.
std::string_view mark_at(std::string_view text, std::size_t at, char decimal) {
  const std::string_view rest = text.substr(at);
  const std::string_view other = decimal == ',' ? "." : ",";
  if (rest.starts_with(other)) return other;
  const auto mark = std::find_if(kMarks.begin(), kMarks.end(), [&](std::string_view m) { return rest.starts_with(m); });
  return mark == kMarks.end() ? std::string_view{} : *mark;
}

/// The sign taken off the text; U+2212 is a minus too.
bool take_minus(std::string_view& text) {
  for (const std::string_view sign : {std::string_view("+"), std::string_view("-"), std::string_view("−")}) {
    if (!text.starts_with(sign)) continue;
    text.remove_prefix(sign.size());
    return sign != "+";
  }
  return false;
}

struct Digits {
  std::string whole;      ///< before the decimal mark, without marks of thousands
  std::string_view rest;  ///< from the decimal mark or the exponent on
  bool grouped = false;
};

Digits whole_digits(std::string_view text, char decimal) {
  const std::size_t first = digits_at(text, 0);
  Digits found{std::string(text.substr(0, first)), text.substr(first), false};
  if (first == 0 || first > kGroup || text[0] == '0') return found;
  const std::string_view mark = mark_at(text, first, decimal);
  std::size_t at = first;
  while (!mark.empty() && text.substr(at).starts_with(mark) && digits_at(text, at + mark.size()) == kGroup) {
    found.whole.append(text.substr(at + mark.size(), kGroup));
    at += mark.size() + kGroup;
    found.grouped = true;
  }
  found.rest = text.substr(at);
  return found;
}

}  // namespace

std::optional<double> parse_number(std::string_view text, char decimal) {
  text = detail::trimmed(text);
  const bool minus = take_minus(text);
  if (text.empty() || text.front() == '-' || text.front() == '+') return std::nullopt;
  const Digits digits = whole_digits(text, decimal);
  std::string plain = digits.whole + std::string(digits.rest);
  if (decimal == ',') {
    if (plain.find('.') != std::string::npos || plain.back() == ',') return std::nullopt;
    std::replace(plain.begin(), plain.end(), ',', '.');
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc{} || end != plain.data() + plain.size() || !std::isfinite(value)) return std::nullopt;
  return minus ? -value : value;
}

bool has_thousands(std::string_view text, char decimal) {
  if (!parse_number(text, decimal)) return false;
  text = detail::trimmed(text);
  take_minus(text);
  return whole_digits(text, decimal).grouped;
}

}  // namespace glisson::fit

#include "fit/data/clock_time.h"

#include <algorithm>
#include <vector>

#include "base/text.h"
#include "fit/data/measured_number.h"

namespace glisson::fit {
namespace {

constexpr double kSixty = 60.0;
constexpr std::size_t kMostDigits = 4;  // of the first part

bool is_digits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

/// The parts of `h:mm:ss` or `m:ss`, of which the last may have a fraction; nothing where the text is neither.
std::vector<std::string_view> clock_parts(std::string_view text, char decimal) {
  std::vector<std::string_view> parts = parts_of(detail::trimmed(text));
  if (parts.size() < 2 || parts.size() > 3 || parts.front().size() > kMostDigits) return {};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    const std::size_t mark = last ? std::min(parts[i].find(decimal), parts[i].size()) : parts[i].size();
    if (!is_digits(parts[i].substr(0, mark)) || (i > 0 && mark != 2)) return {};
    if (mark < parts[i].size() && !is_digits(parts[i].substr(mark + 1))) return {};
    if (i > 0 && parts[i].front() >= '6') return {};
  }
  return parts;
}

bool has_fraction(std::string_view seconds) { return seconds.size() > 2; }

}  // namespace

std::optional<double> parse_clock(std::string_view text, char decimal) {
  const std::vector<std::string_view> parts = clock_parts(text, decimal);
  if (parts.empty() || (parts.size() == 2 && !has_fraction(parts.back()))) return std::nullopt;
  double seconds = 0.0;
  for (const std::string_view part : parts) seconds = kSixty * seconds + parse_number(part, decimal).value_or(0.0);
  return seconds;
}

bool is_twofold_clock(std::string_view text) {
  const std::vector<std::string_view> parts = clock_parts(text, '.');
  return parts.size() == 2 && !has_fraction(parts.back());
}

}  // namespace glisson::fit

// surface_source.cpp — see surface_source.h.
#include "scene/surface/surface_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "base/text.h"

namespace glisson::surface_file {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\n'; }

/// Whether all of a word is a number.
template <class T>
bool parsed(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > kLongest ? "…\"" : "\"");
}

std::string_view first_word(std::string_view& line) {
  const auto begin = std::find_if_not(line.begin(), line.end(), is_blank);
  const auto end = std::find_if(begin, line.end(), is_blank);
  const std::string_view word(begin, end);
  line = {end, line.end()};
  return word;
}

double real_in(const Source& source, std::string_view word, const char* what) {
  double value = 0.0;
  if (word.empty()) source.fail(std::string("the line ends before ") + what);
  if (!parsed(word, value)) source.fail(std::string("expected ") + what + ", a number, found " + shown(word));
  if (!std::isfinite(value))
    source.fail(std::string(what) + " is " + shown(word) + "; coordinates must be finite: repair the file");
  return value;
}

bool Source::line(std::string_view& text) {
  if (position_ >= bytes_.size()) return false;
  line_ = next_line_++;
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  text = detail::trimmed(bytes_.substr(position_, end - position_));
  position_ = std::min(end + 1, bytes_.size());
  return true;
}

std::string_view Source::word() {
  while (position_ < bytes_.size() && is_blank(bytes_[position_])) next_line_ += bytes_[position_++] == '\n';
  line_ = next_line_;
  std::string_view rest = bytes_.substr(position_);
  const std::string_view found = first_word(rest);
  position_ += found.size();
  return found;
}

void Source::expect(std::string_view wanted, const char* within) {
  const std::string_view found = word();
  if (detail::lower_case(found) == wanted) return;
  const std::string expected = "expected \"" + std::string(wanted) + "\" in " + within;
  if (left() == 0) fail(expected + ", but the file ends: it is cut off; write it again");
  fail(expected + ", found " + shown(found));
}

double Source::real(const char* what) {
  const std::string_view found = word();
  if (found.empty()) fail(std::string("the file ends before ") + what + ": it is cut off; write it again");
  return real_in(*this, found, what);
}

void Source::skip(std::uint64_t count, const std::string& what) {
  if (count > left())
    fail("the file ends within " + what + ": " + std::to_string(count) + " bytes are needed and " +
         detail::count_text(left(), "is", "are") + " left; it is cut off: write it again");
  position_ += static_cast<std::size_t>(count);
}

template <class T>
T Source::number(const std::string& what) {
  const std::size_t at = position_;
  skip(sizeof(T), what);
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes_.data() + at, sizeof(T));
  if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}
template std::int8_t Source::number(const std::string&);
template std::uint8_t Source::number(const std::string&);
template std::int16_t Source::number(const std::string&);
template std::uint16_t Source::number(const std::string&);
template std::int32_t Source::number(const std::string&);
template std::uint32_t Source::number(const std::string&);
template float Source::number(const std::string&);
template double Source::number(const std::string&);

void Source::fail(const std::string& what) const {
  const std::string where = binary_ ? ", byte " + std::to_string(position_) : ":" + std::to_string(line_);
  throw std::invalid_argument(name_ + where + ": " + what);
}

}  // namespace glisson::surface_file

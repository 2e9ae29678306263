#include "io/gmsh_source.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "io/raw_mesh.h"

namespace glisson::detail {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

template <class T>
bool parse(std::string_view token, T& value) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  const char* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace

void GmshSource::fail(const std::string& what) const {
  std::string where = name_;
  if (text_part_) {
    where += ":" + std::to_string(line_);
  } else {
    where += ", byte " + std::to_string(position_);
  }
  if (!section_.empty()) where += ", $" + section_;
  if (record_ != nullptr) {
    where += ", " + std::string(record_) + (record_index_ > 0 ? " " + std::to_string(record_index_) : "");
  }
  detail::fail(where, what);
}

std::string GmshSource::shown(std::string_view text) const {
  constexpr std::size_t kLongest = 40;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return '"' + out + (text.size() > kLongest ? "…\"" : "\"");
}

void GmshSource::skip_white_space() {
  while (position_ < bytes_.size() && (is_blank(bytes_[position_]) || bytes_[position_] == '\n')) {
    line_ += bytes_[position_++] == '\n';
  }
}

std::string_view GmshSource::rest_of_line() const {
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view rest = bytes_.substr(position_, end - position_);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

bool GmshSource::next_section(std::string& section) {
  section_.clear();
  record_ = nullptr;
  text_part_ = true;
  skip_white_space();
  if (position_ >= bytes_.size()) return false;
  const std::string_view header = rest_of_line();
  if (header.size() < 2 || header[0] != '$') fail("expected a section such as $Nodes, found " + shown(header));
  if (header.starts_with("$End")) fail("found " + shown(header) + " without its beginning");
  section_ = section = header.substr(1);
  position_ += header.size();
  end_of_text_line();
  text_part_ = !binary_;
  return true;
}

void GmshSource::end_section() {
  record_ = nullptr;
  text_part_ = true;
  skip_white_space();
  const std::string end = "$End" + section_;
  const std::string_view found = rest_of_line();
  if (found == end) {
    position_ += found.size();
    return;
  }
  text_part_ = !binary_;
  fail(position_ >= bytes_.size()
           ? "the file ends before " + end + ": it is cut off"
           : "expected " + end + ", found " + shown(found) + ": more entries than the count says");
}

void GmshSource::skip_section() {
  const std::string end = "$End" + section_;
  const std::size_t found = bytes_.find(end, position_);
  if (found == std::string_view::npos) fail("the file ends before " + end + ": it is cut off");
  line_ += static_cast<std::size_t>(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(position_),
                                               bytes_.begin() + static_cast<std::ptrdiff_t>(found), '\n'));
  position_ = found + end.size();
}

void GmshSource::record(const char* what, std::uint64_t index) {
  record_ = what;
  record_index_ = index;
  text_part_ = !binary_;
  if (!binary_) skip_white_space();
}

void GmshSource::text_record(const char* what, std::uint64_t index) {
  record_ = what;
  record_index_ = index;
  text_part_ = true;
  skip_white_space();
}

std::string_view GmshSource::token(const char* what) {
  while (position_ < bytes_.size() && is_blank(bytes_[position_])) ++position_;
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !is_blank(bytes_[position_]) && bytes_[position_] != '\n') ++position_;
  if (position_ > begin) return bytes_.substr(begin, position_ - begin);
  fail(std::string("expected ") + what + ", found the end of the " + (position_ >= bytes_.size() ? "file" : "line"));
}

std::string_view GmshSource::take(std::size_t bytes, const char* what) {
  if (bytes_.size() - position_ < bytes) fail(std::string("the file ends before ") + what + ": it is cut off");
  position_ += bytes;
  return bytes_.substr(position_ - bytes, bytes);
}

template <class T>
T GmshSource::bytes_as(const char* what) {
  char raw[sizeof(T)];
  const std::string_view taken = take(sizeof(T), what);
  std::copy(taken.begin(), taken.end(), raw);
  if (swapped_) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

std::int64_t GmshSource::integer(const char* what) {
  return binary_ ? bytes_as<std::int32_t>(what) : text_integer(what);
}

std::uint64_t GmshSource::size(const char* what) {
  if (!binary_) return text_size(what);
  return size_bytes_ == 4 ? bytes_as<std::uint32_t>(what) : bytes_as<std::uint64_t>(what);
}

double GmshSource::real(const char* what) { return binary_ ? bytes_as<double>(what) : text_real(what); }

std::int64_t GmshSource::text_integer(const char* what) {
  const std::string_view text = token(what);
  std::int32_t value = 0;
  if (!parse(text, value)) fail(std::string("expected ") + what + ", an integer, found " + shown(text));
  return value;
}

std::uint64_t GmshSource::text_size(const char* what) {
  const std::string_view text = token(what);
  std::uint64_t value = 0;
  if (!parse(text, value)) fail(std::string("expected ") + what + ", an integer from 0, found " + shown(text));
  return value;
}

double GmshSource::text_real(const char* what) {
  const std::string_view text = token(what);
  double value = 0.0;
  if (!parse(text, value)) fail(std::string("expected ") + what + ", a number, found " + shown(text));
  return value;
}

std::string GmshSource::quoted(const char* what) {
  while (position_ < bytes_.size() && is_blank(bytes_[position_])) ++position_;
  const std::string_view rest = rest_of_line();
  if (rest.size() < 2 || rest.front() != '"' || rest.back() != '"') {
    fail(std::string("expected ") + what + " in double quotes, found " + shown(rest));
  }
  position_ += rest.size();
  return std::string(rest.substr(1, rest.size() - 2));
}

void GmshSource::end_of_text_line() {
  const std::string_view rest = rest_of_line();
  if (!rest.empty()) fail("expected the end of the line, found " + shown(rest));
  position_ = std::min(bytes_.find('\n', position_), bytes_.size());
  if (position_ < bytes_.size()) ++position_, ++line_;
}

void GmshSource::byte_order_mark() {
  text_part_ = false;
  const auto mark = bytes_as<std::uint32_t>("the byte order mark");
  if (mark != 1 && mark != 0x01000000u) fail("the byte order mark is " + std::to_string(mark) + " instead of 1");
  swapped_ = mark != 1;
}

void GmshSource::require_room(std::uint64_t count, std::size_t text_bytes, std::size_t binary_bytes,
                              const char* what) const {
  const std::size_t left = bytes_.size() - position_;
  if (count <= left / (binary_ ? binary_bytes : text_bytes)) return;
  fail("the file says " + std::to_string(count) + " " + what + ", but only " + std::to_string(left) +
       " bytes are left: the count is wrong or the file is cut off");
}

}  // namespace glisson::detail

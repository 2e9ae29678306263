#include "io/legacy_vtk_source.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "io/raw_mesh.h"

namespace glisson::detail {
namespace {

enum class Kind { bits, signed_integer, unsigned_integer, real, text };

struct ValueType {
  const char* name;
  int bits;
  Kind kind;
};

constexpr ValueType kValueTypes[] = {
    {"bit", 1, Kind::bits},
    {"char", 8, Kind::signed_integer},
    {"signed_char", 8, Kind::signed_integer},
    {"unsigned_char", 8, Kind::unsigned_integer},
    {"short", 16, Kind::signed_integer},
    {"unsigned_short", 16, Kind::unsigned_integer},
    {"int", 32, Kind::signed_integer},
    {"unsigned_int", 32, Kind::unsigned_integer},
    {"vtkidtype", 32, Kind::signed_integer},
    {"long", 64, Kind::signed_integer},
    {"unsigned_long", 64, Kind::unsigned_integer},
    {"vtktypeint64", 64, Kind::signed_integer},
    {"vtktypeuint64", 64, Kind::unsigned_integer},
    {"float", 32, Kind::real},
    {"double", 64, Kind::real},
    {"string", 8, Kind::text},
    {"utf8_string", 8, Kind::text},
};

const ValueType* find_value_type(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kValueTypes), std::end(kValueTypes), [&](const auto& t) { return name == t.name; });
  return found == std::end(kValueTypes) ? nullptr : found;
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// Item `index` of a block, big-endian as all legacy files are.
std::uint64_t item(std::string_view block, std::uint64_t index, int bits) {
  const auto size = static_cast<std::size_t>(bits) / 8;
  std::uint64_t value = 0;
  for (const char c : block.substr(index * size, size)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::int64_t signed_item(std::string_view block, std::uint64_t index, int bits) {
  const int unused = 64 - bits;
  return static_cast<std::int64_t>(item(block, index, bits) << unused) >> unused;
}

double number_item(std::string_view block, std::uint64_t index, const ValueType& type) {
  if (type.kind == Kind::bits) return static_cast<unsigned char>(block[index / 8]) >> (7 - index % 8) & 1;
  if (type.kind == Kind::signed_integer) return static_cast<double>(signed_item(block, index, type.bits));
  const std::uint64_t value = item(block, index, type.bits);
  if (type.kind == Kind::unsigned_integer) return static_cast<double>(value);
  return type.bits == 32 ? std::bit_cast<float>(static_cast<std::uint32_t>(value)) : std::bit_cast<double>(value);
}

}  // namespace

void LegacyVtkSource::refuse(const std::string& what) const {
  const std::string place = binary_ ? ", byte " + std::to_string(position_) : ":" + std::to_string(item_line_);
  fail(name_ + place + (keyword_.empty() ? "" : ", " + keyword_), what);
}

std::string_view LegacyVtkSource::line() {
  item_line_ = line_;
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view text = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  ++line_;
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

void LegacyVtkSource::skip_space() {
  while (position_ < bytes_.size() && is_space(bytes_[position_])) line_ += bytes_[position_++] == '\n';
}

std::string_view LegacyVtkSource::word(const char* what) {
  skip_space();
  item_line_ = line_;
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !is_space(bytes_[position_])) ++position_;
  if (position_ == begin) refuse(std::string("the file ends before ") + what + ": it is cut off");
  return bytes_.substr(begin, position_ - begin);
}

std::optional<std::string> LegacyVtkSource::next_keyword() {
  keyword_.clear();
  skip_space();
  if (position_ >= bytes_.size()) return std::nullopt;
  const std::string_view text = word("a keyword");
  for (const char c : text.substr(0, 40)) keyword_ += c > ' ' && c <= '~' ? c : '?';
  return lower_case(keyword_);
}

std::uint64_t LegacyVtkSource::count(const char* what) {
  const std::string_view text = word(what);
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    refuse(std::string("expected ") + what + ", an integer from 0, found \"" + std::string(text.substr(0, 40)) + "\"");
  }
  // Not even a bit for each would fit: refuse before the number is multiplied by anything.
  if (value / 8 > bytes_.size()) {
    refuse(std::to_string(value) + " as " + what + " is more than the file has room for: it is wrong or cut off");
  }
  return value;
}

std::string LegacyVtkSource::type() {
  std::string text = lower_case(word("a type"));
  if (find_value_type(text) == nullptr) refuse("values of type \"" + text.substr(0, 40) + "\" are not read");
  return text;
}

void LegacyVtkSource::require_text_room(std::uint64_t number) const {
  if (number <= (bytes_.size() - position_ + 1) / 2) return;
  refuse(std::to_string(number) + " values where only " + std::to_string(bytes_.size() - position_) +
         " bytes are left: the count is wrong or the file is cut off");
}

double LegacyVtkSource::text_number(std::uint64_t index, std::uint64_t of) {
  const std::string_view text = word("a number");
  double value = 0.0;
  const std::size_t sign = text.starts_with('+');
  const auto result = std::from_chars(text.data() + sign, text.data() + text.size(), value);
  if (result.ptr != text.data() + text.size() || result.ec == std::errc::invalid_argument) {
    refuse("expected number " + std::to_string(index + 1) + " of " + std::to_string(of) + ", found \"" +
           std::string(text.substr(0, 40)) + "\"");
  }
  return value;
}

std::string_view LegacyVtkSource::binary_block(std::uint64_t number, int bits) {
  line();                                                            // the data begin after the keyword's line
  number = std::min<std::uint64_t>(number, std::uint64_t{1} << 56);  // far more than any file holds
  const auto bytes = static_cast<std::size_t>((number * static_cast<std::uint64_t>(bits) + 7) / 8);
  if (bytes > bytes_.size() - position_) {
    refuse(std::to_string(number) + " values where only " + std::to_string(bytes_.size() - position_) +
           " bytes are left: the count is wrong or the file is cut off");
  }
  position_ += bytes;
  return bytes_.substr(position_ - bytes, bytes);
}

/// Strings: lines of a text file; in a binary one each has its length before it, in 1, 2, 4 or 8 bytes as the
/// two highest bits 3, 2, 1 or 0 tell.
void LegacyVtkSource::skip_strings(std::uint64_t number) {
  line();
  for (std::uint64_t i = 0; i < number; ++i) {
    if (position_ >= bytes_.size()) refuse("the file ends before string " + std::to_string(i + 1) + ": it is cut off");
    if (!binary_) {
      line();
      continue;
    }
    const int code = static_cast<unsigned char>(bytes_[position_]) >> 6;
    const std::size_t size = std::size_t{1} << (3 - code);
    if (size > bytes_.size() - position_) refuse("the file ends within a string: it is cut off");
    const int bits = static_cast<int>(8 * size);
    const std::uint64_t length = item(bytes_.substr(position_, size), 0, bits) & (~std::uint64_t{0} >> (64 - bits + 2));
    position_ += size;
    if (length > bytes_.size() - position_) refuse("the file ends within a string: it is cut off");
    position_ += length;
  }
}

void LegacyVtkSource::values(std::uint64_t number, const std::string& type_name, std::vector<double>* keep) {
  const ValueType& type = *find_value_type(type_name);
  if (type.kind == Kind::text) return skip_strings(number);
  if (binary_) {
    const std::string_view block = binary_block(number, type.bits);
    for (std::uint64_t i = 0; keep != nullptr && i < number; ++i) keep->push_back(number_item(block, i, type));
    return;
  }
  require_text_room(number);
  const bool single = type.kind == Kind::real && type.bits == 32;
  for (std::uint64_t i = 0; i < number; ++i) {
    const double value = text_number(i, number);
    if (keep != nullptr) keep->push_back(single ? static_cast<float>(value) : value);
  }
}

std::vector<std::int64_t> LegacyVtkSource::integers(std::uint64_t number, const std::string& type_name) {
  const ValueType& type = *find_value_type(type_name);
  if (type.bits < 32 || type.kind == Kind::real) {
    refuse("cells in values of type \"" + type_name + "\"; they must be integers of 32 or 64 bits");
  }
  std::vector<std::int64_t> list;
  if (binary_) {
    const std::string_view block = binary_block(number, type.bits);
    for (std::uint64_t i = 0; i < number; ++i) list.push_back(signed_item(block, i, type.bits));
    return list;
  }
  require_text_room(number);
  for (std::uint64_t i = 0; i < number; ++i) {
    const double value = text_number(i, number);
    if (!(std::abs(value) <= 9e15) || value != std::floor(value)) {
      refuse("expected an integer as number " + std::to_string(i + 1) + " of " + std::to_string(number));
    }
    list.push_back(static_cast<std::int64_t>(value));
  }
  return list;
}

}  // namespace glisson::detail

#include "fit/data/text_encoding.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace glisson::fit {
namespace {

enum class ByteOrder { little, big };

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Number of bytes of the UTF-8 character that starts here; 0 where none does.
std::size_t utf8_length(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  const std::size_t length = first < 0x80         ? 1
                             : first >> 5 == 0x06 ? 2
                             : first >> 4 == 0x0E ? 3
                             : first >> 3 == 0x1E ? 4
                                                  : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (byte_at(text, i) >> 6 != 0x02) return 0;
  }
  return length;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) return false;
    i += length;
  }
  return true;
}

void append_utf8(std::string& text, std::uint32_t point) {
  const auto byte = [&](std::uint32_t value) { text += static_cast<char>(value); };
  const auto rest = [&](unsigned shift) { byte(0x80 | ((point >> shift) & 0x3F)); };
  if (point < 0x80) return byte(point);
  if (point < 0x800) return byte(0xC0 | (point >> 6)), rest(0);
  if (point < 0x10000) return byte(0xE0 | (point >> 12)), rest(6), rest(0);
  byte(0xF0 | (point >> 18)), rest(12), rest(6), rest(0);
}

std::string of_latin1(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) append_utf8(text, byte_at(bytes, i));
  return text;
}

/// Half a pair of surrogates becomes U+FFFD; an odd last byte is no character.
std::string of_utf16(std::string_view bytes, ByteOrder order) {
  constexpr std::uint32_t kHigh = 0xD800, kLow = 0xDC00, kEnd = 0xE000, kUnknown = 0xFFFD;
  const auto unit = [&](std::size_t i) -> std::uint32_t {
    const unsigned a = byte_at(bytes, 2 * i), b = byte_at(bytes, 2 * i + 1);
    return order == ByteOrder::little ? a | b << 8 : b | a << 8;
  };
  std::string text;
  const std::size_t units = bytes.size() / 2;
  for (std::size_t i = 0; i < units; ++i) {
    const std::uint32_t here = unit(i);
    const std::uint32_t next = i + 1 < units ? unit(i + 1) : 0;
    if (here < kHigh || here >= kEnd) {
      append_utf8(text, here);
    } else if (here < kLow && next >= kLow && next < kEnd) {
      append_utf8(text, 0x10000 + ((here - kHigh) << 10) + (next - kLow));
      ++i;
    } else {
      append_utf8(text, kUnknown);
    }
  }
  return text;
}

/// Whether bytes without a mark are UTF-16 of this order: a table is mostly ASCII, whose other byte is 0.
bool looks_like_utf16(std::string_view bytes, ByteOrder order) {
  constexpr std::size_t kLookedAt = 4000, kFewest = 8;
  const std::size_t size = std::min(bytes.size(), kLookedAt) / 2 * 2;
  std::size_t zeros = 0, wrong = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const bool high = (i % 2 == 1) == (order == ByteOrder::little);
    if (byte_at(bytes, i) == 0) ++(high ? zeros : wrong);
  }
  constexpr std::size_t kMostly = 4;  // three of four characters
  return size >= kFewest && wrong == 0 && 2 * zeros * kMostly >= size * (kMostly - 1);
}

std::string binary_problem(std::string_view bytes) {
  if (bytes.starts_with("PK\x03\x04"))
    return "is a workbook (.xlsx) or another packed file; `python -m glisson.workbook FILE.xlsx` writes its sheet as "
           "FILE.csv, and glisson.fit() in Python takes it as it is";
  if (bytes.starts_with("\xD0\xCF\x11\xE0"))
    return "is an old workbook (.xls); save it as .csv, or as .xlsx, which glisson.fit() in Python takes";
  return {};
}

}  // namespace

DecodedText decode_text(std::string bytes) {
  const std::string_view view = bytes;
  if (std::string problem = binary_problem(view); !problem.empty()) return {{}, std::move(problem)};
  if (view.starts_with("\xFF\xFE")) return {of_utf16(view.substr(2), ByteOrder::little), {}};
  if (view.starts_with("\xFE\xFF")) return {of_utf16(view.substr(2), ByteOrder::big), {}};
  for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
    if (looks_like_utf16(view, order)) return {of_utf16(view, order), {}};
  }
  if (view.find('\0') != std::string_view::npos)
    return {{}, "is not text: it contains bytes of value 0; export it as .csv"};
  if (view.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (is_utf8(bytes)) return {std::move(bytes), {}};
  return {of_latin1(bytes), {}};
}

}  // namespace glisson::fit

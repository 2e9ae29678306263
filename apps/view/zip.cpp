// zip.cpp — see zip.h.
//
//   local head, content │ local head, content │ … │ directory: a head for each │ end: where the directory is
#include "view/zip.h"

#include <array>
#include <cstdint>

namespace glisson::view {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kEntry = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kUtf8 = 0x0800, kStored = 0, kTime = 0, kDate = (2000 - 1980) << 9 | 1 << 5 | 1;

class Bytes {
 public:
  void u16(std::uint16_t x) { put(x, 2); }
  void u32(std::uint32_t x) { put(x, 4); }
  void text(const std::string& x) { bytes += x; }
  std::string bytes;

 private:
  void put(std::uint32_t x, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(x >> (8 * i) & 255u));
  }
};

std::uint32_t crc32(const std::string& content) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t x = i;
      for (int bit = 0; bit < 8; ++bit) x = (x & 1u) != 0 ? x >> 1 ^ 0xedb88320u : x >> 1;
      table[i] = x;
    }
    return table;
  }();
  std::uint32_t crc = 0xffffffffu;
  for (const char c : content) crc = kTable[(crc ^ static_cast<std::uint8_t>(c)) & 255u] ^ crc >> 8;
  return ~crc;
}

/// What the head of a file and its entry in the directory share.
void put_facts(Bytes& out, const ZipFile& file, std::uint32_t crc) {
  out.u16(kVersion);
  out.u16(kUtf8);
  out.u16(kStored);
  out.u16(kTime);
  out.u16(kDate);
  out.u32(crc);
  out.u32(static_cast<std::uint32_t>(file.content.size()));
  out.u32(static_cast<std::uint32_t>(file.content.size()));
  out.u16(static_cast<std::uint16_t>(file.name.size()));
  out.u16(0);  // no further field
}

}  // namespace

std::string zip(std::span<const ZipFile> files) {
  Bytes out, directory;
  for (const ZipFile& file : files) {
    const std::uint32_t crc = crc32(file.content);
    const auto at = static_cast<std::uint32_t>(out.bytes.size());
    out.u32(kLocal);
    put_facts(out, file, crc);
    out.text(file.name);
    out.text(file.content);
    directory.u32(kEntry);
    directory.u16(kVersion);
    put_facts(directory, file, crc);
    for (int i = 0; i < 3; ++i) directory.u16(0);  // no comment, first disk, no inner attributes
    directory.u32(0);
    directory.u32(at);
    directory.text(file.name);
  }
  const auto begin = static_cast<std::uint32_t>(out.bytes.size());
  out.text(directory.bytes);
  const auto count = static_cast<std::uint16_t>(files.size());
  out.u32(kEnd);
  out.u16(0);
  out.u16(0);
  out.u16(count);
  out.u16(count);
  out.u32(static_cast<std::uint32_t>(directory.bytes.size()));
  out.u32(begin);
  out.u16(0);
  return std::move(out.bytes);
}

}  // namespace glisson::view

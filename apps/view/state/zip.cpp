// zip.cpp — see zip.h.
//
//   local head, content │ local head, content │ … │ directory: a head for each │ end: where the directory is
#include "view/state/zip.h"

#include <boost/crc.hpp>
#include <limits>
#include <stdexcept>

namespace glisson::view {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kEntry = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kUtf8 = 0x0800, kStored = 0, kTime = 0, kDate = (2000 - 1980) << 9 | 1 << 5 | 1;
constexpr std::uint64_t kLocalBytes = 30, kEntryBytes = 46, kEndBytes = 22;  // of each, without a name

class ZipBytes {
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

/// What the head of a file and its entry in the directory share.
void put_facts(ZipBytes& out, const std::string& name, std::uint32_t crc, std::uint64_t bytes) {
  out.u16(kVersion);
  out.u16(kUtf8);
  out.u16(kStored);
  out.u16(kTime);
  out.u16(kDate);
  out.u32(crc);
  out.u32(static_cast<std::uint32_t>(bytes));
  out.u32(static_cast<std::uint32_t>(bytes));
  out.u16(static_cast<std::uint16_t>(name.size()));
  out.u16(0);  // no further field
}

}  // namespace

ZipFile text_file(std::string name, std::string text) {
  return {std::move(name), [text = std::move(text)](const TextSink& out) { out(text); }};
}

ZipArchive::ZipArchive(std::vector<ZipFile> files, const std::function<bool()>& goes_on) {
  std::uint64_t directory = kEndBytes;
  for (ZipFile& file : files) {
    Entry entry{.file = std::move(file), .at = static_cast<std::uint32_t>(bytes_)};
    boost::crc_32_type crc;
    entry.file.content([&](std::string_view piece) {
      crc.process_bytes(piece.data(), piece.size());
      entry.bytes += piece.size();
      return whole_ = whole_ && goes_on();
    });
    entry.crc = crc.checksum();
    bytes_ += kLocalBytes + entry.file.name.size() + entry.bytes;
    directory += kEntryBytes + entry.file.name.size();
    if (bytes_ + directory > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("an archive of 4 GiB or more");
    entries_.push_back(std::move(entry));
  }
  bytes_ += directory;
}

std::string ZipArchive::directory() const {
  ZipBytes out;
  std::uint64_t begin = 0;
  for (const Entry& x : entries_) {
    out.u32(kEntry);
    out.u16(kVersion);
    put_facts(out, x.file.name, x.crc, x.bytes);
    for (int i = 0; i < 3; ++i) out.u16(0);  // no comment, first disk, no inner attributes
    out.u32(0);
    out.u32(x.at);
    out.text(x.file.name);
    begin = x.at + kLocalBytes + x.file.name.size() + x.bytes;
  }
  const auto bytes = static_cast<std::uint32_t>(out.bytes.size());
  const auto count = static_cast<std::uint16_t>(entries_.size());
  out.u32(kEnd);
  out.u16(0);
  out.u16(0);
  out.u16(count);
  out.u16(count);
  out.u32(bytes);
  out.u32(static_cast<std::uint32_t>(begin));
  out.u16(0);
  return std::move(out.bytes);
}

bool ZipArchive::write(const TextSink& out) const {
  bool wanted = true;
  for (const Entry& x : entries_) {
    ZipBytes head;
    head.u32(kLocal);
    put_facts(head, x.file.name, x.crc, x.bytes);
    head.text(x.file.name);
    if (!out(head.bytes)) return false;
    x.file.content([&](std::string_view piece) { return wanted = out(piece); });
    if (!wanted) return false;
  }
  return out(directory());
}

}  // namespace glisson::view

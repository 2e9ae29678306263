#include "io/vtu_blocks.h"

#include <vtkDataCompressor.h>

#include <algorithm>
#include <string>

namespace glisson::detail {
namespace {

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool is_xml_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Bytes in their order, from raw data or from base64 text that may be padded in between.
class ByteStream {
 public:
  ByteStream(std::string_view data, bool base64) : data_(data), base64_(base64) {}

  std::vector<unsigned char> take(std::uint64_t count) {
    if (count > data_.size() - position_) cut_off();  // base64 only makes it longer
    std::vector<unsigned char> out;
    out.reserve(static_cast<std::size_t>(count));
    while (out.size() < count) out.push_back(base64_ ? decoded() : raw());
    return out;
  }

  std::uint64_t word(const VtuPacking& packing) {
    const std::vector<unsigned char> bytes = take(packing.word);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value = value << 8 | bytes[packing.big_endian ? i : bytes.size() - 1 - i];
    }
    return value;
  }

  std::size_t left() const { return data_.size() - position_; }

 private:
  [[noreturn]] static void cut_off() { throw BadBlock("the file ends within its data: it is damaged or cut off"); }

  unsigned char raw() {
    if (position_ >= data_.size()) cut_off();
    return static_cast<unsigned char>(data_[position_++]);
  }

  unsigned char decoded() {
    while (have_ < 8) {
      if (position_ >= data_.size()) cut_off();
      const char c = data_[position_++];
      if (is_xml_space(c)) continue;
      if (c == '=') {  // what is left of the bits is padding
        have_ = 0;
        continue;
      }
      const int value = sextet(c);
      if (value < 0) cut_off();
      bits_ = bits_ << 6 | static_cast<std::uint32_t>(value);
      have_ += 6;
    }
    have_ -= 8;
    return static_cast<unsigned char>(bits_ >> have_ & 0xff);
  }

  std::string_view data_;
  bool base64_;
  std::size_t position_ = 0;
  std::uint32_t bits_ = 0;
  int have_ = 0;
};

[[noreturn]] void too_large(std::uint64_t parts, std::uint64_t bytes) {
  throw BadBlock("its data claim " + std::to_string(parts) + " blocks of " + std::to_string(bytes) +
                 " bytes, more than the file has room for: it is damaged or cut off");
}

std::vector<unsigned char> unpack_compressed(ByteStream& stream, const VtuPacking& packing, std::uint64_t most) {
  const std::uint64_t parts = stream.word(packing), whole = stream.word(packing), last = stream.word(packing);
  if (parts > stream.left() / packing.word || whole > most || last > most || (parts > 0 && whole > most / parts)) {
    too_large(parts, std::max(whole, last));
  }
  std::vector<std::uint64_t> packed;
  for (std::uint64_t i = 0; i < parts; ++i) packed.push_back(stream.word(packing));
  std::vector<unsigned char> out;
  for (std::uint64_t i = 0; i < parts; ++i) {
    const auto size = static_cast<std::size_t>(i + 1 == parts && last > 0 ? last : whole);
    const std::vector<unsigned char> part = stream.take(packed[i]);
    const std::size_t begin = out.size();
    out.resize(begin + size);
    if (size > 0 && packing.compressor->Uncompress(part.data(), part.size(), out.data() + begin, size) != size) {
      throw BadBlock("block " + std::to_string(i + 1) + " of its compressed data cannot be unpacked: it is damaged");
    }
  }
  return out;
}

}  // namespace

std::vector<unsigned char> unpack_block(std::string_view data, const VtuPacking& packing, std::uint64_t most) {
  ByteStream stream(data, packing.base64);
  if (packing.compressor != nullptr) return unpack_compressed(stream, packing, most);
  const std::uint64_t bytes = stream.word(packing);
  if (bytes > stream.left()) too_large(1, bytes);
  return stream.take(bytes);
}

}  // namespace glisson::detail

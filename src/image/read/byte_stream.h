// byte_stream.h — the bytes of a file one after the other, unpacked on the way where it is compressed (gzip or zlib, by zlib).
//
// zlib and not libdeflate, which unpacks only what is in memory as a whole: an image is cropped while it is read.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glisson::image {

/// Where bytes come from: a file, or memory that stands for it (fuzzers).
struct ByteSource {
  std::filesystem::path file;
  std::optional<std::string_view> memory{};
};

class ByteStream {
 public:
  enum class Packing { none, gzip };  ///< gzip: also zlib's own format

  /// @param skip  bytes of the file before the stream begins
  /// @throws ImageError  no such file, or one that ends before that
  ByteStream(const ByteSource& source, Packing packing, std::uint64_t skip = 0);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Reads up to `size` bytes. @return how many there were @throws ImageError  data that cannot be unpacked, or are cut off
  std::size_t read(void* to, std::size_t size);
  /// Unpacked bytes so far.
  std::uint64_t position() const { return position_; }
  /// Reads on to the end of what is packed, which holds its check sum. @return bytes that were left, at most `most` are read
  std::uint64_t rest(std::uint64_t most);
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::size_t raw(void* to, std::size_t size);
  std::size_t unpack(unsigned char* to, std::size_t size);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string_view memory_{};
  Packing packing_;
  std::uint64_t position_ = 0;
  z_stream z_{};
  bool ended_ = false;  ///< the last packed member
  std::vector<unsigned char> in_;
};

}  // namespace glisson::image

// zip.h — a few files as one, uncompressed: what a browser can save at once and any system opens.
//
// Contents are made twice and kept never: once to learn their length and checksum, which stand before them, once to write them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace glisson::view {

/// Takes the next piece of a text. @return false where no more is wanted
using TextSink = std::function<bool(std::string_view)>;

struct ZipFile {
  std::string name;                              ///< within the archive
  std::function<void(const TextSink&)> content;  ///< the same pieces each time
};

/// A file whose content is a text.
ZipFile text_file(std::string name, std::string text);

class ZipArchive {
 public:
  /// Measures the files. @param goes_on  asked before each piece; where it says no the archive is not whole()
  /// @throws std::length_error where they are 4 GiB or more together
  explicit ZipArchive(
      std::vector<ZipFile> files, const std::function<bool()>& goes_on = [] { return true; });

  bool whole() const { return whole_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Hands over the archive in pieces. @return whether all of it was wanted
  bool write(const TextSink& out) const;

 private:
  struct Entry {
    ZipFile file;
    std::uint32_t crc = 0, at = 0;
    std::uint64_t bytes = 0;
  };
  std::string directory() const;

  std::vector<Entry> entries_;
  std::uint64_t bytes_ = 0;
  bool whole_ = true;
};

}  // namespace glisson::view

// zip.h — a few files as one, uncompressed: what a browser can save at once and any system opens.
#pragma once

#include <span>
#include <string>

namespace glisson::view {

struct ZipFile {
  std::string name;  ///< within the archive
  std::string content;
};

/// The archive's bytes; each file below 4 GiB, all of them together, too.
std::string zip(std::span<const ZipFile> files);

}  // namespace glisson::view

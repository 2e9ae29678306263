// support.h — what the fuzz targets share: a promise that ends the program when it is broken, a folder of their own, numbers
// read off an input, and files in one input.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glisson::fuzz {

/// Stops the fuzzer with the promise's words unless it was kept.
void require(bool kept, std::string_view promise);

/// A folder for this process below the system's one for temporary files; removed at a regular end.
const std::filesystem::path& scratch();
void write_file(const std::filesystem::path& file, std::string_view bytes);
std::string read_file(const std::filesystem::path& file);

/// Files in one input: a line `=== NAME`, then the bytes up to the line feed before the next such line, or to the end.
/// What comes before the first such line belongs to no file.
std::vector<std::pair<std::string, std::string_view>> files_in(std::string_view input);

/// Numbers off the front of an input; zeros from where it has ended.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T take() {
    T value{};
    std::memcpy(&value, bytes_.data(), std::min(sizeof(T), bytes_.size()));
    bytes_.remove_prefix(std::min(sizeof(T), bytes_.size()));
    return value;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

}  // namespace glisson::fuzz

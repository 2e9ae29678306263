#include "support.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace glisson::fuzz {
namespace {

namespace fs = std::filesystem;

struct Scratch {
  fs::path folder = fs::temp_directory_path() / ("glisson_fuzz." + std::to_string(getpid()));
  Scratch() { fs::create_directories(folder); }
  ~Scratch() {
    std::error_code error;
    fs::remove_all(folder, error);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

}  // namespace

void require(bool kept, std::string_view promise) {
  if (kept) return;
  std::fprintf(stderr, "a promise was broken: %.*s\n", static_cast<int>(promise.size()), promise.data());
  std::abort();
}

const fs::path& scratch() {
  static const Scratch own;
  return own.folder;
}

void write_file(const fs::path& file, std::string_view bytes) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require(static_cast<bool>(stream.flush()), "there is room for the files of an input");
}

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  require(static_cast<bool>(stream), "the files that inputs are laid over are there");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::pair<std::string, std::string_view>> files_in(std::string_view input) {
  constexpr std::string_view kMark = "=== ";
  std::vector<std::pair<std::string, std::string_view>> files;
  while (!input.empty()) {
    const bool named = input.substr(0, kMark.size()) == kMark;
    const std::size_t line = std::min(input.find('\n'), input.size());
    const std::string name(named ? input.substr(kMark.size(), line - kMark.size()) : std::string_view{});
    if (named) input.remove_prefix(std::min(line + 1, input.size()));
    const bool empty = input.substr(0, kMark.size()) == kMark;
    const std::size_t end = empty ? 0 : std::min(input.find("\n=== "), input.size());
    if (named) files.emplace_back(name, input.substr(0, end));
    input.remove_prefix(empty ? 0 : std::min(end + 1, input.size()));
  }
  return files;
}

}  // namespace glisson::fuzz

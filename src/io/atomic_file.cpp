#include "io/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "io/raw_mesh.h"

namespace glisson::detail {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
  fail(file.string(), "it cannot be written: " + reason + "; check the folder, its permissions and the space left");
}

/// The system's number for what went wrong; 0: all is written.
int write_error(const std::filesystem::path& file, std::string_view bytes) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (out == nullptr) return errno;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  const int first = written ? 0 : errno;
  if (std::fclose(out) != 0 && first == 0) return errno;
  return first;
}

}  // namespace

void replace_file(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path part = file;
  part += ".part";
  std::error_code error;
  const std::filesystem::path folder = file.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    fail(file.string(), "its folder " + folder.string() + " does not exist; create it first");
  }
  if (const int number = write_error(part, bytes); number != 0) {
    std::filesystem::remove(part, error);
    refuse(file, std::strerror(number));
  }
  std::filesystem::rename(part, file, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(part, error);
  refuse(file, reason);
}

}  // namespace glisson::detail

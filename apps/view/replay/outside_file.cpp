// outside_file.cpp — see outside_file.h.
#include "view/replay/outside_file.h"

#include <stdexcept>
#include <system_error>

namespace glisson::view {

namespace fs = std::filesystem;

bool can_be_read(const fs::path& file, std::uintmax_t most) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (!fs::is_regular_file(status))
    throw std::invalid_argument(file.string() + ": not a regular file (" +
                                (error ? error.message() : "a pipe, a device or a folder") +
                                "); remove it, or run the scene again");
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error && size > most)
    throw std::invalid_argument(file.string() + ": " + std::to_string(size) + " bytes, at most " +
                                std::to_string(most) + " are read; a run writes less: run the scene again");
  return true;
}

std::ifstream open_outside(const fs::path& file, std::uintmax_t most) {
  if (!can_be_read(file, most)) return {};
  return std::ifstream(file, std::ios::binary);
}

}  // namespace glisson::view

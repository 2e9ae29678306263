#include "io/atomic_file.h"

#include "io/raw_mesh.h"

namespace glisson::detail {

void replace_file(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write) {
  std::filesystem::path part = file;
  part += ".part";
  std::error_code error;
  const std::filesystem::path folder = file.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    fail(file.string(), "its folder " + folder.string() + " does not exist; create it first");
  }
  try {
    write(part);
  } catch (...) {
    std::filesystem::remove(part, error);
    throw;
  }
  std::filesystem::rename(part, file, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(part, error);
  fail(file.string(), "it cannot be replaced: " + reason);
}

}  // namespace glisson::detail

// output_folder.cpp — see output_folder.h.
#include "report/output_folder.h"

#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "report/output_file.h"
#include "scene/run/result_names.h"

namespace glisson {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".glisson";
constexpr const char* kMarkText = "Results of glisson. A new run into this folder replaces them.\n";

[[noreturn]] void refuse_folder(const fs::path& folder, const std::string& reason) {
  throw std::invalid_argument(folder.string() + ": " + reason +
                              "; choose another folder with --out DIR, or empty this one yourself");
}

/// Files and folders below `folder`, the deepest first. Links are not followed and are not ours.
std::vector<fs::path> former_run(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const bool ours =
        !entry.is_symlink() &&
        (entry.is_directory() || (entry.is_regular_file() && scene::is_result_file(entry.path().filename().string())));
    if (!ours)
      refuse_folder(folder,
                    "holds " + entry.path().lexically_relative(folder).string() + ", which glisson did not write");
    found.push_back(entry.path());
  }
  return {found.rbegin(), found.rend()};
}

}  // namespace

void prepare_output_folder(const fs::path& folder) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder)) refuse_folder(folder, "is a file, not a folder");
    if (fs::exists(folder) && !fs::is_empty(folder)) {
      if (!fs::exists(folder / kMark)) refuse_folder(folder, "is not empty and holds no results of glisson");
      for (const fs::path& file : former_run(folder)) fs::remove(file);
    }
  } catch (const fs::filesystem_error& error) {
    throw OutputError(folder.string() + ": cannot be prepared: " + error.code().message() +
                      "; choose another folder with --out DIR");
  }
  make_folder(folder);
  write_whole(folder / kMark, kMarkText);
}

}  // namespace glisson

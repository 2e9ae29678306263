// variant_folder.cpp — see variant_folder.h.
#include "view/replay/variant_folder.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>

namespace glisson::view {
namespace {

constexpr const char* kFrames = "frames.pvd";

[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const std::string& why) {
  throw std::invalid_argument(folder.string() + ": " + why);
}

bool has_file(const std::filesystem::path& folder, const char* name) {
  std::error_code error;
  return std::filesystem::is_regular_file(folder / name, error);
}

std::vector<std::string> variants_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (has_file(at->path(), kFrames)) names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

VariantFolder variant_folder(const std::filesystem::path& folder, const std::string& wanted) {
  VariantFolder found;
  if (has_file(folder, kFrames)) {
    found = {folder, folder.filename().string(), {folder.filename().string()}};
    if (!wanted.empty() && wanted != found.variant)
      refuse_folder(folder, "--variant " + wanted + ": this is the folder of one variant; give the folder of the run");
    return found;
  }
  found.variants = variants_in(folder);
  if (found.variants.empty()) {
    refuse_folder(folder, has_file(folder, ".glisson")
                              ? "a run without frames; run its scene again with `--set output.frames=30`, or open "
                                "report.html"
                              : "holds no run of glisson (no <variant>/frames.pvd); give the folder that `glisson run "
                                "SCENE --out DIR` wrote, or a scene file");
  }
  found.variant = wanted.empty() ? found.variants.front() : wanted;
  if (std::find(found.variants.begin(), found.variants.end(), found.variant) == found.variants.end()) {
    std::string names;
    for (const std::string& name : found.variants) names += (names.empty() ? "" : ", ") + name;
    refuse_folder(folder, "--variant " + wanted + ": no such variant with frames; it has " + names);
  }
  found.path = folder / found.variant;
  return found;
}

}  // namespace glisson::view

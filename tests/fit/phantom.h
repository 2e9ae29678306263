// phantom.h — the silicone phantoms' files, where they lie beside the sources, and folders for variants of files.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fit/data/load_curves.h"
#include "glisson/scene/scene.h"
#include "support/places.h"

namespace glisson::fit::phantom {

inline const std::filesystem::path kPhantoms = glisson::test::shipped("../shared/data/phantom");

inline bool have_phantoms() { return std::filesystem::exists(kPhantoms / "EF10_100T_A1.csv"); }

/// Diameter 50 mm, height 30 mm.
inline const SpecimenSize kPhantomSize{.area = 3.14159265358979323846 * 0.025 * 0.025, .height = 0.030, .radius = {}};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of a test, empty at its start and removed at its end.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("glisson_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline DataSpec spec_of(std::vector<std::filesystem::path> files) {
  DataSpec spec;
  spec.files = std::move(files);
  return spec;
}

/// What loading says is wrong; empty where nothing is.
inline std::string complaint(const DataSpec& spec, const SpecimenSize& size = {},
                             const std::filesystem::path& base = {}) {
  try {
    load_curves(spec, size, base);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

}  // namespace glisson::fit::phantom

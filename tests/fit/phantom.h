// phantom.h — the silicone phantoms' files, where they lie beside the sources, and folders for variants of files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fit/data/load_curves.h"
#include "glisson/scene/scene.h"
#include "support/folder.h"
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

using test::Folder;

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

// shipped_scenes_test.cpp — the scenes that come with the project are sound.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "glisson/scene/scene.h"
#include "support/places.h"

namespace glisson {
namespace {

/// A FIT.toml, which frees parameters of a scene or specimen, or membranes; tests/fit reads those.
bool is_fit(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.find("\n[[parameter]]") != std::string::npos || text.find("\n[insertion]") != std::string::npos;
}

// Every scene under scenes/ is read without complaint and says what it is.
TEST(ShippedScenes, AreSound) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::shipped("scenes"))) {
    if (entry.path().extension() != ".toml" || is_fit(entry.path())) continue;
    ++count;
    try {
      const Scene scene = load_scene(entry.path());
      EXPECT_FALSE(scene.title.empty() || scene.description.empty()) << entry.path();
      EXPECT_FALSE(scene.variants.empty()) << entry.path();
    } catch (const SceneError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(count, 0) << "no scenes under " << test::shipped("scenes");
}

}  // namespace
}  // namespace glisson

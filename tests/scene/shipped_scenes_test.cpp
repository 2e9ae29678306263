// shipped_scenes_test.cpp — the scenes that come with the project are sound.
#include <gtest/gtest.h>

#include <filesystem>

#include "glisson/scene.h"

namespace glisson {
namespace {

// Every scene under scenes/ is read without complaint and says what it is.
TEST(ShippedScenes, AreSound) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(GLISSON_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    try {
      const Scene scene = load_scene(entry.path());
      EXPECT_FALSE(scene.title.empty() || scene.description.empty()) << entry.path();
      EXPECT_FALSE(scene.variants.empty()) << entry.path();
    } catch (const SceneError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(count, 0) << "no scenes under " GLISSON_SOURCE_DIR "/scenes";
}

}  // namespace
}  // namespace glisson

// image_scene_test.cpp — glisson scene from-image: the scene that it writes runs, and the body starts at rest where the
// image has it.
#include <cmath>

#include "app/program.h"
#include "image/label_image.h"

namespace glisson::test {
namespace {

using ImageScene = ProgramTest;
using ::testing::HasSubstr;

/// A ball of 54 mm with a lump, whose back lies 10 mm deep in a slab.
std::string organ_on_a_slab() {
  return meta_image({26, 24, 26}, 3.0, [](int i, int j, int k) {
    const double r = std::hypot(i - 12.5, j - 13.5, k - 12.5);
    return j < 8 ? 9 : r < 3.5 ? 64 : r < 9.0 ? 5 : 0;
  });
}

// Two commands from an image to a pressed organ: it holds still until the finger comes, and the finger meets it.
TEST_F(ImageScene, RunsAsItIsWritten) {
  const Outcome written = run({"scene", "from-image", write("a.mha", organ_on_a_slab()), "--organ", "liver=5",
                               "--labels", "tumour=64", "--beside", "spine=9", "--press", "5", "--out", "s.toml"});
  ASSERT_THAT(written, Exits(0)) << written.err;
  const Outcome ran = run({"run", "s.toml", "--out", "out"});
  ASSERT_THAT(ran, Exits(0)) << ran.err;
  const nlohmann::json summary = read_json(folder_ / "out/main/summary.json");
  EXPECT_TRUE(summary.contains("unloaded"));
  EXPECT_GT(summary.at("peak_force_N").get<double>(), 0.1);
}

// What the command refuses it says with the way out, and a scene that may hold changes stays.
TEST_F(ImageScene, ExplainsWhatItRefuses) {
  const std::string image = write("a.mha", organ_on_a_slab());
  const auto said = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"scene", "from-image", image};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    EXPECT_THAT(outcome, Exits(2));
    return outcome.err;
  };
  EXPECT_THAT(said({"--organ", "7", "--out", "t.toml"}), HasSubstr("label 7"));
  EXPECT_THAT(said({"--organ", "5", "--out", "t.toml"}), HasSubstr("Give --beside NAME=LABELS"));
  write("mine.toml", "title = \"mine\"\n");
  EXPECT_THAT(said({"--organ", "5", "--beside", "spine=9", "--out", "mine.toml"}), HasSubstr("--force"));
  EXPECT_THAT(read_text(folder_ / "mine.toml"), HasSubstr("mine"));
}

}  // namespace
}  // namespace glisson::test

// measured_test.cpp — a chart takes measured points from a file beside its scene, in the units it shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The small scene with a chart that shows points of a file of this text.
Scene scene_with(const std::string& file, const std::string& keys) {
  const test::Folder folder;
  folder.write("measured.csv", file);
  const std::string chart =
      "[[chart]]\ntitle = \"f\"\nx = \"depth_m\"\ny = \"force_N\"\n[[chart.measured]]\npath = "
      "\"measured.csv\"\n";
  return parse_scene(test::kSmallScene + chart + keys, "s.toml", folder.path());
}

std::string complaint(const std::string& file, const std::string& keys) {
  try {
    scene_with(file, keys);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

// x shown is x_scale (x − x_offset); words in other columns do not matter.
TEST(Measured, IsReadAndScaled) {
  const Scene scene = scene_with("# by hand\nplace_mm,force_mN,what\n10,20,a\n12.5,40,b\n",
                                 "label = \"1999\"\nx = \"place_mm\"\ny = \"force_mN\"\nx_offset = 9\nx_scale = 2\n"
                                 "y_scale = 0.001\n");
  const MeasuredSpec& m = scene.charts.at(0).measured.at(0);
  EXPECT_EQ(m.label, "1999");
  EXPECT_THAT(m.xs, ElementsAre(2.0, 7.0));
  EXPECT_THAT(m.ys, ElementsAre(0.02, 0.04));
}

// A file, column or number that is not there is told with the line of the scene, and that of the file.
TEST(Measured, MistakesAreTold) {
  const std::string keys = "x = \"a\"\ny = \"b\"\n";
  EXPECT_THAT(complaint("a,c\n1,2\n", keys), AllOf(StartsWith("s.toml:20:1: chart.0.measured: "),
                                                   HasSubstr("/measured.csv: no column \"b\"; it has: a, c")));
  EXPECT_THAT(complaint("a,b\n1,2\n3,x\n", keys), HasSubstr(":3: \"x\" in column 2 is no finite number"));
  EXPECT_THAT(complaint("a,b\n", "path = 3\n"), HasSubstr("path"));
  EXPECT_THAT(test::complaint(test::kSmallScene + "[[chart]]\ntitle = \"f\"\nx = \"depth_m\"\ny = \"force_N\"\n"
                                                  "measured = [{ path = \"none.csv\", x = \"a\", y = \"b\" }]\n"),
              HasSubstr("/scenes/none.csv: cannot be read"));
}

}  // namespace
}  // namespace glisson

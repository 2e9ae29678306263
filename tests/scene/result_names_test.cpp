// No name of a scene can take the place of a file that a run writes, on any file system; what a run writes is known by name.
#include "scene/parse/result_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson::scene {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Every file and folder of a run and of a fit, in any case, and what becomes one of them.
TEST(ResultNames, OfARunAreNoNamesOfVariantsToolsAndInstruments) {
  for (const char* name : {"report.html", "scene.toml", "fit.toml", "fit.json", "fit.state.json", "tissue.toml",
                           "summary.json", "forces.csv", "forces_side.csv", "events.csv", "frames.pvd", "frames",
                           "view.jsonl", "frame_0001.vtu", "scene.toml.part", "Forces.CSV", "SCENE.toml", "FRAMES"}) {
    EXPECT_THAT(unfit_as_folder(name), HasSubstr("glisson itself writes")) << name;
    EXPECT_THAT(unfit_as_table(name), HasSubstr("glisson itself writes")) << name;
  }
  for (const char* name : {".glisson", ".", "..", "a/b", "/", "-a", "a.", "", "a\nb", "a\tb", "\x7f", "a b"})
    EXPECT_FALSE(unfit_as_folder(name).empty()) << name;
  for (const char* name : {".", "..", "a/b", "a\\b", "/", "", "a\nb", "\x7f", "a,b", "a\"b", "C:"})
    EXPECT_FALSE(unfit_as_table(name).empty()) << name;
  EXPECT_THAT(unfit_as_folder(std::string(81, 'a')), HasSubstr("longer than 80"));
}

// Names that only look alike stay allowed, those of the shipped scenes among them.
TEST(ResultNames, LeaveOthersAlone) {
  for (const char* name :
       {"main", "v10", "eta_1000", "scene", "forces", "report.html.old", "frame_a.vtu", "a.part.b"}) {
    EXPECT_THAT(unfit_as_folder(name), IsEmpty()) << name;
    EXPECT_THAT(unfit_as_table(name), IsEmpty()) << name;
  }
  for (const char* name : {"18 G", "Nadel (groß)", "probe.2"}) EXPECT_THAT(unfit_as_table(name), IsEmpty()) << name;
}

// A former run is cleared away by these names alone: a file of the user's that differs in case is not one of ours.
TEST(ResultNames, AreKnownByTheirExactNames) {
  EXPECT_TRUE(is_result_file("forces_a b.csv"));
  EXPECT_TRUE(is_result_file("frame_0001.vtu"));
  EXPECT_TRUE(is_result_file("report.html.part"));
  EXPECT_TRUE(is_result_file("tool_18 G_0012.vtp"));
  EXPECT_TRUE(is_result_file("tool_a_b.pvd"));
  for (const char* name : {"tool_0001.vtp", "tool__0001.vtp", "tool_a_.vtp", "tool_.pvd", "Report.html", "forces_.csv",
                           "frame_.vtu", "frame_1a.vtu", ".part", "thesis.txt", "frames"})
    EXPECT_FALSE(is_result_file(name)) << name;
}

// A tool and an instrument whose names differ in case alone would share a file where case does not count.
TEST(ResultNames, OfToolsAndInstrumentsDifferInMoreThanCase) {
  const std::string needle =
      "[[instrument]]\nkind = \"ball\"\nname = \"Press\"\ntip_m = [0, 0, 1]\n"
      "motion = { kind = \"press\", velocity_mm_s = 1, depth_mm = 1 }\n";
  EXPECT_THAT(test::complaint(test::kSmallScene + needle),
              HasSubstr("\"Press\" is taken by a tool (upper and lower case"));
}

}  // namespace
}  // namespace glisson::scene

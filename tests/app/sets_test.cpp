// What `check` says of sets whose size hangs on rounding or that hold vertices which bear nothing, and what runs on them give.
#include <cmath>

#include "app/program.h"
#include "glisson/io.h"
#include "glisson/mesh.h"

namespace glisson::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Sets : public ProgramTest {
 protected:
  /// What check says of a scene.
  std::string check(const std::string& text) {
    const Outcome outcome = run({"check", write("s.toml", text)});
    EXPECT_THAT(outcome, Exits(0));
    return outcome.out;
  }
};

/// A block of 40 × 40 × 20 mm about x = y = 0 on cells of 4 mm, pressed on a set by 1 mm.
std::string pressed_block(const std::string& pad) {
  return R"([mesh]
kind = "box"
cells = [10, 10, 5]
size_m = [0.04, 0.04, 0.02]
origin_m = [-0.02, -0.02, 0]
[sets.pad]
)" + pad +
         R"(
[tissue]
youngs_modulus_Pa = 4000
poisson_ratio = 0.4
[motion]
integrator = "quasi_static"
[[fixed]]
set = "z_min"
[[tool]]
set = "pad"
depth_mm = 1
[output]
frames = 1
)";
}

const std::string kPadByBox = "box_m = { min = [-0.008, -0.008, 0.02], max = [0.008, 0.008, 0.02] }";

// A pad of 16 mm given by a box presses as the one of its 25 vertices by number does, to the last byte: 0.177 N. On cells that are
// mirrored about its middle nothing acts sideways. `check` says how many vertices only the tolerance gives it.
TEST_F(Sets, APadGivenByABoxIsTheWholePad) {
  std::string numbers;
  for (int j = 3; j <= 7; ++j) {
    for (int i = 3; i <= 7; ++i) numbers += (numbers.empty() ? "" : ", ") + std::to_string(i + 11 * (j + 11 * 5));
  }
  write("s.toml", pressed_block(kPadByBox));
  write("numbers.toml", pressed_block("vertices = [" + numbers + "]"));
  ASSERT_THAT(run({"run", "s.toml", "--out", "box"}), Exits(0));
  ASSERT_THAT(run({"run", "numbers.toml", "--out", "numbers"}), Exits(0));
  EXPECT_EQ(read_text(folder_ / "box/main/forces.csv"), read_text(folder_ / "numbers/main/forces.csv"));
  const auto forces = read_csv(folder_ / "box/main/forces.csv");
  EXPECT_NEAR(forces.at("force_z_N").back(), -0.177, 0.0005);
  ASSERT_THAT(run({"run", "s.toml", "--set", "mesh.split=alternating", "--out", "mirrored"}), Exits(0));
  const auto mirrored = read_csv(folder_ / "mirrored/main/forces.csv");
  for (const char* sideways : {"force_x_N", "force_y_N"})
    EXPECT_LE(std::abs(mirrored.at(sideways).back()), 1e-7 * 0.177);
  const std::string said = check(pressed_block(kPadByBox));
  EXPECT_THAT(said, HasSubstr("\"pad\", 25 vertices"));
  EXPECT_THAT(said, HasSubstr("set      \"pad\": 25 vertices, 9 of them outside of its bounds by rounding alone"));
  EXPECT_THAT(check(pressed_block("side = { axis = \"z\", end = \"upper\", depth_m = 0 }")),
              Not(HasSubstr("rounding")));
}

// Bounds that miss vertices by more than rounding, as those of a file in single precision are missed, are named with what is missed
// and by how much; bounds well between vertices are not.
TEST_F(Sets, CheckNamesVerticesJustOutside) {
  const std::string missed = "box_m = { min = [-0.00799999, -0.008, 0.02], max = [0.008, 0.008, 0.02] }";
  EXPECT_THAT(check(pressed_block(missed)),
              HasSubstr("set      \"pad\": 20 vertices; 5 more lie outside of its bounds by 1e-05 mm or less"));
  const std::string between = "box_m = { min = [-0.01, -0.01, 0.019], max = [0.01, 0.01, 0.021] }";
  EXPECT_THAT(check(pressed_block(between)), Not(HasSubstr("set      \"pad\"")));
}

// Of regions `check` says it of the centroids of their tets. Those of a cell lie at 1/4, 1/2 and 3/4 of it along x, two of six each: a bound
// in the middle of the second column of 50 cells has 6 + 4 of 6.
TEST_F(Sets, CheckNamesTetsOfRegionsByRounding) {
  const std::string scene =
      pressed_block(kPadByBox) + "[[region]]\nname = \"low\"\ntissue.youngs_modulus_Pa = 8000\nbox_m = ";
  EXPECT_THAT(check(scene + "{ min = [-1, -1, 0], max = [-0.014, 1, 1] }"),
              HasSubstr("region   \"low\": 500 tets, 100 of them outside of its bounds by rounding alone"));
  EXPECT_THAT(check(scene + "{ min = [-1, -1, 0], max = [-0.0135, 1, 1] }"), Not(HasSubstr("region   \"low\": 5")));
}

// Vertices in no tet are left out of what bears a load, and `check` says how many: the block's support takes the whole force.
TEST_F(Sets, LooseVerticesAreLeftOut) {
  TetMesh mesh = box_mesh({.cells = {2, 2, 4}, .size = {0.02, 0.02, 0.04}});
  for (int i = 0; i < 18; ++i) mesh.vertices.push_back({0.001 * i, 0.004, 0.04});
  write_vtu(folder_ / "loose.vtu", mesh);
  const std::string scene = R"([mesh]
kind = "file"
path = "loose.vtu"
[sets.bottom]
side = { axis = "z", end = "lower", depth_m = 1e-6 }
[sets.top]
side = { axis = "z", end = "upper", depth_m = 1e-6 }
[motion]
integrator = "quasi_static"
duration_s = 0.1
[[fixed]]
set = "bottom"
[[load]]
set = "top"
force_N = [0, 0, 0.02]
[output]
frames = 1
)";
  EXPECT_THAT(check(scene), HasSubstr("load     \"top\", 9 vertices (left out: 18 in no tet, which bear nothing)"));
  ASSERT_THAT(run({"run", "s.toml", "--out", "o"}), Exits(0));
  EXPECT_NEAR(read_csv(folder_ / "o/main/forces.csv").at("support_bottom_z_N").back(), -0.02, 1e-8);
}

}  // namespace
}  // namespace glisson::test

// image_command_test.cpp — glisson image: fields of frames and regions of meshes on the voxels of an image.
#include <cmath>
#include <cstring>

#include "app/program.h"
#include "glisson/image/read_image.h"
#include "glisson/io.h"
#include "image/label_image.h"

namespace glisson::test {
namespace {

using ImageCommand = ProgramTest;
using ::testing::HasSubstr;

/// Voxels of 10 mm whose centres are the vertices of the box of small_scene, in RAS.
std::string vertex_grid() {
  return meta_image({3, 3, 3}, 10.0, [](int, int, int) { return 1; });
}

// At voxels whose centres are vertices, the image has the displacement that the frame has there, in mm; at rest as deformed, where the body still
// holds them.
TEST_F(ImageCommand, DisplacementOfAFrame) {
  ASSERT_THAT(run({"run", write("a.toml", small_scene()), "--out", "out"}), Exits(0));
  const std::string grid = write("grid.mha", vertex_grid());
  const Outcome outcome =
      run({"image", "out", "--like", grid, "--field", "displacement", "--out", "u.nii", "--frame", "1"});
  ASSERT_THAT(outcome, Exits(0)) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("displacement_mm, 3 × 3 × 3 voxels, 27 of them in the body"));
  const std::string array = "displacement_m";
  const ReadFrame frame = read_frame(folder_ / "out/main/frames/frame_0001.vtu", std::span(&array, 1));
  const std::string bytes = read_text(folder_ / "u.nii");
  ASSERT_EQ(bytes.size(), 352u + 27u * 3u * 4u);
  double largest = 0.0;
  for (std::size_t v = 0; v < 27; ++v) {
    const Vec3d& x = frame.mesh.vertices[v];
    const auto voxel = static_cast<std::size_t>(std::lround(100.0 * x.x) + 3 * std::lround(100.0 * x.y) +
                                                9 * std::lround(100.0 * x.z));
    for (std::size_t c = 0; c < 3; ++c) {
      float value = 0.0F;
      std::memcpy(&value, bytes.data() + 352 + 4 * (27 * c + voxel), 4);
      const double expected = 1e3 * frame.vertex_fields.at(0).values[3 * v + c];
      EXPECT_NEAR(value, expected, 1e-6);
      largest = std::max(largest, std::abs(expected));
    }
  }
  EXPECT_GT(largest, 0.1);
}

// Stress, strain and temperature come from their arrays by their names without unit; the last frame is taken unless another is asked for; what is
// outside has the value that was given.
TEST_F(ImageCommand, FieldsOfTets) {
  ASSERT_THAT(run({"run", write("a.toml", small_scene()), "--out", "out"}), Exits(0));
  const std::string grid = write("grid.mha", meta_image({8, 8, 9}, 4.0, [](int, int, int) { return 1; }));
  ASSERT_THAT(run({"image", "out", "--like", grid, "--field", "von_mises", "--outside", "-1", "--out", "v.nii.gz"}),
              Exits(0));
  const GreyImage stress = read_grey_image(folder_ / "v.nii.gz");
  std::size_t inside = 0;
  for (std::size_t v = 0; v < stress.voxels.size(); ++v) {
    const auto at = stress.grid.place(v);
    const bool in_body = at[0] <= 5 && at[1] <= 5 && at[2] <= 5;  // 20 mm
    ASSERT_EQ(stress.voxels[v] == -1.0F, !in_body) << v;
    if (!in_body) continue;
    ++inside;
    ASSERT_GT(stress.voxels[v], 1.0F) << v;
  }
  EXPECT_EQ(inside, 216u);
  ASSERT_THAT(run({"image", "out", "--like", grid, "--field", "stress", "--own", "--out", "s.nii"}), Exits(0));
  EXPECT_EQ(read_text(folder_ / "s.nii").size(), 352u + 8u * 8u * 9u * 6u * 4u);
}

// The regions of a mesh are labels with their names; after a press the labels are where the body is.
TEST_F(ImageCommand, Labels) {
  const std::string image = write("a.mha", meta_image({26, 24, 22}, 3.0, [](int i, int j, int k) {
                                    return std::hypot(i - 12.5, j - 11.5, k - 10.5) > 9.0 ? 0 : i < 13 ? 5 : 9;
                                  }));
  ASSERT_THAT(run({"mesh", image, "--labels", "organ=5,lump=9", "--out", "b.vtu"}), Exits(0));
  ASSERT_THAT(run({"image", "b.vtu", "--like", image, "--field", "labels", "--out", "l.nii.gz"}), Exits(0));
  const LabelImage labels = read_label_image(folder_ / "l.nii.gz");
  EXPECT_EQ(labels.names, (std::map<int, std::string>{{5, "organ"}, {9, "lump"}}));
  const LabelImage before = read_label_image(image);
  std::size_t same = 0, set = 0;
  for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
    set += before.voxels[v] != 0;
    same += before.voxels[v] != 0 && before.voxels[v] == labels.voxels[v];
  }
  EXPECT_GE(static_cast<double>(same) / static_cast<double>(set), 0.98);
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "out"}), Exits(0));
  const std::string grid = write("grid.mha", meta_image({12, 12, 22}, 2.0, [](int, int, int) { return 1; }));
  const auto top = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {"image", "out", "--like", grid, "--field", "labels", "--outside", "9", "--out", "t.nii"});
    const Outcome outcome = run(more);
    EXPECT_THAT(outcome, Exits(0)) << outcome.err;
    const LabelImage made = read_label_image(folder_ / "t.nii");
    return made.voxels[made.grid.at(5, 5, 10)];  // z = 20 mm, the top at rest, 1 mm above the pressed one
  };
  EXPECT_EQ(top({}), 0);
  EXPECT_EQ(top({"--deformed"}), 9);
}

// What cannot be done is said with the way out.
TEST_F(ImageCommand, ExplainsWhatItRefuses) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "out"}), Exits(0));
  const std::string grid = write("grid.mha", vertex_grid());
  const auto said = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "image");
    const Outcome outcome = run(arguments);
    EXPECT_THAT(outcome, Exits(2));
    return outcome.err;
  };
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"out", "--like", grid, "--out", "u.nii"});
    return said(more);
  };
  EXPECT_THAT(with({"--field", "temperature"}),
              HasSubstr("has no field \"temperature\"; it has: displacement_m, velocity_m_s"));
  EXPECT_THAT(with({"--field", "stress", "--frame", "7"}), HasSubstr("has 3 frames, 0 to 2"));
  EXPECT_THAT(with({"--field", "stress", "--variant", "x"}), HasSubstr("no such variant with frames; it has main"));
  EXPECT_THAT(with({"--field", "stress", "--outside", "far"}), HasSubstr("give a number, or nan"));
  EXPECT_THAT(with({"--field", "labels", "--outside", "nan"}), HasSubstr("give a label, 0 to 65535"));
  std::string far = vertex_grid();
  far.replace(far.find("Offset = 0 0 0"), 14, "Offset = 900 0 0");
  EXPECT_THAT(said({"out", "--like", write("far.mha", far), "--field", "stress", "--out", "u.nii"}),
              HasSubstr("no voxel's centre lies in the body, which is at 0 to 20, 0 to 20, 0 to 20 mm in RAS"));
  EXPECT_THAT(
      said({"out/main/frames/frame_0001.vtu", "--like", grid, "--field", "s", "--frame", "1", "--out", "u.nii"}),
      HasSubstr("is one frame"));
  EXPECT_THAT(said({"out", "--like", grid, "--field", "s", "--out", "u.mha"}),
              HasSubstr("give a name that ends in .nii or .nii.gz"));
  EXPECT_THAT(said({"out", "--like", "none.nii", "--field", "s", "--out", "u.nii"}),
              HasSubstr("there is no such file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "u.nii"));
}

}  // namespace
}  // namespace glisson::test

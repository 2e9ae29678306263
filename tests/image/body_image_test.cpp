// body_image_test.cpp — fields of a body on the voxels of an image, and the files that they become.
#include "glisson/image/body_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "glisson/image/image_body.h"
#include "glisson/image/read_image.h"
#include "glisson/image/write_image.h"
#include "image/label_image.h"
#include "support/folder.h"

namespace glisson {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float kGap = std::numeric_limits<float>::quiet_NaN();

/// A grid whose axes are turned and, by `shear`, not at right angles; its voxels' centres lie on no face of the meshes here.
ImageGrid skew_grid(double shear) {
  ImageGrid grid;
  grid.size = {23, 19, 21};
  const double c = std::cos(0.4), s = std::sin(0.4);
  grid.axes = Mat3d{{{{0.0031 * c, -0.0029 * s, shear * 0.001}, {0.0031 * s, 0.0029 * c, 0.0}, {0.0, 0.0, 0.0033}}}};
  grid.origin = {-0.0111, -0.0123, -0.0097};
  return grid;
}

struct LinearField {
  Vec3d slope{310.0, -170.0, 90.0};
  double at(const Vec3d& x) const { return 7.0 + dot(slope, x); }
};

bool in_box(const Vec3d& x) { return x.x > 0.0 && x.y > 0.0 && x.z > 0.0 && x.x < 0.03 && x.y < 0.02 && x.z < 0.04; }

TetMesh block() { return box_mesh({.cells = {5, 3, 6}, .size = {0.03, 0.02, 0.04}, .split = BoxSplit::alternating}); }

// A field that is linear in space comes back exact, to 1e-6 of its size, at the centre of each voxel within the body, and nowhere else, on a
// sheared grid; so it does on the body as an affine map has deformed it.
TEST(BodyImages, LinearFieldIsExact) {
  const TetMesh mesh = block();
  const LinearField field;
  std::vector<double> values;
  std::vector<Vec3d> moved;
  const Mat3d map{{{{1.1, 0.2, 0.0}, {0.0, 0.9, 0.1}, {0.1, 0.0, 1.2}}}};
  for (const Vec3d& x : mesh.vertices) {
    values.insert(values.end(), {field.at(x), -2.0 * field.at(x)});
    moved.push_back(map * x);
  }
  const ImageGrid grid = skew_grid(0.4);
  for (const bool deformed : {false, true}) {
    SCOPED_TRACE(deformed);
    const VoxelPlaces places(mesh, grid, deformed ? std::span<const Vec3d>(moved) : std::span<const Vec3d>());
    const ValueImage image = places.vertex_values(values, 2, kGap);
    std::size_t inside = 0;
    double worst = 0.0;
    for (std::size_t v = 0; v < grid.voxels(); ++v) {
      const auto at = grid.place(v);
      const Vec3d x = grid.world({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
      const Vec3d rest = deformed ? inverse(map) * x : x;
      ASSERT_EQ(!std::isnan(image.values[v]), in_box(rest)) << v;
      if (!in_box(rest)) continue;
      ++inside;
      worst = std::max({worst, std::abs(image.values[v] - field.at(rest)),
                        0.5 * std::abs(image.values[grid.voxels() + v] + 2.0 * field.at(rest))});
    }
    EXPECT_EQ(places.inside(), inside);
    EXPECT_GT(inside, 500u);
    EXPECT_LE(worst, 1e-6 * 25.0);  // the field is 3.6 to 19.9 in the body
  }
}

// Tets that are gone hold no voxel.
TEST(BodyImages, RemovedTetsAreOutside) {
  const TetMesh mesh = block();
  std::vector<char> removed(mesh.tets.size(), 1);
  EXPECT_EQ(VoxelPlaces(mesh, skew_grid(0.0), {}, removed).inside(), 0u);
  removed.assign(removed.size(), 0);
  const std::size_t all = VoxelPlaces(mesh, skew_grid(0.0), {}, removed).inside();
  for (std::size_t t = 0; t < removed.size() / 2; ++t) removed[t] = 1;
  const std::size_t half = VoxelPlaces(mesh, skew_grid(0.0), {}, removed).inside();
  EXPECT_NEAR(static_cast<double>(half) / static_cast<double>(all), 0.5, 0.05);  // one of 12 layers of voxels
}

// What is constant in a region stays so up to its faces, with the jump between regions; the mean over the body is kept, and the
// value of a tet is its own where that is asked for.
TEST(BodyImages, ValuesOfTets) {
  TetMesh mesh = block();
  std::vector<double> by_region, by_tet;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d centre{};
    for (const std::uint32_t v : mesh.tets[t]) centre += mesh.vertices[v] * 0.25;
    mesh.regions.push_back(centre.z < 0.02 ? 1 : 2);
    by_region.push_back(mesh.regions.back() == 1 ? 100.0 : 900.0);
    by_tet.push_back(static_cast<double>(t));
  }
  const ImageGrid grid = skew_grid(0.0);
  const VoxelPlaces places(mesh, grid);
  const ValueImage smooth = places.tet_values(by_region, 1, TetValues::smooth, -1.0F);
  const ValueImage own = places.tet_values(by_tet, 1, TetValues::own, -1.0F);
  const LabelImage labels = places.labels(7);
  std::size_t of_two = 0;
  for (std::size_t v = 0; v < grid.voxels(); ++v) {
    const float expected = labels.voxels[v] == 1 ? 100.0F : labels.voxels[v] == 2 ? 900.0F : -1.0F;
    ASSERT_NEAR(smooth.values[v], expected, 1e-3);
    ASSERT_TRUE(labels.voxels[v] == 7 ? own.values[v] == -1.0F
                                      : mesh.regions[static_cast<std::size_t>(own.values[v])] == labels.voxels[v]);
    of_two += labels.voxels[v] == 2;
  }
  EXPECT_NEAR(static_cast<double>(of_two) / static_cast<double>(places.inside()), 0.5, 0.05);
}

// What does not fit is refused: fields of another length, regions that are no labels.
TEST(BodyImages, Refuses) {
  TetMesh mesh = block();
  const VoxelPlaces places(mesh, skew_grid(0.0));
  const std::vector<double> short_one(7);
  EXPECT_THAT([&] { places.vertex_values(short_one, 1, 0.0F); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("7 values at vertices in place of 168")));
  EXPECT_THAT([&] { places.tet_values(short_one, 1, TetValues::own, 0.0F); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("7 values of tets")));
  mesh.regions.assign(mesh.tets.size(), 70000);
  EXPECT_THAT([&] { places.labels(); }, ThrowsMessage<std::invalid_argument>(HasSubstr("region 70000 is no label")));
}

class ImageFiles : public test::InFolder {};

double grid_difference(const ImageGrid& a, const ImageGrid& b) {
  double worst = norm(a.origin - b.origin);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, 20.0 * std::abs(a.axes(r, c) - b.axes(r, c)));
  }
  return worst;
}

// Values that were written read as the same bits, NaN included where gaps are allowed, on a grid that is the same to single precision; packed
// or not.
TEST_F(ImageFiles, ValuesComeBack) {
  ValueImage image{skew_grid(0.4), 1, {}};
  std::mt19937 random(3);
  for (std::size_t v = 0; v < image.grid.voxels(); ++v)
    image.values.push_back(v % 7 == 0 ? kGap : 1e-3F * static_cast<float>(random() % 100000));
  for (const char* name : {"v.nii", "v.nii.gz"}) {
    const std::filesystem::path file = folder_ / name;
    write_nifti(file, image);
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
    const GreyImage back = read_grey_image(file, {.gaps = true});
    EXPECT_LE(grid_difference(back.grid, image.grid), 2e-8);  // 20 voxels of 3 mm, and 11 mm, in single precision
    ASSERT_EQ(back.voxels.size(), image.values.size());
    EXPECT_EQ(std::memcmp(back.voxels.data(), image.values.data(), 4 * image.values.size()), 0);
    EXPECT_THAT([&] { read_grey_image(file); }, ThrowsMessage<ImageError>(HasSubstr("no finite number")));
  }
}

// The quaternion is that of the axes: with the sform taken out of the file, the reader gets the same grid from it, for turns about any axis by
// any angle, half turns among them, and left-handed axes. A sheared grid has no quaternion.
TEST_F(ImageFiles, QuaternionIsThatOfTheAxes) {
  std::mt19937 random(5);
  std::normal_distribution<double> draw;
  const auto without_sform = [&](const ImageGrid& grid) {
    write_nifti(folder_ / "q.nii", ValueImage{grid, 1, std::vector<float>(grid.voxels())});
    std::ifstream stream(folder_ / "q.nii", std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    bytes[254] = 0;
    return read_grey_image(write("q2.nii", bytes));
  };
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const Vec3d axis = trial % 5 == 0
                           ? Vec3d{trial % 3 == 0 ? 1.0 : 0.0, trial % 3 == 1 ? 1.0 : 0.0, trial % 3 == 2 ? 1.0 : 0.0}
                           : unit(Vec3d{draw(random), draw(random), draw(random)});
    const double angle = trial % 4 == 0 ? M_PI : draw(random), c = std::cos(angle), s = std::sin(angle);
    ImageGrid grid;
    grid.size = {2, 3, 2};
    const Vec3d spacing{0.001, 0.002, 0.0035};
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3d e{};
      e[k] = trial % 2 == 1 && k == 1 ? -spacing[k] : spacing[k];
      const Vec3d turned = e * c + cross(axis, e) * s + axis * (dot(axis, e) * (1.0 - c));
      for (std::size_t r = 0; r < 3; ++r) grid.axes(r, k) = turned[r];
    }
    grid.origin = {0.1 * draw(random), 0.1 * draw(random), 0.1 * draw(random)};
    const GreyImage back = without_sform(grid);
    EXPECT_TRUE(back.notes.empty());
    // The first component, which is not in the file, is √(1 − b² − c² − d²): near a half turn it is known to 1.2e-7 over itself.
    const double side = determinant(grid.axes) < 0.0 ? -1.0 : 1.0;
    const double trace =
        grid.axes(0, 0) / spacing[0] + grid.axes(1, 1) / spacing[1] + side * grid.axes(2, 2) / spacing[2];
    const double first = 0.5 * std::sqrt(std::max(0.0, 1.0 + trace));
    const double turn = first < 1e-7 ? 0.0 : 2.0 * std::min(1.2e-7 / first, 4e-4);
    EXPECT_LE(grid_difference(back.grid, grid), 2e-7 + 20.0 * spacing[2] * turn) << angle;
  }
  EXPECT_THAT(without_sform(skew_grid(0.4)).notes, testing::Contains(HasSubstr("gives no orientation")));
}

// Labels keep their numbers and names, in one byte where they fit and in two where not.
TEST_F(ImageFiles, LabelsComeBack) {
  for (const int largest : {255, 65535}) {
    SCOPED_TRACE(largest);
    LabelImage image =
        test::label_image({9, 8, 7}, 0.002, [&](int i, int j, int k) { return (i * j * k * 977) % (largest + 1); });
    image.names = {{1, "liver <left> & \"right\""}, {largest, "tumour]]> in it"}};
    const std::filesystem::path file = folder_ / "l.nii.gz";
    write_nifti(file, image, "labels");
    const LabelImage back = read_label_image(file);
    EXPECT_EQ(back.voxels, image.voxels);
    EXPECT_EQ(back.names, (std::map<int, std::string>{{1, "liver <left> & \"right\""}, {largest, "tumour in it"}}));
  }
}

// A vector has five dimensions, the fourth of one, with its components one volume after the other; intent, type and offset are at NIfTI's places.
TEST_F(ImageFiles, VectorsHaveFiveDimensions) {
  ImageGrid grid;
  grid.size = {2, 3, 4};
  ValueImage image{grid, 3, {}};
  for (int v = 0; v < 72; ++v) image.values.push_back(static_cast<float>(v));
  write_nifti(folder_ / "u.nii", image, VoxelValues::displacement, "displacement_mm");
  std::ifstream stream(folder_ / "u.nii", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(bytes.size(), 352u + 72u * 4u);
  std::array<std::int16_t, 8> dim{};
  std::memcpy(dim.data(), bytes.data() + 40, sizeof dim);
  EXPECT_EQ(dim, (std::array<std::int16_t, 8>{5, 2, 3, 4, 1, 3, 1, 1}));
  std::int16_t intent = 0, type = 0;
  float offset = 0.0F, last = 0.0F;
  std::memcpy(&intent, bytes.data() + 68, 2);
  std::memcpy(&type, bytes.data() + 70, 2);
  std::memcpy(&offset, bytes.data() + 108, 4);
  std::memcpy(&last, bytes.data() + bytes.size() - 4, 4);
  EXPECT_EQ(intent, 1006);
  EXPECT_EQ(type, 16);
  EXPECT_EQ(offset, 352.0F);
  EXPECT_EQ(last, 71.0F);
  EXPECT_EQ(bytes.substr(148, 15), "displacement_mm");
}

// What cannot be written is refused by name, and leaves no file.
TEST_F(ImageFiles, RefusesToWrite) {
  ImageGrid grid;
  const ValueImage image{grid, 1, {1.0F}};
  const auto refusal = [&](const std::string& name, const ValueImage& what, VoxelValues kind = VoxelValues::plain) {
    try {
      write_nifti(folder_ / name, what, kind);
    } catch (const std::invalid_argument& error) {
      EXPECT_FALSE(std::filesystem::exists(folder_ / name));
      EXPECT_FALSE(std::filesystem::exists((folder_ / name).string() + ".part"));
      return std::string(error.what());
    }
    return std::string("was written");
  };
  EXPECT_THAT(refusal("a.mha", image), HasSubstr("give a name that ends in .nii or .nii.gz"));
  EXPECT_THAT(refusal("none/a.nii", image), HasSubstr("does not exist; create it first"));
  EXPECT_THAT(refusal("a.nii", image, VoxelValues::vector), HasSubstr("a vector has 3 components, not 1"));
  EXPECT_THAT(refusal("a.nii", {grid, 1, {1.0F, 2.0F}}), HasSubstr("2 numbers for 1 voxels"));
  grid.size = {40000, 1, 1};
  EXPECT_THAT(refusal("a.nii", {grid, 1, std::vector<float>(40000)}), HasSubstr("at most 32767"));
  EXPECT_EQ(refusal("a.nii", image), "was written");
}

// Labels to tets and back: the voxels of the image and those of its mesh overlap by a Dice coefficient of 0.98 and more.
TEST_F(ImageFiles, LabelsToMeshAndBack) {
  const auto label = [](int i, int j, int k) {
    if (std::hypot(i - 15.5, j - 14.5, k - 13.5) > 11.0) return 0;
    return i < 16 ? 10 : 20;
  };
  const std::filesystem::path file = write("halves.mha", test::meta_image({32, 30, 28}, 3.0, label));
  const ImageMesh made = image_mesh({.path = file, .labels = {"left=10", "right=20"}});
  const LabelImage image = read_label_image(file);
  const LabelImage back = VoxelPlaces(made.mesh, image.grid).labels();
  EXPECT_EQ(back.names, (std::map<int, std::string>{{10, "left"}, {20, "right"}}));
  for (const int region : {10, 20}) {
    double both = 0.0, sum = 0.0;
    for (std::size_t v = 0; v < image.voxels.size(); ++v) {
      both += image.voxels[v] == region && back.voxels[v] == region;
      sum += (image.voxels[v] == region) + (back.voxels[v] == region);
    }
    EXPECT_GE(2.0 * both / sum, 0.98) << region;
  }
}

}  // namespace
}  // namespace glisson

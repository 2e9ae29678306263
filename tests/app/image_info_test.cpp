// image_info_test.cpp — glisson info of an image: its grid, and each label's name, volume, pieces and extent.
#include <fstream>

#include "app/program.h"
#include "support/places.h"

namespace glisson::test {
namespace {

using ImageInfo = ProgramTest;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A MetaImage of 8 × 6 × 5 voxels of 2 × 2 × 4 mm, LPS, its voxels from a function of their place.
template <class Label>
std::string small_image(Label label) {
  std::string text =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = 2 2 4\nOffset = 10 20 30\nDimSize = 8 6 5\n"
      "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 8; ++i) text += static_cast<char>(label(i, j, k));
    }
  }
  return text;
}

// Two blocks of a label are two pieces; volumes are those of their voxels; extents are in RAS, of which LPS negates x and y.
TEST_F(ImageInfo, ListsLabels) {
  const auto label = [](int i, int j, int k) {
    if (i >= 1 && i <= 2 && j >= 1 && j <= 3 && k >= 1 && k <= 2) return 3;
    if (i == 5 && j == 2 && k == 2) return 3;
    return i == 7 && j == 5 && k == 4 ? 9 : 0;
  };
  const std::string file = write("a.mha", small_image(label));
  const Outcome text = run({"info", file});
  ASSERT_THAT(text, Exits(0));
  EXPECT_THAT(text.out, AllOf(HasSubstr("label image, 8 × 6 × 5 voxels of 2 × 2 × 4 mm"), HasSubstr("axes RAS"),
                              HasSubstr("  *\n")));
  const nlohmann::json json = nlohmann::json::parse(run({"info", file, "--json"}).out);
  ASSERT_EQ(json.at("labels").size(), 2u);
  const nlohmann::json& three = json.at("labels")[0];
  EXPECT_EQ(three.at("label"), 3);
  EXPECT_EQ(three.at("voxels"), 13);
  EXPECT_NEAR(three.at("volume_ml").get<double>(), 13 * 0.016, 1e-12);
  EXPECT_EQ(three.at("pieces"), 2);
  EXPECT_NEAR(three.at("largest_piece_ml").get<double>(), 12 * 0.016, 1e-12);
  EXPECT_FALSE(three.at("at_border"));
  const double box[2][3] = {{-21.0, -27.0, 32.0}, {-11.0, -21.0, 40.0}};  // −(10 + 2·5.5) … −(10 + 2·0.5), …
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(three.at("box_min_mm")[a].get<double>(), box[0][a], 1e-9);
    EXPECT_NEAR(three.at("box_max_mm")[a].get<double>(), box[1][a], 1e-9);
  }
  EXPECT_TRUE(json.at("labels")[1].at("at_border"));
}

// Names of segments are listed with them.
TEST_F(ImageInfo, ListsNames) {
  const Outcome text = run({"info", shipped("tests/image/data/segments.seg.nrrd").string()});
  ASSERT_THAT(text, Exits(0));
  EXPECT_THAT(text.out, AllOf(HasSubstr("    5  liver"), HasSubstr("    7  portal vein")));
}

// An image of grey values gives these, and the reason why it is none of labels; one that is cut off gives a message.
TEST_F(ImageInfo, GreyAndDamagedImages) {
  std::string bytes = small_image([](int i, int, int) { return i; });
  bytes.replace(bytes.find("MET_UCHAR"), 9, "MET_CHAR\n");
  bytes.back() = static_cast<char>(-5);
  const Outcome grey = run({"info", write("grey.mha", bytes)});
  ASSERT_THAT(grey, Exits(0));
  EXPECT_THAT(grey.out,
              AllOf(HasSubstr("grey image"), HasSubstr("values -5 to 7"), HasSubstr("voxel (7, 5, 4) is -5")));
  bytes.resize(bytes.size() - 3);
  const Outcome cut = run({"info", write("cut.mha", bytes)});
  EXPECT_THAT(cut, Exits(2));
  EXPECT_THAT(cut.err, HasSubstr("is truncated"));
}

}  // namespace
}  // namespace glisson::test

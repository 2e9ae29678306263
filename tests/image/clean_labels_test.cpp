// clean_labels_test.cpp — labels chosen, joined, freed of islands and holes, resampled; each change said in mL.
#include "glisson/image/clean_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "image/label_image.h"

namespace glisson {
namespace {

using test::label_image;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kMl = 1e-6;

const std::map<int, std::string> kNames{{5, "liver"}, {63, "vena_cava"}, {64, "portal_vein"}};

std::vector<LabelGroup> groups(const std::vector<std::string>& words) { return label_groups(words, kNames); }

/// Cleans nothing.
constexpr CleanLabels kAsIs{.smallest_piece_ml = 0.0, .largest_hole_ml = 0.0};

/// A block of label 5 with what `more` puts over it; voxels of 1 mL.
template <class More>
LabelImage block(More more) {
  return label_image({9, 9, 9}, 0.01, [&](int i, int j, int k) {
    const int other = more(i, j, k);
    if (other >= 0) return other;
    return i >= 2 && i <= 6 && j >= 2 && j <= 6 && k >= 2 && k <= 6 ? 5 : 0;
  });
}

// Labels are chosen by number or name, joined by +, and named by what stands before =.
TEST(LabelGroups, AreNumbersAndNames) {
  const auto made = groups({"LIVER", "vessels = 63+portal_vein", "7"});
  ASSERT_EQ(made.size(), 3u);
  EXPECT_EQ(made[0].name, "liver");
  EXPECT_THAT(made[0].labels, ElementsAre(5));
  EXPECT_EQ(made[1].name, "vessels");
  EXPECT_THAT(made[1].labels, ElementsAre(63, 64));
  EXPECT_EQ(made[1].number(), 63);
  EXPECT_EQ(made[2].name, "label_7");
}

// What is no label is said, with the one that was probably meant.
TEST(LabelGroups, RefuseWhatIsNoLabel) {
  EXPECT_THAT([] { groups({"livre"}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("did you mean \"liver\"?")));
  EXPECT_THAT([] { groups({"0"}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("allowed: 1 to 65535")));
  EXPECT_THAT(
      [] {
        groups({"5", "a=7+liver"});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("label 5 is named twice")));
  EXPECT_THAT(
      [] {
        groups({"5", "liver=7"});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("two regions are called \"liver\"")));
  EXPECT_THAT([] { groups({"a=5+"}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("a label is missing")));
  EXPECT_THAT([] { groups({}); }, ThrowsMessage<std::invalid_argument>(HasSubstr("no label is chosen")));
  EXPECT_THAT([] { label_groups(std::vector<std::string>{"liver"}, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("gives its labels no names")));
}

// Joined labels are one region; those that are not chosen are space.
TEST(CleanLabels, JoinsLabels) {
  const LabelImage image = block([](int i, int j, int k) {
    return i == 4 && j == 4 && k == 4 ? 63 : i == 4 && j == 4 && k == 5 ? 9 : -1;
  });
  const GroupImage out = clean_labels(image, groups({"organ=5+63"}), kAsIs);
  EXPECT_NEAR(out.volumes()[0], 124 * kMl, 1e-12);
  EXPECT_THAT(out.pieces(), ElementsAre(1));
  EXPECT_TRUE(out.report.empty());
}

// Voxels that touch at an edge or a corner are two pieces; those that share a face are one.
TEST(CleanLabels, FacesConnect) {
  const auto corner = [](int di, int dj, int dk) {
    return clean_labels(
               label_image({6, 6, 6}, 0.01,
                           [=](int i, int j, int k) {
                             return (i == 2 && j == 2 && k == 2) || (i == 2 + di && j == 2 + dj && k == 2 + dk) ? 5 : 0;
                           }),
               groups({"5"}), kAsIs)
        .pieces();
  };
  EXPECT_THAT(corner(1, 0, 0), ElementsAre(1));
  EXPECT_THAT(corner(1, 1, 0), ElementsAre(2));
  EXPECT_THAT(corner(1, 1, 1), ElementsAre(2));
}

// Pieces below the limit go to what is around them, and the report says how many and how much; the largest stays however small it is.
TEST(CleanLabels, DropsIslands) {
  const LabelImage image = block([](int i, int j, int k) {
    if (i == 4 && j == 4 && k == 4) return 63;              // in the liver
    if (i == 0 && j == 0 && k <= 1) return 5;               // two voxels outside
    return i == 8 && j >= 3 && j <= 5 && k == 4 ? 63 : -1;  // three
  });
  const GroupImage out = clean_labels(image, groups({"5", "63"}), {.smallest_piece_ml = 2.5, .largest_hole_ml = 0.0});
  EXPECT_NEAR(out.volumes()[0], 125 * kMl, 1e-12);  // 124 + the island that became liver
  EXPECT_NEAR(out.volumes()[1], 3 * kMl, 1e-12);
  EXPECT_THAT(out.report,
              ElementsAre("islands: 1 piece of \"liver\" dropped, 2 mL; they are of what is around them now",
                          "islands: 1 piece of \"vena_cava\" dropped, 1 mL; they are of what is around them now",
                          HasSubstr("border:")));
  EXPECT_THAT(clean_labels(image, groups({"63"}), {.smallest_piece_ml = 1000.0}).volumes(),
              ElementsAre(testing::DoubleNear(3 * kMl, 1e-12)));
}

// Only so many pieces are kept as are asked for, the largest.
TEST(CleanLabels, KeepsTheLargestPieces) {
  const LabelImage image = label_image({12, 3, 3}, 0.01, [](int i, int j, int k) {
    return j == 1 && k == 1 && (i == 1 || (i >= 3 && i <= 5) || i >= 7) && i <= 8 ? 5 : 0;
  });
  EXPECT_NEAR(clean_labels(image, groups({"5"}), {.keep_pieces = 2, .smallest_piece_ml = 0.0}).volumes()[0], 5 * kMl,
              1e-12);
  EXPECT_NEAR(clean_labels(image, groups({"5"}), {.keep_pieces = 1, .smallest_piece_ml = 0.0}).volumes()[0], 3 * kMl,
              1e-12);
}

// Holes up to the limit are filled by what has most of their faces; larger ones and those that reach the image's border stay.
TEST(CleanLabels, FillsHoles) {
  const LabelImage image = block([](int i, int j, int k) {
    if (j == 4 && k == 4 && (i == 3 || i == 4)) return 0;
    return i == 4 && j == 3 && k == 3 ? 0 : -1;
  });
  const GroupImage out = clean_labels(image, groups({"5"}), {.largest_hole_ml = 1.5});
  EXPECT_NEAR(out.volumes()[0], 123 * kMl, 1e-12);
  EXPECT_THAT(out.report, ElementsAre("holes: 1 filled, 1 mL"));
  EXPECT_NEAR(clean_labels(image, groups({"5"}), {.largest_hole_ml = 2.0}).volumes()[0], 125 * kMl, 1e-12);
}

// An organ that the image cuts is reported at that face, also in an image that was cropped; one that a crop alone cuts is not.
TEST(CleanLabels, SaysWhereTheImageEnds) {
  LabelImage image = label_image({4, 4, 4}, 0.01, [](int, int, int k) { return k >= 2 ? 5 : 0; });
  const GroupImage whole = clean_labels(image, groups({"5"}), kAsIs);
  EXPECT_THAT(whole.cut, ElementsAre(true, true, true, true, false, true));
  EXPECT_THAT(whole.report.back(), HasSubstr("the image ends in the body at its last k"));
  image.whole = {10, 4, 4};
  image.crop_low = {3, 0, 0};
  EXPECT_THAT(clean_labels(image, groups({"5"}), kAsIs).cut, ElementsAre(false, false, true, true, false, true));
}

// Resampled to cubes of half the size nothing changes; to twice the size a ball keeps its volume to the grain of its surface, and the box
// of the image stays.
TEST(CleanLabels, Resamples) {
  const LabelImage image = label_image(
      {30, 28, 26}, 0.001, [](int i, int j, int k) { return std::hypot(i - 14.5, j - 13.5, k - 12.5) < 10.0 ? 5 : 0; });
  const double before = clean_labels(image, groups({"5"}), kAsIs).volumes()[0];
  const GroupImage fine = clean_labels(image, groups({"5"}), {.voxel = 0.0005});
  EXPECT_EQ(fine.grid.size, (std::array<std::size_t, 3>{60, 56, 52}));
  EXPECT_NEAR(fine.volumes()[0], before, 1e-12);
  const GroupImage coarse = clean_labels(image, groups({"5"}), {.voxel = 0.002});
  EXPECT_NEAR(coarse.volumes()[0], before, 0.04 * before);
  EXPECT_NEAR(norm(coarse.grid.world({-0.5, -0.5, -0.5}) - image.grid.world({-0.5, -0.5, -0.5})), 0.0, 1e-15);
  EXPECT_NEAR(norm(coarse.grid.world({14.5, 13.5, 12.5}) - image.grid.world({29.5, 27.5, 25.5})), 0.0, 1e-15);
  EXPECT_THAT(coarse.report.front(), HasSubstr("resampled: \"liver\""));
}

// A label without a voxel, or one that vanishes in cleaning, is named.
TEST(CleanLabels, NamesWhatVanishes) {
  const LabelImage image = block([](int i, int j, int k) { return i == 4 && j == 4 && k == 4 ? 63 : -1; });
  EXPECT_THAT(
      [&] {
        clean_labels(image, groups({"5", "64"}), kAsIs);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("region \"portal_vein\" (label 64) has no voxel in the image")));
  EXPECT_THAT(
      [&] {
        clean_labels(image, groups({"5", "63"}), {.voxel = 0.03});
      },
      ThrowsMessage<std::invalid_argument>(
          HasSubstr("region \"vena_cava\" (label 63) has no voxel left after cleaning")));
  EXPECT_THAT([&] { clean_labels(image, groups({"5"}), {.smallest_piece_ml = -1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("smallest_piece_ml")));
}

}  // namespace
}  // namespace glisson

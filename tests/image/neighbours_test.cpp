// What lies beside a body of labels: by distance, without the body's own islands.
#include "glisson/image/neighbours.h"

#include <gtest/gtest.h>

namespace glisson {
namespace {

/// A row of voxels of 2 mm along x, three across.
LabelImage row_of(const std::vector<int>& labels) {
  LabelImage image;
  image.grid.size = {labels.size(), 3, 3};
  for (std::size_t a = 0; a < 3; ++a) image.grid.axes(a, a) = 0.002;
  for (std::size_t line = 0; line < 9; ++line) {
    for (const int label : labels) image.voxels.push_back(static_cast<std::uint16_t>(label));
  }
  image.whole = image.grid.size;
  image.names = {{1, "organ"}, {2, "near"}, {3, "far"}, {4, "by_the_island"}};
  return image;
}

TEST(Neighbours, AreThoseWithinTheDistanceOfTheCleanedBody) {
  const LabelImage image = row_of({0, 1, 1, 1, 1, 1, 1, 2, 2, 0, 3, 3, 0, 0, 0, 0, 0, 4, 1, 4});
  CleanLabels one_piece;
  one_piece.keep_pieces = 1;
  one_piece.smallest_piece_ml = 0.0;
  const std::vector<std::string> words{"organ"};
  const GroupImage body = clean_labels(image, label_groups(words, image.names), one_piece);
  const std::vector<Neighbour> at_2_mm = neighbours(image, body, 0.0021);
  ASSERT_EQ(at_2_mm.size(), 1u);
  EXPECT_EQ(at_2_mm[0].label, 2);
  EXPECT_EQ(at_2_mm[0].name, "near");
  EXPECT_EQ(at_2_mm[0].voxels, 9u) << "one layer of the two";
  const std::vector<Neighbour> at_8_mm = neighbours(image, body, 0.0081);
  ASSERT_EQ(at_8_mm.size(), 2u) << "nothing beside the island that was dropped, and not the island itself";
  EXPECT_EQ(at_8_mm[1].label, 3);
  EXPECT_EQ(at_8_mm[1].voxels, 9u);
  GroupImage other = body;
  other.grid.size[0] += 1;
  EXPECT_THROW(neighbours(image, other, 0.01), std::invalid_argument);
}

}  // namespace
}  // namespace glisson

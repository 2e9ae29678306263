// Levels of what acts beside the tissue: ahead of what rises, slow to come down, and those of vertices that stay.
#include "dynamics/step/added_levels.h"

#include <gtest/gtest.h>

#include <sstream>

namespace glisson {
namespace {

using Stiffness = std::vector<VertexStiffness>;

std::vector<double> masses_of(const AddedLevels& levels) {
  std::vector<double> masses(4, 0.0);
  levels.add_masses(1.0, masses);
  return masses;
}

TEST(AddedLevels, RunAheadOfARiseAndComeDownSlowly) {
  AddedLevels levels;
  EXPECT_FALSE(levels.meet(Stiffness{{1, 100.0}, {3, 5.0}})) << "unknown yet";
  levels.settle();
  EXPECT_EQ(masses_of(levels), (std::vector<double>{0.0, 120.0, 0.0, 6.0}));
  EXPECT_TRUE(levels.meet(Stiffness{{1, 101.0}, {3, 5.0}})) << "within its room";
  EXPECT_FALSE(levels.meet(Stiffness{{1, 115.0}, {3, 5.0}})) << "two more rises like this one are not";
  levels.settle();
  EXPECT_NEAR(masses_of(levels)[1], 1.2 * 115.0 * (115.0 / 101.0) * (115.0 / 101.0), 1e-9);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(levels.meet(Stiffness{{1, 0.0}, {3, 5.0}}));
  levels.settle();
  EXPECT_GT(masses_of(levels)[1], 100.0) << "a sheet that whips back is slack at one step only";
  for (int i = 0; i < 400; ++i) EXPECT_TRUE(levels.meet(Stiffness{{1, 10.0}, {3, 5.0}}));
  levels.settle();
  EXPECT_NEAR(masses_of(levels)[1], 12.0, 1e-9);
}

TEST(AddedLevels, StayWithTheirVertices) {
  AddedLevels levels;
  levels.meet(Stiffness{{0, 10.0}, {1, 100.0}, {2, 20.0}});
  levels.settle();
  EXPECT_FALSE(levels.meet(Stiffness{{1, 90.0}, {3, 7.0}}));
  levels.settle();
  const std::vector<double> masses = masses_of(levels);
  EXPECT_EQ(masses[0], 0.0);
  EXPECT_GT(masses[1], 110.0) << "comes down slowly";
  EXPECT_NEAR(masses[3], 8.4, 1e-12);
}

TEST(AddedLevels, ComeBackFromACheckpoint) {
  AddedLevels levels;
  levels.meet(Stiffness{{1, 100.0}, {3, 5.0}});
  levels.settle();
  Archive writer;
  levels.archive(writer, 4);
  AddedLevels again;
  Archive reader(writer.bytes());
  again.archive(reader, 4);
  EXPECT_EQ(masses_of(again), masses_of(levels));
  EXPECT_TRUE(again.meet(Stiffness{{1, 100.0}, {3, 5.0}}));
  Archive short_reader(writer.bytes());
  EXPECT_THROW(again.archive(short_reader, 3), std::runtime_error) << "vertex 3 is not there";
}

}  // namespace
}  // namespace glisson

// nearest_test.cpp — the word that was probably meant.
#include "base/nearest.h"

#include <gtest/gtest.h>

#include <array>

namespace glisson::scene {
namespace {

// The distance counts insertions, deletions, replacements and swaps of neighbours, whatever the case.
TEST(EditDistance, CountsSlips) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("velocity", "velocity"), 0u);
  EXPECT_EQ(edit_distance("Velocity", "vELOCITY"), 0u);
  EXPECT_EQ(edit_distance("velocty", "velocity"), 1u) << "deleted";
  EXPECT_EQ(edit_distance("velocitty", "velocity"), 1u) << "inserted";
  EXPECT_EQ(edit_distance("velosity", "velocity"), 1u) << "replaced";
  EXPECT_EQ(edit_distance("velcoity", "velocity"), 1u) << "swapped";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

// It does not matter which of two words is the slip.
TEST(EditDistance, IsSymmetric) {
  const std::array<std::string, 5> words{"mesh", "sets", "tissue", "region", "motion"};
  for (const auto& a : words) {
    for (const auto& b : words) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
  }
}

// A slip, a forgotten unit and a foreign unit lead to the key; another word leads to none.
TEST(Nearest, SuggestsSlipsOnly) {
  const std::array<std::string, 3> keys{"density_kg_m3", "viscosity_Pa_s", "name"};
  EXPECT_EQ(nearest("density", keys), "density_kg_m3");
  EXPECT_EQ(nearest("density_g_cm3", keys), "density_kg_m3");
  EXPECT_EQ(nearest("Viscosity_Pas", keys), "viscosity_Pa_s");
  EXPECT_EQ(nearest("nmae", keys), "name");
  EXPECT_EQ(nearest("temperature", keys), "");
  EXPECT_EQ(nearest("", keys), "");
  EXPECT_EQ(nearest(std::string(100000, 'x'), keys), "") << "no quadratic work on absurd keys";
}

}  // namespace
}  // namespace glisson::scene

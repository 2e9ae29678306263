// tangent_matrix_test.cpp — the tangent of a body of elements: what is summed is solved, what cannot be solved is told.
#include "lab/tangent_matrix.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace glisson::lab::tangent_matrix_test {
namespace {

/// A ring of elements of three unknowns each, of which two are shared with the next: a ring has no band.
constexpr std::size_t kUnknowns = 24;
std::vector<std::vector<std::size_t>> ring() {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < kUnknowns; ++i) groups.push_back({i, (i + 1) % kUnknowns, (i + 2) % kUnknowns});
  return groups;
}

TangentMatrix stiff_ring() {
  TangentMatrix a(kUnknowns, ring());
  for (std::size_t g = 0; g < kUnknowns; ++g) {
    const double k = 1.0 + 0.1 * static_cast<double>(g);
    a.add(g, std::array<std::array<double, 3>, 3>{{{2.0 * k, -k, 0.3}, {-k, 3.0 * k, -k}, {0.3, -k, 2.0 * k}}});
  }
  return a;
}

// A x by rows gives back the right-hand side, with a row fixed and an entry added alone, to the rounding of well-conditioned rows.
TEST(TangentMatrix, SolvesWhatWasSummed) {
  TangentMatrix a = stiff_ring();
  a(5, 6) += 0.25, a(6, 5) += 0.25;
  a.fix(3);
  std::vector<double> x(kUnknowns);
  for (std::size_t i = 0; i < kUnknowns; ++i) x[i] = std::sin(1.0 + static_cast<double>(i));
  const std::vector<double> right = x;
  std::vector<double> back(kUnknowns, 0.0);
  ASSERT_TRUE(a.factor());
  a.solve(x);
  EXPECT_EQ(x[3], right[3]);
  for (std::size_t i = 0; i < kUnknowns; ++i) a.add_row(i, x[i], back);  // symmetric: Aᵀx is Ax
  for (std::size_t i = 0; i < kUnknowns; ++i) EXPECT_NEAR(back[i], right[i], 1e-13) << i;
}

// Factors of cleared and refilled entries are those of the last entries.
TEST(TangentMatrix, ForgetsWhatWasCleared) {
  TangentMatrix a(2, {{0, 1}});
  a.add(0, std::array<std::array<double, 2>, 2>{{{5.0, 1.0}, {1.0, 5.0}}});
  ASSERT_TRUE(a.factor());
  a.clear();
  a.add(0, std::array<std::array<double, 2>, 2>{{{2.0, 0.0}, {0.0, 4.0}}});
  ASSERT_TRUE(a.factor());
  std::vector<double> x{2.0, 2.0};
  a.solve(x);
  EXPECT_EQ(x, (std::vector<double>{1.0, 0.5}));
}

// A pivot that vanishes, and numbers that are none, are told and not solved.
TEST(TangentMatrix, TellsWhatHasNoFactor) {
  TangentMatrix a(2, {{0, 1}});
  EXPECT_FALSE(a.factor());
  for (const double no : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    a.clear();
    a.add(0, std::array<std::array<double, 2>, 2>{{{no, 0.0}, {0.0, 1.0}}});
    EXPECT_FALSE(a.factor());
  }
}

}  // namespace
}  // namespace glisson::lab::tangent_matrix_test

// A cycle of deformation that ends where it began leaves no work with an energy, and does with a secant law.
//
// The path is not proportional: stretch, shear, unstretch, unshear. Work is ∮ P : dF, by Simpson's rule on each leg,
// halved until its error is far below what is looked for.
#include <gtest/gtest.h>

#include "material/every_tissue.h"

namespace glisson {
namespace {

constexpr double kStretch = 0.2, kShear = 0.3;

/// H at the corners of the cycle.
std::array<Mat3d, 5> corners(double size) {
  Mat3d stretched, both, sheared;
  stretched(2, 2) = size * kStretch, sheared(0, 1) = size * kShear;
  both(2, 2) = size * kStretch, both(0, 1) = size * kShear;
  return {Mat3d{}, stretched, both, sheared, Mat3d{}};
}

/// ∫ P : dF along a piece of the leg from H to H + leg; both ends count, so that a jump before them is seen.
double piece(const test::Specimen& s, const Mat3d& H, const Mat3d& leg, double begin, double end) {
  double total = 0.0;
  for (const auto& [at, weight] : {std::pair{0.0, 1.0 / 6.0}, {0.5, 4.0 / 6.0}, {1.0, 1.0 / 6.0}}) {
    const double x = begin + at * (end - begin);
    total += weight * (end - begin) * test::inner(s.P(sum(H, scaled(leg, x))), leg);
  }
  return total;
}
/// The same, halved where it has to be: a table's force jumps at its knots.
double piecewise(const test::Specimen& s, const Mat3d& H, const Mat3d& leg, double begin, double end) {
  const double middle = 0.5 * (begin + end), one = piece(s, H, leg, begin, end),
               two = piece(s, H, leg, begin, middle) + piece(s, H, leg, middle, end);
  if (std::abs(one - two) < 1e-8 || end - begin < 1e-9) return two;  // [J/m³] of some 100 stored
  return piecewise(s, H, leg, begin, middle) + piecewise(s, H, leg, middle, end);
}
double work(const test::Specimen& s, const Mat3d& from, const Mat3d& to) {
  return piecewise(s, from, test::difference(to, from), 0.0, 1.0);
}

struct Cycle {
  double work, stored;
  double relative() const { return std::abs(work) / stored; }
};
Cycle cycle(const Tissue& t, double size = 1.0) {
  const test::Specimen s(t);
  const auto H = corners(size);
  Cycle c{0.0, s.response.energy(H[2], s.shape)};
  for (std::size_t k = 0; k < 4; ++k) c.work += work(s, H[k], H[k + 1]);
  return c;
}

// Every law with an energy gives back what it took, to 1e-6 of what is stored half way.
TEST(ClosedCycle, EnergyLeavesNoWork) {
  double worst = 0.0;
  for (const Tissue& t : test::every_tissue()) {
    if (!test::is_conservative(t)) continue;
    SCOPED_TRACE(t.name);
    const Cycle c = cycle(t);
    EXPECT_GT(c.stored, 0.0);
    EXPECT_LT(c.relative(), 1e-6);
    worst = std::max(worst, c.relative());
  }
  RecordProperty("worst", std::to_string(1e9 * worst) + "e-9");
}

// A secant law does not: the work is real, well above what integration leaves.
TEST(ClosedCycle, SecantLeavesWork) {
  for (const Tissue& t : test::tensor_mass_tissues()) {
    if (test::is_conservative(t)) continue;
    SCOPED_TRACE(t.name);
    const Cycle c = cycle(t);
    RecordProperty("percent: " + t.name, std::to_string(100.0 * c.work / c.stored));
    EXPECT_GT(c.relative(), 1e-3);
    EXPECT_LT(c.relative(), 0.5);
  }
}

// Walked the other way round, the work changes sign: with a secant law there is always a cycle that gives work for
// nothing.
TEST(ClosedCycle, SecantWorkChangesSignWithTheDirection) {
  for (const Tissue& t : test::tensor_mass_tissues()) {
    if (test::is_conservative(t)) continue;
    SCOPED_TRACE(t.name);
    const test::Specimen s(t);
    const auto H = corners(1.0);
    double back = 0.0;
    for (std::size_t k = 4; k > 0; --k) back += work(s, H[k], H[k - 1]);
    const Cycle c = cycle(t);
    EXPECT_NEAR(back, -c.work, 1e-6 * c.stored);
  }
}

}  // namespace
}  // namespace glisson

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

/// What is left of P when all Maxwell branches have relaxed.
Mat3d relaxed_stress(const test::Specimen& s, const Mat3d& H) {
  const Mat3d P = s.P(H);
  return test::difference(P, s.response.carry(H, s.response.relaxing(H, P) * s.response.relaxing_share()));
}
double relaxed_work(const test::Specimen& s, const Mat3d& from, const Mat3d& to) {
  constexpr int kPieces = 4000;  // midpoint rule: its error is 1e-8 of the work
  const Mat3d leg = test::difference(to, from);
  double sum = 0.0;
  for (int i = 0; i < kPieces; ++i) {
    sum += test::inner(relaxed_stress(s, glisson::sum(from, scaled(leg, (i + 0.5) / kPieces))), leg) / kPieces;
  }
  return sum;
}

// What branches leave is the gradient of an energy, in every kinematics and whether all of the stress or its deviator relaxes: a
// branch much faster than the motion takes and gives no work. (The deviator of Cauchy's stress, in the place of that of the
// strain's own, would give 0.6 to 3 % of what is stored, and a body whose branch takes 1 µs gains energy without end.)
TEST(ClosedCycle, RelaxedStressHasAnEnergy) {
  for (const MaxwellPart part : {MaxwellPart::deviator, MaxwellPart::all}) {
    for (Tissue t : test::carriers()) {
      t.law = ConstantLaw{}, t.law_form = LawForm::secant, t.maxwell = {{0.5, 1e-6}}, t.maxwell_part = part;
      SCOPED_TRACE(t.name + (part == MaxwellPart::all ? " all" : " deviator"));
      const test::Specimen s(t);
      ASSERT_TRUE(s.response.stores_energy());
      const auto H = corners(1.0);
      double around = 0.0, half = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        around += relaxed_work(s, H[k], H[k + 1]);
        if (k == 1) half = around;
      }
      const double stored = s.response.relaxed_energy(H[2], s.shape);
      EXPECT_NEAR(half, stored, 1e-6 * stored);
      EXPECT_LT(std::abs(around), 1e-6 * stored);
    }
  }
}

}  // namespace
}  // namespace glisson

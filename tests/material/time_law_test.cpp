// Maxwell branches whose times follow the deformation: their laws by hand, a material point against an independent integration
// of its equation, the second law, and what is left where the law does nothing.
#include "glisson/material/time_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glisson/material_point.h"
#include "glisson/oscillation.h"
#include "material/branch_pace.h"
#include "material/every_tissue.h"
#include "material/uniaxial_path.h"

namespace glisson {
namespace {

using reference::Real;
using reference::RealTensor;

// τ(x)/τ by hand: e^(a x), (x/x₀)ⁿ, and the clamps. The slope of ln φ is a or n/x between them, 0 beyond.
TEST(TimeLaw, IsItsFormula) {
  const TimeLaw slower = ExponentialTime{.rate = 5.0, .most = 4.0};
  const TimeLaw cubic = PowerTime{.exponent = 3.0, .reference = 0.2, .least = 1e-3};
  EXPECT_NEAR(time_factor(slower, 0.2), std::exp(1.0), 1e-15);
  EXPECT_DOUBLE_EQ(time_factor(slower, 1.0), 4.0);
  EXPECT_NEAR(time_factor(cubic, 0.1), 0.125, 1e-15);
  EXPECT_NEAR(time_factor(cubic, 0.01), 1e-3, 1e-17);
  EXPECT_NEAR(time_factor(cubic, 0.0), 1e-3, 1e-17);
  const BranchPaces paces({{0.4, 2.0, slower}, {0.3, 5.0, cubic}, {0.1, 8.0, {}}});
  EXPECT_NEAR(paces.at(0, 0.2), 0.5 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(paces.at(1, 0.1), 8.0 / 5.0, 1e-14);
  EXPECT_DOUBLE_EQ(paces.at(2, 0.5), 0.125);
  EXPECT_NEAR(paces.at(0, Dual(0.2, 1.0)).d, -2.5 * std::exp(-1.0), 1e-14);
  EXPECT_NEAR(paces.at(1, Dual(0.1, 1.0)).d, -48.0, 1e-12);
  EXPECT_DOUBLE_EQ(paces.at(0, Dual(1.0, 1.0)).d, 0.0);
  EXPECT_DOUBLE_EQ(paces.at(1, Dual(0.001, 1.0)).d, 0.0);
}

// The pace of a tetrahedron is that of the oracle, which takes its measure from corners.
TEST(TimeLaw, OraclePaces) {
  for (const Tissue& t : test::maxwell_tissues()) {
    if (!t.relaxation_follows()) continue;
    const test::Specimen s(t);
    test::Draw draw(8);
    for (int n = 0; n < 20; ++n) {
      const Mat3d H = n < 10 ? draw.stretched(0.67, 1.44) : draw.tensor(1e-3);
      for (std::size_t k = 0; k < t.maxwell.size(); ++k) {
        const auto exact = static_cast<double>(reference::pace(s.point, k, test::real_gradient(H)));
        EXPECT_NEAR(s.response.paces().at(k, s.response.measure(H, s.shape)), exact, 1e-9 * exact) << t.name;
      }
    }
  }
}

/// F of a way through shear and stretch that turns back: up to 30 % in two seconds, held for one, and back in half a second.
Mat3d deformation_at(double t) {
  const double a = t < 2.0 ? 0.5 * t : (t < 3.0 ? 1.0 : std::max(0.0, 1.0 - 2.0 * (t - 3.0)));
  Mat3d F = identity<double>();
  F(0, 2) = 0.3 * a, F(0, 0) += 0.1 * a, F(2, 2) -= 0.15 * a, F(1, 0) = -0.05 * a;
  return F;
}

/// P at the end of `until` by the oracle's formulas alone: q′ = (S − q)/τ(x) with the classical steps of fourth order.
Mat3d integrated(const Tissue& tissue, double until, int steps) {
  const reference::MaterialPoint point = test::Specimen(tissue).point;
  std::vector<RealTensor> q(tissue.maxwell.size(), RealTensor::Zero());
  const auto F_at = [](double t) { return test::to_real(deformation_at(t)); };
  const double h = until / steps;
  for (int n = 0; n < steps; ++n) {
    const double t = n * h;
    const RealTensor F[3]{F_at(t), F_at(t + 0.5 * h), F_at(t + h)};
    RealTensor S[3];
    for (int i = 0; i < 3; ++i) S[i] = reference::relaxing_stress(point, F[i]);
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto rate = [&](int i, const RealTensor& at) {
        return RealTensor(reference::pace(point, k, F[i]) * (S[i] - at));
      };
      const RealTensor a = rate(0, q[k]), b = rate(1, q[k] + Real(0.5 * h) * a), c = rate(1, q[k] + Real(0.5 * h) * b),
                       d = rate(2, q[k] + Real(h) * c);
      q[k] += Real(h) / 6 * (a + 2 * b + 2 * c + d);
    }
  }
  const RealTensor F = F_at(until);
  RealTensor held = RealTensor::Zero();
  for (std::size_t k = 0; k < q.size(); ++k) held += Real(tissue.maxwell[k].share) * q[k];
  return test::to_double(reference::piola(point, F) - (test::is_small(tissue) ? held : RealTensor(F * held)));
}

Mat3d stepped(const Tissue& tissue, double until, int steps) {
  MaterialPoint point(tissue);
  for (int n = 1; n <= steps; ++n) {
    const Mat3d F = deformation_at(until * n / steps);
    MaterialTargets targets;
    for (std::size_t i = 0; i < 9; ++i) targets(i / 3, i % 3).value = F(i / 3, i % 3);
    EXPECT_TRUE(point.advance(until / steps, targets).converged) << tissue.name;
  }
  return point.state().nominal;
}

// On the way up, in the hold and after the way back; the knees of the way are on steps of both. The error of the point's steps
// falls by four when they are halved.
TEST(TimeLaw, MaterialPointIsTheEquationsSolution) {
  int tissues = 0;
  for (Tissue t : test::maxwell_tissues()) {
    if (!t.relaxation_follows()) continue;
    ++tissues;
    for (MaxwellBranch& b : t.maxwell) {  // no clamp on the way, whose corner would cost an order
      std::visit([](auto& law) { law.least = 1e-9, law.most = 1e9; }, *b.time_law);
    }
    t.maxwell[1].time_law = ExponentialTime{.rate = 5.0};
    for (const double until : {2.0, 3.0, 3.5}) {
      const Mat3d exact = integrated(t, until, 1400), P = stepped(t, until, 7000);
      EXPECT_LE(test::apart(P, exact), 1e-6) << t.name << " at " << until;
    }
    const Mat3d exact = integrated(t, 2.0, 1400);
    const double coarse = test::apart(stepped(t, 2.0, 100), exact), fine = test::apart(stepped(t, 2.0, 200), exact);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << t.name;
  }
  EXPECT_GE(tissues, 8);
}

// A power of the measure, from rest on where it is clamped: 1e-6 too, in more steps about the corner.
TEST(TimeLaw, MaterialPointIsTheSolutionOfAPower) {
  Tissue t = test::hyperelastic_tissues().front();
  t.maxwell = {{0.5, 0.7, PowerTime{.exponent = 1.0, .reference = 0.2, .least = 0.05}},
               {0.3, 2.0, PowerTime{.exponent = -1.5, .reference = 0.2, .most = 30.0}}};
  for (const double until : {2.0, 3.0, 3.4}) {
    EXPECT_LE(test::apart(stepped(t, until, 34000), integrated(t, until, 6800)), 1e-6) << until;
  }
}

// A law that does nothing leaves the plain branch, to the rounding of 1/τ.
TEST(TimeLaw, ConstantLawIsThePlainBranch) {
  for (const Tissue& plain : test::maxwell_tissues()) {
    if (plain.relaxation_follows()) continue;
    Tissue t = plain;
    t.maxwell[0].time_law = ExponentialTime{.rate = 0.0};
    t.maxwell[1].time_law = PowerTime{.exponent = 0.0};
    for (const double until : {2.0, 3.5}) {
      EXPECT_LE(test::apart(stepped(t, until, 350), stepped(plain, until, 350)), 1e-13) << t.name;
    }
  }
}

/// A branch that goes by its own clock does the work of a plain one of time 1 along the same strains, in whatever time.
Tissue shearing() {
  Tissue t;
  t.youngs_modulus = 3000.0, t.kinematics = Kinematics::small;
  t.maxwell = {{0.6, 0.5, PowerTime{.exponent = 2.0, .reference = 0.1, .least = 1e-2}},
               {0.3, 4.0, ExponentialTime{.rate = -20.0}}};
  return t;
}

/// Work on a branch over a step, per volume: along the polygon of S over ξ that the step goes by, from the overstress before and the
/// stress that is added.  ∫ (S − q) dγ = Δγ [ o₀ (1 − e^(−ξ))/ξ + Δ (1 − (1 − e^(−ξ))/ξ)/ξ ]
double work_of_step(double over, double added, double shear, double xi) {
  const double kept = -std::expm1(-xi) / xi;
  const double rest = xi < 1e-3 ? 0.5 - xi / 6.0 : (1.0 - kept) / xi;
  return shear * (over * kept + added * rest);
}

// The second law: of the work done on a branch what its spring does not hold, ½ g (S − q):(S − q)/2μ, is lost, never won; it is
// lost however the time changes. Cycles of shear of many sizes, at rates from far above to far below the branch's.
TEST(TimeLaw, DissipationIsNeverNegative) {
  const Tissue t = shearing();
  for (const MaxwellBranch& branch : t.maxwell) {
    Tissue one = t;
    one.maxwell = {branch};
    const Response response(one);
    const double mu = t.lame().mu, soft = branch.share * mu;
    const auto pace = [&](double shear) {
      Mat3d H{};
      H(0, 2) = shear;
      return response.paces().at(0, response.measure(H, ElementShape{}));
    };
    for (const double period : {0.01, 1.0, 100.0}) {
      MaterialPoint point(one);
      double lost = 0.0, least = 0.0, before = 0.0, last = 0.0;
      constexpr int steps = 4000;
      const double h = 6.0 * period / steps;
      for (int n = 1; n <= steps; ++n) {
        const double phase = 6.0 * n / steps, shear = 0.1 * phase * std::sin(2.0 * 3.141592653589793 * phase);
        const MaterialTargets targets = test_targets(MaterialTest::simple_shear, MaterialControl::deformation, shear);
        const double over = point.advance(h, targets).nominal(0, 2) - (1.0 - branch.share) * mu * shear;  // g (S − q)
        const double work =
            work_of_step(before, soft * (shear - last), shear - last, 0.5 * h * (pace(last) + pace(shear)));
        const double heat = work - 0.5 * (over * over - before * before) / soft;
        lost += heat, least = std::min(least, heat);
        before = over, last = shear;
      }
      EXPECT_GT(lost, 0.0);
      EXPECT_GE(least, -1e-12 * lost) << law_name(*branch.time_law) << ", period " << period;
    }
  }
}

// The weights of explicit steps take energy in each, however long and whatever the step before was, and are those of the exact
// step up to ξ²/12.
TEST(TimeLaw, ExplicitWeightsTakeEnergyInEveryStep) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 2000; ++n) {
    const double xi = std::exp(6.0 * normal(random)), before = normal(random), strain = normal(random);
    const BranchWeights<> w = passive_weights_over(xi);
    const double after =
        w.decay * before + (1.0 - w.to) * strain;  // of a modulus of 1: S − q, with S from 0 to the strain
    const double heat = 0.5 * (before + after) * strain - 0.5 * (after * after - before * before);
    EXPECT_GE(heat, -1e-15 * (before * before + after * after + strain * strain)) << xi;
  }
  for (const double xi : {0.3, 0.1, 0.01}) {
    const BranchWeights<> passive = passive_weights_over(xi), exact = weights_over(xi);
    EXPECT_DOUBLE_EQ(passive.decay, exact.decay);
    EXPECT_NEAR((1.0 - passive.to) / (1.0 - exact.to) - 1.0, xi * xi / 12.0, 0.01 * xi * xi);
  }
}

// A mass on two springs, one behind a dashpot whose time is chosen anew in each step, at random and so that the motion grows
// most: at steps up to the limit of both springs together it does not grow.
TEST(TimeLaw, AMassIsStableUpToTheStepOfTheInstant) {
  std::mt19937 random(6);
  std::lognormal_distribution<double> any(0.0, 4.0);
  const double soft = 1.0, spring = 3.0, mass = 1.0, h = 2.0 * std::sqrt(0.98 * mass / (soft + spring));
  for (const bool worst : {false, true}) {
    double x = 1.0, v = 0.0, over = 0.0, first = 0.0;
    for (int n = 0; n < 20000; ++n) {
      v -= h / mass * (soft * x + over);
      const double next = x + h * v;
      // ½ m v² + ½ c x x' + ½ o v h + o²/2C, which leapfrog keeps where nothing is lost
      const double energy =
          0.5 * mass * v * v + 0.5 * soft * x * next + 0.5 * over * h * v + 0.5 * over * over / spring;
      if (n == 0) first = energy;
      ASSERT_LE(energy, first * (1.0 + 1e-12)) << n;
      double chosen = 0.0, most = -1.0;
      for (int trial = 0; trial < (worst ? 20 : 1); ++trial) {
        const BranchWeights<> w = passive_weights_over(any(random));
        const double after = w.decay * over + (1.0 - w.to) * spring * (next - x);
        const double speed = std::abs(v - h / mass * (soft * next + after));
        if (speed > most) most = speed, chosen = after;
      }
      over = chosen, x = next;
    }
  }
}

// Closed cycles at large strain, of each kind of tissue, with time to relax at their end: the work left in them is not negative.
TEST(TimeLaw, ClosedCyclesTakeWork) {
  for (const Tissue& t : test::maxwell_tissues()) {
    if (!t.relaxation_follows() || !test::is_conservative(t)) continue;
    for (const double speed : {30.0, 1.0, 0.03}) {
      MaterialPoint point(t);
      const auto to = [](double a) {
        MaterialTargets targets;
        const Mat3d F = deformation_at(2.0 * a);
        for (std::size_t i = 0; i < 9; ++i) targets(i / 3, i % 3).value = F(i / 3, i % 3);
        return targets;
      };
      double work = 0.0, size = 0.0;
      constexpr int steps = 2000;
      for (int n = 1; n <= steps; ++n) {
        const MaterialState was = point.state();
        const double a = 1.0 - std::abs(1.0 - 2.0 * n / double(steps));
        const MaterialState& now = point.advance(1.0 / speed / steps, to(a));
        const double done =
            0.5 * test::inner(sum(was.nominal, now.nominal), test::difference(now.deformation, was.deformation));
        work += done, size += std::abs(done);
      }
      EXPECT_GT(work, 1e-4 * size) << t.name << ", " << speed;
    }
  }
}

// A small oscillation about a stretch that is held has the branch's time there, whatever its slope: all has relaxed.
TEST(TimeLaw, OscillationTakesTheTimeOfItsStretch) {
  Tissue t = shearing();
  t.maxwell[0].time_law = PowerTime{.exponent = 2.0, .reference = 0.1};
  t.maxwell_part = MaxwellPart::all;  // so that the sides are by ν after long times, too
  const double stretch = 1.2, frequencies[]{0.05, 0.5, 5.0};
  const double side = 1.0 - t.poisson_ratio * (stretch - 1.0);
  const double q = 3.0 * std::cbrt(std::pow(side * side * stretch, 2.0)) / (2.0 * side * side + stretch * stretch);
  const double s = std::sqrt(1.5 * (1.0 - q));
  Tissue plain = t;
  for (MaxwellBranch& b : plain.maxwell) b.time *= time_factor(*b.time_law, s), b.time_law.reset();
  const auto a = oscillation(t, frequencies, stretch), b = oscillation(plain, frequencies, stretch);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(a[k].storage, b[k].storage, 1e-9 * b[k].storage);
    EXPECT_NEAR(a[k].loss, b[k].loss, 1e-8 * b[k].loss);
  }
}

// A time that depends on what a point has not: refused as a stiffness of it is.
TEST(TimeLaw, NeedsAMeasureOfThePoint) {
  Tissue t = shearing();
  t.measure = DeformationMeasure::radius_ratio;
  EXPECT_THROW(MaterialPoint{t}, std::invalid_argument);
  EXPECT_THROW(UniaxialPath{t}, std::invalid_argument);
  t.measure = DeformationMeasure::one_minus_q;
  EXPECT_NO_THROW(MaterialPoint{t});
  t.maxwell[0].time_law = PowerTime{.reference = 0.0};
  EXPECT_THROW(require_valid(t), std::invalid_argument);
}

}  // namespace
}  // namespace glisson

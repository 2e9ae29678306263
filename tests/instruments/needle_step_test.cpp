// Neither the puncture nor the largest force depends on the step: tissue that a tip meets takes up its speed within the time of a
// shear wave across the zone, not within a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "needle_scenes.h"

namespace glisson::needle_step_test {
namespace {

using test::event;
using test::insert;
using test::Inserted;
using test::Insertion;
using test::pushed;

constexpr double kAbove = 1e-4;  ///< the tip starts that far above the surface [m]

/// 648 tets; the quickest motion is over in 10 ms.
Insertion into_small_body(double speed, double step) {
  Insertion o;
  o.mesh = {.radius = 0.015, .height = 0.015, .radial_cells = 3, .axial_cells = 4, .grading = 2.0};
  o.needle.zone = 4e-3;
  o.needle.rupture.force = 0.2;
  o.needle.tip.cutting = 0.06;
  o.start.z = o.mesh.height + kAbove;
  o.strokes = {{.to = {0, 0, -6e-3}, .velocity = speed, .ramp = 0.0, .rest = 0.0}};
  o.options.step = step;
  o.options.precision = Precision::double_precision;
  return o;
}

struct Puncture {
  double contact_force = 0.0;  ///< largest within 2 ms of the contact [N]
  double force = 0.0;          ///< of the tip, largest up to the puncture [N]
  double depth = 0.0;          ///< below the surface at rest [m]
  double after = 0.0;          ///< largest on the hand within 2 ms of the puncture [N]
};

Puncture puncture(double speed, double step) {
  Inserted run = insert(into_small_body(speed, step));
  const double contact = kAbove / speed;
  Puncture p;
  while (run.needle->stage() != NeedleStage::inside && run.simulation.time() < run.end) {
    if (!run.simulation.step().made()) throw std::runtime_error("a step was not made");
    p.force = std::max(p.force, run.needle->tip_force());
    if (run.simulation.time() < contact + 2e-3) p.contact_force = std::max(p.contact_force, run.needle->tip_force());
  }
  p.depth = event(*run.needle, "puncture")->depth - kAbove;
  const double broke = run.simulation.time();
  while (run.simulation.time() < broke + 2e-3 && run.simulation.step().made())
    p.after = std::max(p.after, pushed(*run.needle));
  const auto record = [step](const std::string& what, double value) {
    ::testing::Test::RecordProperty(what + std::to_string(step), static_cast<int>(std::lround(value)));
  };
  record("puncture_nm_", 1e9 * p.depth);
  record("puncture_uN_", 1e6 * p.force);
  record("after_uN_", 1e6 * p.after);
  record("contact_uN_", 1e6 * p.contact_force);
  return p;
}

struct AtSpeed {
  double speed;               ///< [m/s]
  double finest;              ///< step of the reference [s]
  std::vector<double> steps;  ///< [s]
};
void PrintTo(const AtSpeed& a, std::ostream* out) { *out << 1e3 * a.speed << " mm/s"; }

class NeedleStep : public ::testing::TestWithParam<AtSpeed> {};

// A step sees the contact late by up to its way, v h, and its first force a step later: the depth is off by at most 1.6 v h, and
// 0.1 %. The forces converge with h/τ, τ = 3 ms: 3 % for the force of the puncture and what follows, 6 % for the force of contact,
// which jumps. With the speed taken up within a step, the reference at 500 mm/s had 50 N at contact.
TEST_P(NeedleStep, PunctureAndPeaksAreThoseOfTheFinestStep) {  // long
  const Puncture fine = puncture(GetParam().speed, GetParam().finest);
  for (const double step : GetParam().steps) {
    SCOPED_TRACE(step);
    const Puncture p = puncture(GetParam().speed, step);
    EXPECT_NEAR(p.depth, fine.depth, 1e-3 * fine.depth + 1.6 * GetParam().speed * step);
    EXPECT_NEAR(p.force, fine.force, 0.01 * fine.force);
    EXPECT_NEAR(p.after, fine.after, 0.03 * fine.after);
    EXPECT_NEAR(p.contact_force, fine.contact_force, 0.06 * fine.contact_force);
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, NeedleStep,
                         ::testing::Values(AtSpeed{0.001, 5e-5, {1e-4}}, AtSpeed{0.01, 5e-6, {1e-4, 2e-5}},
                                           AtSpeed{0.1, 1e-6, {1e-4, 2e-5, 5e-6}},
                                           AtSpeed{0.5, 1e-6, {1e-4, 2e-5, 5e-6}}));

// What is left of the speed is inertia: up to 50 mm/s the depth is that of the slow limit to 0.2 %, at 500 mm/s 15 % more.
TEST(NeedleSpeed, ShowsAsInertiaOnly) {  // long
  const double slow = puncture(0.005, 5e-5).depth;
  EXPECT_NEAR(puncture(0.05, 5e-6).depth, slow, 2e-3 * slow);
  EXPECT_NEAR(puncture(0.5, 2e-6).depth, 1.15 * slow, 0.02 * slow);
}

// The tip pierces a membrane inside when it is pushed with the stated force, at 200 mm/s as well as slowly, at any step. Depth as
// above.
TEST(NeedleSpeed, InnerPunctureIsThatOfTheFinestStep) {
  const auto inner = [](double step) {
    Insertion o = into_small_body(0.2, step);
    o.mesh.height = 0.02, o.mesh.axial_cells = 5;
    o.start.z = o.mesh.height + kAbove;
    o.strokes.front().to.z = -0.018;
    o.needle.rupture.force = 0.05;
    o.needle.tip.cutting = 0.03;
    o.inner_boundary = 0.0121;
    o.needle.regions[1] = {.cutting = 0.03, .puncture = 0.2};
    Inserted run = insert(o);
    double most = 0.0;
    while (event(*run.needle, "inner puncture") == nullptr && run.simulation.time() < run.end) {
      if (!run.simulation.step().made()) throw std::runtime_error("a step was not made");
      most = std::max(most, run.needle->tip_force());
    }
    EXPECT_NEAR(most, 0.2, 1e-3) << step;
    return event(*run.needle, "inner puncture")->depth;
  };
  const double fine = inner(5e-6);
  for (const double step : {1e-4, 2e-5}) EXPECT_NEAR(inner(step), fine, 1e-3 * fine + 1.6 * 0.2 * step);
}

// The impulse of a contact is the momentum of the zone: at 300 mm/s twice as much as at 150, whatever the step.
TEST(NeedleSpeed, ImpulseOfContactIsMomentum) {
  const auto impulse = [](double speed, double step) {
    Insertion o = into_small_body(speed, step);
    o.needle.rupture.force = 10.0;
    Inserted run = insert(o);
    double sum = 0.0;
    while (run.simulation.time() < kAbove / speed + 2e-3 && run.simulation.step().made())
      sum += step * run.needle->tip_force();
    return sum;
  };
  const double fine = impulse(0.3, 1e-6);
  EXPECT_NEAR(impulse(0.3, 2e-5), fine, 0.02 * fine);
  EXPECT_NEAR(impulse(0.15, 1e-6), 0.5 * fine, 0.01 * fine);
}

}  // namespace
}  // namespace glisson::needle_step_test

// Preparing keeps what a test says: contact is found within its own error, smoothing leaves polynomials alone, averaging
// keeps the mean and lowers noise by √n, cycles and crops cut where they say, and noise is measured rightly beside spikes.
#include "fit/data/prepare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include "fit/data/contact.h"
#include "fit/data/samples.h"
#include "fit/data/smooth.h"

namespace glisson::fit::prepare_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<double> even(std::size_t n, double low, double high) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = low + (high - low) * static_cast<double>(i) / static_cast<double>(n - 1);
  return x;
}

std::vector<double> of(const std::vector<double>& x, const std::function<double(double)>& f) {
  std::vector<double> y;
  for (const double v : x) y.push_back(f(v));
  return y;
}

void add_noise(std::vector<double>& y, double sd, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sd);
  for (double& v : y) v += normal(random);
}

double rms(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum / static_cast<double>(v.size()));
}

constexpr double kTouch = 2.3e-3, kRest = 0.15, kNoise = 0.02;

/// Errors of contact over many seeds, and each over its own deviation.
struct Errors {
  std::vector<double> error, scaled;
};
Errors contact_errors(const std::function<double(double)>& force, unsigned seeds) {
  Errors e;
  const auto x = even(600, 0.0, 10e-3);
  for (unsigned seed = 0; seed < seeds; ++seed) {
    auto f = of(x, [&](double v) { return kRest + (v > kTouch ? force(v - kTouch) : 0.0); });
    add_noise(f, kNoise, seed);
    const auto contact = find_contact(x, f, 4.0);
    if (!contact || contact->extrapolated) {
      ADD_FAILURE() << "no contact at seed " << seed;
      continue;
    }
    e.error.push_back(contact->at - kTouch);
    e.scaled.push_back(e.error.back() / contact->deviation);
  }
  return e;
}

// Where the force is a parabola from contact on, the fit's model is true. A parabola through m rows of noise s has at its
// end the standard deviation 3 s/√m, which moves the crossing with the rest by 3 s/(k √m), k the slope there; the search
// over the kink costs no more than half as much again. The fit takes in rows up to 20 s = 0.4 N over the rest.
TEST(Contact, IsFoundWithinItsOwnErrorOnParabolas) {
  constexpr double kSlope = 400.0, kCurvature = 5e4;
  const Errors e = contact_errors([](double u) { return kSlope * u + kCurvature * u * u; }, 300);
  // 0.4 N is reached at u = 0.9 mm, 54 rows of 10 mm / 600
  const double bound = 1.5 * 3.0 * kNoise / (kSlope * std::sqrt(54.0));
  EXPECT_LT(rms(e.error), bound);
  // The deviation it states is the true one: within 4 % by the rms of 300 ratios, but that rows lie 17 µm apart where the
  // deviation is 20 µm, so that the sum of squares is a parabola of x_c from row to row only; measured: 1.3 here, 0.94 to
  // 1.05 with 3000 and 20000 rows.
  EXPECT_NEAR(rms(e.scaled), 1.15, 0.25);
  for (const double z : e.scaled) EXPECT_LT(std::abs(z), 6.0);
}

// Tissues stiffen exponentially and spheres touch with F ∝ u^1.5: no parabola, but close to one near the touch. The
// first's slope at the touch is 200 N/m, and 20 s are reached after 1.5 mm, 88 rows; the bound is that of a parabola. A sphere has
// no slope at contact, so that the touch is less sharp: a force of 2 s is reached at (0.04 / 2e4)^(2/3) = 0.16 mm.
TEST(Contact, IsFoundForForcesThatAreNoParabolas) {
  const Errors exponential = contact_errors([](double u) { return 0.5 * std::expm1(u / 2.5e-3); }, 200);
  EXPECT_LT(rms(exponential.error), 1.5 * 3.0 * kNoise / (200.0 * std::sqrt(88.0)));
  const Errors sphere = contact_errors([](double u) { return 2e4 * std::pow(u, 1.5); }, 200);
  EXPECT_LT(rms(sphere.error), 0.16e-3);
}

// A file that begins in contact has no rest; the parabola of its first rows, carried back, is exact for a parabola.
TEST(Contact, IsCarriedBackWhereAFileBeginsInContact) {
  const auto x = even(300, 0.0, 10e-3);
  const auto f = of(x, [](double v) { return 300.0 * (v + 0.4e-3) + 2e4 * (v + 0.4e-3) * (v + 0.4e-3); });
  const auto contact = find_contact(x, f, 4.0);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->extrapolated);
  EXPECT_NEAR(contact->at, -0.4e-3, 1e-9);
  EXPECT_EQ(contact->before, 0u);
}

// Of a set in which one file begins in contact all are carried to zero from the force at which that one begins: a sphere's
// force has no slope at contact, so that each by itself is placed by what it shows of the toe, and the same tests apart.
TEST(Contact, IsPlacedAlikeWhereSomeOfASetBeginInContact) {
  const auto force = [](double u) { return u > 0.0 ? 2e4 * std::pow(u, 1.5) : 0.0; };
  const auto rested = even(800, 0.0, 10e-3), pressed = even(600, 2.8e-3, 10e-3);
  const auto all = of(rested, [&](double x) { return kRest + force(x - kTouch); });
  const auto part = of(pressed, [&](double x) { return force(x - kTouch); });
  const auto own = find_contact(rested, all, 4.0), other = find_contact(pressed, part, 4.0);
  ASSERT_TRUE(own && other);
  ASSERT_TRUE(!own->extrapolated && other->extrapolated);
  EXPECT_GT(std::abs(own->at - other->at), 0.06e-3);
  const auto a = contact_from(rested, all, *own, other->first_force);
  const auto b = contact_from(pressed, part, *other, other->first_force);
  ASSERT_TRUE(a && b);
  // the rest is subtracted to 1e-3 N of a slope of 670 N/m at that force
  EXPECT_NEAR(a->at, b->at, 0.02e-3);
  EXPECT_DOUBLE_EQ(a->rest_force, own->rest_force);
}

TEST(Contact, IsNotFoundInNoise) {
  const auto x = even(400, 0.0, 10e-3);
  int found = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    auto f = of(x, [](double) { return kRest; });
    add_noise(f, kNoise, seed);
    found += find_contact(x, f, 4.0).has_value();
  }
  // five rows in a row above 4 s of pure noise: probability (3e-5)^5 a place
  EXPECT_EQ(found, 0);
}

// A polynomial of the filter's degree comes out unchanged, at the ends and on uneven points too.
TEST(LocalFit, LeavesPolynomialsUnchanged) {
  auto x = even(60, -1.0, 2.0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * std::sin(7.0 * static_cast<double>(i));
  for (std::size_t degree = 0; degree <= 5; ++degree) {
    const auto y = of(x, [&](double v) {
      double sum = 0.0;
      for (std::size_t k = 0; k <= degree; ++k)
        sum += std::pow(v, static_cast<double>(k)) * (1.0 + 0.3 * static_cast<double>(k));
      return sum;
    });
    const LocalFit fit = local_fit(x, y, 4, degree);
    // values to 100: 1e-10 is 1e4 roundings
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(fit.values[i], y[i], 1e-10) << degree << " at " << i;
  }
}

// The leverages of a projection add up to its rank: for one window over all points, degree + 1.
TEST(LocalFit, HasTheLeverageOfAProjection) {
  const auto x = even(9, 0.0, 1.0);
  const LocalFit fit = local_fit(x, x, 4, 3);
  EXPECT_NEAR(std::accumulate(fit.leverage.begin(), fit.leverage.end(), 0.0), 4.0, 1e-12);
}

TEST(RunningMedian, TakesOutSpikesAndNothingElse) {
  auto y = even(50, 0.0, 1.0);
  y[20] += 5.0;
  y[21] -= 3.0;
  const auto clean = running_median(y, 3);
  for (std::size_t i = 5; i < 45; ++i) EXPECT_NEAR(clean[i], static_cast<double>(i) / 49.0, 3.0 / 49.0);
  EXPECT_EQ(running_median(even(50, 0.0, 1.0), 3)[25], 25.0 / 49.0);
}

// The noise of a bent curve is measured within the scatter of a median of 1000 (σ·1.17/√1000 ≈ 4 %, and as much for
// neighbours' correlation), with one row in fifty a spike as well as without.
TEST(Noise, IsMeasuredOnACurveAndBesideSpikes) {
  const auto x = even(1000, 0.0, 1.0);
  for (const bool spikes : {false, true}) {
    auto y = of(x, [](double v) { return std::exp(4.0 * v); });
    add_noise(y, 0.05, 11);
    for (std::size_t i = 25; spikes && i < y.size(); i += 50) y[i] += 3.0;
    EXPECT_NEAR(noise_about_curve(x, y), 0.05, 0.006);
  }
}

Samples line(std::size_t n) {
  Samples s;
  s.time = even(n, 0.0, 10.0);
  s.displacement = even(n, 0.0, 1e-2);
  s.force = of(s.time, [](double t) { return 3.0 * t; });
  return s;
}

// Bins of equal size keep the mean of everything; noise of n rows a bin falls by √n.
TEST(Resample, KeepsTheMeanAndLowersNoise) {
  Samples rows = line(2000);
  Samples noisy = rows;
  add_noise(noisy.force, 0.5, 3);
  for (const ResampleOver over : {ResampleOver::time, ResampleOver::displacement}) {
    const Resampled r = resampled(noisy, {over, ResampleHow::average, 100});
    ASSERT_EQ(r.rows.size(), 100u);
    EXPECT_DOUBLE_EQ(r.rows_a_point, 20.0);
    const auto mean = [](const std::vector<double>& v) {
      return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size());
    };
    // bins differ by a row at most, 1/20 of a bin's deviation from the mean in two bins
    EXPECT_NEAR(mean(r.rows.force), mean(noisy.force), 0.02);
    std::vector<double> residual;
    for (std::size_t i = 0; i < 100; ++i) residual.push_back(r.rows.force[i] - 3.0 * r.rows.time[i]);
    // the rms of 100 values scatters by 1/√200 = 7 %
    EXPECT_NEAR(rms(residual), 0.5 / std::sqrt(20.0), 0.25 * 0.5 / std::sqrt(20.0));
    for (std::size_t i = 1; i < 100; ++i) EXPECT_GT(r.rows.time[i], r.rows.time[i - 1]);
  }
}

TEST(Resample, PicksRowsAndLeavesFewAlone) {
  const Samples rows = line(1000);
  const Resampled r = resampled(rows, {ResampleOver::time, ResampleHow::pick, 10});
  ASSERT_EQ(r.rows.size(), 10u);
  EXPECT_DOUBLE_EQ(r.rows_a_point, 1.0);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(r.rows.time[i], static_cast<double>(i) + 0.5, 0.0051);  // half a row's spacing
    EXPECT_DOUBLE_EQ(r.rows.force[i], 3.0 * r.rows.time[i]);
  }
  EXPECT_EQ(resampled(line(80), {ResampleOver::time, ResampleHow::average, 100}).rows.time, line(80).time);
  EXPECT_EQ(resampled(rows, {ResampleOver::none, ResampleHow::average, 10}).rows.size(), 1000u);
}

/// In and out again, `cycles` times, 100 rows each way, a force that is stiffer on the way in.
RawTest cyclic(int cycles) {
  RawTest t;
  t.file = "cycles.csv";
  for (int i = 0; i <= 200 * cycles; ++i) {
    const int phase = i % 200;
    const double x = (phase <= 100 ? phase : 200 - phase) * 1e-4;
    t.lines.push_back(static_cast<std::uint32_t>(i + 2));
    t.time.push_back(0.1 * i);
    t.displacement.push_back(x);
    t.force.push_back((phase <= 100 ? 200.0 : 150.0) * x);
  }
  return t;
}

DataSpec every_row() {
  DataSpec spec;
  spec.resample.over = ResampleOver::none;
  return spec;
}

PreparedCurve prepared(const RawTest& test, const DataSpec& spec, const SpecimenSize& size = {}) {
  scene::Problems problems("t.csv");
  auto result = prepare(test, spec, size, problems);
  problems.throw_if_any();
  return *result;
}

std::string fault(const RawTest& test, const DataSpec& spec, const SpecimenSize& size = {}) {
  scene::Problems problems("t.csv");
  try {
    prepare(test, spec, size, problems);
    problems.throw_if_any();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

TEST(Cycle, TakesTheWayThatIsAskedFor) {
  DataSpec spec = every_row();
  EXPECT_EQ(prepared(cyclic(3), spec).curve.size(), 601u);
  EXPECT_EQ(prepared(cyclic(3), spec).account.cycles, 3u);
  spec.cycle.part = CyclePart::loading;
  const PreparedCurve in = prepared(cyclic(3), spec);
  EXPECT_EQ(in.curve.size(), 101u);
  EXPECT_DOUBLE_EQ(in.curve.force.back(), 2.0);
  EXPECT_NEAR(in.curve.velocity, 1e-3, 1e-12);
  spec.cycle.part = CyclePart::unloading;
  spec.cycle.number = 2;
  const PreparedCurve out = prepared(cyclic(3), spec);
  EXPECT_EQ(out.curve.size(), 101u);
  EXPECT_DOUBLE_EQ(out.curve.time.front(), 0.0);
  EXPECT_NEAR(out.curve.force[50], 150.0 * 50e-4, 1e-12);
  spec.cycle.part = CyclePart::both;
  EXPECT_EQ(prepared(cyclic(3), spec).curve.size(), 201u);
  spec.cycle.number = 4;
  EXPECT_THAT(fault(cyclic(3), spec), HasSubstr("has no loading of cycle 4: 3 found; choose another cycle.number"));
}

// Over the way, a curve must go one way only; on the way out, too, its points come in the order of time.
TEST(Cycle, IsResampledOverTheWayOneWayAtATime) {
  DataSpec spec;
  spec.resample = {ResampleOver::displacement, ResampleHow::average, 10};
  EXPECT_THAT(fault(cyclic(1), spec),
              HasSubstr("goes in and out again, so that a displacement comes more than once; give "
                        "cycle.part = \"loading\""));
  spec.cycle.part = CyclePart::unloading;
  const Curve out = prepared(cyclic(1), spec).curve;
  ASSERT_EQ(out.size(), 10u);
  for (std::size_t i = 1; i < out.size(); ++i) {
    EXPECT_GT(out.time[i], out.time[i - 1]);
    EXPECT_LT(out.displacement[i], out.displacement[i - 1]);
  }
}

// Noise of the way is no turn.
TEST(Cycle, IgnoresJitter) {
  auto x = even(500, 0.0, 1.0);
  add_noise(x, 0.01, 5);
  EXPECT_EQ(turning_points(x, 0.1).size(), 2u);
}

RawTest pressed(double slope = 500.0, std::size_t n = 401) {
  RawTest t;
  t.file = "pressed.csv";
  t.time = even(n, 5.0, 45.0);
  t.displacement = even(n, 0.0, 40e-3);
  t.force = of(t.displacement, [&](double x) { return 0.25 + slope * std::max(0.0, x - 10.05e-3); });
  t.lines.resize(n, 2);
  return t;
}

// Displacement, time and force count from the touch, between two rows.
TEST(Prepare, CountsFromContact) {
  for (const ContactKind kind : {ContactKind::detect, ContactKind::given}) {
    DataSpec spec = every_row();
    spec.contact.kind = kind;
    spec.contact.at = 10.05e-3;
    const PreparedCurve c = prepared(pressed(), spec);
    EXPECT_NEAR(c.account.contact, 10.05e-3, 1e-7);
    EXPECT_NEAR(c.account.force_at_rest, 0.25, 1e-6);
    EXPECT_EQ(c.account.rows_before_contact, 101u);
    EXPECT_NEAR(c.curve.displacement.front(), 0.05e-3, 1e-7);
    EXPECT_NEAR(c.curve.time.front(), 0.05, 1e-4);
    for (std::size_t i = 0; i < c.curve.size(); ++i)
      EXPECT_NEAR(c.curve.force[i], 500.0 * c.curve.displacement[i], 1e-4);
    EXPECT_NEAR(c.curve.velocity, 1e-3, 1e-12);
  }
}

// The rows before a cycle that is chosen stay with it: its turns and as many as branches need, counted from the same zero.
TEST(Prepare, KeepsWhatWasBeforeACycle) {
  RawTest test = pressed();
  test.time.clear(), test.displacement.clear(), test.force.clear(), test.lines.clear();
  for (int i = 0; i <= 6000; ++i) {
    test.time.push_back(0.01 * i);
    test.displacement.push_back(1e-3 * (1.0 - std::cos(2.0 * std::numbers::pi * i / 2000.0)));
    test.force.push_back(500.0 * test.displacement.back());
    test.lines.push_back(static_cast<std::size_t>(i) + 2);
  }
  DataSpec spec = every_row();
  spec.cycle.number = 3;
  const Curve c = prepared(test, spec).curve;
  EXPECT_EQ(c.size(), 2001u);
  EXPECT_NEAR(c.time.front(), 0.0, 1e-12);
  ASSERT_EQ(c.past_time.size(), c.past_displacement.size());
  EXPECT_GT(c.past_time.size(), 300u);
  EXPECT_LT(c.past_time.size(), 400u);
  EXPECT_NEAR(c.past_time.front(), -40.0, 1e-9);
  EXPECT_LT(c.past_time.back(), 0.0);
  for (std::size_t i = 0; i < c.past_time.size(); ++i)
    EXPECT_NEAR(c.past_displacement[i],
                1e-3 * (1.0 - std::cos(2.0 * std::numbers::pi * (c.past_time[i] + 40.0) / 20.0)), 1e-9);
  spec.cycle.number = 1;
  EXPECT_TRUE(prepared(test, spec).curve.past_time.empty());
}

TEST(Prepare, CropsByEveryMeasure) {
  SpecimenSize size;
  size.height = 0.1;
  const auto cropped_to = [&](const std::function<void(CropSpec&)>& set) {
    DataSpec spec = every_row();
    set(spec.crop);
    return prepared(pressed(), spec, size);
  };
  EXPECT_NEAR(cropped_to([](CropSpec& c) { c.max_time = 20.01; }).curve.time.back(), 20.0, 1e-9);
  EXPECT_NEAR(cropped_to([](CropSpec& c) { c.min_time = 19.99; }).curve.time.front(), 20.0, 1e-9);
  EXPECT_NEAR(cropped_to([](CropSpec& c) { c.max_displacement = 15.01e-3; }).curve.displacement.back(), 15e-3, 1e-9);
  EXPECT_NEAR(cropped_to([](CropSpec& c) { c.max_strain = 0.2001; }).curve.displacement.back(), 20e-3, 1e-9);
  EXPECT_NEAR(cropped_to([](CropSpec& c) { c.max_force = 1.251; }).curve.displacement.back(), 12e-3, 1e-9);
  EXPECT_EQ(cropped_to([](CropSpec& c) { c.max_force = 1.251; }).account.rows_cropped, 401u - 121u);
  DataSpec strain;
  strain.crop.max_strain = 0.5;
  EXPECT_THAT(fault(pressed(), strain), HasSubstr("the height of the specimen is not known; give height_mm"));
}

// A puncture: the curve ends at the largest force before the fall, or at the largest of all.
TEST(Prepare, EndsAtThePeakOrTheFirstDrop) {
  RawTest t = pressed();
  for (std::size_t i = 200; i < t.size(); ++i) t.force[i] -= 3.0;
  DataSpec spec = every_row();
  spec.crop.until = CropUntil::drop;
  EXPECT_EQ(prepared(t, spec).curve.size(), 200u);
  spec.crop.until = CropUntil::peak;
  EXPECT_EQ(prepared(t, spec).curve.size(), 401u);
}

TEST(Prepare, SaysWhatIsTooLittle) {
  DataSpec spec;
  spec.crop.max_displacement = 0.25e-3;
  EXPECT_THAT(
      fault(pressed(), spec),
      HasSubstr("too few points: what the crop leaves has 3 of the 401 rows read; at least 5 are needed; widen"));
  EXPECT_THAT(fault(pressed(500.0, 4), DataSpec{}), HasSubstr("too few points: the file has 4 of the 4 rows read"));
  spec = {};
  spec.contact.kind = ContactKind::detect;
  EXPECT_THAT(fault(pressed(0.0), spec), HasSubstr("contact not found"));
}

// The noise stated for a curve is that of its points: of rows, less √(rows a point).
TEST(Prepare, StatesTheNoiseOfItsPoints) {
  RawTest t = pressed(500.0, 4001);
  add_noise(t.force, 0.1, 9);
  const PreparedCurve c = prepared(t, DataSpec{});
  EXPECT_NEAR(c.account.row_noise, 0.1, 0.01);
  EXPECT_NEAR(c.curve.noise, c.account.row_noise / std::sqrt(40.01), 1e-12);
  EXPECT_THAT(c.account.text(), HasSubstr("pressed: 4001 rows; 100 points, noise of a row 0."));
}

}  // namespace
}  // namespace glisson::fit::prepare_test

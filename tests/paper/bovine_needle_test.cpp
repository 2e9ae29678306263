// The needle of scenes/needle/bovine_liver.toml follows the measured curve of bovine liver [Okamura2004] before, at and after
// the puncture of the surface, through three inner punctures and on the plateau; on finer meshes it is the same, and its tissue
// gains no energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "../support/scene_runs.h"
#include "support/places.h"

namespace glisson {
namespace {

constexpr double kStart = 9.15;             ///< position of the needle where the tip of the scene starts [mm]
constexpr double kSurface = kStart + 0.12;  ///< and where it meets the liver [mm]

struct Point {
  double position, force;  ///< [mm], [N]
  std::string what;
};

std::vector<Point> measured() {
  std::ifstream file(test::shipped("scenes/needle/bovine_liver_measured.csv"));
  std::vector<Point> points;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    Point p;
    char comma = 0;
    if (fields >> p.position >> comma >> p.force >> comma && std::getline(fields, p.what)) points.push_back(p);
  }
  return points;
}

/// Force over position of the only instrument, and its events.
class Curve final : public RunObserver {
 public:
  void on_sample(const Sample& s) override {
    position.push_back(kStart + 1e3 * s.instruments.front().depth);
    force.push_back(-s.instruments.front().force.z);
    support.push_back(0.0);
    for (const ForceParts& f : s.supports) support.back() += f.total().z;
    if (!s.stored_energy) return;
    stored_most = std::max(stored_most, *s.stored_energy);
    drift_most = std::max(drift_most, std::abs(s.energies.elastic - *s.stored_energy));
  }
  void on_event(const RunEvent& e) override { events.push_back(e.what); }

  double at(double x) const {
    for (std::size_t i = 1; i < position.size(); ++i) {
      if (position[i] >= x) {
        return force[i - 1] + (force[i] - force[i - 1]) * (x - position[i - 1]) / (position[i] - position[i - 1]);
      }
    }
    return force.back();
  }
  double position_of(const std::string& event) const {
    for (const InstrumentEvent& e : events) {
      if (e.event == event) return kStart + 1e3 * e.depth;
    }
    return std::nan("");
  }

  std::vector<double> position, force, support;
  double stored_most = 0.0;  ///< largest W(u), where the run keeps it [J]
  double drift_most = 0.0;   ///< that the work of the elastic forces was off it [J]
  std::vector<InstrumentEvent> events;
};

/// At another speed [mm/s], sampled as often per millimetre, without frames.
std::vector<Override> at_speed(double speed) {
  return {{"output.frames", "0"},
          {"output.sample_rate_hz", std::to_string(500.0 / 3.0 * speed)},
          {"instrument.needle.motion.velocity_mm_s", std::to_string(speed)}};
}

/// Ten times as fast as measured, where inertia shows: with the tissue's own mass alone, and elastic, so that its energy is a function of
/// where it is.
std::vector<Override> ten_times_as_fast() {
  std::vector<Override> overrides = at_speed(30.0);
  overrides.push_back({"tissue.maxwell", "[]"});
  overrides.push_back({"motion.mass_scaling", "fixed"});
  overrides.push_back({"motion.mass_scaling_step_s", "1e-7"});
  return overrides;
}

// Before the puncture within 0.03 N rms of the nine points (measured: 0.020); puncture within 5 % in force and place; least force of the 2 mm after it
// 0.08 to 0.42 N, where 0.15 to 0.42 N was measured; the plateau's mean within 10 %; and while nothing moves fast the supports bear what
// the hand feels, to 1 %.
void expect_surface_and_plateau(const Curve& curve) {
  double squares = 0.0;
  int count = 0;
  Point puncture;
  for (const Point& p : measured()) {
    if (p.what == "before the puncture") {
      squares += std::pow(curve.at(p.position) - p.force, 2);
      ++count;
    }
    if (p.what == "puncture") puncture = p;
  }
  ASSERT_EQ(count, 9);
  const double rms = std::sqrt(squares / count);
  ::testing::Test::RecordProperty("rms_before_uN", static_cast<int>(1e6 * rms));
  EXPECT_LT(rms, 0.03);

  const double broke = curve.position_of("puncture");
  EXPECT_NEAR(broke, puncture.position, 0.05 * puncture.position);
  EXPECT_NEAR(curve.at(broke - 0.01), puncture.force, 0.05 * puncture.force);
  double least = puncture.force;
  for (double x = broke; x < broke + 2.0; x += 0.02) least = std::min(least, curve.at(x));
  EXPECT_LT(least, 0.42);
  EXPECT_GT(least, 0.08);

  double plateau = 0.0, balance = 0.0;
  int on_it = 0;
  for (std::size_t i = 0; i < curve.position.size(); ++i) {
    if (curve.position[i] < 40.0) continue;
    plateau += curve.force[i];
    balance += curve.support[i];
    ++on_it;
  }
  ASSERT_GT(on_it, 500);
  EXPECT_NEAR(plateau / on_it, 1.505, 0.10 * 1.505);  // the middle of 1.44 to 1.57 N
  EXPECT_NEAR(balance / on_it, plateau / on_it, 0.01 * plateau / on_it);
}

// The inner punctures come in number and place as measured, to 0.4 mm: the first is 0.13 mm early, and where the swinging tip breaks a
// membrane depends on rounding to some 0.03 mm.
void expect_inner_punctures(const Curve& curve) {
  std::vector<double> places;
  for (const InstrumentEvent& e : curve.events) {
    if (e.event == "inner puncture") places.push_back(kStart + 1e3 * e.depth);
  }
  std::vector<Point> inner;
  for (const Point& p : measured()) {
    if (p.what == "inner puncture") inner.push_back(p);
  }
  ASSERT_EQ(places.size(), inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) EXPECT_NEAR(places[i], inner[i].position, 0.4);
}

/// The whole measured curve, by position; points at one position are averaged.
std::map<double, std::pair<double, int>> whole_curve(const std::filesystem::path& path) {
  std::map<double, std::pair<double, int>> sums;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    double position = 0.0, force = 0.0;
    char comma = 0;
    if (!(fields >> position >> comma >> force)) continue;
    auto& [sum, count] = sums[position];
    sum += force, ++count;
  }
  return sums;
}

struct Error {
  double position, force;  ///< [mm], [N]
  bool at_drop;            ///< within 0.3 mm of one of the four
};

double rms_of(const std::vector<Error>& errors, bool with_drops, double from) {
  double squares = 0.0, count = 0.0;
  for (const Error& e : errors) {
    if (e.position < from || (e.at_drop && !with_drops)) continue;
    squares += e.force * e.force, count += 1.0;
  }
  return std::sqrt(squares / count);
}

// Over 0 to 48 mm, every 0.2 mm: 0.052 N rms but for 0.3 mm on either side of the four drops, 0.070 N with them, since where a drop of 1 N
// comes 0.1 mm early the force is 0.7 N off. A fifth of the positions lie before the tip's start, where there is nothing but noise: without
// these it is 0.057 and 0.077 N.
void expect_whole_curve(const Curve& curve, const std::map<double, std::pair<double, int>>& points) {
  std::vector<double> drops;
  for (const Point& p : measured()) {
    if (p.what.ends_with("puncture") && p.force > 1.4) drops.push_back(p.position);
  }
  ASSERT_EQ(drops.size(), 4U);
  std::vector<Error> errors;
  for (int i = 0; i <= 240; ++i) {
    const double x = 0.2 * i;
    const auto next = points.lower_bound(x);
    const auto value = [](const auto& p) { return p.second.first / p.second.second; };
    double force = value(*next);
    if (next != points.begin()) {
      const auto before = std::prev(next);
      force = value(*before) + (force - value(*before)) * (x - before->first) / (next->first - before->first);
    }
    errors.push_back({x, (x < kStart ? 0.0 : curve.at(x)) - force,
                      std::ranges::any_of(drops, [x](double d) { return std::abs(d - x) <= 0.3; })});
  }
  const auto record = [&](const std::string& of, double from) {
    ::testing::Test::RecordProperty(of + "_outside_drops_uN", static_cast<int>(1e6 * rms_of(errors, false, from)));
    ::testing::Test::RecordProperty(of + "_with_drops_uN", static_cast<int>(1e6 * rms_of(errors, true, from)));
  };
  record("rms", 0.0), record("rms_from_the_start", kStart);
  EXPECT_LT(rms_of(errors, false, 0.0), 0.07);
  EXPECT_LT(rms_of(errors, true, 0.0), 0.10);
}

// What the scene claims, on one run of it. The whole curve, of 371 points, is read from beside the checkout; that part is skipped
// where it is missing.
TEST(BovineNeedle, FollowsTheMeasuredCurve) {  // long
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", at_speed(3.0));
  Variant variant = scene.variants.front();
  variant.simulation.track_energies = false;
  Curve curve;
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(variant, {}, curve, stop);
  ASSERT_EQ(summary.end, RunSummary::End::finished);
  // `glisson check` says up to 2.1 times as many as asked for; 2.06 measured, and where a puncture comes sooner or later some more
  EXPECT_LT(static_cast<double>(summary.steps), 2.7 * summary.time_s / *variant.simulation.mass_scaling_step);
  expect_surface_and_plateau(curve);
  expect_inner_punctures(curve);
  const auto path = test::shipped("../shared/data/needle/bovine_liver.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  expect_whole_curve(curve, whole_curve(path));
}

struct Cells {
  int radial, axial;
};

/// Up to the puncture, ten times as fast as measured, on a mesh of so many cells.
Curve pressed_in(const Cells& cells) {
  std::vector<Override> overrides = ten_times_as_fast();
  overrides.push_back({"mesh.radial_cells", std::to_string(cells.radial)});
  overrides.push_back({"mesh.axial_cells", std::to_string(cells.axial)});
  overrides.push_back({"instrument.needle.motion.depth_mm", "10.6"});  // the approach of 0.12 mm included
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", overrides);
  Curve curve;
  const std::atomic<bool> stop{false};
  EXPECT_EQ(run_variant(scene.variants.front(), {}, curve, stop).end, RunSummary::End::finished);
  return curve;
}

/// Position where the force first reaches a value [mm].
double position_at(const Curve& curve, double force) {
  for (std::size_t i = 1; i < curve.force.size(); ++i) {
    if (curve.force[i] < force) continue;
    const double share = (force - curve.force[i - 1]) / (curve.force[i] - curve.force[i - 1]);
    return curve.position[i - 1] + share * (curve.position[i] - curve.position[i - 1]);
  }
  return std::nan("");
}

void record(const Cells& cells, const Curve& curve, double surface) {
  const std::string of = std::to_string(cells.radial) + "x" + std::to_string(cells.axial);
  const auto keep = [&](const std::string& what, double value) {
    ::testing::Test::RecordProperty(of + what, static_cast<int>(std::lround(value)));
  };
  for (int d = 2; d <= 9; ++d) keep("_at_" + std::to_string(d) + "mm_uN", 1e6 * curve.at(surface + d));
  for (const double f : {0.15, 0.5, 1.0})
    keep("_depth_at_" + std::to_string(std::lround(1e3 * f)) + "mN_um", 1e3 * (position_at(curve, f) - surface));
  keep("_puncture_um", 1e3 * (curve.position_of("puncture") - surface));
}

// The mesh resolves the zone: what is fitted belongs to the tissue. Against the finest of three meshes, of 43 200 to 93 312 tets, the
// force 2 to 9 mm deep within 2 %, the indentations at 0.15, 0.5 and 1 N and at the puncture within 1.5 % (measured: 1.6 and 1.0 %). The
// finest has 0.4 % more force than one of half as many tets again (docs/needles.md).
TEST(BovineNeedle, IsTheSameOnFinerMeshes) {  // verify
  const Cells finest{12, 36};
  const Curve fine = pressed_in(finest);
  record(finest, fine, kSurface);
  for (const Cells& cells : {Cells{10, 24}, Cells{12, 24}}) {
    SCOPED_TRACE(std::to_string(cells.radial) + " x " + std::to_string(cells.axial) + " cells");
    const Curve curve = pressed_in(cells);
    record(cells, curve, kSurface);
    for (int depth = 2; depth <= 9; ++depth) {
      const double force = fine.at(kSurface + depth);
      EXPECT_NEAR(curve.at(kSurface + depth), force, 0.02 * force) << depth << " mm deep";
    }
    for (const double force : {0.15, 0.5, 1.0}) {
      const double depth = position_at(fine, force) - kSurface;
      EXPECT_NEAR(position_at(curve, force) - kSurface, depth, 0.015 * depth) << "at " << force << " N";
    }
    const double puncture = fine.position_of("puncture") - kSurface;
    EXPECT_NEAR(curve.position_of("puncture") - kSurface, puncture, 0.015 * puncture);
  }
}

// Averaged volumes and a law with an energy: through four drops at ten times the measured speed, the work of the elastic forces
// is W(u) to 1 %, and the tissue comes to rest. With a stiffness law of the form `secant` it would have given off 4 mJ more.
TEST(BovineNeedle, GainsNoEnergyFromItsTissue) {  // verify
  std::vector<Override> overrides = ten_times_as_fast();
  overrides.push_back({"output.sample_rate_hz", "500"});
  overrides.push_back({"output.stored_energy", "true"});
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", overrides);
  Curve curve;
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, curve, stop);
  ASSERT_EQ(summary.end, RunSummary::End::finished);
  RecordProperty("stored_most_uJ", static_cast<int>(std::lround(1e6 * curve.stored_most)));
  RecordProperty("drift_most_nJ", static_cast<int>(std::lround(1e9 * curve.drift_most)));
  RecordProperty("kinetic_end_nJ", static_cast<int>(std::lround(1e9 * summary.energies.kinetic)));
  ASSERT_GT(curve.stored_most, 1e-3);
  EXPECT_LT(curve.drift_most, 0.01 * curve.stored_most);
  EXPECT_LT(summary.energies.kinetic, 1e-3 * curve.stored_most);
}

}  // namespace
}  // namespace glisson

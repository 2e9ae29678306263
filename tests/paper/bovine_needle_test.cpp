// The needle of scenes/needle/bovine_liver.toml follows the measured curve of bovine liver [Okamura2004] before, at and after
// the puncture of the surface, through three inner punctures and on the plateau.
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

constexpr double kStart = 9.15;  ///< position of the needle where the tip of the scene starts [mm]

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
  std::vector<InstrumentEvent> events;
};

// Before the puncture within 0.05 N rms of the nine points; puncture within 5 % in force and place; least force of the 2 mm after it
// within what was measured there, 0.15 to 0.42 N; the plateau's mean within 10 %; and while nothing moves fast the supports bear what
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
  EXPECT_LT(std::sqrt(squares / count), 0.05);

  const double broke = curve.position_of("puncture");
  EXPECT_NEAR(broke, puncture.position, 0.05 * puncture.position);
  EXPECT_NEAR(curve.at(broke - 0.01), puncture.force, 0.05 * puncture.force);
  double least = puncture.force;
  for (double x = broke; x < broke + 2.0; x += 0.02) least = std::min(least, curve.at(x));
  EXPECT_LT(least, 0.42);
  EXPECT_GT(least, 0.10);

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

// The inner punctures come in number and place as measured, to the 0.3 mm that a comparison of the curves leaves out.
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
  for (std::size_t i = 0; i < inner.size(); ++i) EXPECT_NEAR(places[i], inner[i].position, 0.3);
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

// 0.12 N rms over 0 to 48 mm, every 0.2 mm, but for 0.3 mm on either side of the four drops.
void expect_whole_curve(const Curve& curve, const std::map<double, std::pair<double, int>>& points) {
  std::vector<double> drops;
  for (const Point& p : measured()) {
    if (p.what.ends_with("puncture") && p.force > 1.4) drops.push_back(p.position);
  }
  ASSERT_EQ(drops.size(), 4U);
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i <= 240; ++i) {
    const double x = 0.2 * i;
    if (std::any_of(drops.begin(), drops.end(), [x](double d) { return std::abs(d - x) <= 0.3; })) continue;
    const auto next = points.lower_bound(x);
    const auto value = [](const auto& p) { return p.second.first / p.second.second; };
    double force = value(*next);
    if (next != points.begin()) {
      const auto before = std::prev(next);
      force = value(*before) + (force - value(*before)) * (x - before->first) / (next->first - before->first);
    }
    squares += std::pow((x < kStart ? 0.0 : curve.at(x)) - force, 2);
    ++count;
  }
  const double rms = std::sqrt(squares / count);
  ::testing::Test::RecordProperty("rms_uN", static_cast<int>(1e6 * rms));
  EXPECT_GT(count, 220);
  EXPECT_LT(rms, 0.12);
}

// What the scene claims, on one run of it. The whole curve, of 371 points, is read from beside the checkout; that part is skipped
// where it is missing.
TEST(BovineNeedle, FollowsTheMeasuredCurve) {
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", {{"output.frames", "0"}});
  Curve curve;
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, curve, stop);
  ASSERT_EQ(summary.end, RunSummary::End::finished);
  expect_surface_and_plateau(curve);
  expect_inner_punctures(curve);
  const auto path = test::shipped("../shared/data/needle/bovine_liver.csv");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  expect_whole_curve(curve, whole_curve(path));
}

}  // namespace
}  // namespace glisson

// The needle of scenes/needle/bovine_liver.toml follows the measured curve of bovine liver [Okamura2004] before, at and after
// the puncture.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
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

// Before the puncture within 0.05 N rms of the ten points; puncture within 5 % in force and place; at most 0.35 N within 2 mm
// after it; the plateau's mean within 10 %; and while nothing moves fast the supports bear what the hand feels, to 1 %.
TEST(BovineNeedle, FollowsTheMeasuredCurve) {
  const Scene scene = test::shipped_scene("needle/bovine_liver.toml", {{"output.frames", "0"}});
  Curve curve;
  const std::atomic<bool> stop{false};
  const RunSummary summary = run_variant(scene.variants.front(), {}, curve, stop);
  ASSERT_EQ(summary.end, RunSummary::End::finished);

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
  EXPECT_LT(curve.at(broke + 2.0), 0.35);
  EXPECT_GT(curve.at(broke + 2.0), 0.10);  // measured: 0.15 to 0.30 N
  EXPECT_NEAR(curve.position_of("inner puncture"), 37.0, 0.05 * 37.0);

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

}  // namespace
}  // namespace glisson

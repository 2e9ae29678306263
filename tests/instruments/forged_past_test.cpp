// The numbers of a checkpoint are taken as they were written or refused: a count, a vertex or a tet that is none never passes.
#include <gtest/gtest.h>

#include <limits>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/container.h"
#include "instruments/contact_scenes.h"

namespace glisson::forged_past_test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A block in a vessel that holds it, under a ball that is bonded to it, and the edge of a blade half-way through it.
struct Bench {
  TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  Simulation body{mesh, {{0, Tissue{}}}};
  std::shared_ptr<Container> container;
  std::shared_ptr<ContactTool> ball;
  std::shared_ptr<Blade> blade;

  Bench() {
    ContainerOptions vessel;
    vessel.vessel = BoxVessel{.width = 0.02, .length = 0.02};
    vessel.pose.position = {0.01, 0.01, 0.0};
    vessel.bonded = true;
    container = std::make_shared<Container>(vessel);
    ContactOptions options;
    options.shape = Ball{.radius = 4e-3};
    options.bonded = true;
    ball = std::make_shared<ContactTool>(options, moving({0.005, 0.005, 0.021}, 0.05));
    blade = std::make_shared<Blade>(body, "blade", moving({0.0113, 0.01, 0.021}, 0.1), Vec3d{0, 0, -1},
                                    BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}});
    for (const std::shared_ptr<Interaction>& x : all()) body.attach(x);
  }
  std::vector<std::shared_ptr<Interaction>> all() const { return {container, ball, blade}; }
  void run() {
    for (int i = 0; i < 50; ++i) {
      ASSERT_LE(body.step().status, StepStatus::inverted);
      blade->cut();
    }
  }

 private:
  static std::shared_ptr<ToolDriver> moving(const Vec3d& from, double speed) {
    return std::make_shared<test::GivenPath>([=](double t) {
      return Pose{from + Vec3d{0.0, 0.0, -speed * t}, identity<double>()};
    });
  }
};

TEST(ForgedPast, IsTakenAsItWasWrittenOrRefused) {
  Bench bench;
  bench.run();
  for (const std::shared_ptr<Interaction>& x : bench.all()) {
    const std::vector<double> past = x->past();
    ASSERT_GT(past.size(), 20u);
    for (std::size_t at = 0; at < past.size(); ++at) {
      for (const double forged : {past[at] + 0.5, -1.0, 1e300, kInfinite}) {
        std::vector<double> changed = past;
        changed[at] = forged;
        if (!x->restore(changed)) continue;
        EXPECT_EQ(x->past(), changed) << at << " from " << past[at] << " to " << forged;
      }
    }
    EXPECT_TRUE(x->restore(past));
    EXPECT_EQ(x->past(), past);
  }
}

TEST(ForgedPast, IsRefusedWhereItIsCut) {
  Bench bench;
  bench.run();
  for (const std::shared_ptr<Interaction>& x : bench.all()) {
    const std::vector<double> past = x->past();
    for (std::size_t n = 0; n < past.size(); ++n) {
      const std::vector<double> cut(past.begin(), past.begin() + static_cast<std::ptrdiff_t>(n));
      if (!x->restore(cut)) continue;
      EXPECT_EQ(x->past(), cut) << "a blade with fewer pieces of its edge in tissue";
    }
  }
}

}  // namespace
}  // namespace glisson::forged_past_test

// The numbers of a checkpoint are taken as they were written or refused: a count, a vertex or a tet that is none never passes.
#include <gtest/gtest.h>

#include <stdexcept>

#include "glisson/archive.h"
#include "glisson/instruments/blade.h"
#include "glisson/instruments/container.h"
#include "instruments/contact_scenes.h"

namespace glisson::forged_past_test {
namespace {

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
    blade = std::make_shared<Blade>(BladeOptions{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .cut_every = 0.0},
                                    moving({0.0113, 0.01, 0.021}, 0.1));
    for (const std::shared_ptr<Interaction>& x : all()) body.attach(x);
  }
  std::vector<std::shared_ptr<Interaction>> all() const { return {container, ball, blade}; }
  void run() {
    for (int i = 0; i < 50; ++i) ASSERT_LE(body.step().status, StepStatus::inverted);
  }

 private:
  static std::shared_ptr<ToolDriver> moving(const Vec3d& from, double speed) {
    return std::make_shared<test::GivenPath>([=](double t) {
      return Pose{from + Vec3d{0.0, 0.0, -speed * t}, identity<double>()};
    });
  }
};

bool takes(Interaction& x, const std::string& bytes) {
  try {
    restore(x, bytes);
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

TEST(ForgedPast, IsTakenAsItWasWrittenOrRefused) {
  Bench bench;
  bench.run();
  for (const std::shared_ptr<Interaction>& x : bench.all()) {
    const std::string past = archived(*x);
    ASSERT_GT(past.size(), 150u);
    std::size_t refused = 0;
    for (std::size_t at = 0; at < past.size(); ++at) {
      for (const auto& [bytes, flip] : {std::pair{1, 0x01}, {1, 0x80}, {1, 0xff}, {4, 0xff}, {8, 0xff}}) {
        std::string changed = past;
        for (std::size_t k = at; k < std::min(past.size(), at + bytes); ++k) changed[k] = char(changed[k] ^ flip);
        if (takes(*x, changed)) {
          EXPECT_EQ(archived(*x), changed) << bytes << " bytes at " << at << " by " << flip;
        } else {
          ++refused;
        }
      }
    }
    EXPECT_GT(refused, 20u);
    EXPECT_TRUE(takes(*x, past));
    EXPECT_EQ(archived(*x), past);
  }
}

TEST(ForgedPast, IsRefusedWhereItIsCut) {
  Bench bench;
  bench.run();
  for (const std::shared_ptr<Interaction>& x : bench.all()) {
    const std::string past = archived(*x);
    for (std::size_t n = 0; n < past.size(); ++n) EXPECT_FALSE(takes(*x, past.substr(0, n))) << n;
    EXPECT_FALSE(takes(*x, past + "x"));
  }
}

}  // namespace
}  // namespace glisson::forged_past_test

// The work of a semi-implicit step is bounded: where contact is not found the step is not made, nothing has changed, and the message
// has ways out; automatic steps become shorter until it is found.
#include <gmock/gmock.h>

#include <chrono>

#include "glisson/scene/scene.h"

namespace glisson::bounded_step_test {
namespace {

using ::testing::HasSubstr;

/// A block of 50 g, bonded to tissue of 6.4 kg and pushed by 100 N: within a step of 10 ms it would go by 0.2 m without the tissue,
/// five times through the whole body.
BuiltVariant pushed(const std::string& motion) {
  const std::string text = R"(
mesh = { kind = "box", cells = [5, 5, 3], size_m = [0.04, 0.04, 0.04] }
tissue = { density_kg_m3 = 100000, viscosity_Pa_s = 89.44, hyperelastic = { kind = "gent", bulk_modulus_Pa = 20000, mu_Pa = 1000, limit = 3 } }
motion = { integrator = "semi_implicit", duration_s = 0.02)" +
                           motion + R"( }
[[instrument]]
kind = "block"
name = "block"
tip_m = [0.0275, 0.01376, 0.045]
friction = 0
bonded = true
motion = { kind = "push", force_N = 100, duration_s = 0.1, mass_kg = 0.05, damping_N_s_m = 0 }
)";
  return build_variant(parse_scene(text, "pushed.toml", ".").variants.front(), {});
}

double seconds_of(Simulation& body, StepResult& result) {
  const auto begin = std::chrono::steady_clock::now();
  result = body.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// A given step in which contact is not found: status, message, and all as before. It took 40 s, and was made with whatever the last of
// 480 000 sweeps had left. Measured: 0.3 s.
TEST(BoundedStep, GivesUpAndChangesNothing) {
  BuiltVariant built = pushed(", step_s = 0.0104");
  Simulation& body = built.simulation;
  StepResult result;
  double longest = 0.0;
  int made = 0;
  std::uint64_t hash = 0;
  Energies before;
  Vec3d force, place;
  do {
    hash = body.state_hash(), before = body.energies();
    force = built.instruments[0]->force(), place = built.instruments[0]->pose().position;
    longest = std::max(longest, seconds_of(body, result));
  } while (result.made() && ++made < 5);
  ASSERT_EQ(result.status, StepStatus::not_converged);
  EXPECT_LT(longest, 20.0) << "of the clock [s]";
  EXPECT_THAT(std::string(result.message), HasSubstr("contact was not found in a step of 0.0104 s"));
  EXPECT_THAT(std::string(result.message), HasSubstr("Ways out: step_s = \"auto\" or a smaller step"));
  EXPECT_EQ(body.state_hash(), hash);
  EXPECT_EQ(body.steps(), static_cast<std::uint64_t>(made));
  EXPECT_EQ(body.energies().elastic, before.elastic);
  EXPECT_EQ(body.energies().work_tools, before.work_tools);
  EXPECT_EQ(body.energies().kinetic, before.kinetic);
  EXPECT_EQ(built.instruments[0]->force(), force);
  EXPECT_EQ(built.instruments[0]->pose().position, place);
}

// Automatic steps become as short as contact needs: the block has the momentum that its push and the tissue's answer have given it,
// m v = ∫(F + f) dt, to the search's tolerance of 1e-5 of what holds it back. One step of 8.9 ms was made before, with −7.5 for 0.89 N s.
TEST(BoundedStep, AutomaticStepsFindContact) {
  BuiltVariant built = pushed("");
  Simulation& body = built.simulation;
  StepResult result;
  double longest = 0.0, impulse = 0.0, speed = 0.0;
  Vec3d before = built.instruments[0]->pose().position;
  const Vec3d down = built.instruments[0]->direction();
  while (body.time() < 0.007) {
    const double start = body.time();
    longest = std::max(longest, seconds_of(body, result));
    ASSERT_TRUE(result.made()) << result.message << " at " << start << " s";
    const double h = body.time() - start;
    impulse += (100.0 - dot(built.instruments[0]->force(), down)) * h;
    const Vec3d now = built.instruments[0]->pose().position;
    speed = dot(now - before, down) / h, before = now;
    EXPECT_NEAR(0.05 * speed, impulse, 1e-4 * 100.0 * body.time()) << "m v and ∫(F + f) dt [N s]";
  }
  EXPECT_LT(longest, 20.0) << "of the clock [s]";
}

}  // namespace
}  // namespace glisson::bounded_step_test

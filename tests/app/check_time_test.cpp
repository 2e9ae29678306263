// glisson check ends within ten seconds, whatever the scene, and says what it has left out.
#include <chrono>

#include "app/program.h"

namespace glisson::test::check_time_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// 10 s on a machine that has nothing else to do; other tests run beside this one [s].
constexpr double kMost = 40.0;

class CheckTime : public ProgramTest {
 protected:
  Outcome timed(const std::string& scene) {
    const auto begin = std::chrono::steady_clock::now();
    Outcome outcome = run({"check", write("s.toml", scene)});
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
  }
  double seconds_ = 0.0;
};

std::string block(int cells, const std::string& motion, const std::string& more = "") {
  const std::string n = std::to_string(cells);
  return "mesh = { kind = \"box\", cells = [" + n + ", " + n + ", " + n +
         "], size_m = [0.04, 0.04, 0.04] }\n"
         "tissue = { density_kg_m3 = 1000, viscosity_Pa_s = 500, hyperelastic = { kind = \"neo_hookean\", mu_Pa = "
         "1000, "
         "bulk_modulus_Pa = 50000 } }\n"
         "motion = { " +
         motion +
         " }\n[[fixed]]\nset = \"z_min\"\n[[tool]]\nname = \"plate\"\nset = \"z_max\"\n"
         "direction = [0, 0, -1]\nvelocity_mm_s = 20\ndepth_mm = 12\n" +
         more;
}

// A first step of minutes is not waited for: mesh, sets and tissue are told, its cost is said not to be known.
TEST_F(CheckTime, LongFirstStepIsNotWaitedFor) {  // long
  const Outcome outcome = timed(block(26, "integrator = \"quasi_static\", step_s = 0.6"));
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_LT(seconds_, kMost);
  EXPECT_THAT(outcome.out, HasSubstr("105456 tets"));
  EXPECT_THAT(outcome.out, HasSubstr("the first took longer than"));
  EXPECT_THAT(outcome.out, HasSubstr("Left out for want of time: the cost of a step of main"));
}

// What cannot be ended, as a search for the stable step of a million tets, is left: the program ends and says within what.
TEST_F(CheckTime, EndsWithinWhatCannotBeEnded) {  // long
  const Outcome outcome = timed(block(70, "integrator = \"central_difference\""));
  EXPECT_THAT(outcome, Exits(4)) << "not a pass";
  EXPECT_THAT(outcome.out, HasSubstr("This is not a pass (exit status 4)"));
  EXPECT_LT(seconds_, kMost);
  EXPECT_THAT(outcome.out, HasSubstr("The check ends after 9 s, within the mesh and the stable step of main"));
  EXPECT_THAT(outcome.out, HasSubstr("Not known: whether main can be run"));
}

// Of many variants those that time is left for are told.
TEST_F(CheckTime, ManyVariantsAreToldAsFarAsTimeGoes) {  // long
  std::string variants;
  for (int i = 0; i < 40; ++i) variants += "[[variant]]\nname = \"v" + std::to_string(i) + "\"\n";
  const Outcome outcome = timed(block(12, "integrator = \"central_difference\"", variants));
  EXPECT_THAT(outcome, Exits(4)) << "variants were not looked at";
  EXPECT_THAT(outcome.out, HasSubstr("This is not a pass (exit status 4)"));
  EXPECT_LT(seconds_, kMost);
  EXPECT_THAT(outcome.out, HasSubstr("variant v39"));
  EXPECT_THAT(outcome.out, HasSubstr("What was looked at can be run"));
}

// A scene that time suffices for has all, and no word of time.
TEST_F(CheckTime, SmallSceneLeavesNothingOut) {
  const Outcome outcome = timed(small_scene());
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("The scene can be run"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("for want of time")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("  fast  ")));
}

// A tool faster than the waves of the tissue that it is to move: 3600 Pa at ν = 0.4 and 1000 kg/m³ have √(7714/1000) = 2.78 m/s.
TEST_F(CheckTime, ToolFasterThanWavesIsTold) {
  const std::string scene = write("s.toml", small_scene());
  const Outcome fast = run({"check", scene, "--set", "tool.0.velocity_mm_s=1e9"});
  EXPECT_THAT(fast, Exits(0));
  EXPECT_THAT(fast.out, HasSubstr("moves at up to 1e+09 mm/s, where waves in the tissue have 2.78e+03 mm/s"));
  EXPECT_THAT(run({"check", scene, "--set", "tool.0.velocity_mm_s=2700"}).out, Not(HasSubstr("  fast  ")));
  EXPECT_THAT(run({"check", scene, "--set", "tool.0.velocity_mm_s=2900"}).out, HasSubstr("  fast  "));
  const Outcome wild = run({"check", scene, "--set", "tool.0.velocity_mm_s=1e30"});
  EXPECT_THAT(wild, Exits(2));
  EXPECT_THAT(wild.err, HasSubstr("1e+30 mm/s is out of range"));
}

}  // namespace
}  // namespace glisson::test::check_time_test

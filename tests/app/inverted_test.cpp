// `glisson run` on St Venant–Kirchhoff tissue that is pressed through itself: it ends, and says how and when tets turned over.
#include "app/program.h"

namespace glisson::test {
namespace {

using Inverted = ProgramTest;
using ::testing::HasSubstr;

/// A block of 48 tets pressed to twice its height, of a law that is at rest inside out as well.
std::string pressed_through(const std::string& motion) {
  return "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n[tissue]\nyoungs_modulus_Pa = 3600\n"
         "poisson_ratio = 0.4\nkinematics = \"green\"\n[[fixed]]\nset = \"z_min\"\n[[tool]]\nname = \"press\"\n"
         "set = \"z_max\"\ndepth_mm = 40\nvelocity_mm_s = 100\n[motion]\nduration_s = 0.5\n" +
         motion;
}

// By itself the run goes on to its end, with most tets inside out, and says so.
TEST_F(Inverted, RunOfGreenTetsEndsAndTells) {
  const Outcome outcome = run({"run", write("s.toml", pressed_through("")), "--out", "o"});
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("finished (up to "));
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  EXPECT_EQ(summary["end"], "finished");
  EXPECT_GE(summary["inverted_tets_most"], 20);
  EXPECT_GT(summary["first_inversion_s"], 0.05);
  EXPECT_LT(summary["steps"], 20000) << "steps do not crawl";
}

// Where the scene asks for it, the first one ends the run, with a message on the error stream and an exit code of its own.
TEST_F(Inverted, StopsAtTheFirstWhereAsked) {
  const Outcome outcome = run({"run", write("s.toml", pressed_through("on_inversion = \"stop\"\n")), "--out", "o"});
  EXPECT_THAT(outcome, Exits(3));
  EXPECT_THAT(outcome.err, HasSubstr("tets are inverted (J <= 0); press less deep"));
  EXPECT_EQ(read_json(folder_ / "o/main/summary.json")["end"], "stopped_inverted");
}

// Thrown so far that no step moves time on: a status and what can be done, not a run without end.
TEST_F(Inverted, EndsWhereStepsNoLongerMoveTimeOn) {
  const Outcome outcome = run({"run", write("s.toml", pressed_through("")), "--out", "o", "--set",
                               "tool.0.depth_mm=40000", "--set", "tool.0.velocity_mm_s=1e9"});
  EXPECT_THAT(outcome, Exits(3));
  EXPECT_THAT(outcome.err, HasSubstr("a stable step does not advance time; press less deep"));
  EXPECT_EQ(read_json(folder_ / "o/main/summary.json")["end"], "stopped_unstable");
}

}  // namespace
}  // namespace glisson::test

// Ctrl-C, SIGTERM and SIGHUP: the run ends soon, everything written so far is whole, and a report is made of it.
#include <chrono>
#include <csignal>
#include <regex>
#include <thread>

#include "app/program.h"

namespace glisson::test {
namespace {

class Interrupt : public ProgramTest, public ::testing::WithParamInterface<int> {
 protected:
  /// Waits until two variants have said that a tenth or more is behind them.
  static bool under_way(const Started& program) {
    for (int i = 0; i < 3000; ++i) {
      const std::string out = program.output_so_far();
      if (out.find("thick: 10 %") != std::string::npos && out.find("thicker: started") != std::string::npos)
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
};

TEST_P(Interrupt, KeepsWhatIsWritten) {
  Started program = start({"run", write("s.toml", long_scene()), "--out", "o", "--threads", "2"});
  ASSERT_TRUE(under_way(program)) << program.output_so_far();
  program.signal(GetParam());
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = program.wait();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_THAT(outcome, Exits(130));
  EXPECT_LT(seconds, 20.0) << "until the end";

  auto f = read_csv(folder_ / "o/thick/forces.csv");
  ASSERT_GE(f["time_s"].size(), 2u);
  const nlohmann::json summary = read_json(folder_ / "o/thick/summary.json");
  EXPECT_EQ(summary["end"], "interrupted");
  EXPECT_GT(summary["time_s"], 0.0);
  EXPECT_LT(summary["time_s"], 0.05) << "the whole run";
  EXPECT_NE(read_text(folder_ / "o/thick/frames.pvd").find("frame_0000.vtu"), std::string::npos);
  const nlohmann::json report = report_data(folder_ / "o/report.html");
  EXPECT_EQ(report["scenes"][0]["variants"][0]["summary"]["end"], "interrupted");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o/never/summary.json"))
      << "a variant that was waiting has no results";
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, ::testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& signal) {
  return signal.param == SIGINT ? "SIGINT" : signal.param == SIGTERM ? "SIGTERM" : "SIGHUP";
});

using LongStep = ProgramTest;

// Within a step of Newton's method that takes minutes the program says how long it has been at it, and Ctrl-C ends it within a second: the step is not
// made, and what was written before stays.
TEST_F(LongStep, SaysSoAndEndsAtOnce) {  // long
  Started program =
      start({"run", write("s.toml", R"(mesh = { kind = "box", cells = [26, 26, 26], size_m = [0.04, 0.04, 0.04] }
tissue = { density_kg_m3 = 1000, hyperelastic = { kind = "neo_hookean", mu_Pa = 1000, bulk_modulus_Pa = 50000 } }
motion = { integrator = "quasi_static", step_s = 0.6 }
[[fixed]]
set = "z_min"
[[tool]]
name = "plate"
set = "z_max"
direction = [0, 0, -1]
velocity_mm_s = 20
depth_mm = 12
)"),
             "--out", "o"});
  for (int i = 0; i < 3000 && program.output_so_far().find("in one step for") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_NE(program.output_so_far().find("main: 0.0 %, in one step for "), std::string::npos)
      << program.output_so_far();
  program.signal(SIGINT);
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = program.wait();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_THAT(outcome, Exits(130));
  EXPECT_LT(seconds, 20.0) << "until the end: 1 s for the step and the report, on a machine that does nothing else";
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  EXPECT_EQ(summary["end"], "interrupted");
  EXPECT_EQ(summary["steps"], 0);
  EXPECT_NE(read_text(folder_ / "o/main/frames.pvd").find("frame_0000.vtu"), std::string::npos);
}

}  // namespace
}  // namespace glisson::test

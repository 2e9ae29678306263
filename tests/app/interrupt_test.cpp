// Ctrl-C and SIGTERM: the run ends soon, everything written so far is whole, and a report is made of it.
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

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, ::testing::Values(SIGINT, SIGTERM),
                         [](const auto& signal) { return signal.param == SIGINT ? "SIGINT" : "SIGTERM"; });

}  // namespace
}  // namespace glisson::test

// What `glisson run` and `glisson check` make of a scene of heat: tables, frames, summary with checks, report, exit codes, Ctrl-C.
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "app/program.h"
#include "glisson/io.h"
#include "support/places.h"

namespace glisson::test {
namespace {

using HeatRun = ProgramTest;

/// A block that freezes from a face and around a probe.
std::string heat_scene(const std::string& more = {}, int cells = 6, double duration = 60.0) {
  return "title = \"A block that freezes\"\n[mesh]\nkind = \"box\"\ncells = [" + std::to_string(cells) + ", " +
         std::to_string(cells) + ", " + std::to_string(cells) +
         "]\nsize_m = [0.04, 0.04, 0.04]\n[heat]\nduration_s = " + std::to_string(duration) +
         "\nsample_every_s = 10\n[[heat.tissue]]\npreset = \"liver\"\n[[heat.boundary]]\nset = "
         "\"x_min\"\ntemperature_C = -80\n"
         "[[heat.probe]]\nname = \"needle\"\nfrom_m = [0.02, 0.02, 0.01]\nto_m = [0.02, 0.02, 0.04]\nactive_length_mm "
         "= 20\n"
         "power_W_m = -300\n[[heat.sensor]]\nname = \"near\"\npoint_m = [0.005, 0.02, 0.02]\n[[heat.front]]\nname = "
         "\"ice\"\n"
         "from_m = [0, 0.005, 0.005]\nto_m = [0.04, 0.005, 0.005]\n[[heat.isotherm]]\nname = \"cold\"\ntemperature_C = "
         "-20\n"
         "[output]\nframes = 3\n" +
         more;
}

// Without a sensor temperature.csv has the mean of the body, whose heat content it follows while nothing freezes: ρ c V (T − 37).
TEST_F(HeatRun, WritesTheMeanWhereThereIsNoSensor) {
  const std::string scene =
      "[mesh]\nkind = \"box\"\ncells = [4, 4, 4]\nsize_m = [0.04, 0.04, 0.04]\n[heat]\nduration_s = 60\n"
      "sample_every_s = 10\n[[heat.tissue]]\npreset = \"soft_tissue\"\ndensity_kg_m3 = 1000\nspecific_heat_J_kg_K = "
      "3600\nperfusion_per_s = 0\n"
      "metabolic_heat_W_m3 = 0\n[[heat.boundary]]\nset = \"x_min\"\nflux_W_m2 = -500\n";
  ASSERT_THAT(run({"run", write("s.toml", scene), "--out", "o", "--quiet"}), Exits(0));
  auto t = read_csv(folder_ / "o/main/temperature.csv"), h = read_csv(folder_ / "o/main/heat.csv");
  ASSERT_EQ(t["mean_C"].size(), 7U);
  const double mean = 37.0 + h["stored_J"].back() / (1000.0 * 3600.0 * 6.4e-5);
  EXPECT_LT(mean, 36.9);
  EXPECT_NEAR(t["mean_C"].back(), mean, 1e-9);
}

// The files, their columns, and that they agree with each other; checks as numbers, in the summary and in words in the report.
TEST_F(HeatRun, LeavesTablesFramesAndChecks) {
  const std::string checks =
      "[[check]]\nwhat = \"it is cold\"\ncolumn = \"near_C\"\nexpected = -30\ntolerance = 25\n"
      "[[check]]\nwhat = \"there is ice\"\ncolumn = \"frozen_m3\"\nat_least = 1e-6\n"
      "[[check]]\nwhat = \"the balance closes\"\ncolumn = \"imbalance_J\"\nover = \"stored_J\"\nat = \"end\"\nat_least "
      "= -1e-10\nat_most = 1e-10\n";
  const Outcome outcome = run({"run", write("s.toml", heat_scene(checks)), "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("ok    it is cold\n"));
  auto t = read_csv(folder_ / "o/main/temperature.csv"), h = read_csv(folder_ / "o/main/heat.csv");
  ASSERT_EQ(t["time_s"].size(), 7U);
  EXPECT_EQ(t["near_C"].front(), 37.0);
  EXPECT_EQ(h["time_s"], t["time_s"]);
  EXPECT_GT(h["dead_m3"].back(), 0.0) << "liver dies below −40 °C";
  EXPECT_GT(h["ice_m"].back(), 0.002);
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  EXPECT_EQ(summary["end"], "finished");
  EXPECT_EQ(summary["near_C"], t["near_C"].back());
  EXPECT_EQ(summary["cold_volume_m3"], h["cold_volume_m3"].back());
  ASSERT_EQ(summary["checks"].size(), 3U);
  const nlohmann::json& first = summary["checks"][0];
  EXPECT_EQ(first["name"], "it is cold");
  EXPECT_EQ(first["measured"], t["near_C"].back());
  EXPECT_EQ(first["expected"], -30.0);
  EXPECT_EQ(first["tolerance"], 25.0);
  EXPECT_TRUE(first["ok"].get<bool>());
  EXPECT_EQ(summary["checks"][1]["bound"], "at_least");
  EXPECT_TRUE(summary["checks"][1]["tolerance"].is_null());
  const nlohmann::json scene = report_data(folder_ / "o/report.html")["scenes"][0];
  EXPECT_EQ(scene["checks"].size(), 3U);
  EXPECT_EQ(scene["charts"][0]["title"], "Temperatures");
  EXPECT_EQ(scene["charts"][0]["lines"][0]["label"], "near");
  const nlohmann::json& surface = scene["variants"][0]["surface"];
  EXPECT_EQ(surface["isotherms"], nlohmann::json::parse(R"([{"name": "cold", "temperature_C": -20.0}])"));
  ASSERT_EQ(surface["instruments"].size(), 1U) << "the probe is drawn as a needle";
  EXPECT_EQ(surface["instruments"][0]["name"], "needle");
  EXPECT_FALSE(surface["tets"].get<std::string>().empty()) << "isotherms are surfaces within the tets";
  ASSERT_EQ(surface["frames"].size(), 3U);
  EXPECT_EQ(surface["frames"][0]["fields"]["temperature"]["high"], 37.0);
  EXPECT_NEAR(surface["frames"][2]["fields"]["temperature"]["low"].get<double>(), h["lowest_C"].back(), 1e-9);
  EXPECT_EQ(surface["frames"][2]["displacement"], "") << "it rests";
  const auto frames = read_pvd(folder_ / "o/main/frames.pvd");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames.back().first, 60.0);
  const std::vector<std::string> names{"temperature_C", "dead", "coldest_C", "cem43_min"};
  const ReadFrame last = read_frame(folder_ / "o/main/frames" / frames.back().second.filename(), names);
  ASSERT_EQ(last.vertex_fields.size(), 4U);
  for (const Field& field : last.vertex_fields) {
    if (field.name != "temperature_C") continue;
    EXPECT_NEAR(*std::min_element(field.values.begin(), field.values.end()), h["lowest_C"].back(), 1e-9);
  }
  const Outcome view = run({"view", "o"});
  EXPECT_THAT(view, Exits(2));
  EXPECT_THAT(view.err, ::testing::HasSubstr("a run of heat"));
  EXPECT_THAT(run({"run", "s.toml", "--out", "o", "--quiet"}), Exits(0))
      << "a second run replaces all files of the first";
}

// A check that fails ends the program with status 1 and stands in the summary; so does a column that is not there.
TEST_F(HeatRun, FailsItsChecks) {
  const Outcome bad = run(
      {"run",
       write("s.toml", heat_scene("[[check]]\nwhat = \"warm\"\ncolumn = \"near_C\"\nexpected = 37\ntolerance = 1\n")),
       "--out", "o", "--quiet"});
  EXPECT_THAT(bad, Exits(1));
  EXPECT_THAT(bad.out, ::testing::HasSubstr("FAIL  warm\n"));
  EXPECT_FALSE(read_json(folder_ / "o/main/summary.json")["checks"][0]["ok"].get<bool>());
  const Outcome none =
      run({"run", write("n.toml", heat_scene("[[check]]\nwhat = \"w\"\ncolumn = \"far_C\"\nat_least = 0\n")), "--out",
           "n"});
  EXPECT_THAT(none, Exits(1));
  EXPECT_THAT(none.out, ::testing::HasSubstr("temperature.csv and heat.csv have no column \"far_C\""));
  const nlohmann::json check = read_json(folder_ / "n/main/summary.json")["checks"][0];
  EXPECT_TRUE(check["measured"].is_null());
  EXPECT_FALSE(check["ok"].get<bool>());
}

// The summary of a run of mechanics has its checks, too, in the same form.
TEST_F(HeatRun, MechanicsHaveChecksToo) {
  const std::string checks =
      "[[check]]\nwhat = \"it presses\"\ncolumn = \"force_N\"\nat = \"largest\"\nat_least = 0.01\n";
  ASSERT_THAT(run({"run", write("s.toml", small_scene(checks)), "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  ASSERT_EQ(summary["checks"].size(), 1U);
  EXPECT_EQ(summary["checks"][0]["name"], "it presses");
  EXPECT_GT(summary["checks"][0]["measured"].get<double>(), 0.01);
  EXPECT_EQ(summary["checks"][0]["expected"], 0.01);
  ASSERT_THAT(run({"run", write("n.toml", small_scene()), "--out", "n", "--quiet"}), Exits(0));
  EXPECT_EQ(read_json(folder_ / "n/main/summary.json")["checks"], nlohmann::json::array());
}

// A scene of heat is checked without a run; what it cannot do is refused by name, with status 2.
TEST_F(HeatRun, IsCheckedAndRefused) {
  const Outcome good = run({"check", write("s.toml", heat_scene())});
  EXPECT_THAT(good, Exits(0));
  EXPECT_THAT(good.out, ::testing::HasSubstr("1 probe"));
  const Outcome outside = run({"run", "s.toml", "--set", "heat.probe.needle.to_m=[0.02, 0.02, 0.09]", "--set",
                               "heat.probe.needle.active_length_mm=70"});
  EXPECT_THAT(outside, Exits(2));
  EXPECT_THAT(outside.err, ::testing::HasSubstr("probe \"needle\""));
  const Outcome kelvin = run({"run", "s.toml", "--set", "heat.temperature_C=310"});
  EXPECT_THAT(kelvin, Exits(2));
  EXPECT_THAT(kelvin.err, ::testing::HasSubstr("temperatures are in °C, not in K"));
  for (const char* command : {"view", "converge"}) {
    const Outcome other = run({command, "s.toml"});
    EXPECT_THAT(other, Exits(2)) << command;
    EXPECT_THAT(other.err, ::testing::HasSubstr("scene is one of heat")) << command;
  }
}

// Ctrl-C keeps what is written: whole lines, frames, a summary that says so, a report.
TEST_F(HeatRun, CtrlCKeepsWhatIsWritten) {
  Started program = start({"run", write("s.toml", heat_scene("", 24, 100000.0)), "--out", "o"});
  for (int i = 0; i < 3000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (std::filesystem::exists(folder_ / "o/main/heat.csv") &&
        read_csv(folder_ / "o/main/heat.csv")["time_s"].size() > 2)
      break;
  }
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_THAT(outcome, Exits(130));
  EXPECT_GE(read_csv(folder_ / "o/main/temperature.csv")["time_s"].size(), 2U);
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  EXPECT_EQ(summary["end"], "interrupted");
  EXPECT_GT(summary["time_s"], 0.0);
  EXPECT_GE(read_pvd(folder_ / "o/main/frames.pvd").size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/report.html"));
}

// The shipped front of Neumann at −140 °C is within half a percent of the closed form, as its own check says.
TEST_F(HeatRun, ShippedNeumannHoldsItsCheck) {
  const std::string scene = shipped("scenes/heat/neumann.toml").string();
  ASSERT_THAT(run({"run", scene, "--variant", "at_140", "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json checks = read_json(folder_ / "o/at_140/summary.json")["checks"];
  ASSERT_EQ(checks.size(), 2U);
  EXPECT_NEAR(checks[0]["measured"].get<double>(), 2.0 * 0.50541 * std::sqrt(2.0 / 1.8e6 * 600.0), 0.005 * 0.0261);
}

}  // namespace
}  // namespace glisson::test

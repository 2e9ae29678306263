// What a run with a needle leaves behind: its forces beside those of the container, events as they happened, and a report
// that can draw both.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/program.h"

namespace glisson::test {
namespace {

using Instruments = ProgramTest;

/// A needle goes 8 mm into a block in a box at 100 mm/s, and the surface gives way on its way.
std::string needle_scene(const std::string& more = "") {
  return R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.04, 0.04, 0.04]
origin_m = [-0.02, -0.02, 0]
[motion]
damping_rate_per_s = 100
[container]
kind = "box"
width_mm = 40
length_mm = 40
hold = "bonded"
[[instrument]]
kind = "needle"
name = "needle"
tip_m = [0.001, 0.002, 0.041]
rupture.force_N = 0.05
tip.cutting_N = 0.01
motion = { kind = "press", depth_mm = 9, velocity_mm_s = 100 }
[output]
frames = 4
)" + more;
}

/// Lines of a csv with words in it, split at commas.
std::vector<std::vector<std::string>> words_of(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) lines.back().push_back(word);
  }
  return lines;
}

// forces.csv of a scene without a driven set is led by the instrument, whose parts add up; the container's loads follow, and
// what presses on the tissue from above arrives below.
TEST_F(Instruments, ForcesAreOfTheInstrumentAndTheContainer) {
  ASSERT_THAT(run({"run", write("s.toml", needle_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string text = read_text(folder_ / "o/main/forces.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time_s,depth_m,force_x_N,force_y_N,force_z_N,force_N,normal_N,friction_N,cutting_N,bottom_z_N,side_z_N,"
            "side_radial_N,energy_elastic_J,energy_kinetic_J,energy_dissipated_J,work_tools_J,work_loads_J,"
            "dissipated_viscous_J,dissipated_maxwell_J,dissipated_damping_J,dissipated_friction_J,dissipated_contact_J,"
            "dissipated_fracture_J,energy_instruments_J,energy_numerical_J,position_x_m,position_y_m,position_z_m,"
            "rotation_w,rotation_x,rotation_y,rotation_z,torque_x_N_m,torque_y_N_m,torque_z_N_m,handle_torque_x_N_m,"
            "handle_torque_y_N_m,handle_torque_z_N_m,normal_x_N,normal_y_N,normal_z_N,friction_x_N,friction_y_N,"
            "friction_z_N,cutting_x_N,cutting_y_N,cutting_z_N,friction_size_N");
  auto f = read_csv(folder_ / "o/main/forces.csv");
  double peak = 0.0, below = 0.0;
  for (std::size_t i = 0; i < f["force_N"].size(); ++i) {
    EXPECT_NEAR(f["force_N"][i], f["normal_N"][i] + f["friction_N"][i] + f["cutting_N"][i], 1e-12) << i;
    EXPECT_NEAR(f["depth_m"][i], 0.1 * f["time_s"][i], 1e-12) << i;
    peak = std::max(peak, f["force_N"][i]);
    below = std::max(below, -f["bottom_z_N"][i] - f["side_z_N"][i]);
  }
  for (std::size_t i = 0; i < f["force_z_N"].size(); ++i) {
    EXPECT_NEAR(f["force_z_N"][i], f["normal_z_N"][i] + f["friction_z_N"][i] + f["cutting_z_N"][i], 1e-12) << i;
    EXPECT_NEAR(f["position_z_m"][i], 0.041 - f["depth_m"][i], 1e-12) << i;
  }
  EXPECT_NEAR(peak, 0.055, 0.006) << "it gives way in the step after 0.05 N are reached: a tenth of a millimetre on";
  EXPECT_GT(below, 0.02);
}

// events.csv has its head and its lines in order of time, each with the depth of the instrument then; the report has them.
TEST_F(Instruments, EventsAreListed) {
  ASSERT_THAT(run({"run", write("s.toml", needle_scene()), "--out", "o", "--quiet"}), Exits(0));
  const auto lines = words_of(read_text(folder_ / "o/main/events.csv"));
  ASSERT_GE(lines.size(), 3u);
  EXPECT_EQ(lines[0], (std::vector<std::string>{"time_s", "depth_m", "event", "instrument"}));
  EXPECT_EQ(lines[1].at(2), "contact");
  EXPECT_EQ(lines[2].at(2), "puncture");
  double last = 0.0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].size(), 4u);
    EXPECT_GE(std::stod(lines[i][0]), last);
    last = std::stod(lines[i][0]);
    EXPECT_NEAR(std::stod(lines[i][1]), 0.1 * last, 1e-12);
    EXPECT_EQ(lines[i][3], "needle");
  }
  const nlohmann::json variant = report_data(folder_ / "o/report.html")["scenes"][0]["variants"][0];
  ASSERT_EQ(variant["events"].size(), lines.size() - 1);
  EXPECT_EQ(variant["events"][1]["event"], "puncture");
}

// The surface of the report says what the instrument looks like and, in every frame, where its tip is.
TEST_F(Instruments, AreInTheReport) {
  const std::string ball = R"([[instrument]]
kind = "ball"
name = "finger"
tip_m = [0.01, 0.01, 0.05]
radius_mm = 5
motion = { kind = "press", depth_mm = 9, velocity_mm_s = 100 }
)";
  ASSERT_THAT(run({"run", write("s.toml", needle_scene(ball)), "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json surface = report_data(folder_ / "o/report.html")["scenes"][0]["variants"][0]["surface"];
  ASSERT_EQ(surface["instruments"].size(), 2u);
  EXPECT_EQ(surface["instruments"][0]["kind"], "needle");
  EXPECT_EQ(surface["instruments"][1]["kind"], "ball");
  EXPECT_EQ(surface["instruments"][1]["radius_m"], 0.005);
  EXPECT_EQ(surface["container"]["kind"], "box");
  EXPECT_EQ(surface["container"]["width_m"], 0.04);
  EXPECT_NEAR(surface["container"]["height_m"].get<double>(), 1.15 * 0.04, 1e-9) << "above the body: it has no end";
  EXPECT_TRUE(surface["frames"].back()["fields"].contains("contact_pressure"));
  for (const nlohmann::json& frame : surface["frames"]) {
    const double gone = std::min(0.009, 0.1 * frame["time_s"].get<double>());
    EXPECT_NEAR(frame["instruments"][0]["points"].back(), 0.041 - gone, 1e-7);
    EXPECT_NEAR(frame["instruments"][1]["points"].back(), 0.05 - gone, 1e-7);
  }
  EXPECT_EQ(read_csv(folder_ / "o/main/forces_finger.csv").size(), 34u);
}

// At wall-clock pace the dearest moment of a run is told: the frame of the puncture.
TEST_F(Instruments, BenchTellsWhatThePunctureCosts) {
  const Outcome outcome =
      run({"bench", "realtime", write("s.toml", needle_scene()), "--threads", "1", "--json", "r.json"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, testing::HasSubstr("puncture"));
  const nlohmann::json result = read_json(folder_ / "r.json");
  EXPECT_GT(result["peak_force_N"], 0.0);
  bool found = false;
  for (const nlohmann::json& e : result["events"]) {
    found = found || e["events"].get<std::string>().find("puncture") != std::string::npos;
    EXPECT_GT(e["compute_us"], 0.0);
  }
  EXPECT_TRUE(found);
}

/// A ball is pressed into a block and dragged, and its energy W(u) is asked for.
const char* const kBallScene = R"([mesh]
kind = "box"
cells = [6, 6, 3]
size_m = [0.04, 0.04, 0.02]
[[fixed]]
set = "z_min"
[[instrument]]
kind = "ball"
name = "ball"
radius_mm = 8
friction = 0.4
tip_m = [0.015, 0.02, 0.0201]
motion = { kind = "strokes", velocity_mm_s = 50, strokes = [{ depth_mm = 2 }, { depth_mm = 2, aside_mm = [4, 0, 0] }] }
[output]
frames = 3
stored_energy = true
)";

// Beside each frame lies the tool as it is then, listed in a collection of its own; frames have pressure and traction of contact.
TEST_F(Instruments, FramesHaveToolsAndContact) {
  ASSERT_THAT(run({"run", write("s.toml", kBallScene), "--out", "o", "--quiet"}), Exits(0));
  const std::string pvd = read_text(folder_ / "o/main/tool_ball.pvd");
  for (const std::string number : {"0000", "0001", "0002"}) {
    const std::string file = "frames/tool_ball_" + number + ".vtp";
    EXPECT_NE(pvd.find(file), std::string::npos);
    EXPECT_NE(read_text(folder_ / "o/main" / file).find("<PolyData>"), std::string::npos);
    const std::string frame = read_text(folder_ / "o/main/frames" / ("frame_" + number + ".vtu"));
    EXPECT_NE(frame.find("\"contact_pressure_Pa\""), std::string::npos);
    EXPECT_NE(frame.find("\"contact_traction_Pa\""), std::string::npos);
  }
}

// The ledger of forces.csv closes with W(u), line by line, and friction is told by its vector.
TEST_F(Instruments, LedgerClosesInTheTable) {
  ASSERT_THAT(run({"run", write("s.toml", kBallScene), "--out", "o", "--quiet"}), Exits(0));
  auto f = read_csv(folder_ / "o/main/forces.csv");
  const double work = f["work_tools_J"].back();
  ASSERT_GT(work, 0.0);
  for (std::size_t i = 0; i < f["time_s"].size(); ++i) {
    const double sum = f["energy_stored_J"][i] + f["energy_kinetic_J"][i] + f["energy_dissipated_J"][i] +
                       f["dissipated_friction_J"][i] + f["dissipated_contact_J"][i] + f["dissipated_fracture_J"][i] +
                       f["energy_instruments_J"][i] + f["energy_numerical_J"][i];
    EXPECT_NEAR(sum, f["work_tools_J"][i] + f["work_loads_J"][i], 1e-3 * work) << i;
    EXPECT_NEAR(f["energy_drift_J"][i], f["energy_elastic_J"][i] - f["energy_stored_J"][i], 1e-18) << i;
  }
  EXPECT_GT(f["dissipated_friction_J"].back(), 0.1 * work);
  EXPECT_GT(f["friction_size_N"].back(), 3.0 * std::abs(f["friction_N"].back()));
  EXPECT_GT(f["contact_area_m2"].back(), 0.0);
}

}  // namespace
}  // namespace glisson::test

// glisson converge: the table, the JSON and the report of a scene on finer meshes, and what it says where it cannot.

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "app/program.h"

namespace glisson::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ConvergeProgram = ProgramTest;

constexpr const char* kPad = R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.04, 0.04, 0.04]
[sets.pad]
box_m = { min = [0.0099, 0.0099, 0.0399], max = [0.0301, 0.0301, 1] }
[sets.ball]
sphere_m = { center = [0.02, 0.02, 0.04], radius = 0.012 }
surface_only = true
[tissue]
poisson_ratio = 0.3
[motion]
integrator = "quasi_static"
step_s = 0.1
[output]
frames = 0
[[fixed]]
set = "z_min"
[[tool]]
set = "pad"
depth_mm = 1
[[probe]]
name = "tip"
point_m = [0.02, 0.02, 0.03]
)";

// Table, JSON and report tell the same: values that fall toward the extrapolated one, an interval around it, the error.
TEST_F(ConvergeProgram, TellsTheErrorOfTheMesh) {
  const Outcome outcome = run({"converge", write("s.toml", kPad), "--out", "o", "--json", "c.json"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("The mesh as given has an error of +"));
  const nlohmann::json found = read_json(folder_ / "c.json")["variants"][0];
  ASSERT_EQ(found["levels"].size(), 3u);
  EXPECT_EQ(found["column"], "force_N");
  EXPECT_EQ(found["levels"][2]["tets"], 64 * 384);
  EXPECT_NEAR(found["levels"][0]["cell_m"].get<double>(), 0.01, 1e-12);
  EXPECT_NEAR(found["levels"][1]["tool_area_m2"].get<double>(), 4e-4, 1e-12);
  const double fine = found["levels"][2]["value"], limit = found["extrapolated"];
  EXPECT_GT(found["levels"][1]["value"].get<double>(), fine);
  EXPECT_GT(fine, limit);
  EXPECT_LT(found["low"].get<double>(), limit);
  EXPECT_GT(found["high"].get<double>(), limit);
  EXPECT_EQ(found["largest_order"], 1.0) << "a pad within a face";
  EXPECT_TRUE(found["change_with_mass"].is_null()) << "quasi-static";
  EXPECT_NEAR(found["error_as_given"].get<double>(), found["levels"][0]["value"].get<double>() / limit - 1.0, 1e-9);
  const nlohmann::json page = report_data(folder_ / "o/report.html")["scenes"][0];
  EXPECT_EQ(page["variants"].size(), 3u);
  EXPECT_EQ(page["charts"][1]["points"][0]["x"].size(), 3u);
  EXPECT_EQ(page["tables"][0]["rows"].size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/main_3/forces.csv"));
}

// A peak that contains inertia does so on every mesh: one run more, with a quarter of the mass and half of the step, shows it.
TEST_F(ConvergeProgram, SaysWhatInertiaAdds) {
  const Outcome outcome = run({"converge", write("s.toml", kPad), "--out", "o", "--levels", "2", "--set",
                               "motion.integrator=explicit", "--set", "motion.step_s=auto", "--json", "c.json"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("it contains inertia"));
  EXPECT_GT(std::abs(read_json(folder_ / "c.json")["variants"][0]["change_with_mass"].get<double>()), 0.01);
  EXPECT_EQ(read_json(folder_ / "o/main_lighter/summary.json")["end"], "finished");
}

// A set that a ball chooses covers another area on each mesh: said, with the way out. A probe can be compared, at the end too.
TEST_F(ConvergeProgram, SaysWhatChangesWithTheMesh) {
  const std::string scene = write("s.toml", kPad);
  const Outcome ball = run({"converge", scene, "--out", "o", "--levels", "2", "--set", "tool.0.set=ball"});
  ASSERT_THAT(ball, Exits(0));
  EXPECT_THAT(ball.out, HasSubstr("area of the tool's set changes"));
  EXPECT_THAT(ball.out, HasSubstr("order 1 is assumed"));
  const Outcome probe = run({"converge", scene, "--out", "p", "--levels", "2", "--column", "tip_displacement_z_m",
                             "--at", "end", "--json", "p.json"});
  ASSERT_THAT(probe, Exits(0));
  EXPECT_LT(read_json(folder_ / "p.json")["variants"][0]["extrapolated"].get<double>(), -1e-4);
}

// Cylinders get twice the cells along their radius and axis; a mesh from a file is split, which is said.
TEST_F(ConvergeProgram, RefinesCylindersAndMeshesOfFiles) {
  const std::string cylinder = write("c.toml", R"([mesh]
kind = "cylinder"
radius_m = 0.02
height_m = 0.02
radial_cells = 3
axial_cells = 3
[motion]
integrator = "quasi_static"
step_s = 0.1
[[fixed]]
set = "bottom"
[[tool]]
set = "top"
depth_mm = 1
[output]
frames = 2
)");
  const Outcome round = run({"converge", cylinder, "--out", "o", "--json", "c.json", "--levels", "2"});
  ASSERT_THAT(round, Exits(0));
  const nlohmann::json first = read_json(folder_ / "c.json")["variants"][0]["levels"];
  EXPECT_EQ(first[1]["tets"].get<int>(), 8 * first[0]["tets"].get<int>());
  EXPECT_GT(first[1]["tool_area_m2"].get<double>(), first[0]["tool_area_m2"].get<double>()) << "nearer to a circle";

  const std::string file = write("f.toml", R"([mesh]
kind = "file"
path = "o/main_1/frames/frame_0000.vtu"
[motion]
integrator = "quasi_static"
step_s = 0.1
[[fixed]]
set = "bottom"
[[tool]]
set = "top"
depth_mm = 1
[output]
frames = 0
)");
  const Outcome split = run({"converge", file, "--out", "p", "--json", "f.json", "--levels", "2"});
  ASSERT_THAT(split, Exits(0));
  EXPECT_THAT(split.out, HasSubstr("Every tet was split in eight"));
  const nlohmann::json levels = read_json(folder_ / "f.json")["variants"][0]["levels"];
  EXPECT_EQ(levels[1]["tets"].get<int>(), 8 * levels[0]["tets"].get<int>());
  EXPECT_NEAR(levels[0]["value"].get<double>(), first[0]["value"].get<double>(), 1e-6) << "the same body";
  EXPECT_NEAR(levels[1]["tool_area_m2"].get<double>(), first[0]["tool_area_m2"].get<double>(), 1e-12)
      << "its polyhedron";
}

// Where the values do not follow one power of the size of cells nothing is extrapolated, in table, JSON and report: here the
// resultant of a set that has other vertices on each mesh.
TEST_F(ConvergeProgram, ExtrapolatesNothingFalse) {
  const std::string scene = write("s.toml", kPad);
  const Outcome ball = run({"converge", scene, "--out", "o", "--set", "tool.0.set=ball", "--json", "c.json"});
  ASSERT_THAT(ball, Exits(0));
  EXPECT_THAT(ball.out,
              AllOf(HasSubstr("so that nothing is extrapolated"), HasSubstr("not extrapolated; expected within")));
  EXPECT_THAT(ball.out, Not(HasSubstr("has an error of")));
  const nlohmann::json found = read_json(folder_ / "c.json")["variants"][0];
  EXPECT_TRUE(found["extrapolated"].is_null());
  EXPECT_TRUE(found["error_as_given"].is_null());
  EXPECT_LT(found["low"].get<double>(), found["levels"][2]["value"].get<double>());
  const nlohmann::json chart = report_data(folder_ / "o/report.html")["scenes"][0]["charts"][1];
  EXPECT_EQ(chart["fits"].size(), 1u) << "the interval alone";
}

// Ctrl-C during the second mesh keeps the first, whole, and what there is of the second; one value says nothing of the error.
TEST_F(ConvergeProgram, KeepsWhatIsDoneWhenInterrupted) {
  const std::string scene =
      write("s.toml", small_scene("[[variant]]\nname = \"slow\"\ntissue.viscosity_Pa_s = 6000\n"));
  Started program = start({"converge", scene, "--out", "o", "--json", "c.json"});
  for (int i = 0; i < 6000 && program.output_so_far().find("slow_2: 10 %") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_THAT(outcome, Exits(130));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("mesh 1 of 3: 48 tets"), HasSubstr("slow_1: finished"),
                                 HasSubstr("two are needed to say anything"), HasSubstr("did not come to its end")));
  EXPECT_EQ(read_json(folder_ / "c.json")["variants"][0]["levels"].size(), 1u);
  EXPECT_EQ(read_json(folder_ / "o/slow_1/summary.json")["end"], "finished");
  EXPECT_EQ(read_json(folder_ / "o/slow_2/summary.json")["end"], "interrupted");
  EXPECT_EQ(report_data(folder_ / "o/report.html")["scenes"][0]["variants"].size(), 2u);
  const Outcome again = run({"converge", write("t.toml", kPad), "--out", "o", "--levels", "2", "--quiet"});
  EXPECT_THAT(again, Exits(0)) << "a former study is replaced";
}

// What cannot be compared is refused before anything runs, with the columns there are.
TEST_F(ConvergeProgram, RefusesWhatIsNotThere) {
  const std::string scene = write("s.toml", kPad);
  const Outcome column = run({"converge", scene, "--column", "force"});
  EXPECT_THAT(column, Exits(2));
  EXPECT_THAT(column.err, HasSubstr("no such column; it has time_s, depth_m"));
  const Outcome large = run({"converge", scene, "--set", "mesh.cells=[40,40,40]", "--levels", "4"});
  EXPECT_THAT(large, Exits(2));
  EXPECT_THAT(large.err,
              AllOf(HasSubstr("--levels 4"), HasSubstr("1.97e+08 tets; at most 3e+07"), HasSubstr("fewer levels")));
  EXPECT_THAT(run({"converge", scene, "--levels", "1"}), Exits(2));
  EXPECT_THAT(run({"converge", scene, "--at", "start"}), Exits(2));
  const std::string loaded = std::string(kPad).substr(0, std::string(kPad).find("[[tool]]")) +
                             "[[load]]\nset = \"pad\"\nforce_N = [0, 0, -0.1]\n";
  const Outcome none = run({"converge", write("l.toml", loaded + "\n"), "--set", "motion.duration_s=0.1"});
  EXPECT_THAT(none, Exits(2));
  EXPECT_THAT(none.err, HasSubstr("no tool or instrument"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace glisson::test

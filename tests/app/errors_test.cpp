// Mistakes of the user: exit code 2 and one message that says where, what and what to do. Nothing is written.
#include <algorithm>

#include "app/program.h"

namespace glisson::test {
namespace {

using Errors = ProgramTest;

struct Mistake {
  std::vector<std::string> arguments;
  std::vector<std::string> said;  ///< parts of the message on standard error
};

// Each of these ends with exit code 2, tells the place and the way out, and leaves no folder behind.
TEST_F(Errors, AreToldWithPlaceAndWayOut) {
  const std::string good = write("good.toml", small_scene());
  const std::string misspelt = write("misspelt.toml", small_scene("[tisue]\nviscosity_Pa_s = 1\n"));
  const std::string range = write("range.toml", small_scene("[[variant]]\nname = \"a\"\ntissue.poisson_ratio = 0.7\n"));
  const std::string fast = write("fast.toml", small_scene("[[variant]]\nname = \"a\"\nmotion.step_s = 0.1\n"));
  const std::string no_set = write("no_set.toml", small_scene("[[load]]\nset = \"z_maxx\"\nforce_N = [0, 0, 1]\n"));
  const std::string broken = write("broken.toml", "[mesh\nkind = 3");
  const std::string text_mesh = write("mesh.vtu", "this is no mesh");
  const std::vector<Mistake> mistakes{
      {{"run", (folder_ / "none.toml").string()}, {"none.toml"}},
      {{"run", misspelt}, {"misspelt.toml:20", "tisue", "tissue"}},
      {{"run", range}, {"range.toml:22", "0.7", "0.5"}},
      {{"run", fast}, {"fast.toml", "step", "0.1", "stable"}},
      {{"run", no_set}, {"no_set.toml:21", "z_maxx", "z_max"}},
      {{"run", broken}, {"broken.toml:1"}},
      {{"run", good, "--mesh", text_mesh}, {"mesh.vtu"}},
      {{"run", good, "--mesh", "missing.vtu"}, {"missing.vtu", "--mesh FILE"}},
      {{"run", good, "--set", "tissue.poisson_ratio"}, {"--set", "key=value"}},
      {{"run", good, "--set", "tissue.poison_ratio=0.3"}, {"poison_ratio", "poisson_ratio"}},
      {{"run", good, "--threads", "0"}, {"--threads", "1", "1024"}},
      {{"run", good, "--speed", "9"}, {"--speed"}},
      {{"run"}, {"scene"}},
      {{"fly"}, {"fly"}},
      {{"info", "missing.msh"}, {"missing.msh"}},
      {{"info", text_mesh}, {"mesh.vtu"}},
      {{"info", text_mesh, "--scale", "-1"}, {"--scale"}},
      {{"check", misspelt}, {"misspelt.toml:20", "tisue"}},
  };
  for (const Mistake& mistake : mistakes) {
    const Outcome outcome = run(mistake.arguments);
    std::string command;
    for (const std::string& argument : mistake.arguments) command += " " + argument;
    EXPECT_THAT(outcome, Exits(2)) << command;
    for (const std::string& part : mistake.said) {
      EXPECT_NE(outcome.err.find(part), std::string::npos) << command << ": expected " << part << " in:\n"
                                                           << outcome.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << command;
  }
}

// A mistake in the last variant is told before the first one runs.
TEST_F(Errors, AreFoundBeforeAnythingRuns) {
  const std::string scene =
      write("s.toml", small_scene("[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\nmotion.step_s = 0.1\n"));
  EXPECT_THAT(run({"run", scene, "--out", "o"}), Exits(2));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o"));
}

// A folder that holds anything not ours is refused and left as it is; a former run is replaced.
TEST_F(Errors, ForeignFilesAreNeverTouched) {
  const std::string scene = write("s.toml", small_scene());
  std::filesystem::create_directory(folder_ / "mine");
  write("mine/thesis.txt", "years of work");
  const Outcome foreign = run({"run", scene, "--out", "mine"});
  EXPECT_THAT(foreign, Exits(2));
  EXPECT_NE(foreign.err.find("holds no results of glisson"), std::string::npos) << foreign.err;

  ASSERT_THAT(run({"run", scene, "--out", "o", "--quiet"}), Exits(0));
  write("o/main/notes.txt", "seen at 3 mm");
  const Outcome mixed = run({"run", scene, "--out", "o"});
  EXPECT_THAT(mixed, Exits(2));
  EXPECT_NE(mixed.err.find("main/notes.txt"), std::string::npos) << mixed.err;
  EXPECT_EQ(read_text(folder_ / "o/main/notes.txt"), "seen at 3 mm");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/main/forces.csv")) << "the former run is whole";

  std::filesystem::remove(folder_ / "o/main/notes.txt");
  EXPECT_THAT(run({"run", scene, "--out", "o", "--quiet", "--set", "output.frames=1"}), Exits(0));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o/main/frames/frame_0001.vtu")) << "of the former run";
}

// A folder that cannot be made is an error of the system (exit code 1) that names it and the way out.
TEST_F(Errors, UnwritableFolderIsTold) {
  const std::string scene = write("s.toml", small_scene());
  const Outcome blocked = run({"run", scene, "--out", scene + "/inside"});
  EXPECT_THAT(blocked, Exits(1));
  EXPECT_NE(blocked.err.find("s.toml/inside"), std::string::npos) << blocked.err;
  EXPECT_NE(blocked.err.find("--out DIR"), std::string::npos) << blocked.err;
}

// A system that refuses a write in the midst of a run (here: by a limit on the size of a file, as a full disk would)
// is an error that names the file and the reason, exit code 1; the lines written before are whole.
TEST_F(Errors, RefusedWriteIsTold) {
  const std::string scene = write("s.toml", small_scene("[[variant]]\nname = \"a\"\noutput.frames = 0\n"));
  const Outcome outcome = run_in({.file_bytes = 4000}, {"run", scene, "--out", "o"});
  EXPECT_THAT(outcome, Exits(1));
  EXPECT_NE(outcome.err.find("o/a/forces.csv: cannot be written: File too large"), std::string::npos) << outcome.err;
  const std::string csv = read_text(folder_ / "o/a/forces.csv");
  EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 5);
}

// Numbers that end a run: exit code 3 and a message with the time and the way out; what was written stays.
TEST_F(Errors, NumericalEndIsExitCode3) {
  const std::string scene = write("s.toml", small_scene(R"([[variant]]
name = "deep"
motion.on_inversion = "stop"
tool.0.depth_mm = 40
tool.0.velocity_mm_s = 200
)"));
  const Outcome outcome = run({"run", scene, "--out", "o"});
  EXPECT_THAT(outcome, Exits(3));
  EXPECT_NE(outcome.err.find("inverted"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("press less deep"), std::string::npos) << outcome.err;
  const nlohmann::json summary = read_json(folder_ / "o/deep/summary.json");
  EXPECT_EQ(summary["end"], "stopped_inverted");
  EXPECT_GE(summary["inverted_tets_most"], 1);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/report.html"));
}

// Numbers that overflow are refused with their range, by check and run alike.
TEST_F(Errors, NumbersThatOverflowAreRefused) {
  const std::string scene = write("s.toml", small_scene());
  for (const char* key : {"tissue.density_kg_m3=1e-300", "tissue.density_kg_m3=1e300", "motion.gravity_m_s2=[0,0,1e30]",
                          "load=[{set=\"x_max\",pressure_Pa=1e300,follows=true}]", "motion.mass_scaling_step_s=1e30"}) {
    for (const char* command : {"check", "run"}) {
      const Outcome outcome = run({command, scene, "--set", key});
      EXPECT_THAT(outcome, Exits(2)) << key;
      EXPECT_NE(outcome.err.find("is out of range; allowed: "), std::string::npos) << outcome.err;
    }
  }
}

// A secant law that pays more than was put in: check names its work once, the run says it with its time, in the terminal, in
// summary.json and in the report, and ends with 0. Its energy form is silent.
TEST_F(Errors, EnergyFromNothingIsSaid) {
  const std::string scene = write("s.toml", R"([mesh]
kind = "box"
cells = [3, 3, 4]
size_m = [0.04, 0.04, 0.04]
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.3
law = { kind = "step", threshold = 0.05, above_Pa = 9000 }
[[fixed]]
set = "z_min"
[[load]]
set = "z_max"
force_N = [0.18, 0, -0.6]
times_s = [0, 0.1, 0.12]
factors = [0, 1, 0]
[motion]
duration_s = 1
[output]
frames = 0
sample_rate_hz = 200
[[variant]]
name = "a"
[[variant]]
name = "b"
)");
  const Outcome check = run({"check", scene});
  EXPECT_THAT(check, Exits(0));
  const std::size_t first = check.out.find("is in secant form");
  EXPECT_NE(first, std::string::npos) << check.out;
  EXPECT_EQ(check.out.find("is in secant form", first + 1), std::string::npos) << "once";

  const Outcome outcome = run({"run", scene, "--variant", "a", "--out", "o"});
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_NE(outcome.out.find("energy from nothing, from 0.1"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("law_form = \"energy\""), std::string::npos) << outcome.err;
  const nlohmann::json summary = read_json(folder_ / "o/a/summary.json");
  EXPECT_NEAR(summary["energy_gain_from_s"], 0.15, 0.05);
  EXPECT_GT(summary["energy_gain_most"], 0.01);
  EXPECT_NE(read_text(folder_ / "o/report.html").find("have given more work than they took"), std::string::npos);

  const Outcome silent = run({"run", scene, "--variant", "a", "--out", "e", "--set", "tissue.law_form=energy", "--set",
                              "tissue.law.width=0.1"});
  EXPECT_THAT(silent, Exits(0));
  EXPECT_EQ(silent.err, "");
  EXPECT_TRUE(read_json(folder_ / "e/a/summary.json")["energy_gain_from_s"].is_null());
  EXPECT_EQ(run({"check", scene, "--set", "tissue.law_form=energy"}).out.find("secant"), std::string::npos);
}

}  // namespace
}  // namespace glisson::test

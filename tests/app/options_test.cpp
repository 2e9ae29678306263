// The options of `glisson run` and `glisson check`: what they change and what they must not change.
#include <regex>

#include "app/program.h"
#include "support/places.h"

namespace glisson::test {
namespace {

using Options = ProgramTest;

std::string two_variants() {
  return small_scene(R"([[variant]]
name = "soft"
[[variant]]
name = "firm"
tissue.youngs_modulus_Pa = 7200
[[variant]]
name = "stiffening"
tissue.law = { kind = "linear", slope_Pa = 9000 }
)");
}

// Results do not depend on how many variants run at a time: equal state hashes and equal bytes of forces.csv.
TEST_F(Options, ThreadsDoNotChangeResults) {
  const std::string scene = write("s.toml", two_variants());
  ASSERT_THAT(run({"run", scene, "--out", "one", "--quiet", "--threads", "1"}), Exits(0));
  ASSERT_THAT(run({"run", scene, "--out", "three", "--quiet", "--threads", "3"}), Exits(0));
  for (const std::string variant : {"soft", "firm", "stiffening"}) {
    const nlohmann::json one = read_json(folder_ / "one" / variant / "summary.json");
    const nlohmann::json three = read_json(folder_ / "three" / variant / "summary.json");
    EXPECT_EQ(one["state_hash"], three["state_hash"]) << variant;
    EXPECT_EQ(read_text(folder_ / "one" / variant / "forces.csv"),
              read_text(folder_ / "three" / variant / "forces.csv"));
  }
}

// --set changes a value for all variants, and the report's copy of the scene says so.
TEST_F(Options, SetChangesTheScene) {
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"run", scene, "--out", "a", "--quiet"}), Exits(0));
  ASSERT_THAT(run({"run", scene, "--out", "b", "--quiet", "--set", "tissue.youngs_modulus_Pa=7200"}), Exits(0));
  const double soft = read_csv(folder_ / "a/main/forces.csv")["elastic_N"].back();
  const double firm = read_csv(folder_ / "b/main/forces.csv")["elastic_N"].back();
  EXPECT_NEAR(firm / soft, 2.0, 0.1) << "twice the modulus, pressed slowly against its wave speed";
  EXPECT_EQ(read_text(folder_ / "b/scene.toml").find("# run with --set 'tissue.youngs_modulus_Pa=7200'"), 0u);
}

// Options answer as the keys of scenes do: with the value, the allowed range and the way out; never with a raw conversion.
TEST_F(Options, SayTheirRangeAndAWayOut) {
  const std::string scene = write("s.toml", small_scene());
  const auto said = [&](const std::vector<std::string>& words) {
    const Outcome outcome = run(words);
    EXPECT_THAT(outcome, Exits(2));
    EXPECT_EQ(outcome.err.find("Could not convert"), std::string::npos) << outcome.err;
    return outcome.err;
  };
  using testing::HasSubstr;
  EXPECT_THAT(said({"view", scene, "--port", "80000"}),
              HasSubstr("glisson: --port: 80000 is outside the allowed range, 0 to 65535; 0 takes any free port"));
  EXPECT_THAT(said({"view", scene, "--port", "http"}),
              HasSubstr("--port: \"http\" is no whole number; allowed: 0 to 65535"));
  EXPECT_THAT(said({"run", scene, "--threads", "1e3"}),
              HasSubstr("--threads: \"1e3\" is no whole number; allowed: 1 to 1024"));
  EXPECT_THAT(said({"info", scene, "--scale", "-1"}), HasSubstr("--scale: -1 is outside the allowed range, > 0"));
  EXPECT_THAT(said({"converge", scene, "--at", "peek"}),
              HasSubstr("--at: \"peek\" is none of peak, end; did you mean peak?"));
  EXPECT_THAT(said({"run", scene, "--variants", "a"}),
              HasSubstr("glisson run has no option --variants; did you mean --variant?\n`glisson run --help` lists"));
}

// --variant runs only those named; a name that is not there is an error that lists the names.
TEST_F(Options, VariantChooses) {
  const std::string scene = write("s.toml", two_variants());
  ASSERT_THAT(run({"run", scene, "--out", "o", "--quiet", "--variant", "firm"}), Exits(0));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/firm/forces.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o/soft"));
  const Outcome wrong = run({"run", scene, "--variant", "hard"});
  EXPECT_THAT(wrong, Exits(2));
  EXPECT_NE(wrong.err.find("it has soft, firm, stiffening"), std::string::npos) << wrong.err;
}

// In a pipe, progress is plain lines at 10 % steps for each variant; --quiet leaves only the report's path.
TEST_F(Options, ProgressInAPipeIsPlainLines) {
  const std::string scene =
      write("s.toml", small_scene("[[variant]]\nname = \"slow\"\ntissue.viscosity_Pa_s = 20000\n"));
  const Outcome outcome = run({"run", scene, "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_EQ(outcome.out.find('\r'), std::string::npos) << "no bar in a pipe";
  EXPECT_NE(outcome.out.find("slow: started\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" %, "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("slow: finished after"), std::string::npos) << outcome.out;
  const Outcome quiet = run({"run", scene, "--out", "o", "--quiet"});
  EXPECT_EQ(quiet.out, "o/report.html\n");
  EXPECT_EQ(quiet.err, "");
}

// --mesh replaces the scene's mesh and says what was replaced; a set that the new mesh does not have is an error.
TEST_F(Options, MeshReplacesTheScenesMesh) {
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"run", scene, "--out", "first", "--quiet"}), Exits(0));
  const std::string frame = (folder_ / "first/main/frames/frame_0000.vtu").string();
  const Outcome outcome = run({"run", scene, "--out", "o", "--mesh", frame});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_NE(outcome.out.find("The mesh is " + frame + " (--mesh) in place of a box."), std::string::npos)
      << outcome.out;
  EXPECT_EQ(read_json(folder_ / "o/main/summary.json")["tets"], 48);

  const Outcome missing = run({"run", scene, "--out", "p", "--mesh", frame, "--set", "fixed.0.set=floor"});
  EXPECT_THAT(missing, Exits(2));
  EXPECT_NE(missing.err.find("floor"), std::string::npos) << missing.err;
}

// check tells mesh, sets, stable step, steps and time without writing anything.
TEST_F(Options, CheckTellsWhatARunWouldBe) {
  const Outcome outcome = run({"check", write("s.toml", small_scene())});
  ASSERT_THAT(outcome, Exits(0));
  for (const char* part : {"27 vertices, 48 tets", "E = 3600 Pa", "\"z_min\", 9 vertices", "\"tool\" on \"z_max\"",
                           "stable below", " steps", "about ", "The scene can be run."}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in:\n" << outcome.out;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

// The number of steps that check foretells for a linear tissue is the number that run makes, give or take one.
TEST_F(Options, CheckForetellsTheSteps) {
  const std::string scene = write("s.toml", small_scene());
  const std::string text = run({"check", scene}).out;
  const std::size_t at = text.find("s simulated, ");
  ASSERT_NE(at, std::string::npos) << text;
  const double foretold = std::stod(text.substr(at + 13));
  ASSERT_THAT(run({"run", scene, "--out", "o", "--quiet"}), Exits(0));
  EXPECT_NEAR(foretold, read_json(folder_ / "o/main/summary.json")["steps"].get<double>(), 1.0);
  EXPECT_EQ(text.find("at the step at rest"), std::string::npos) << text;
}

// Where tissue stiffens, in a region too, the number is that at the step at rest; check says so and why, the run makes more, and
// the paper's tissues no more than check says of shipped scenes.
TEST_F(Options, CheckSaysThatStepsAreThoseAtRest) {
  const std::string law = "tissue.law = { kind = \"exponential\", amplitude_Pa = 3600, rate = 12 }\n";
  write("whole.toml", small_scene("[[variant]]\nname = \"main\"\n" + law));
  write("region.toml",
        small_scene("[[region]]\nname = \"low\"\nsphere_m = { center = [0.01, 0.01, 0.01], radius = 1 }\n" + law));
  const std::regex steps(
      R"((\d+) steps at the step at rest, more as tissue stiffens \(the shipped scenes: up to ([\d.]+) times\), about .* or more)");
  for (const std::string scene : {"whole", "region"}) {
    const std::vector<std::string> deep{"--set", "tool.0.depth_mm=4"};
    const std::string text = run({"check", scene + ".toml", deep[0], deep[1]}).out;
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, steps)) << text;
    ASSERT_THAT(run({"run", scene + ".toml", deep[0], deep[1], "--out", scene, "--quiet"}), Exits(0));
    EXPECT_GT(read_json(folder_ / scene / "main/summary.json")["steps"].get<double>(), 1.1 * std::stod(found[1]));
  }
  const std::string figure2 = shipped("scenes/paper/figure2.toml").string(), text = run({"check", figure2}).out;
  ASSERT_THAT(run({"run", figure2, "--variant", "tissue1", "tissue2", "--out", "o", "--quiet"}), Exits(0));
  for (const std::string name : {"tissue1", "tissue2"}) {
    const std::string rest = text.substr(text.find("\n" + name + " — "));
    std::smatch found;
    ASSERT_TRUE(std::regex_search(rest, found, steps)) << rest;
    const double made = read_json(folder_ / "o" / name / "summary.json")["steps"].get<double>();
    EXPECT_GT(made, 1.1 * std::stod(found[1])) << name;
    EXPECT_LE(made, std::stod(found[2]) * std::stod(found[1])) << name;
  }
}

}  // namespace
}  // namespace glisson::test

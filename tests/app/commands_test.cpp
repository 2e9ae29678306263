// The other subcommands: info, schema, laws, help, and the paper reproduced.
#include "app/program.h"

namespace glisson::test {
namespace {

using Commands = ProgramTest;

// Every subcommand explains itself with examples.
TEST_F(Commands, HelpHasExamples) {
  for (const std::string command : {"run", "check", "info", "reproduce", "schema", "laws", "tissues"}) {
    const Outcome outcome = run({command, "--help"});
    EXPECT_THAT(outcome, Exits(0)) << command;
    EXPECT_NE(outcome.out.find("Examples:\n  glisson " + command), std::string::npos) << outcome.out;
  }
  EXPECT_THAT(run({"--help"}), Exits(0));
  EXPECT_EQ(run({"--version"}).out.find("glisson "), 0u);
}

// The schema names sections, units and ranges; the laws name their parameters.
TEST_F(Commands, SchemaAndLawsDescribeScenes) {
  const std::string schema = run({"schema"}).out;
  for (const char* key : {"poisson_ratio", "damping_rate_per_s", "velocity_mm_s", "sample_rate_hz"}) {
    EXPECT_NE(schema.find(key), std::string::npos) << key;
  }
  const std::string laws = run({"laws"}).out;
  for (const char* law : {"constant", "step", "linear", "polynomial", "exponential", "table", "threshold"}) {
    EXPECT_NE(laws.find(law), std::string::npos) << law;
  }
}

// info prints the same figures as text and as JSON; --scale acts on them.
TEST_F(Commands, InfoDescribesAMesh) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string frame = (folder_ / "o/main/frames/frame_0000.vtu").string();
  const Outcome text = run({"info", frame});
  EXPECT_THAT(text, Exits(0));
  EXPECT_NE(text.out.find("27"), std::string::npos) << text.out;
  const nlohmann::json json = nlohmann::json::parse(run({"info", frame, "--json"}).out);
  EXPECT_EQ(json["vertices"], 27);
  EXPECT_EQ(json["tets"], 48);
  EXPECT_NEAR(json["volume_m3"].get<double>(), 8e-6, 1e-12);
  EXPECT_EQ(json["vertex_sets"]["z_max"], 9);
  const nlohmann::json scaled = nlohmann::json::parse(run({"info", frame, "--json", "--scale", "10"}).out);
  EXPECT_NEAR(scaled["volume_m3"].get<double>(), 8e-3, 1e-9);
}

// The paper's figures: all scenes in one report, every check computed and passed. The quick form ends figure 3 after
// 0.1 s of motion; figure 2 and the checks are the same as in the whole.
TEST_F(Commands, ReproducePassesItsChecks) {
  const Outcome outcome = run({"reproduce", "--quick", "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json report = report_data(folder_ / "o/report.html");
  ASSERT_EQ(report["scenes"].size(), 4u);
  int checks = 0;
  for (const nlohmann::json& scene : report["scenes"]) {
    for (const nlohmann::json& check : scene["checks"]) {
      ++checks;
      EXPECT_TRUE(check["pass"].get<bool>()) << check.dump();
    }
  }
  EXPECT_GE(checks, 7);
  EXPECT_EQ(report["scenes"][3]["tables"][0]["rows"].size(), 6u) << "four models of ours, two of the paper";
  EXPECT_NE(outcome.out.find("The report: "), std::string::npos);
  EXPECT_NE(outcome.out.find("What to try next:"), std::string::npos);
  // the first of these commands works as printed
  EXPECT_THAT(run({"check", "o/figure2/scene.toml", "--set", "tissue.poisson_ratio=0.45"}), Exits(0));
}

}  // namespace
}  // namespace glisson::test

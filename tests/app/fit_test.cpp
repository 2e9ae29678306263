// glisson fit: the files it writes say the same, an interruption loses nothing, and what cannot be used is told with the way
// out and a non-zero exit.
#include <chrono>
#include <csignal>
#include <thread>

#include "app/program.h"
#include "support/places.h"

namespace glisson::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kMean = test::shipped("scenes/fit/phantom_mean.toml").string();

std::string curve(double modulus) {
  std::string text = "time (s),displacement (mm),force (N)\n";
  for (int i = 0; i <= 40; ++i)
    text += std::to_string(i) + "," + std::to_string(0.05 * i) + "," +
            std::to_string(modulus * 4e-4 * 0.05e-3 * i / 0.02) + "\n";
  return text;
}

const std::string kFit = R"([specimen]
kind = "block"
width_mm = 20
depth_mm = 20
height_mm = 20
[tissue]
youngs_modulus_Pa = 3000
[[parameter]]
key = "tissue.youngs_modulus_Pa"
low = 100
high = 1e5
[[data]]
files = ["a.csv"]
[proof]
bootstrap = 20
)";

class Fit : public ProgramTest {
 protected:
  /// The outcome of a fit to a file of curves.
  Outcome fit(const std::string& csv, const std::string& toml = kFit) {
    write("a.csv", csv);
    return run({"fit", write("f.toml", toml), "--out", "o"});
  }
};

TEST_F(Fit, WritesFilesThatAgree) {
  const Outcome outcome = run({"fit", kMean, "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("tissue.hyperelastic.mu_Pa[0]"));
  const nlohmann::json fit = read_json(folder_ / "o/fit.json");
  ASSERT_EQ(fit["parameters"].size(), 2u);
  for (const auto& p : fit["parameters"]) {
    EXPECT_LT(p["ci95"][0], p["value"]);
    EXPECT_GT(p["ci95"][1], p["value"]);
  }
  for (const char* key : {"rms_fit", "forward_runs", "wall_s", "basins"}) EXPECT_TRUE(fit.contains(key)) << key;
  EXPECT_TRUE(fit["rms_heldout"].is_null());
  EXPECT_TRUE(fit["complete"]);
  const nlohmann::json page = report_data(folder_ / "o/report.html");
  EXPECT_EQ(page["fits"][0]["parameters"], fit["parameters"]);
  EXPECT_FALSE(fs::exists(folder_ / "o/fit.state.json")) << "of use to an interrupted fit only";
  // the tissue is one that a scene takes
  const std::string scene = small_scene();
  write("s.toml", scene.substr(0, scene.find("[tissue]")) + "[tissue]\nfile = \"o/tissue.toml\"\n" +
                      scene.substr(scene.find("[[fixed]]")));
  EXPECT_THAT(run({"check", "s.toml"}), Exits(0));
  // once more into the same folder replaces it; anyone else's folder is left alone
  EXPECT_THAT(run({"fit", kMean, "--out", "o", "--quiet", "--bootstrap", "0"}), Exits(0));
  fs::create_directory(folder_ / "other");
  write("other/mine.txt", "mine");
  const Outcome refused = run({"fit", kMean, "--out", "other"});
  EXPECT_THAT(refused, Exits(2));
  EXPECT_TRUE(fs::exists(folder_ / "other/mine.txt"));
}

TEST_F(Fit, GoesOnAfterAnInterruption) {
  // a scene of tets is slow enough to be interrupted: each run takes some milliseconds
  const std::string toml = kFit + "[forward]\nkind = \"scene\"\n[search]\nstarts = 400\n";
  write("a.csv", curve(4200.0));
  const std::vector<std::string> command{"fit", write("f.toml", toml), "--out", "o"};
  Started program = start(command);
  for (int i = 0; i < 3000 && program.output_so_far().find("starts 4/") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  program.signal(SIGINT);
  const Outcome cut = program.wait();
  ASSERT_THAT(cut, Exits(130));
  EXPECT_THAT(cut.err, HasSubstr("the same command resumes"));
  ASSERT_TRUE(fs::exists(folder_ / "o/fit.state.json"));
  EXPECT_FALSE(read_json(folder_ / "o/fit.json")["complete"]);
  const std::size_t known = read_json(folder_ / "o/fit.state.json")["laws"].begin().value()["starts"].size();
  EXPECT_GE(known, 4u);
  Started again = start(command);
  for (int i = 0; i < 3000 && again.output_so_far().find("resuming after") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_THAT(again.output_so_far(), HasSubstr("resuming after " + std::to_string(known) + " starts"));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  again.signal(SIGTERM);
  EXPECT_THAT(again.wait(), Exits(130));
  EXPECT_GE(read_json(folder_ / "o/fit.state.json")["laws"].begin().value()["starts"].size(), known);
}

TEST_F(Fit, ListsTheLawsItKnows) {
  const Outcome outcome = run({"fit", "--list-laws"});
  ASSERT_THAT(outcome, Exits(0));
  for (const char* law : {"constant", "step", "polynomial", "exponential", "ogden"})
    EXPECT_THAT(outcome.out, HasSubstr(law));
}

TEST_F(Fit, RanksLawsOnTheCommandLine) {
  write("a.csv", curve(4200.0));
  const Outcome outcome = run({"fit", write("f.toml", kFit), "--out", "o", "--laws", "constant,linear"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, HasSubstr("what the data support"));
  const nlohmann::json fit = read_json(folder_ / "o/fit.json");
  ASSERT_EQ(fit["laws"].size(), 2u);
  EXPECT_EQ(fit["law"], "constant");
}

TEST_F(Fit, TellsBadInputWithTheWayOut) {
  const auto says = [&](const Outcome& outcome, const std::vector<std::string>& parts) {
    EXPECT_THAT(outcome, Exits(2));
    for (const std::string& part : parts) EXPECT_THAT(outcome.err, HasSubstr(part));
    EXPECT_FALSE(fs::exists(folder_ / "o")) << "nothing is written for a fit that cannot be made";
  };
  says(fit("time (s),displacement (mm)\n0,0\n1,1\n"), {"a.csv", "force"});
  says(fit("time (s),displacement (mm),force (N)\n0,0,0\n2,1,1\n1,2,2\n" + curve(1).substr(curve(1).find("\n") + 1)),
       {"a.csv:4", "time"});
  std::string bad = curve(4200.0);
  bad.insert(bad.find("\n5,") + 1, "4.5,nan,0.1\n");
  says(fit(bad), {"a.csv:", "nan", "skip_bad_rows"});
  says(fit(""), {"a.csv", "empty"});
  says(fit("time (s),displacement (mm),force (N)\n0,0,0\n1,1,1\n"), {"a.csv", "points"});
  std::string metres = curve(4200.0);
  metres.replace(metres.find("(mm)"), 4, "(m)");
  says(fit(metres), {"a.csv:1:1", "in mm it would be 2 mm", "unlikely = true"});
  std::string backward = "time (s),displacement (mm),force (N)\n";
  for (int i = 0; i <= 40; ++i)
    backward +=
        std::to_string(i) + "," + std::to_string(0.05 * (40 - i)) + "," + std::to_string(0.01 * (40 - i)) + "\n";
  says(fit(backward), {"a.csv:1:1", "the rows run backwards", "from 2 mm to 0 mm", "unlikely = true"});
  std::string nothing = "time (s),displacement (mm),force (N)\n";
  for (int i = 0; i <= 40; ++i) nothing += std::to_string(i) + "," + std::to_string(0.05 * i) + ",0\n";
  says(fit(nothing), {"a.csv:1:1", "is 0 N in all of the 41 rows", "choose another column"});
  says(run({"fit", "nowhere.toml"}), {"nowhere.toml", "cannot be read"});
  says(run({"fit", write("g.toml", kFit + "[[parameter]]\nkey = \"tissue.poisson_ratio\"\nlow = 0.5\nhigh = 0.1\n")}),
       {"g.toml:", "not above `low`"});
}

// A fit whose every number stands at a bound is no tissue: it says so, writes none, and ends with another code than 0.
TEST_F(Fit, WritesNoTissueWhereNothingIsIdentified) {
  std::string narrow = kFit;
  narrow.replace(narrow.find("low = 100"), 9, "low = 8000");
  const Outcome outcome = fit(curve(4200.0), narrow);
  EXPECT_THAT(outcome, Exits(3));
  EXPECT_THAT(outcome.err, HasSubstr("nothing is identified"));
  EXPECT_THAT(outcome.out, HasSubstr("at bound"));
  EXPECT_TRUE(fs::exists(folder_ / "o/fit.json"));
  EXPECT_FALSE(fs::exists(folder_ / "o/tissue.toml"));
}

}  // namespace
}  // namespace glisson::test

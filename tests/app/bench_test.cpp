// `glisson bench`: its result file is complete and sane, its states do not depend on threads, its mistakes are told.
#include "app/program.h"

#include <algorithm>
#include <set>

namespace glisson::test {
namespace {

using Bench = ProgramTest;

constexpr std::initializer_list<const char*> kHead{"cpu",  "instruction_set", "compiler",       "flags",       "commit",
                                                   "date", "fma_peak_gflops", "bandwidth_GBps", "load_average"};
constexpr std::initializer_list<const char*> kRow{"model",
                                                  "tets",
                                                  "threads",
                                                  "spread",
                                                  "ns_p10",
                                                  "disturbed",
                                                  "preempted",
                                                  "instruction_set",
                                                  "flops_per_tet",
                                                  "ns_per_tet_step",
                                                  "bytes_per_tet",
                                                  "state_hash",
                                                  "fraction_of_fma_peak",
                                                  "mesh",
                                                  "fraction_of_bandwidth",
                                                  "h_s",
                                                  "steps",
                                                  "peak_rss_MiB"};

// A quick run on figure 1's mesh: all keys, fractions that a machine can reach, one state on any number of threads.
// A step uses every unit of the processor at best as well as a loop that does nothing else, so the fraction is below 1;
// on a busy machine the loop may have been the one that was interrupted, which three times leaves room for.
TEST_F(Bench, QuickRunWritesACompleteResult) {
  const Outcome outcome = run({"bench", "--quick", "--sizes", "768", "--threads", "1,2", "--json", "b.json"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json json = read_json(folder_ / "b.json");
  for (const char* key : kHead) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_GT(json["fma_peak_gflops"].get<double>(), 0.1);
  EXPECT_GT(json["bandwidth_GBps"].get<double>(), 0.1);
  ASSERT_EQ(json["rows"].size(), 6u) << "three models on one and on two threads";
  std::map<std::string, std::string> hashes;
  for (const nlohmann::json& row : json["rows"]) {
    for (const char* key : kRow) EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_EQ(row["tets"], 768);
    EXPECT_GT(row["ns_per_tet_step"].get<double>(), 0.0);
    EXPECT_GT(row["fraction_of_fma_peak"].get<double>(), 0.0);
    EXPECT_LE(row["fraction_of_fma_peak"].get<double>(), 3.0);
    EXPECT_GT(row["fraction_of_bandwidth"].get<double>(), 0.0);
    EXPECT_GE(row["steps"], 10);
    EXPECT_GT(row["ns_p10"].get<double>(), 0.0);
    const bool apart =
        row["spread"].get<double>() > 0.15 || row["ns_per_tet_step"].get<double>() > 1.1 * row["ns_p10"].get<double>();
    EXPECT_EQ(row["disturbed"], apart);
    const std::string hash = row["state_hash"];
    EXPECT_EQ(hashes.try_emplace(row["model"], hash).first->second, hash);
  }
  EXPECT_EQ(hashes.size(), 3u);
  EXPECT_NE(hashes["linear"], hashes["law"]) << "the law must act on the initial state";
  EXPECT_NE(hashes["law"], hashes["full"]);
  EXPECT_NE(outcome.out.find("full / linear, 768 tets"), std::string::npos) << outcome.out;
}

// Every tissue of large deformation by one word, each with its ratio to the linear one.
TEST_F(Bench, EveryModelIsMeasured) {  // long
  const Outcome outcome =
      run({"bench", "--quick", "--sizes", "768", "--threads", "1", "--models", "all", "--json", "b.json"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json json = read_json(folder_ / "b.json");
  ASSERT_EQ(json["rows"].size(), 21u);
  std::set<std::string> hashes;
  for (const nlohmann::json& row : json["rows"]) {
    hashes.insert(row["state_hash"].get<std::string>());
    EXPECT_GT(row["flops_per_tet"].get<double>(), 0.0) << row["model"];
    EXPECT_GT(row["fraction_of_fma_peak"].get<double>(), 0.0) << row["model"];
  }
  EXPECT_EQ(hashes.size(), 21u) << "each tissue moves in its own way";
  EXPECT_GT(json["ratios"]["ogden / linear, 768 tets"].get<double>(), 1.0);
}

// The same program from the same state: a second run ends in the same state.
TEST_F(Bench, StateIsTheSameFromRunToRun) {  // long
  for (const std::string file : {"a.json", "b.json"}) {
    const std::vector<std::string> arguments{"bench", "--quick",   "--sizes", "768",    "--models",
                                             "full",  "--threads", "1",       "--json", file};
    ASSERT_THAT(run(arguments), Exits(0));
  }
  EXPECT_EQ(read_json(folder_ / "a.json")["rows"][0]["state_hash"],
            read_json(folder_ / "b.json")["rows"][0]["state_hash"]);
}

// Any sizes: each the box of cubes that comes nearest, once.
TEST_F(Bench, TakesAnySizes) {  // long
  ASSERT_THAT(run({"bench", "--quick", "--sizes", "100,300,301,1200", "--models", "full", "--threads", "1", "--json",
                   "b.json"}),
              Exits(0));
  std::vector<int> tets;
  const nlohmann::json json = read_json(folder_ / "b.json");
  for (const nlohmann::json& row : json["rows"]) tets.push_back(row["tets"]);
  EXPECT_EQ(tets, (std::vector{96, 324, 1200})) << "2×2×4, 3×3×6, 5×5×8";
}

// Asked for, energies are kept in a second measurement of each model, which moves as the first: same state, and what it costs.
TEST_F(Bench, EnergiesAreMeasuredBesideEachModel) {
  ASSERT_THAT(run({"bench", "--quick", "--energies", "--sizes", "768", "--threads", "1", "--models",
                   "linear,neo_hookean", "--json", "b.json"}),
              Exits(0));
  const nlohmann::json json = read_json(folder_ / "b.json");
  ASSERT_EQ(json["rows"].size(), 2u);
  ASSERT_EQ(json["accounting"].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(json["accounting"][i]["model"], json["rows"][i]["model"]);
    EXPECT_EQ(json["accounting"][i]["energies_kept"], true);
    EXPECT_EQ(json["accounting"][i]["state_hash"], json["rows"][i]["state_hash"]);
  }
  EXPECT_GT(json["ratios"]["energies kept / not, linear, 768 tets"].get<double>(), 0.0);
  EXPECT_GT(json["ratios"]["energies kept / not, neo_hookean, 768 tets"].get<double>(), 0.0);
}

// An instruction set that is asked for is that of the kernels and of the peak they are held against, in every row; all reach
// the same state to rounding, and the hash may differ.
TEST_F(Bench, AForcedInstructionSetIsThatOfKernelsAndPeak) {  // long
  std::set<std::string> names;
  for (const std::string isa : {"avx512", "avx2", "sse4"}) {
    const Outcome outcome = run({"bench", "--quick", "--sizes", "768", "--models", "linear,full,neo_hookean",
                                 "--threads", "1", "--isa", isa, "--json", isa + ".json"});
    if (outcome.err.find("--isa: \"" + isa + "\" is none of ") != std::string::npos) continue;  // this machine has none
    ASSERT_THAT(outcome, Exits(0));
    const nlohmann::json json = read_json(folder_ / (isa + ".json"));
    const std::string name = json["instruction_set"];
    EXPECT_TRUE(names.insert(name).second) << isa << " ran in " << name << " again";
    EXPECT_EQ(json["peaks"][0]["instruction_set"], name);
    for (const nlohmann::json& row : json["rows"]) {
      EXPECT_EQ(row["instruction_set"], name);
      EXPECT_GT(row["fraction_of_fma_peak"].get<double>(), 0.0);
    }
  }
  EXPECT_FALSE(names.empty());
}

// A mesh from a file is measured as one tissue, whatever regions it has.
TEST_F(Bench, TakesAMeshFile) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string mesh = (folder_ / "o/main/frames/frame_0000.vtu").string();
  ASSERT_THAT(run({"bench", "--quick", "--sizes", "768", "--models", "linear", "--threads", "1", "--mesh", mesh,
                   "--mesh", mesh, "--json", "b.json"}),
              Exits(0));
  const nlohmann::json rows = read_json(folder_ / "b.json")["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1]["mesh"], "frame_0000");
  EXPECT_EQ(rows[2]["mesh"], mesh) << "told apart from the first of that name";
  EXPECT_EQ(rows[1]["tets"], 48);
}

// A wrong option is told before anything is measured, with the option, the value and what is allowed.
TEST_F(Bench, WrongOptionsAreErrors) {
  const auto expect_error = [&](const std::vector<std::string>& arguments, const std::string& part) {
    const Outcome outcome = run(arguments);
    EXPECT_THAT(outcome, Exits(2));
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  expect_error({"bench", "--sizes", "5"}, "--sizes: 5 is outside the allowed range, 6 to 5e+07");
  expect_error({"bench", "--isa", "avx9"}, "--isa: \"avx9\" is none of ");
  expect_error({"bench", "--models", "quadratic"}, "--models: \"quadratic\" is none of linear, law, full, branches, ");
  expect_error({"bench", "--threads", "0"}, "--threads: 0 is outside the allowed range, 1 to 1024");
  expect_error({"bench", "--mesh", "none.vtu"}, "none.vtu: there is no such mesh");
  expect_error({"bench", "--json", "no/such/folder.json"}, "the folder no/such does not exist");
  expect_error({"bench", "realtime"}, "scene is required");
  expect_error({"bench", "--quick", "realtime", "s.toml"}, "give the options of realtime after it");
  const std::string scene = write("s.toml", small_scene());
  expect_error({"bench", "realtime", scene, "--frame-ms", "0"},
               "--frame-ms: 0 is outside the allowed range, 0.01 to 1000");
  expect_error({"bench", "realtime", scene, "--variant", "hard"}, "--variant hard");
  expect_error({"bench", "realtime", scene, "--isa", "mmx"}, "--isa: \"mmx\" is none of ");
}

// 0.3 s in frames of 1 ms: each is computed or dropped, and what is simulated is what was computed. That a loaded
// machine keeps the pace is not promised here.
TEST_F(Bench, RealtimeAccountsForEveryFrame) {
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"bench", "realtime", scene, "--set", "motion.duration_s=1", "--seconds", "0.3", "--json", "r.json"}),
              Exits(0));
  const nlohmann::json json = read_json(folder_ / "r.json");
  const double frames = json["frames"], dropped = json["dropped"];
  EXPECT_EQ(frames + dropped, 300.0);
  EXPECT_GT(frames, 0.0);
  EXPECT_LE(json["missed"], json["frames"]);
  EXPECT_NEAR(json["simulated_s"].get<double>(), 1e-3 * frames, json["h_s"].get<double>());
  EXPECT_GE(json["wall_s"].get<double>(), 0.3);
  EXPECT_LE(json["p50_us"], json["p99_us"]);
  EXPECT_LE(json["p99_us"], json["p99_9_us"]);
  EXPECT_LE(json["p99_9_us"], json["max_us"]);
  EXPECT_GT(json["peak_force_N"].get<double>(), 0.0) << "the tool presses";
  ASSERT_EQ(json["frames_us"].size(), json["frames"]);
  ASSERT_EQ(json["frames_steps"].size(), json["frames"]);
  std::uint64_t sum = 0, most = 0;
  for (const std::uint64_t n : json["frames_steps"]) sum += n, most = std::max(most, n);
  EXPECT_EQ(sum, json["steps"].get<std::uint64_t>());
  EXPECT_EQ(most, json["most_steps"].get<std::uint64_t>());
  EXPECT_NEAR(*std::max_element(json["frames_us"].begin(), json["frames_us"].end()), json["max_us"].get<double>(), 0.1);
}

// A scene too heavy for the pace falls behind and ends in time; it does not pile up work.
TEST_F(Bench, RealtimeFallsBehindWithoutPilingUp) {
  const std::string scene =
      write("s.toml", small_scene("[[variant]]\nname = \"thick\"\ntissue.viscosity_Pa_s = 4e5\n"));
  const Outcome outcome = run({"bench", "realtime", scene, "--set", "motion.duration_s=1", "--seconds", "0.3",
                               "--frame-ms", "1", "--json", "r.json"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json json = read_json(folder_ / "r.json");
  EXPECT_GT(json["dropped"], 0);
  EXPECT_LT(json["realtime_factor"].get<double>(), 1.0);
  EXPECT_NE(outcome.out.find("dropped"), std::string::npos) << outcome.out;
}

// The largest body is one of those that were tried and kept the pace, with frames long enough for a loaded machine.
TEST_F(Bench, RealtimeFindsTheLargestBody) {  // long
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"bench", "realtime", scene, "--set", "motion.duration_s=2", "--seconds", "0.4", "--frame-ms", "100",
                   "--threads", "1", "--find", "--set", "tissue.youngs_modulus_Pa=4e7", "--json", "r.json"}),
              Exits(0));
  const nlohmann::json json = read_json(folder_ / "r.json");
  ASSERT_GE(json["trials"].size(), 2U);
  ASSERT_EQ(json["largest"].size(), 1U);
  const nlohmann::json& largest = json["largest"][0];
  EXPECT_TRUE(largest["kept"]);
  EXPECT_LE(largest["p99_us"], 1e5);
  std::size_t most = 0;
  for (const nlohmann::json& t : json["trials"]) {
    if (t["kept"]) most = std::max(most, t["tets"].get<std::size_t>());
  }
  EXPECT_LE(largest["tets"], most);
  EXPECT_GT(largest["tets"], 0);
}

TEST_F(Bench, FindNeedsAMeshThatIsMade) {
  const std::string scene = write("s.toml", "[mesh]\nkind = \"file\"\npath = \"m.vtu\"\n[motion]\nduration_s = 1\n");
  const Outcome outcome = run({"bench", "realtime", scene, "--find"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_NE(outcome.err.find("comes from a file"), std::string::npos) << outcome.err;
}

TEST_F(Bench, HelpHasExamples) {
  EXPECT_NE(run({"bench", "--help"}).out.find("Examples:\n  glisson bench"), std::string::npos);
  EXPECT_NE(run({"bench", "realtime", "--help"}).out.find("Examples:\n  glisson bench realtime"), std::string::npos);
}

}  // namespace
}  // namespace glisson::test

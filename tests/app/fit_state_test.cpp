// fit.state.json is believed only as far as it is what was written: any change of a byte is refused with the way out, forged
// lists are too, and a resumed fit ends with the result of one that was never stopped.
#include "fit/files/fit_state.h"

#include <csignal>
#include <fstream>
#include <thread>

#include "app/program.h"

namespace glisson::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kPrint = "0123456789abcdef";

fit::FitMemory some_memory() {
  fit::StartRecord good{{0.5, 0.25}, {{0.1, 1.0 / 3.0}, 12.5, true, 7, "converged"}};
  fit::StartRecord failed{{0.0, 1.0}, {{0.0, 1.0}, std::numeric_limits<double>::infinity(), false, 0, "\"no\""}};
  return {{"ogden", {{good, failed}, "static, 10 steps", 41.5}}, {"step", {}}};
}

class FitState : public ProgramTest {
 protected:
  void SetUp() override {
    file_ = folder_ / "fit.state.json";
    write_fit_state(file_, kPrint, some_memory());
  }
  /// What reading says of it; empty where it is read.
  std::string complaint() const {
    try {
      read_fit_state(file_, kPrint);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  }
  std::filesystem::path file_;
};

TEST_F(FitState, ComesBackAsItWas) {
  const auto memory = read_fit_state(file_, kPrint);
  ASSERT_TRUE(memory.has_value());
  const fit::LawMemory &law = memory->at("ogden"), was = some_memory().at("ogden");
  ASSERT_EQ(law.starts.size(), was.starts.size());
  for (std::size_t i = 0; i < law.starts.size(); ++i) {
    EXPECT_EQ(law.starts[i].from, was.starts[i].from);
    EXPECT_EQ(law.starts[i].optimum.scaled, was.starts[i].optimum.scaled);
    EXPECT_EQ(law.starts[i].optimum.cost, was.starts[i].optimum.cost);
    EXPECT_EQ(law.starts[i].optimum.message, was.starts[i].optimum.message);
  }
  EXPECT_EQ(law.forward, was.forward);
  EXPECT_EQ(law.speedup, was.speedup);
  EXPECT_TRUE(memory->at("step").starts.empty());
  EXPECT_FALSE(read_fit_state(file_, "of another fit").has_value());
  std::filesystem::remove(file_);
  EXPECT_FALSE(read_fit_state(file_, kPrint).has_value());
}

// Of every byte that is changed the state is refused, or (blanks, the number of the format) nothing of it is taken that was
// not written.
TEST_F(FitState, NoChangedByteIsBelieved) {
  const std::string text = read_text(file_);
  int refused = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char c : {'0', '7', ' ', '"', ']', '\xff', '\0'}) {
      if (text[at] == c) continue;
      std::string changed = text;
      changed[at] = c;
      write("fit.state.json", changed);
      const std::string said = complaint();
      refused += !said.empty();
      if (said.empty()) {
        if (const auto memory = read_fit_state(file_, kPrint)) {
          EXPECT_EQ(memory->at("ogden").starts.at(0).optimum.cost, 12.5) << at;
        }
      } else {
        EXPECT_THAT(said, HasSubstr("fit.state.json: ")) << at;
        EXPECT_THAT(said, HasSubstr("delete it, or start again with --fresh")) << at;
      }
    }
  }
  EXPECT_GT(refused, static_cast<int>(6 * text.size()));
}

// A state that carries the right checksum, but whose lists, numbers or kinds are none that a fit writes.
TEST_F(FitState, ForgedListsAreRefused) {
  const auto forged = [&](auto change) {
    fit::FitMemory memory = some_memory();
    change(memory.at("ogden").starts[0]);
    write_fit_state(file_, kPrint, memory);
    return complaint();
  };
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.from.clear(); }), HasSubstr("`from` is empty"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.optimum.scaled.clear(); }), HasSubstr("`to` is empty"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.from.push_back(0.5); }), HasSubstr("differ in length"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.from[0] = 1.5; }), HasSubstr("numbers from 0 to 1"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.optimum.cost = -1.0; }), HasSubstr("below 0"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.optimum.iterations = -3; }), HasSubstr("out of range"));
  EXPECT_THAT(forged([](fit::StartRecord& s) { s.from = s.optimum.scaled = {0.5}; }), HasSubstr("differ in length"));
}

// What is no state at all: nothing, other JSON, lists within lists, a folder, a device.
TEST_F(FitState, OtherFilesAreRefused) {
  for (const std::string& text : {std::string(), std::string("[]"), std::string("null"), std::string("{\"format\":2}"),
                                  std::string(100'000, '['), "{\"format\":2,\"laws\":" + std::string(100'000, '[')}) {
    write("fit.state.json", text);
    EXPECT_THAT(complaint(), HasSubstr("start again with --fresh")) << text.substr(0, 40);
  }
  for (const char* target : {"/dev/zero", "/"}) {
    std::filesystem::remove(file_);
    std::filesystem::create_symlink(target, file_);
    EXPECT_THAT(complaint(), HasSubstr("start again with --fresh")) << target;
  }
}

class ResumedFit : public ProgramTest {
 protected:
  /// A fit to a block of tets that takes some seconds: 24 starts, 20 replicates.
  std::vector<std::string> command(const std::string& out) {
    std::string csv = "time (s),displacement (mm),force (N)\n";
    for (int i = 0; i <= 40; ++i)
      csv += std::to_string(i) + "," + std::to_string(0.05 * i) + "," + std::to_string(4.2e-3 * i * (1.0 + 0.004 * i)) +
             "\n";
    write("a.csv", csv);
    const std::string toml = R"([specimen]
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
[forward]
kind = "scene"
[search]
starts = 24
)";
    return {"fit", write("f.toml", toml), "--out", out};
  }
  /// Stopped after the first starts.
  void cut(const std::string& out) {
    Started program = start(command(out));
    for (int i = 0; i < 3000 && program.output_so_far().find("starts 4/") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    program.signal(SIGINT);
    ASSERT_THAT(program.wait(), Exits(130));
    ASSERT_TRUE(std::filesystem::exists(folder_ / out / "fit.state.json"));
  }
};

// Of the result of a resumed fit nothing differs but what fit.json says of its session: runs made, their time, all time.
TEST_F(ResumedFit, EndsWithTheResultOfOneThatWasNotStopped) {  // long
  cut("cut");  // first: its words are looked for in a file that other runs fill, too
  ASSERT_THAT(run(command("cut")), Exits(0));
  ASSERT_THAT(run(command("whole")), Exits(0));
  nlohmann::json whole = read_json(folder_ / "whole/fit.json"), resumed = read_json(folder_ / "cut/fit.json");
  EXPECT_LT(resumed["forward_runs"], whole["forward_runs"]);
  for (const char* of_the_session : {"forward_runs", "forward_run_s", "wall_s"}) {
    whole.erase(of_the_session);
    resumed.erase(of_the_session);
  }
  EXPECT_EQ(resumed, whole);
  EXPECT_EQ(read_text(folder_ / "cut/tissue.toml"), read_text(folder_ / "whole/tissue.toml"));
}

// An edited state ends the fit with the file, the fault and the way out; that way works.
TEST_F(ResumedFit, RefusesAnEditedStateAndBeginsAnew) {
  cut("o");
  const std::filesystem::path file = folder_ / "o/fit.state.json";
  nlohmann::ordered_json state = nlohmann::ordered_json::parse(read_text(file));
  state["laws"].begin().value()["starts"][0]["cost"] = 0.001;
  write("o/fit.state.json", state.dump());
  const Outcome edited = run(command("o"));
  EXPECT_THAT(edited, Exits(2));
  EXPECT_THAT(edited.err, HasSubstr("o/fit.state.json: its checksum is wrong"));
  EXPECT_THAT(edited.err, HasSubstr("delete it, or start again with --fresh"));
  state["laws"].begin().value()["starts"][0]["to"] = nlohmann::json::array();
  write("o/fit.state.json", state.dump());
  EXPECT_THAT(run(command("o")), Exits(2));
  std::vector<std::string> fresh = command("o");
  fresh.push_back("--fresh");
  EXPECT_THAT(run(fresh), Exits(0));
}

}  // namespace
}  // namespace glisson::test

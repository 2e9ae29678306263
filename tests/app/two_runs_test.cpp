// One folder, one run: a second process that would write there is refused while the first lives, and nothing is changed.
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <thread>

#include "app/program.h"
#include "report/output_folder.h"

static bool file_system_has_locks = true;  // for this process; the programs that tests start have their own

/// In place of the C library's: refuses as a file system without locks does.
extern "C" int flock(int descriptor, int operation) {
  if (file_system_has_locks) return static_cast<int>(syscall(SYS_flock, descriptor, operation));
  errno = EOPNOTSUPP;
  return -1;
}

namespace glisson::test::two_runs_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;

class TwoRuns : public ProgramTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "first"), fs::create_directories(folder_ / "second");
    out_ = folder_ / "o";
  }
  /// Both write into the same folder, each from a folder of its own.
  Started first(std::vector<std::string> arguments) { return {with_out(std::move(arguments)), folder_ / "first"}; }
  Outcome second(std::vector<std::string> arguments) {
    return Started(with_out(std::move(arguments)), folder_ / "second").wait();
  }
  /// Starts a run of minutes, and waits until it writes.
  Started running() {
    Started program = first({"run", write("long.toml", long_scene())});
    for (int i = 0; i < 3000 && program.output_so_far().find("thick: 10 %") == std::string::npos; ++i)
      std::this_thread::sleep_for(20ms);
    return program;
  }
  /// Names and times of all files in the folder but those that the first run may be writing.
  std::map<std::string, fs::file_time_type> there() const {
    std::map<std::string, fs::file_time_type> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out_)) {
      const std::string name = entry.path().lexically_relative(out_).string();
      const bool grows = name.find("thick") != std::string::npos && !entry.is_directory();
      if (!grows) files[name] = entry.is_directory() ? fs::file_time_type{} : entry.last_write_time();
    }
    return files;
  }
  fs::path out_;

 private:
  std::vector<std::string> with_out(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--out", out_.string()});
    return arguments;
  }
};

// Every command that writes a folder of results is refused by name, with the process that holds it and the way out.
TEST_F(TwoRuns, SecondIsRefusedByName) {
  Started program = running();
  const std::string scene = write("small.toml", small_scene()), fit = write("fit.toml", "");
  const auto before = there();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"run", scene}, {"converge", scene}, {"compare", scene}, {"reproduce", "--quick"}}) {
    const Outcome outcome = second(command);
    EXPECT_THAT(outcome, Exits(2)) << command.front();
    EXPECT_THAT(outcome.err, HasSubstr(out_.string() + ": another run is being written there by process " +
                                       std::to_string(program.id())))
        << command.front();
    EXPECT_THAT(outcome.err, HasSubstr("choose another folder with --out DIR"));
  }
  EXPECT_EQ(there(), before) << "nothing has changed";
  program.signal(SIGTERM);
  EXPECT_THAT(program.wait(), Exits(130));
  EXPECT_EQ(read_json(out_ / "thick/summary.json")["end"], "interrupted") << "the first is whole";
}

// A folder inside that of a running run is refused as that folder is, and not made; so is one around it, whose run would replace it.
TEST_F(TwoRuns, InsideOrAroundIsRefusedByName) {
  const std::string scene = write("small.toml", small_scene());
  const fs::path around = out_;
  ASSERT_THAT(second({"run", scene}), Exits(0)) << "a former run, which the next may replace";
  out_ = around / "x" / "y";
  Started inner = running();
  const auto before = there();
  out_ = around;
  Outcome outcome = second({"run", scene});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, HasSubstr(around.string() + ": another run is being written inside it by process " +
                                     std::to_string(inner.id())));
  out_ = around / "x" / "y";
  EXPECT_EQ(there(), before) << "nothing has changed";
  out_ = around / "x" / "z";
  EXPECT_THAT(second({"run", scene}), Exits(0)) << "beside it is free";
  out_ = around / "x" / "y" / "deep" / "er";
  outcome = second({"run", scene});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err,
              HasSubstr(out_.string() + " is inside the folder of another run. " + (around / "x" / "y").string() +
                        ": another run is being written there by process " + std::to_string(inner.id())));
  EXPECT_FALSE(fs::exists(around / "x" / "y" / "deep"));
  inner.signal(SIGTERM);
  EXPECT_THAT(inner.wait(), Exits(130));
  fs::remove_all(around / "x");
  out_ = around;
  EXPECT_THAT(second({"run", scene}), Exits(0)) << "free again";
}

// The system frees the folder of a run that is killed: the next one replaces what it left, without a word.
TEST_F(TwoRuns, KilledRunLeavesNoLock) {
  Started program = running();
  program.signal(SIGKILL);
  EXPECT_THAT(program.wait(), Exits(128 + SIGKILL));
  ASSERT_TRUE(fs::exists(out_ / "thick/forces.csv"));
  const Outcome outcome = second({"run", write("small.toml", small_scene())});
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_EQ(outcome.err, "");
  EXPECT_FALSE(fs::exists(out_ / "thick"));
}

// A fit holds its folder from its start, before it has written anything; one that cannot be used leaves no folder behind.
TEST_F(TwoRuns, FitHoldsItsFolderToo) {
  std::string csv = "time (s),displacement (mm),force (N)\n";
  for (int i = 0; i <= 40; ++i)
    csv += std::to_string(i) + "," + std::to_string(0.05 * i) + "," + std::to_string(0.003 * i + 1e-5 * i * i) + "\n";
  write("a.csv", csv);
  const std::string spec = R"([specimen]
kind = "block"
width_mm = 20
depth_mm = 20
height_mm = 20
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [3000], alpha = [2], bulk_modulus_Pa = 1e6 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 100
high = 1e5
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = 1
high = 30
[search]
starts = 200
[[data]]
files = ["a.csv"]
[proof]
bootstrap = 20000
)";
  const std::string fit = write("f.toml", spec);
  EXPECT_THAT(second({"fit", write("wrong.toml", spec + "nonsense = 1\n")}), Exits(2));
  EXPECT_FALSE(fs::exists(out_));
  Started program = first({"fit", fit});
  for (int i = 0; i < 3000 && !fs::exists(out_); ++i) std::this_thread::sleep_for(5ms);
  std::this_thread::sleep_for(50ms);
  const Outcome outcome = second({"fit", fit, "--fresh"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, HasSubstr("another run is being written there by process " + std::to_string(program.id())));
  program.signal(SIGKILL);
  EXPECT_THAT(program.wait(), Exits(128 + SIGKILL));
}

// A run goes on in its own folder, however often: the lock is of one process.
TEST_F(TwoRuns, ReplacesItsOwnFormerRun) {
  const std::string scene = write("small.toml", small_scene());
  for (int i = 0; i < 2; ++i) EXPECT_THAT(second({"run", scene}), Exits(0));
}

// On a file system without locks the run goes on, with a warning that names the folder and the reason.
TEST_F(TwoRuns, AFolderWithoutLocksIsWarnedOf) {
  std::vector<std::string> warnings;
  file_system_has_locks = false;
  {
    OutputFolder folder(out_, [&](const std::string& text) { warnings.push_back(text); });
    folder.prepare();
  }
  file_system_has_locks = true;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings.front(),
              HasSubstr(out_.string() + ": cannot be locked (Operation not supported): nothing keeps"));
  EXPECT_TRUE(fs::exists(out_ / ".glisson"));
  OutputFolder(out_, [&](const std::string& text) { warnings.push_back(text); }).prepare();
  EXPECT_EQ(warnings.size(), 1u);
}

}  // namespace
}  // namespace glisson::test::two_runs_test

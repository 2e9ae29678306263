// What the system withholds from the program (descriptors, room, memory) is a message and an exit code, and never a file of
// results that holds something else.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "app/program.h"

namespace glisson::test {
namespace {

using Surrounded = ProgramTest;

using ::testing::HasSubstr;
using ::testing::Not;

// Whichever of the descriptors 0 to 2 are closed, a run writes the same files as with all of them: the first file that it
// opens would else be given the number of standard output or error, and hold what is printed.
TEST_F(Surrounded, ClosedDescriptorsChangeNoFile) {
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"run", scene, "--out", "o"}), Exits(0));
  const std::vector<std::vector<int>> sets{{0}, {1}, {2}, {0, 1}, {1, 2}, {0, 1, 2}};
  for (const std::vector<int>& closed : sets) {
    ASSERT_THAT(run_in({.closed = closed}, {"run", scene, "--out", "c"}), Exits(0));
    for (const char* file : {"main/forces.csv", "main/view.jsonl", "main/frames.pvd", "main/frames/frame_0000.vtu",
                             "scene.toml", ".glisson"}) {
      EXPECT_EQ(read_text(folder_ / "c" / file), read_text(folder_ / "o" / file)) << file << ", closed " << closed[0];
    }
  }
  const std::string wrong = write("w.toml", small_scene("[tisue]\n"));
  EXPECT_THAT(run_in({.closed = {2}}, {"run", wrong, "--out", "w"}), Exits(2));
}

// GLISSON_INSTRUCTION_SET chooses the kernels of a run: the summary names them, and each set reaches the same force to rounding. A set
// that is not there is refused with the variable and those that are.
TEST_F(Surrounded, EnvironmentChoosesTheInstructionSet) {
  const std::string scene = write("s.toml", small_scene());
  const char* before = std::getenv("GLISSON_INSTRUCTION_SET");
  const std::string kept = before == nullptr ? "" : before;
  std::map<std::string, double> forces;
  for (const std::string isa : {"avx512", "avx2", "sse4"}) {
    setenv("GLISSON_INSTRUCTION_SET", isa.c_str(), 1);
    const Outcome outcome = run({"run", scene, "--out", isa});
    if (outcome.err.find("environment variable GLISSON_INSTRUCTION_SET \"" + isa + "\"") != std::string::npos) {
      EXPECT_THAT(outcome.err, HasSubstr("there are: "));
      EXPECT_NE(outcome.exit_code, 0);
      continue;
    }
    ASSERT_THAT(outcome, Exits(0));
    const nlohmann::json summary = read_json(folder_ / isa / "main/summary.json");
    EXPECT_TRUE(forces.emplace(summary["instruction_set"], summary["peak_force_N"]).second) << isa;
  }
  setenv("GLISSON_INSTRUCTION_SET", kept.c_str(), 1);
  ASSERT_FALSE(forces.empty());
  for (const auto& [set, force] : forces) EXPECT_NEAR(force, forces.begin()->second, 1e-5 * force) << set;
}

// A stack that is too small to say anything within is told at once, with what is needed; half a megabyte is enough.
TEST_F(Surrounded, SmallStackIsTold) {
  const std::string scene = write("s.toml", small_scene());
  const Outcome refused = run_in({.stack_bytes = 64 * 1024}, {"run", scene, "--out", "o"});
  EXPECT_THAT(refused, Exits(1));
  EXPECT_THAT(refused.err, HasSubstr("the limit of the stack is 64 KB, where runs need 512 KB or more"));
  EXPECT_THAT(run_in({.stack_bytes = 512 * 1024}, {"run", scene, "--out", "o", "--threads", "2"}), Exits(0));
}

// What is printed and cannot be written is told, by every command, and the exit code says so; a run is not lost by it.
TEST_F(Surrounded, FullStandardOutputIsTold) {
  const std::string scene = write("s.toml", small_scene());
  const std::vector<std::vector<std::string>> commands{{"--version"}, {"schema"},       {"laws"},
                                                       {"tissues"},   {"check", scene}, {"run", scene, "--out", "o"}};
  for (const auto& command : commands) {
    const Outcome outcome = run_in({.out = "/dev/full"}, command);
    EXPECT_THAT(outcome, Exits(1)) << command.front();
    EXPECT_THAT(outcome.err, HasSubstr("standard output cannot be written")) << command.front();
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "o/report.html"));
  EXPECT_EQ(read_json(folder_ / "o/main/summary.json")["end"], "finished");
}

// A frame that the disk refuses is told with file and reason, and without VTK's account of its pipeline. It is written while the run
// goes on, whose other files have few lines here.
TEST_F(Surrounded, RefusedFrameIsToldPlainly) {
  const std::string scene = write("s.toml", small_scene());
  const Outcome outcome =
      run_in({.file_bytes = 3000}, {"run", scene, "--out", "o", "--set", "output.sample_rate_hz=40"});
  EXPECT_THAT(outcome, Exits(1));
  EXPECT_THAT(outcome.err, HasSubstr("o/main/frames/frame_0000.vtu: it cannot be written: File too large"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("vtk")));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "o/main/frames/frame_0000.vtu.part"));
}

// A file above the system's limit is an error of that file for every command, also where it is standard output.
TEST_F(Surrounded, NoCommandEndsBySignalAtTheSizeLimit) {
  const Outcome schema = run_in({.file_bytes = 1000}, {"schema"});
  EXPECT_THAT(schema, Exits(1));
  EXPECT_THAT(schema.err, HasSubstr("standard output cannot be written: File too large"));
}

// Memory that the system refuses is told as that, with the way out: no fault of the scene, no name of an exception.
TEST_F(Surrounded, RefusedMemoryIsTold) {
  if (!kMemoryHasLimits) GTEST_SKIP() << "the address sanitizer cannot run within a limit of addresses";
  const std::string scene = write("s.toml", small_scene());
  const std::vector<std::string> large{"run",       scene, "--out", "o",
                                       "--threads", "1",   "--set", "mesh.cells=[90, 90, 90]"};
  const Outcome outcome = run_in({.memory_bytes = 400ul << 20}, large);
  EXPECT_THAT(outcome, Exits(1));
  EXPECT_THAT(outcome.err, HasSubstr("the system refused more memory"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("bad_alloc")));
}

// A device or a pipe in the place of a scene, a fit, a mesh or a table is refused; it is not read to the end of memory.
TEST_F(Surrounded, DevicesAreNoInput) {
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.vtu");
  const std::string measured =
      write("m.toml",
            small_scene(
                "[[chart]]\ntitle = \"a\"\nx = \"time_s\"\ny = \"force_N\"\n[[chart.measured]]\npath = \"/dev/zero\"\n"
                "x = \"a\"\ny = \"b\"\n"));
  const std::string tissue = write("t.toml", small_scene("[[variant]]\nname = \"a\"\ntissue.file = \"/dev/zero\"\n"));
  const std::vector<std::vector<std::string>> commands{{"check", "/dev/zero"}, {"run", "/dev/zero"},
                                                       {"fit", "/dev/zero"},   {"info", "zero.vtu"},
                                                       {"check", measured},    {"check", tissue}};
  for (const auto& command : commands) {
    const Outcome outcome = run_in({.memory_bytes = kMemoryHasLimits ? 2ul << 30 : 0}, command);
    EXPECT_THAT(outcome, Exits(2)) << command.back();
    EXPECT_THAT(outcome.err, HasSubstr("is a device, a pipe or a socket")) << command.back();
  }
}

// A text file beyond any scene is refused by its size, before it is read.
TEST_F(Surrounded, HugeTextsAreRefused) {
  std::filesystem::resize_file(write("s.toml", "a"), std::uintmax_t{40} << 30);  // of holes
  const Outcome outcome = run({"check", "s.toml"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, HasSubstr("s.toml: is larger than 16 MiB"));
}

}  // namespace
}  // namespace glisson::test

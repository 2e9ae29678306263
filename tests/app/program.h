// program.h — runs the real glisson program from a test and keeps what it said and wrote.
#pragma once

#include <gmock/gmock.h>
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "support/folder.h"

namespace glisson::test {

/// What a run of the program left behind.
struct Outcome {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string out, err;
};

/// What a failed test says of a run: all that the program said, which nobody can ask again of a rare failure.
inline void PrintTo(const Outcome& outcome, std::ostream* stream) {
  *stream << "exit code " << outcome.exit_code << "\nstdout:\n" << outcome.out << "\nstderr:\n" << outcome.err;
}

/// The run ended with this exit code.
MATCHER_P(Exits, code, (negation ? "any exit code but " : "exit code ") + std::to_string(code)) {
  return arg.exit_code == code;
}

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kMemoryHasLimits = false;  ///< the address sanitizer reserves 14 TB of addresses at its start
#else
inline constexpr bool kMemoryHasLimits = true;  ///< a program runs within Surroundings::memory_bytes
#endif

/// What the system gives a program.
struct Surroundings {
  unsigned file_bytes = 0;         ///< the largest file it may write; 0: no limit
  unsigned long memory_bytes = 0;  ///< of address space; 0: no limit
  unsigned long stack_bytes = 0;   ///< of the stack; 0: no limit
  std::vector<int> closed{};       ///< descriptors that are closed when it starts
  std::filesystem::path out{};     ///< standard output; empty: a file that Outcome reads
};

/// A program that has been started; its output goes to files.
class Started {
 public:
  Started(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
          const Surroundings& surroundings = {});
  void signal(int number) const;
  pid_t id() const { return child_; }
  std::string output_so_far() const;
  /// Waits for its end, five minutes at most.
  Outcome wait();

 private:
  pid_t child_;
  std::filesystem::path out_, err_;
};

/// A test that runs the program in its folder.
class ProgramTest : public test::InFolder {
 protected:
  /// Runs the program in the test's folder.
  Outcome run(const std::vector<std::string>& arguments) { return Started(arguments, folder_).wait(); }
  Outcome run_in(const Surroundings& surroundings, const std::vector<std::string>& arguments) {
    return Started(arguments, folder_, surroundings).wait();
  }
  Started start(const std::vector<std::string>& arguments) { return {arguments, folder_}; }
};

std::string read_text(const std::filesystem::path& file);
nlohmann::json read_json(const std::filesystem::path& file);

/// A csv file: its columns by name; fails the test where a line has another number of values than the head.
std::map<std::string, std::vector<double>> read_csv(const std::filesystem::path& file);

/// The data inside a report.html.
nlohmann::json report_data(const std::filesystem::path& file);

/// The text of a scene on a small box (2 × 2 × 2 cubes) pressed on its top, elastic, 0.05 s; `more` is appended.
std::string small_scene(const std::string& more = "");

/// A scene that would run for minutes: what an interruption needs.
std::string long_scene();

}  // namespace glisson::test

#include "app/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace glisson::test {
namespace {

/// In the child: standard output and error into files, then the program.
[[noreturn]] void become_program(std::vector<std::string> arguments, const std::filesystem::path& folder,
                                 const std::filesystem::path& out, const std::filesystem::path& err,
                                 const Surroundings& given) {
  const std::filesystem::path& to = given.out.empty() ? out : given.out;
  const int out_file = open(to.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (out_file < 0 || err_file < 0 || chdir(folder.c_str()) != 0) _exit(126);
  dup2(out_file, STDOUT_FILENO);
  dup2(err_file, STDERR_FILENO);
  close(out_file), close(err_file);
  const rlimit file{given.file_bytes, given.file_bytes}, memory{given.memory_bytes, given.memory_bytes};
  if (given.file_bytes > 0 && setrlimit(RLIMIT_FSIZE, &file) != 0) _exit(126);
  arguments.insert(arguments.begin(), GLISSON_PROGRAM);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  if (given.memory_bytes > 0 && setrlimit(RLIMIT_AS, &memory) != 0) _exit(126);
  const rlimit stack{given.stack_bytes, given.stack_bytes};
  if (given.stack_bytes > 0 && setrlimit(RLIMIT_STACK, &stack) != 0) _exit(126);
  for (const int descriptor : given.closed) close(descriptor);
  execv(GLISSON_PROGRAM, argv.data());
  _exit(127);
}

}  // namespace

Started::Started(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                 const Surroundings& surroundings)
    : out_(folder / "stdout.txt"), err_(folder / "stderr.txt") {
  child_ = fork();
  if (child_ == 0) become_program(arguments, folder, out_, err_, surroundings);
}

void Started::signal(int number) const { kill(child_, number); }

std::string Started::output_so_far() const { return read_text(out_); }

Outcome Started::wait() {
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  while (waitpid(child_, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(5)) kill(child_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, read_text(out_), read_text(err_)};
}

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

nlohmann::json read_json(const std::filesystem::path& file) { return nlohmann::json::parse(read_text(file)); }

std::map<std::string, std::vector<double>> read_csv(const std::filesystem::path& file) {
  std::istringstream text(read_text(file));
  std::string line, cell;
  std::getline(text, line);
  std::vector<std::string> names;
  for (std::istringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(text, line)) {
    std::size_t i = 0;
    for (std::istringstream row(line); std::getline(row, cell, ','); ++i) {
      if (i < names.size()) columns[names[i]].push_back(std::strtod(cell.c_str(), nullptr));
    }
    EXPECT_EQ(i, names.size()) << file << ": " << line;
  }
  return columns;
}

nlohmann::json report_data(const std::filesystem::path& file) {
  const std::string page = read_text(file);
  const std::string opening = "<script id=\"glisson-data\" type=\"application/json\">";
  const std::size_t begin = page.find(opening);
  EXPECT_NE(begin, std::string::npos) << file;
  const std::size_t end = page.find("</script>", begin);
  return nlohmann::json::parse(page.substr(begin + opening.size(), end - begin - opening.size()));
}

std::string small_scene(const std::string& more) {
  return R"(title = "Small press"
[mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
velocity_mm_s = 20
depth_mm = 1
[output]
frames = 3
)" + more;
}

std::string long_scene() {
  return small_scene(R"([[variant]]
name = "thick"
tissue.viscosity_Pa_s = 400000
[[variant]]
name = "thicker"
tissue.viscosity_Pa_s = 600000
[[variant]]
name = "never"
tissue.viscosity_Pa_s = 300000
)");
}

}  // namespace glisson::test

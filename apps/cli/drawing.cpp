// drawing.cpp — see drawing.h.
#include "cli/drawing.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "program/embedded.h"
#include "program/exit_code.h"
#include "report/json_text.h"

namespace glisson::app {
namespace {

constexpr const char* kPackage = "glisson_drawing";
/// Whether a Python has what drawing takes; finding a module is quicker than importing it.
constexpr const char* kProbe =
    "import sys; from importlib.util import find_spec; "
    "sys.exit(0 if sys.version_info >= (3, 11) and find_spec('numpy') and find_spec('matplotlib') else 1)";

/// A folder of its own among temporary files, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "glisson-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Exit code of a program, found as the shell does; 127 where there is none. @param quiet  its output is dropped
int run_program(std::vector<std::string> words, bool quiet) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int stream = 1; quiet && stream <= 2; ++stream)
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", 1, 0);
  pid_t child = 0;
  const int trouble = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (trouble != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kInterrupted;
}

/// The first Python that can draw.
std::string find_python() {
  std::vector<std::string> candidates{"python3", "/usr/bin/python3", "venv/bin/python"};
  if (const char* chosen = std::getenv("GLISSON_PYTHON"); chosen != nullptr) candidates = {chosen};
  std::string tried;
  for (const std::string& python : candidates) {
    if (run_program({python, "-c", kProbe}, true) == 0) return python;
    tried += (tried.empty() ? "" : ", ") + python;
  }
  throw std::runtime_error(
      "charts and pictures are drawn by Python 3.11 or newer with NumPy and matplotlib, and none was found (tried " +
      tried +
      "). Install them: scripts/setup.sh plot, or apt-get install python3-matplotlib, or pip install "
      "matplotlib; GLISSON_PYTHON names another Python");
}

void write_package(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "__init__.py").flush();
  for (const auto& [name, text] : drawing_files()) {
    std::ofstream file(folder / name, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file.flush()) throw std::runtime_error(folder.string() + ": cannot be written");
  }
}

}  // namespace

int draw(const nlohmann::json& options) {
  const std::string python = find_python();
  const TemporaryFolder folder;
  write_package(folder.path() / kPackage);
  const char* before = std::getenv("PYTHONPATH");
  const std::string path = folder.path().string() + (before != nullptr ? ":" + std::string(before) : "");
  setenv("PYTHONPATH", path.c_str(), 1);
  setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
  return run_program({python, "-m", std::string(kPackage) + ".drawing_command", json_text(options)}, false);
}

}  // namespace glisson::app

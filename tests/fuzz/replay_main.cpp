// replay_main.cpp — runs files through a fuzz target's entry point without libFuzzer.
//
//   fuzz_replay_NAME FILE_OR_FOLDER…
//   fuzz_replay_NAME --seeds FOLDER      writes the seeds anew, of a target that makes them
//
// A crash or an exception that the entry point lets through ends the program with an error, after the file's
// name has been printed. So does an empty corpus: a test that ran nothing has proved nothing.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// Of targets whose seeds follow a format of ours that changes.
__attribute__((weak)) void write_seeds(const std::filesystem::path& folder);

namespace {

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool replay(const std::filesystem::path& file, std::size_t& bytes) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    std::fprintf(stderr, "%s: cannot be opened\n", file.c_str());
    return false;
  }
  const std::vector<char> data{std::istreambuf_iterator<char>(stream), {}};
  bytes += data.size();
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(data.data()), data.size());
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: the entry point threw: %s\n", file.c_str(), error.what());
  } catch (...) {
    std::fprintf(stderr, "%s: the entry point threw something that is no std::exception\n", file.c_str());
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--seeds") {
    if (write_seeds == nullptr) return 1;
    write_seeds(argv[2]);
    return 0;
  }
  std::size_t files = 0, failed = 0, bytes = 0;
  for (int i = 1; i < argc; ++i) {
    for (const std::filesystem::path& file : files_of(argv[i])) {
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);  // the last name printed is the one that crashed
      ++files;
      failed += !replay(file, bytes);
    }
  }
  std::printf("%zu files, %zu bytes, %zu failed\n", files, bytes, failed);
  if (files == 0) std::fprintf(stderr, "no file to replay: give files or folders\n");
  return files == 0 || failed > 0 ? 1 : 0;
}

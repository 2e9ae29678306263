// output_file.h — files of a run: written whole or line by line, and never in silence when the disk says no.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glisson {

/// A result that cannot be written: what() names the file and the system's reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Shortest text that reads back as the same double; `nan`, `inf`, `-inf` where it is not finite.
std::string number_text(double value);

/// Replaces a file by `text` in one move: a reader, or an interrupted run, sees the old file or the new one.
/// @throws OutputError
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Makes a folder and those above it. @throws OutputError
void make_folder(const std::filesystem::path& folder);

/// A text file that grows line by line; each line is handed to the system at once, so that whatever ends the
/// program leaves whole lines.
class LineFile {
 public:
  /// @throws OutputError where the file cannot be made
  explicit LineFile(std::filesystem::path file);
  /// @param line  without its line end @throws OutputError (a full disk, for one)
  void write(std::string_view line);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace glisson

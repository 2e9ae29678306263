// folder.h — a folder that one test has for itself, whatever runs beside it.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace glisson::test {

/// A new folder with a name that no other has, empty at its start and removed at its end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "glisson-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file into it, the bytes as they are, and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// A test with a folder of its own.
class InFolder : public ::testing::Test {
 private:
  const Folder own_;

 protected:
  const std::filesystem::path& folder_ = own_.path();
  std::string write(const std::string& name, const std::string& bytes) const {
    return own_.write(name, bytes).string();
  }
};

}  // namespace glisson::test

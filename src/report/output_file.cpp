// output_file.cpp — see output_file.h.
#include "report/output_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

namespace glisson {
namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& file, const std::string& reason) {
  throw OutputError(file.string() + ": cannot be written: " + reason +
                    "; choose a folder with free space and write permission with --out DIR");
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) cannot_write(folder, error.message());
}

void write_whole(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path part = file;
  part += ".part";
  std::FILE* out = std::fopen(part.c_str(), "wb");
  if (out == nullptr) cannot_write(file, std::strerror(errno));
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  const int write_error = errno;
  const bool closed = std::fclose(out) == 0;
  const int close_error = errno;
  std::error_code error;
  if (!written || !closed) {
    std::filesystem::remove(part, error);
    cannot_write(file, std::strerror(written ? close_error : write_error));
  }
  std::filesystem::rename(part, file, error);
  if (error) cannot_write(file, error.message());
}

LineFile::LineFile(std::filesystem::path file) : path_(std::move(file)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) cannot_write(path_, std::strerror(errno));
}

void LineFile::write(std::string_view line) {
  std::string text(line);
  text += '\n';
  const bool written = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
  if (!written || std::fflush(file_.get()) != 0) cannot_write(path_, std::strerror(errno));
}

}  // namespace glisson

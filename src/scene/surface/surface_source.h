// surface_source.h — the bytes of a surface file as words and lines of text, or as little- or big-endian numbers.
//
// Every fault says where: the line of a text, the byte of a binary file. No count is believed before the file has room for it.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "glisson/scene/surface_file.h"

namespace glisson::surface_file {

class Source {
 public:
  Source(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  std::string_view bytes() const { return bytes_; }
  std::size_t left() const { return bytes_.size() - position_; }

  // Text.
  /// The next line without its end and blanks around it; false at the end of the file.
  bool line(std::string_view& text);
  /// The next word, also from a later line; empty at the end of the file.
  std::string_view word();
  /// The same in lower case, which must be this one. @param within  "a facet"
  void expect(std::string_view wanted, const char* within);
  double real(const char* what);

  // Binary.
  void set_binary(std::endian order) { binary_ = true, order_ = order; }
  void skip(std::uint64_t bytes, const std::string& what);
  template <class T>
  T number(const std::string& what);

  /// `FILE:LINE: …` of what was read last, or `FILE, byte N: …`. @throws std::invalid_argument
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view bytes_;
  std::string name_;
  std::size_t position_ = 0, next_line_ = 1, line_ = 1;
  bool binary_ = false;
  std::endian order_ = std::endian::little;
};

/// The word that a line begins with, taken off it; empty where there is none.
std::string_view first_word(std::string_view& line);
/// A finite number in all of a word. @param what  it is, for a message
double real_in(const Source& source, std::string_view word, const char* what);
/// Printable and short, in quotes.
std::string shown(std::string_view text);

/// The reader of each format. @throws std::invalid_argument
TriangleSurface read_stl(Source& source);
TriangleSurface read_obj(Source& source);
TriangleSurface read_ply(Source& source);

/// Reads bytes as if they were the file `name`, whose ending tells the format. @throws as read_surface
TriangleSurface parse(std::string_view bytes, const std::filesystem::path& name, double scale);

}  // namespace glisson::surface_file

// gmsh_source.h — the bytes of a Gmsh file as sections, records and numbers, text or binary alike.
//
// One reader of a section serves both encodings: `integer`, `size` and `real` take a token of the current
// line in a text file and 4, 4/8 or 8 bytes in a binary one. Every error says where: the line of a text
// file, the section and record of a binary one. No count is believed before the file has room for it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace glisson::detail {

class GmshSource {
 public:
  GmshSource(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  void set_binary(std::size_t size_bytes) { binary_ = true, size_bytes_ = size_bytes; }
  bool binary() const { return binary_; }

  /// Moves into the next section and gives its name without "$"; false at the end of the file.
  bool next_section(std::string& section);
  /// Requires "$End" + the section's name here.
  void end_section();
  /// Moves past the "$End…" of a section that is not read.
  void skip_section();

  /// Starts a record; its numbers stand on one line of a text file. Named in errors as "WHAT INDEX".
  void record(const char* what, std::uint64_t index = 0);
  /// The same for the parts of a binary file that are text.
  void text_record(const char* what, std::uint64_t index = 0);

  std::int64_t integer(const char* what);  ///< a C int
  std::uint64_t size(const char* what);    ///< a C size_t
  double real(const char* what);           ///< finite or not
  std::int64_t text_integer(const char* what);
  std::uint64_t text_size(const char* what);
  double text_real(const char* what);
  std::string quoted(const char* what);  ///< "…" up to the last quote of the line
  void end_of_text_line();               ///< moves past the line's end, exactly: binary data may follow
  /// The four bytes of the number 1 that tell the byte order of a binary file.
  void byte_order_mark();

  /// Refuses a count of things that cannot all fit in what is left of the file.
  void require_room(std::uint64_t count, std::size_t text_bytes, std::size_t binary_bytes, const char* what) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view token(const char* what);
  std::string_view take(std::size_t bytes, const char* what);
  template <class T>
  T bytes_as(const char* what);
  void skip_white_space();
  std::string_view rest_of_line() const;
  std::string shown(std::string_view text) const;

  std::string_view bytes_;
  std::string name_;
  std::string section_;
  const char* record_ = nullptr;
  std::uint64_t record_index_ = 0;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
  std::size_t size_bytes_ = 8;
  bool binary_ = false, swapped_ = false, text_part_ = true;
};

}  // namespace glisson::detail

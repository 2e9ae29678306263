// legacy_vtk_source.h — the bytes of a legacy .vtk file as words, lines and blocks of numbers.
//
// No count is believed before the file has room for it. Errors name the line of a text file and the byte of
// a binary one, with the keyword.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glisson::detail {

class LegacyVtkSource {
 public:
  LegacyVtkSource(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  void set_binary() { binary_ = true; }

  bool at_end() const { return position_ >= bytes_.size(); }
  std::string_view line();                    ///< the rest of the line, moving past its end
  std::string_view word(const char* what);    ///< the next word, also from a later line
  std::optional<std::string> next_keyword();  ///< in lower case; none at the end of the file
  std::uint64_t count(const char* what);      ///< an integer that the file might have room for
  std::string type();                         ///< of values, in lower case

  /// A block of values of a type; kept where the pointer is not null, rounded to float if that is their type.
  void values(std::uint64_t number, const std::string& type, std::vector<double>* keep = nullptr);
  /// A block of integers of 32 or 64 bits.
  std::vector<std::int64_t> integers(std::uint64_t number, const std::string& type);

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  void skip_space();
  double text_number(std::uint64_t index, std::uint64_t of);
  void require_text_room(std::uint64_t number) const;
  std::string_view binary_block(std::uint64_t number, int bits);
  void skip_strings(std::uint64_t number);

  std::string_view bytes_;
  const std::string& name_;
  std::string keyword_;
  std::size_t position_ = 0, line_ = 1;
  std::size_t item_line_ = 1;  ///< where the last word or line began
  bool binary_ = false;
};

}  // namespace glisson::detail

// curve_file.h — a file of measured numbers, as the machines of laboratories write them.
//
//   EF10_100T_A_sample_1          ┐
//   Speed (mm/min): 10;           ┘ prose, any number of lines
//   Time (s);Weg (mm);Kraft (N)     names, the last line of words above the numbers
//   s;mm;N                          units, where they have a line of their own
//   0,1;0,0069;0,0231               numbers: separator `,` `;` or tab, decimal point or comma, found or said
//
// The parsers that Debian 12 and Ubuntu 24.04 package split lines at a separator that is known beforehand (libcsv3; libfccp
// at compile time); finding it, the decimal mark, the names and the units is what takes the work here, so that they
// would save one short function. scene/parse/word_table.h reads strict files and is left so: a scene should say what it means.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glisson::fit {

/// How a file is written, where it shall not be found out.
struct TextSpec {
  char separator = 0;            ///< 0: found
  char decimal = 0;              ///< '.' or ','; 0: found
  std::uint32_t names_line = 0;  ///< line of the columns' names, from 1; 0: found
};

struct CurveFile {
  struct Field {
    std::string text;
    std::uint32_t column = 0;  ///< byte of the line, from 1
  };
  struct Row {
    std::uint32_t line = 0;
    std::vector<Field> fields;
  };
  std::filesystem::path file;
  char separator = ',', decimal = '.';
  std::uint32_t names_line = 0;    ///< 0: there is none
  std::vector<std::string> names;  ///< as written, trimmed; empty: the file has no line of names
  std::vector<std::string> units;  ///< of each column, from the line below the names or from the name; "": not said
  std::vector<Row> rows;           ///< from the first row of numbers to the last
  std::size_t columns = 0;         ///< most rows have as many

  /// `"Load (N)"`, or `column 3` where it has no name.
  std::string title(std::size_t column) const;
};

/// A number as the file writes it; nothing where it is none or not finite.
std::optional<double> parse_number(std::string_view text, char decimal);

/// @throws SceneError `file:line:column: …` where the file cannot be read, is empty or has no rows of numbers
CurveFile read_curve_file(const std::filesystem::path& file, const TextSpec& spec = {});
/// The same from text. @param file  stands for it in messages
CurveFile parse_curve_file(std::string text, const std::filesystem::path& file, const TextSpec& spec = {});

}  // namespace glisson::fit

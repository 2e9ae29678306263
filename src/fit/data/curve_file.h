// curve_file.h — a file of measured numbers, as the machines of laboratories write them.
//
//   EF10_100T_A_sample_1          ┐
//   Speed (mm/min): 10;           ┘ prose, any number of lines
//   Time (s);Weg (mm);Kraft (N)     names, the last line of words above the numbers
//   s;mm;N                          units, where they have a line of their own
//   0,1;0,0069;1.023,1              numbers: separator `,` `;` tab or blanks, decimal point or comma, found or said
//
// in the order   text_encoding ─▶ text_layout ─▶ names, units and intervals (here) ─▶ choose_column ─▶ raw_test
//
// A file may hold several tables of this form one below the other, as a rheometer's intervals.
//
// The parsers that Debian 12 and Ubuntu 24.04 package split lines at a separator that is known beforehand (libcsv3; libfccp
// at compile time); finding it, the decimal mark, the names and the units is what takes the work here, so that they
// would save one short function. scene/parse/word_table.h reads strict files and is left so: a scene should say what it means.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fit/data/measured_number.h"
#include "fit/data/text_layout.h"

namespace glisson::fit {

struct CurveFile {
  struct Row {
    std::uint32_t line = 0;
    std::vector<TextField> fields;
  };
  std::filesystem::path file;
  char separator = ',', decimal = '.';
  std::uint32_t names_line = 0;    ///< 0: there is none
  std::vector<std::string> names;  ///< as written, trimmed; empty: the file has no line of names
  std::vector<std::string> units;  ///< of each column, from the line below the names or from the name; "": not said
  /// Of columns of clock times the time of the first row, as written; their numbers are seconds since then. Else "".
  std::vector<std::string> clocks;
  std::vector<Row> rows;    ///< from the first row of numbers to the last
  std::size_t columns = 0;  ///< most rows have as many

  /// `"Load (N)"`, or `column 3` where it has no name.
  std::string title(std::size_t column) const;
  /// Whether a column holds clock times.
  bool is_clock(std::size_t column) const { return column < clocks.size() && !clocks[column].empty(); }
};

/// @throws SceneError `file:line:column: …` where the file cannot be read, is empty, has no rows of numbers or several tables
CurveFile read_curve_file(const std::filesystem::path& file, const TextSpec& spec = {});
/// The same from text. @param file  stands for it in messages
CurveFile parse_curve_file(std::string text, const std::filesystem::path& file, const TextSpec& spec = {});

}  // namespace glisson::fit

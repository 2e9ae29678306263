// word_table.h — a file of numbers separated by commas: a line of names, then a line for each row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace glisson::scene {

/// The words of a .csv; blank lines and those that begin with # are passed over.
struct WordTable {
  struct Row {
    std::string where;  ///< `file:line`
    std::vector<std::string> words;
  };
  Row names;
  std::vector<Row> rows;

  /// Place of a column; the number of columns where there is none.
  std::size_t column(const std::string& name) const;
  /// @throws std::runtime_error `file:line: …` for a word that is no finite number
  static double number(const Row& row, std::size_t column);
};

/// @throws std::runtime_error where the file cannot be read or has no line
WordTable read_word_table(const std::filesystem::path& file);

}  // namespace glisson::scene

// text_layout.h — lines of a machine's file, and how they part into fields: separator and decimal mark, found or said.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glisson::fit {

/// How a file is written, where it shall not be found out.
struct TextSpec {
  char separator = 0;            ///< ' ' stands for any number of blanks; 0: found
  char decimal = 0;              ///< '.' or ','; 0: found
  std::uint32_t names_line = 0;  ///< line of the columns' names, from 1; 0: found
  std::uint32_t interval = 0;    ///< which of several tables one below the other, from 1; 0: there is one
};

struct TextField {
  std::string text;
  std::uint32_t column = 0;  ///< byte of the line, from 1
};

struct TextRow {
  std::uint32_t line = 0;
  std::string_view text;  ///< the whole line, of the text that was given
  std::vector<TextField> fields;
};

struct TextStyle {
  char separator = ',', decimal = '.';
};

constexpr std::size_t kFewestNumbers = 2;  ///< of a row: a displacement and a force

/// Lines that are not blank, ended by LF, CRLF or CR, without fields.
std::vector<TextRow> lines_of(std::string_view text);

/// Fields of a line. Quotes hold a separator; separators at its end mean nothing.
std::vector<TextField> split_line(std::string_view line, char separator);

/// Fields of a line of names above columns that blanks part: as many as there are columns, where one of the ways to part it
/// gives them, by two blanks or more, or by one, a unit in brackets going with its name; else none.
std::vector<TextField> split_names(std::string_view line, std::size_t columns);

std::size_t numbers_in(const TextRow& row, char decimal);

/// The style that explains the lines best, and their fields by it.
/// @throws SceneError where no line holds two numbers, or where a mark may be that of thousands as well as the decimal one
TextStyle find_style(std::vector<TextRow>& rows, const TextSpec& spec, const std::filesystem::path& file);

[[noreturn]] void fail_in(const std::filesystem::path& file, std::uint32_t line, const std::string& what);

}  // namespace glisson::fit

#include "fit/data/curve_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <system_error>

#include "base/input_file.h"
#include "fit/data/units.h"
#include "glisson/scene/scene.h"
#include "scene/parse/problems.h"

namespace glisson::fit {
namespace {

using Row = CurveFile::Row;
using Field = CurveFile::Field;

constexpr std::size_t kFewestNumbers = 2;  // of a row: a way and a force
constexpr std::size_t kLinesLookedAt = 2000;

struct Line {
  std::uint32_t number;
  std::string_view text;
};

struct Style {
  char separator, decimal;
};
// In order of preference, where two read the same numbers.
constexpr std::array kStyles{Style{';', '.'},  Style{';', ','}, Style{'\t', '.'},
                             Style{'\t', ','}, Style{',', '.'}, Style{',', ','}};

[[noreturn]] void fail(const std::filesystem::path& file, std::uint32_t line, const std::string& what) {
  throw SceneError(file.string() + ":" + std::to_string(line) + ":1: " + what);
}

/// Number of bytes of the UTF-8 character that starts here; 0 where none does.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80         ? 1
                             : byte(0) >> 5 == 0x06 ? 2
                             : byte(0) >> 4 == 0x0E ? 3
                             : byte(0) >> 3 == 0x1E ? 4
                                                    : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 0x02) return 0;
  }
  return length;
}

/// Text whose bytes are not UTF-8 is taken for Latin-1, which older machines write (µ, °).
std::string as_utf8(std::string text) {
  bool valid = true;
  for (std::size_t i = 0; i < text.size() && valid;) {
    const std::size_t length = utf8_length(std::string_view(text).substr(i));
    valid = length > 0;
    i += length;
  }
  if (valid) return text;
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      converted += c;
    } else {
      converted += static_cast<char>(0xC0 | (byte >> 6));
      converted += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return converted;
}

/// Lines that are not blank, ended by LF, CRLF or CR.
std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  std::uint32_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    ++number;
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (!detail::trimmed(line).empty()) lines.push_back({number, line});
    at = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return lines;
}

/// A field in quotes; `""` in it is one. A quote that nothing closes ends with the line.
std::string quoted_field(std::string_view line, std::size_t& at) {
  std::string text;
  for (++at; at < line.size(); ++at) {
    if (line[at] != '"') {
      text += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      text += line[++at];
    } else {
      ++at;
      break;
    }
  }
  return text;
}

Row split(const Line& line, char separator) {
  Row row{line.number, {}};
  const std::string_view text = line.text;
  for (std::size_t at = 0; at <= text.size();) {
    while (at < text.size() && text[at] == ' ') ++at;
    const auto column = static_cast<std::uint32_t>(at + 1);
    std::string word;
    if (at < text.size() && text[at] == '"') word = quoted_field(text, at);
    const std::size_t end = std::min(text.find(separator, std::min(at, text.size())), text.size());
    if (at < end) word += text.substr(at, end - at);
    row.fields.push_back({std::string(detail::trimmed(word)), column});
    at = end + 1;
  }
  while (row.fields.size() > 1 && row.fields.back().text.empty()) row.fields.pop_back();  // trailing separators
  return row;
}

std::size_t numbers_in(const Row& row, char decimal) {
  return static_cast<std::size_t>(std::count_if(
      row.fields.begin(), row.fields.end(), [&](const Field& f) { return parse_number(f.text, decimal).has_value(); }));
}

/// A field that holds another separator has been split at the wrong one.
bool is_split_wrongly(const Row& row) {
  return std::any_of(row.fields.begin(), row.fields.end(),
                     [](const Field& f) { return f.text.find_first_of(";\t") != std::string::npos; });
}

/// How well a style explains the lines: the numbers it finds, each counted by the share of its line that is numbers.
double score(const std::vector<Line>& lines, Style style) {
  double sum = 0.0;
  const std::size_t step = lines.size() / kLinesLookedAt + 1;
  for (std::size_t i = 0; i < lines.size(); i += step) {
    const Row row = split(lines[i], style.separator);
    const auto numbers = static_cast<double>(numbers_in(row, style.decimal));
    if (numbers >= kFewestNumbers && !is_split_wrongly(row))
      sum += numbers * numbers / static_cast<double>(row.fields.size());
  }
  return sum;
}

Style find_style(const std::vector<Line>& lines, const TextSpec& spec, const std::filesystem::path& file) {
  Style best{spec.separator ? spec.separator : ',', spec.decimal ? spec.decimal : '.'};
  double most = 0.0;
  for (const Style style : kStyles) {
    if ((spec.separator && style.separator != spec.separator) || (spec.decimal && style.decimal != spec.decimal))
      continue;
    const double reached = score(lines, style);
    if (reached > most) {
      most = reached;
      best = style;
    }
  }
  if (most > 0.0) return best;
  fail(file, lines.front().number,
       "has no rows of numbers: no line has two or more, separated by `,`, `;` or tab; check the file, or say "
       "`text.separator` and `text.decimal`");
}

/// What stands where a number is missing.
bool is_missing(std::string_view text) {
  std::string word;
  for (const char c : text) word += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  constexpr std::array<std::string_view, 12> kWords{"",     "nan", "-nan", "inf", "-inf", "+inf",
                                                    "null", "n/a", "na",   "-",   "#n/a", "--"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end() || word.substr(0, 1) == "#";
}

/// Words that name columns: two or more that are neither numbers nor stand for missing ones.
bool is_words(const Row& row, char decimal) {
  const auto is_word = [&](const Field& f) { return !is_missing(f.text) && !parse_number(f.text, decimal); };
  return std::count_if(row.fields.begin(), row.fields.end(), is_word) >= 2;
}

std::string without_brackets(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '(' || text.front() == '[')) text = text.substr(1, text.size() - 2);
  return std::string(detail::trimmed(text));
}

bool is_unit_text(const std::string& text) {
  const std::string unit = without_brackets(text);
  for (const Quantity q : {Quantity::time, Quantity::length, Quantity::force, Quantity::stress, Quantity::strain}) {
    if (find_unit(q, unit)) return true;
  }
  return false;
}

/// A line of units: half of its words or more are units.
bool is_units(const Row& row) {
  std::size_t words = 0, units = 0;
  for (const Field& f : row.fields) {
    words += !f.text.empty();
    units += is_unit_text(f.text);
  }
  return units >= 2 && 2 * units >= words;
}

/// Columns that most rows of numbers have.
std::size_t usual_width(const std::vector<Row>& rows, char decimal) {
  std::map<std::size_t, std::size_t> counts;
  for (const Row& row : rows) {
    if (numbers_in(row, decimal) >= kFewestNumbers) ++counts[row.fields.size()];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

/// First row of numbers as wide as most; the number of rows where there is none.
std::size_t first_numbers(const std::vector<Row>& rows, std::size_t width, char decimal, std::size_t from) {
  for (std::size_t i = from; i < rows.size(); ++i) {
    if (rows[i].fields.size() == width && numbers_in(rows[i], decimal) >= kFewestNumbers) return i;
  }
  return rows.size();
}

void take_names(CurveFile& result, const Row& names, const Row* units) {
  result.names_line = names.line;
  for (std::size_t i = 0; i < names.fields.size(); ++i) {
    result.names.push_back(names.fields[i].text);
    const bool below = units && i < units->fields.size() && !units->fields[i].text.empty();
    result.units.push_back(below ? without_brackets(units->fields[i].text) : split_title(names.fields[i].text).unit);
  }
}

/// Finds the line of names above row `first`, and whether units follow it. @return first row after them
std::size_t find_names(CurveFile& result, const std::vector<Row>& rows, std::size_t first) {
  std::size_t words = first;
  while (words > 0 && !is_words(rows[words - 1], result.decimal)) --words;
  if (words == 0) return first;
  const bool units = is_units(rows[words - 1]) && words > 1 && is_words(rows[words - 2], result.decimal);
  take_names(result, rows[words - (units ? 2 : 1)], units ? &rows[words - 1] : nullptr);
  return words;
}

/// The same where the user says the line of names.
std::size_t said_names(CurveFile& result, const std::vector<Row>& rows, std::uint32_t line) {
  const auto names = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.line == line; });
  if (names == rows.end())
    fail(result.file, line, "is said to hold the columns' names (`text.names_line`), but is blank or after the end");
  const bool units = names + 1 != rows.end() && is_units(names[1]);
  take_names(result, *names, units ? &names[1] : nullptr);
  return static_cast<std::size_t>(names - rows.begin()) + (units ? 2 : 1);
}

/// Lines below the numbers that hold no field of a row: "end of test".
bool is_footer(const Row& row, char decimal) {
  return numbers_in(row, decimal) == 0 &&
         std::none_of(row.fields.begin(), row.fields.end(), [](const Field& f) { return is_missing(f.text); });
}

}  // namespace

std::string CurveFile::title(std::size_t column) const {
  if (column < names.size() && !names[column].empty()) return "\"" + names[column] + "\"";
  return "column " + std::to_string(column + 1);
}

std::optional<double> parse_number(std::string_view text, char decimal) {
  text = detail::trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  std::string plain(text);
  if (decimal == ',') {
    if (plain.find('.') != std::string::npos) return std::nullopt;
    std::replace(plain.begin(), plain.end(), ',', '.');
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (error != std::errc{} || end != plain.data() + plain.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

CurveFile parse_curve_file(std::string text, const std::filesystem::path& file, const TextSpec& spec) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.compare(0, 2, "\xFF\xFE") == 0 || text.compare(0, 2, "\xFE\xFF") == 0)
    fail(file, 1, "is written in UTF-16; save it as UTF-8 or plain text");
  if (text.compare(0, kMark.size(), kMark) == 0) text.erase(0, kMark.size());
  if (text.find('\0') != std::string::npos)
    fail(file, 1, "is not text: it contains bytes of value 0; export it as .csv");
  text = as_utf8(std::move(text));
  const std::vector<Line> lines = lines_of(text);
  if (lines.empty()) fail(file, 1, "is empty; expected a line of names and rows of numbers");
  const Style style = find_style(lines, spec, file);
  CurveFile result;
  result.file = file;
  result.separator = style.separator;
  result.decimal = style.decimal;
  std::vector<Row> rows;
  for (const Line& line : lines) rows.push_back(split(line, style.separator));
  result.columns = usual_width(rows, style.decimal);
  const std::size_t after_names = spec.names_line ? said_names(result, rows, spec.names_line) : 0;
  std::size_t first = first_numbers(rows, result.columns, style.decimal, after_names);
  first = spec.names_line ? after_names : find_names(result, rows, first);
  std::size_t last = rows.size();
  while (last > first && is_footer(rows[last - 1], style.decimal)) --last;
  if (first >= last) fail(file, lines.back().number, "has no rows of numbers below the columns' names");
  rows.resize(last);
  result.rows.assign(std::make_move_iterator(rows.begin() + static_cast<std::ptrdiff_t>(first)),
                     std::make_move_iterator(rows.end()));
  return result;
}

CurveFile read_curve_file(const std::filesystem::path& file, const TextSpec& spec) {
  detail::InputFile input = detail::read_input(file, detail::kTableInput);
  if (!input.problem.empty()) throw SceneError(input.problem);
  return parse_curve_file(std::move(input.bytes), file, spec);
}

}  // namespace glisson::fit

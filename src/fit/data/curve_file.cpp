#include "fit/data/curve_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>

#include "base/input_file.h"
#include "base/text.h"
#include "fit/data/clock_time.h"
#include "fit/data/text_encoding.h"
#include "fit/data/units.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {
namespace {

using TextRows = std::span<const TextRow>;

constexpr std::size_t kFewestOfCurve = 5;  // rows; a shorter table is a summary

/// What stands where a number is missing.
bool is_missing(std::string_view text) {
  const std::string word = detail::lower_case(text);
  constexpr std::array<std::string_view, 12> kWords{"",     "nan", "-nan", "inf", "-inf", "+inf",
                                                    "null", "n/a", "na",   "-",   "#n/a", "--"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end() || word.substr(0, 1) == "#";
}

/// Fields that are neither numbers nor stand for missing ones.
std::size_t words_in(const TextRow& row, char decimal) {
  return static_cast<std::size_t>(std::count_if(row.fields.begin(), row.fields.end(), [&](const TextField& f) {
    return !is_missing(f.text) && !parse_number(f.text, decimal);
  }));
}

/// Words that name columns.
bool is_words(const TextRow& row, char decimal) { return words_in(row, decimal) >= 2; }

std::string without_brackets(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '(' || text.front() == '[')) text = text.substr(1, text.size() - 2);
  return std::string(detail::trimmed(text));
}

/// A line of units: half of its words or more are units.
bool is_units(const TextRow& row, char decimal) {
  std::size_t words = 0, units = 0;
  for (const TextField& f : row.fields) {
    words += !f.text.empty();
    units += is_unit(without_brackets(f.text)) && !parse_number(f.text, decimal);
  }
  return units >= 2 && 2 * units >= words;
}

/// Columns that most rows of numbers have.
std::size_t usual_width(TextRows rows, char decimal) {
  std::map<std::size_t, std::size_t> counts;
  for (const TextRow& row : rows) {
    if (numbers_in(row, decimal) >= kFewestNumbers) ++counts[row.fields.size()];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

/// First row of numbers as wide as most; the number of rows where there is none.
std::size_t first_numbers(TextRows rows, std::size_t width, char decimal) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].fields.size() == width && numbers_in(rows[i], decimal) >= kFewestNumbers) return i;
  }
  return rows.size();
}

/// Lines below the numbers that hold no field of a row: "end of test".
bool is_footer(const TextRow& row, char decimal) {
  return numbers_in(row, decimal) == 0 &&
         std::none_of(row.fields.begin(), row.fields.end(), [](const TextField& f) { return is_missing(f.text); });
}

/// A line of prose with numbers in it: "Interval and data points: 2 16".
bool begins_with_word(const TextRow& row, char decimal) {
  const auto first =
      std::find_if(row.fields.begin(), row.fields.end(), [](const TextField& f) { return !f.text.empty(); });
  return first != row.fields.end() && !is_missing(first->text) && !parse_number(first->text, decimal);
}

/// A table of the file: its names, its units where they have a line, its numbers. Indices of lines.
struct Table {
  std::size_t names = 0;  ///< line; that of the first numbers where there is none
  std::size_t first = 0, last = 0;
  bool named = false, units = false;
};

class Tables {
 public:
  Tables(TextRows rows, char decimal) : rows_(rows), decimal_(decimal) {}

  /// The tables one below the other, whose lines of names say their units or are alike; or the one below the last words.
  std::vector<Table> find() const {
    std::vector<Table> found;
    const std::vector<std::size_t> names = names_of_several();
    for (std::size_t i = 0; i < names.size(); ++i)
      found.push_back(named(names[i], i + 1 < names.size() ? names[i + 1] : rows_.size()));
    const bool none = found.empty() || (found.size() == 1 && found[0].last - found[0].first < kFewestOfCurve);
    return none ? std::vector<Table>{only()} : found;
  }

  /// The table below a line of names that is said.
  Table below(std::size_t names) const {
    std::size_t end = rows_.size();
    for (const std::size_t other : names_of_several()) {
      if (other > names) end = std::min(end, other);
    }
    return named(names, end);
  }

 private:
  bool is_units_at(std::size_t i) const { return i < rows_.size() && is_units(rows_[i], decimal_); }

  /// The last line of words above the first row of numbers as wide as most.
  Table only() const {
    const std::size_t width = usual_width(rows_, decimal_);
    const std::size_t first = first_numbers(rows_, width, decimal_);
    std::size_t words = first;
    while (words > 0 && !is_words(rows_[words - 1], decimal_)) --words;
    Table table{words > 0 ? words - 1 : first, words > 0 ? words : first, rows_.size(), words > 0, false};
    table.units = words > 1 && is_units_at(words - 1) && is_words(rows_[words - 2], decimal_);
    if (table.units) --table.names;
    return without_footer(table);
  }

  Table named(std::size_t names, std::size_t end) const {
    Table table{names, names + 1, end, true, is_units_at(names + 1)};
    table.first += table.units;
    if (end < rows_.size()) {
      while (table.last > table.first && begins_with_word(rows_[table.last - 1], decimal_)) --table.last;
    }
    return without_footer(table);
  }

  Table without_footer(Table table) const {
    while (table.last > table.first && is_footer(rows_[table.last - 1], decimal_)) --table.last;
    return table;
  }

  /// Whether a line of more words than numbers has numbers below it.
  bool is_above_numbers(std::size_t i) const {
    const TextRow& row = rows_[i];
    if (!is_words(row, decimal_) || words_in(row, decimal_) <= numbers_in(row, decimal_) || is_units(row, decimal_))
      return false;
    const std::size_t next = i + (is_units_at(i + 1) ? 2 : 1);
    return next < rows_.size() && numbers_in(rows_[next], decimal_) >= kFewestNumbers &&
           numbers_in(rows_[next], decimal_) >= words_in(rows_[next], decimal_);
  }

  bool says_units(std::size_t i) const {
    const auto has = [](const TextField& f) { return !split_title(f.text).unit.empty(); };
    return is_units_at(i + 1) || std::any_of(rows_[i].fields.begin(), rows_[i].fields.end(), has);
  }

  bool is_alike(std::size_t a, std::size_t b) const {
    return std::equal(rows_[a].fields.begin(), rows_[a].fields.end(), rows_[b].fields.begin(), rows_[b].fields.end(),
                      [](const TextField& x, const TextField& y) { return x.text == y.text; });
  }

  /// Lines of names of which there are several: each says units, or is the same as another.
  std::vector<std::size_t> names_of_several() const {
    std::vector<std::size_t> above, names;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (is_above_numbers(i)) above.push_back(i);
    }
    for (const std::size_t i : above) {
      const bool again =
          std::any_of(above.begin(), above.end(), [&](std::size_t j) { return i != j && is_alike(i, j); });
      if (again || says_units(i)) names.push_back(i);
    }
    return names;
  }

  TextRows rows_;
  char decimal_;
};

/// `1 in lines 8 to 12 (5 rows), 2 in …`.
std::string list_of(const std::vector<Table>& tables, TextRows rows) {
  std::string list;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const Table& t = tables[i];
    list += (i ? ", " : "") + std::to_string(i + 1);
    if (t.first < t.last)
      list += " in lines " + std::to_string(rows[t.first].line) + " to " + std::to_string(rows[t.last - 1].line);
    list += " (" + detail::count_text(t.last - t.first, "row", "rows") + ")";
  }
  return list;
}

Table chosen_table(const std::vector<Table>& tables, TextRows rows, const TextSpec& spec,
                   const std::filesystem::path& file) {
  const std::string count = detail::count_text(tables.size(), "interval", "intervals");
  if (spec.interval > tables.size())
    fail_in(file, rows.front().line,
            "has " + count + ", and interval = " + std::to_string(spec.interval) +
                " is asked for: " + list_of(tables, rows));
  if (spec.interval > 0) return tables[spec.interval - 1];
  std::vector<Table> long_ones;
  for (const Table& t : tables) {
    if (t.last - t.first >= kFewestOfCurve) long_ones.push_back(t);
  }
  if (tables.size() == 1 || long_ones.empty()) return tables.front();
  if (long_ones.size() == 1) return long_ones.front();
  fail_in(file, rows[tables[1].names].line,
          "holds " + count + ": " + list_of(tables, rows) + "; give interval = 1 to " + std::to_string(tables.size()));
}

/// The table that is meant.
Table find_table(TextRows rows, char decimal, const TextSpec& spec, const std::filesystem::path& file) {
  const Tables tables(rows, decimal);
  if (spec.names_line == 0) return chosen_table(tables.find(), rows, spec, file);
  const auto names =
      std::find_if(rows.begin(), rows.end(), [&](const TextRow& r) { return r.line == spec.names_line; });
  if (names == rows.end())
    fail_in(file, spec.names_line,
            "is said to hold the columns' names (`text.names_line`), but is blank or after the end");
  return tables.below(static_cast<std::size_t>(names - rows.begin()));
}

/// The names of the columns; of those that blanks part as many as there are columns, or none.
void take_names(CurveFile& result, TextRows rows, const Table& table) {
  const TextRow& line = rows[table.names];
  const bool blanks = result.separator == ' ';
  std::vector<TextField> names = blanks ? split_names(line.text, result.columns) : line.fields;
  if (names.empty()) return;
  result.names_line = line.line;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string_view name = names[i].text;
    if (i == 0 && name.starts_with('#')) name = detail::trimmed(name.substr(1));
    result.names.emplace_back(name);
    const auto* units = table.units ? &rows[table.names + 1].fields : nullptr;
    const bool below = units && i < units->size() && !(*units)[i].text.empty();
    result.units.push_back(below ? without_brackets((*units)[i].text) : split_title(name).unit);
  }
}

/// Whether a field and the next are one number whose mark of thousands has parted them.
bool is_parted_number(const std::string& before, const std::string& after) {
  return has_thousands(before + "," + after, '.');
}

[[noreturn]] void fail_parted(const CurveFile& file, const CurveFile::Row& row, std::size_t width,
                              const std::string& before, const std::string& after) {
  fail_in(file.file, row.line,
          "has " + std::to_string(row.fields.size()) + " fields where " + std::to_string(width) +
              " are expected: in \"" + before + ',' + after +
              "\" a comma parts thousands as well as columns; export with `;` or tabs between the columns, or with "
              "numbers in quotes");
}

/// Complains of rows wider than others because commas part columns and thousands alike.
void require_whole_numbers(const CurveFile& file) {
  if (file.separator != ',') return;
  std::size_t width = file.names.size();
  if (width == 0) {
    width = file.columns;
    for (const CurveFile::Row& row : file.rows) {
      if (row.fields.size() >= kFewestNumbers) width = std::min(width, row.fields.size());
    }
  }
  for (const CurveFile::Row& row : file.rows) {
    for (std::size_t i = 0; row.fields.size() > width && i + 1 < row.fields.size(); ++i) {
      const std::string &a = row.fields[i].text, &b = row.fields[i + 1].text;
      if (is_parted_number(a, b)) fail_parted(file, row, width, a, b);
    }
  }
}

/// Complains of a column in which one large number has a mark of thousands and another has not.
void require_one_notation(const CurveFile& file) {
  constexpr double kLeast = 1000.0;
  struct Seen {
    const CurveFile::Row *marked = nullptr, *bare = nullptr;
  };
  std::vector<Seen> seen;
  for (const CurveFile::Row& row : file.rows) {
    if (seen.size() < row.fields.size()) seen.resize(row.fields.size());
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      const std::string& text = row.fields[i].text;
      const auto value = parse_number(text, file.decimal);
      if (!value || std::abs(*value) < kLeast || text.find_first_of("eE") != std::string::npos) continue;
      const CurveFile::Row*& first = has_thousands(text, file.decimal) ? seen[i].marked : seen[i].bare;
      if (!first) first = &row;
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].marked || !seen[i].bare) continue;
    fail_in(file.file, seen[i].marked->line,
            "\"" + seen[i].marked->fields[i].text + "\" in " + file.title(i) + " has a mark of thousands, and \"" +
                seen[i].bare->fields[i].text + "\" in line " + std::to_string(seen[i].bare->line) +
                " has none; give text.decimal = \"" + (file.decimal == '.' ? "," : ".") +
                "\" if it is a decimal mark, or correct the file");
  }
}

/// Seconds as the file writes numbers, to a nanosecond.
std::string seconds_text(double seconds, char decimal) {
  char text[64];
  std::snprintf(text, sizeof text, "%.9f", seconds);
  std::string written = text;
  std::replace(written.begin(), written.end(), '.', decimal);
  return written;
}

/// Columns whose fields, in every row of numbers, are clock times of one meaning.
std::vector<bool> clock_columns(TextRows rows, char decimal) {
  std::vector<std::size_t> clocks, others;
  for (const TextRow& row : rows) {
    if (numbers_in(row, decimal) < kFewestNumbers) continue;
    if (clocks.size() < row.fields.size()) clocks.resize(row.fields.size()), others.resize(row.fields.size());
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      const bool clock = parse_clock(row.fields[i].text, decimal).has_value();
      clocks[i] += clock;
      others[i] += !clock && !is_missing(row.fields[i].text);
    }
  }
  std::vector<bool> found(clocks.size(), false);
  for (std::size_t i = 0; i < clocks.size(); ++i) found[i] = clocks[i] >= kFewestOfCurve && others[i] == 0;
  return found;
}

/// Puts seconds in the place of clock times, so that they are numbers as others are.
/// @return what was written in each row of each such column; empty for other columns
std::vector<std::map<std::uint32_t, std::string>> read_clocks(std::vector<TextRow>& rows, char decimal) {
  const std::vector<bool> columns = clock_columns(rows, decimal);
  std::vector<std::map<std::uint32_t, std::string>> written(columns.size());
  for (TextRow& row : rows) {
    for (std::size_t i = 0; i < std::min(columns.size(), row.fields.size()); ++i) {
      const auto seconds = columns[i] ? parse_clock(row.fields[i].text, decimal) : std::nullopt;
      if (!seconds) continue;
      written[i][row.line] = row.fields[i].text;
      row.fields[i].text = seconds_text(*seconds, decimal);
    }
  }
  return written;
}

/// Makes the numbers of clock times count from the first row of the table.
void count_from_first(CurveFile& file, const std::vector<std::map<std::uint32_t, std::string>>& written) {
  file.clocks.resize(written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    double first = 0.0;
    for (CurveFile::Row& row : file.rows) {
      const auto clock = written[i].find(row.line);
      if (clock == written[i].end()) continue;
      const double seconds = parse_clock(clock->second, file.decimal).value_or(0.0);
      if (file.clocks[i].empty()) file.clocks[i] = clock->second, first = seconds;
      row.fields[i].text = seconds_text(seconds - first, file.decimal);
    }
    if (file.is_clock(i) && i < file.units.size()) file.units[i] = "s";
  }
}

}  // namespace

std::string CurveFile::title(std::size_t column) const {
  if (column < names.size() && !names[column].empty()) return "\"" + names[column] + "\"";
  return "column " + std::to_string(column + 1);
}

CurveFile parse_curve_file(std::string text, const std::filesystem::path& file, const TextSpec& spec) {
  const DecodedText decoded = decode_text(std::move(text));
  if (!decoded.problem.empty()) fail_in(file, 1, decoded.problem);
  std::vector<TextRow> rows = lines_of(decoded.text);
  if (rows.empty()) fail_in(file, 1, "is empty; expected a line of names and rows of numbers");
  const TextStyle style = find_style(rows, spec, file);
  const auto clocks = read_clocks(rows, style.decimal);
  const Table table = find_table(rows, style.decimal, spec, file);
  if (table.first >= table.last) fail_in(file, rows.back().line, "has no rows of numbers below the columns' names");
  CurveFile result;
  result.file = file;
  result.separator = style.separator;
  result.decimal = style.decimal;
  const TextRows numbers = TextRows(rows).subspan(table.first, table.last - table.first);
  result.columns = usual_width(numbers, style.decimal);
  if (table.named) take_names(result, rows, table);
  for (const TextRow& row : numbers) result.rows.push_back({row.line, row.fields});
  count_from_first(result, clocks);
  require_whole_numbers(result);
  require_one_notation(result);
  return result;
}

CurveFile read_curve_file(const std::filesystem::path& file, const TextSpec& spec) {
  detail::InputFile input = detail::read_input(file, detail::kTableInput);
  if (!input.problem.empty()) throw SceneError(input.problem);
  return parse_curve_file(std::move(input.bytes), file, spec);
}

}  // namespace glisson::fit

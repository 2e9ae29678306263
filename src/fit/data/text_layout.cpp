#include "fit/data/text_layout.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/text.h"
#include "fit/data/measured_number.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kLinesLookedAt = 2000;

// In order of preference, where two read the same numbers.
constexpr std::array kStyles{TextStyle{';', '.'}, TextStyle{';', ','}, TextStyle{'\t', '.'}, TextStyle{'\t', ','},
                             TextStyle{',', '.'}, TextStyle{',', ','}, TextStyle{' ', '.'},  TextStyle{' ', ','}};

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

/// Fields between runs of at least `fewest` blanks.
std::vector<TextField> split_at_blanks(std::string_view line, std::size_t fewest) {
  std::vector<TextField> fields;
  const std::string run(fewest, ' ');
  for (std::size_t at = line.find_first_not_of(' '); at < line.size(); at = line.find_first_not_of(' ', at)) {
    const auto column = static_cast<std::uint32_t>(at + 1);
    std::string word;
    if (line[at] == '"') word = quoted_field(line, at);
    const std::size_t end = std::min(line.find(run, std::min(at, line.size())), line.size());
    if (at < end) word += line.substr(at, end - at);
    fields.push_back({std::string(detail::trimmed(word)), column});
    at = end;
  }
  return fields;
}

/// Words of one blank, with a unit in brackets joined to the name before it, and without a mark of comments.
std::vector<TextField> split_words(std::string_view line) {
  std::vector<TextField> words;
  for (TextField& word : split_at_blanks(line, 1)) {
    const bool mark = words.empty() && (word.text == "#" || word.text == "%" || word.text == "//");
    const bool unit = !words.empty() && (word.text.front() == '(' || word.text.front() == '[');
    if (unit)
      words.back().text += " " + word.text;
    else if (!mark)
      words.push_back(std::move(word));
  }
  return words;
}

/// A field that holds another separator has been split at the wrong one, and so has one with a blank between numbers
/// where commas may be decimal marks.
bool is_split_wrongly(const TextRow& row, TextStyle style) {
  return std::any_of(row.fields.begin(), row.fields.end(), [&](const TextField& f) {
    const bool other = f.text.find_first_of(";\t") != std::string::npos;
    const bool several =
        style.separator == ',' && f.text.find(' ') != std::string::npos && parse_number(f.text, style.decimal);
    return other || several;
  });
}

/// Every so-manieth line: enough to tell the style.
std::vector<const TextRow*> some_of(const std::vector<TextRow>& rows) {
  std::vector<const TextRow*> some;
  const std::size_t step = rows.size() / kLinesLookedAt + 1;
  for (std::size_t i = 0; i < rows.size(); i += step) some.push_back(&rows[i]);
  return some;
}

/// How well a style explains the lines: the numbers it finds, each counted by the share of its line that is numbers.
double score(const std::vector<const TextRow*>& rows, TextStyle style) {
  double sum = 0.0;
  for (const TextRow* row : rows) {
    const TextRow parted{row->line, row->text, split_line(row->text, style.separator)};
    const auto numbers = static_cast<double>(numbers_in(parted, style.decimal));
    if (numbers >= kFewestNumbers && !is_split_wrongly(parted, style))
      sum += numbers * numbers / static_cast<double>(parted.fields.size());
  }
  return sum;
}

/// Fields that are one number with either decimal mark, by column.
struct TwofoldColumn {
  std::size_t twofold = 0;  ///< such as `1,234`: 1.234 or 1234
  std::size_t plain = 0;    ///< the same with both
  std::uint32_t line = 0;   ///< of the first twofold one
  std::string text;
};

std::vector<TwofoldColumn> twofold_columns(const std::vector<const TextRow*>& rows, char separator) {
  std::vector<TwofoldColumn> columns;
  for (const TextRow* row : rows) {
    const TextRow parted{row->line, row->text, split_line(row->text, separator)};
    if (numbers_in(parted, '.') < kFewestNumbers) continue;
    for (std::size_t i = 0; i < parted.fields.size(); ++i) {
      const auto with_point = parse_number(parted.fields[i].text, '.'),
                 with_comma = parse_number(parted.fields[i].text, ',');
      if (columns.size() <= i) columns.resize(i + 1);
      TwofoldColumn& column = columns[i];
      if (!with_point || !with_comma) continue;
      if (*with_point == *with_comma) {
        ++column.plain;
      } else if (++column.twofold == 1) {
        column.line = row->line;
        column.text = parted.fields[i].text;
      }
    }
  }
  return columns;
}

/// The decimal mark of numbers that read alike well with both: a column whose every number has the mark writes three decimals;
/// one with whole numbers between them may be either.
char decimal_of_twofold(const std::vector<const TextRow*>& rows, TextStyle best, const std::filesystem::path& file) {
  for (const TwofoldColumn& column : twofold_columns(rows, best.separator)) {
    if (column.twofold == 0) continue;
    if (column.plain == 0) return column.text.find(',') == std::string::npos ? '.' : ',';
    fail_in(file, column.line,
            "\"" + column.text +
                "\" may have a decimal mark or one of thousands; give text.decimal = \".\" or \",\", which of the two "
                "is decimal");
  }
  return best.decimal;
}

}  // namespace

void fail_in(const std::filesystem::path& file, std::uint32_t line, const std::string& what) {
  throw SceneError(file.string() + ":" + std::to_string(line) + ":1: " + what);
}

std::vector<TextRow> lines_of(std::string_view text) {
  std::vector<TextRow> lines;
  std::uint32_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    ++number;
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (!detail::trimmed(line).empty()) lines.push_back({number, line, {}});
    at = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return lines;
}

std::vector<TextField> split_line(std::string_view text, char separator) {
  if (separator == ' ') return split_at_blanks(text, 1);
  std::vector<TextField> fields;
  for (std::size_t at = 0; at <= text.size();) {
    while (at < text.size() && text[at] == ' ') ++at;
    const auto column = static_cast<std::uint32_t>(at + 1);
    std::string word;
    if (at < text.size() && text[at] == '"') word = quoted_field(text, at);
    const std::size_t end = std::min(text.find(separator, std::min(at, text.size())), text.size());
    if (at < end) word += text.substr(at, end - at);
    fields.push_back({std::string(detail::trimmed(word)), column});
    at = end + 1;
  }
  while (fields.size() > 1 && fields.back().text.empty()) fields.pop_back();
  return fields;
}

std::vector<TextField> split_names(std::string_view line, std::size_t columns) {
  std::vector<TextField> names = split_at_blanks(line, 2);
  if (names.size() != columns) names = split_words(line);
  return names.size() == columns ? names : std::vector<TextField>{};
}

std::size_t numbers_in(const TextRow& row, char decimal) {
  return static_cast<std::size_t>(std::count_if(row.fields.begin(), row.fields.end(), [&](const TextField& f) {
    return parse_number(f.text, decimal).has_value();
  }));
}

TextStyle find_style(std::vector<TextRow>& rows, const TextSpec& spec, const std::filesystem::path& file) {
  const std::vector<const TextRow*> some = some_of(rows);
  std::optional<TextStyle> best;
  double most = 0.0;
  bool twofold = false;
  for (const TextStyle style : kStyles) {
    if ((spec.separator && style.separator != spec.separator) || (spec.decimal && style.decimal != spec.decimal))
      continue;
    const double reached = score(some, style);
    if (reached > 0.0 && reached == most && best->separator == style.separator) twofold = true;
    if (!(reached > most)) continue;
    most = reached;
    best = style;
    twofold = false;
  }
  if (!best)
    fail_in(file, rows.front().line,
            "has no rows of numbers: no line has two or more, separated by `,`, `;`, tab or blanks; check the file, or "
            "say `text.separator` and `text.decimal`");
  const bool quoted =
      std::any_of(some.begin(), some.end(), [](const TextRow* r) { return r->text.find('"') != r->text.npos; });
  const bool comma_parts = best->separator == ',' && !quoted;  // then it stands in no number
  if (twofold && !comma_parts) best->decimal = decimal_of_twofold(some, *best, file);
  for (TextRow& row : rows) row.fields = split_line(row.text, best->separator);
  return *best;
}

}  // namespace glisson::fit

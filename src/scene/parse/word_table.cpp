#include "scene/parse/word_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/input_file.h"

namespace glisson::scene {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string> fields(std::string_view line) {
  std::vector<std::string> found;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    found.emplace_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return found;
}

}  // namespace

std::size_t WordTable::column(const std::string& name) const {
  return static_cast<std::size_t>(std::find(names.words.begin(), names.words.end(), name) - names.words.begin());
}

double WordTable::number(const Row& row, std::size_t column) {
  const std::string text = column < row.words.size() ? row.words[column] : std::string{};
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return value;
  throw std::runtime_error(row.where + ": \"" + text + "\" in column " + std::to_string(column + 1) +
                           " is no finite number");
}

WordTable read_word_table(const std::filesystem::path& file) {
  detail::InputFile input = detail::read_input(file, detail::kTableInput);
  if (!input.problem.empty()) throw std::runtime_error(input.problem);
  std::istringstream in(std::move(input.bytes));
  WordTable table;
  std::string line;
  for (std::size_t n = 1; std::getline(in, line); ++n) {
    if (trimmed(line).empty() || line.front() == '#') continue;
    WordTable::Row row{file.string() + ":" + std::to_string(n), fields(line)};
    if (table.names.words.empty())
      table.names = std::move(row);
    else
      table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace glisson::scene

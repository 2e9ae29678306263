#include "report/csv_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "report/output_file.h"

namespace glisson {
namespace {

constexpr std::size_t kPageRows = 2000;  // of forces in the page; forces.csv has them all
constexpr std::size_t kFirstRows = 100;  // of them kept one by one: the start is where overheads appear
constexpr int kPageDigits = 7;

template <class Values, class Text>
std::string joined(const Values& values, Text text) {
  std::string line;
  for (const auto& value : values) {
    if (!line.empty()) line += ',';
    line += text(value);
  }
  return line;
}

/// A number of 7 digits: what a plot needs, at half the length.
double short_number(double value) {
  if (!std::isfinite(value)) return value;
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, kPageDigits).ptr;
  double rounded = 0.0;
  std::from_chars(text.data(), end, rounded);
  return rounded;
}

/// Rows the page shows of `rows`: all of a short table, else the first hundred and then evenly spaced ones to the last.
std::vector<std::size_t> page_rows(std::size_t rows) {
  std::vector<std::size_t> kept;
  const std::size_t first = std::min(rows, rows <= kPageRows ? rows : kFirstRows);
  for (std::size_t i = 0; i < first; ++i) kept.push_back(i);
  const std::size_t left = rows - first;
  const std::size_t wanted = std::min(left, kPageRows - std::min(first, kPageRows));
  for (std::size_t k = 1; k <= wanted; ++k) kept.push_back(first + left * k / wanted - 1);
  return kept;
}

}  // namespace

std::string csv_line(const std::vector<std::string>& names) {
  return joined(names, [](const std::string& name) { return name; });
}

std::string csv_line(const std::vector<double>& row) { return joined(row, number_text); }

nlohmann::json table_json(const std::vector<std::string>& columns, const std::vector<std::vector<double>>& table) {
  const std::vector<std::size_t> rows = page_rows(table.empty() ? 0 : table.front().size());
  nlohmann::json data = nlohmann::json::array();
  for (const std::vector<double>& column : table) {
    std::vector<double> kept;
    kept.reserve(rows.size());
    for (const std::size_t row : rows) kept.push_back(short_number(column[row]));
    data.push_back(std::move(kept));
  }
  return {{"columns", columns}, {"data", std::move(data)}};
}

}  // namespace glisson

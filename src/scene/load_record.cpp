// load_record.cpp — a recorded way from a .csv: names first, then a line for each time.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "glisson/scene.h"

namespace glisson {
namespace {

constexpr std::size_t kMostLines = 10'000'000;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + ": " + what);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> found;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    found.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return found;
}

/// A column and the factor that takes its unit to metres.
struct Column {
  std::size_t at = 0;
  double scale = 1.0;
};

std::optional<Column> column(const std::vector<std::string_view>& names, const std::string& what) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == what + "_m") return Column{i, 1.0};
    if (names[i] == what + "_mm") return Column{i, 1e-3};
  }
  return {};
}

/// Where time and place are in a line.
struct Layout {
  std::size_t time = 0;
  std::optional<Column> depth;
  std::array<Column, 3> place{};

  Layout(const std::string& where, const std::vector<std::string_view>& names) : depth(column(names, "depth")) {
    const auto found = std::find(names.begin(), names.end(), "time_s");
    if (found == names.end()) fail(where, "no column `time_s`; the first line names the columns: time_s, depth_m");
    time = static_cast<std::size_t>(found - names.begin());
    if (depth) return;
    const auto x = column(names, "x"), y = column(names, "y"), z = column(names, "z");
    if (!x || !y || !z) fail(where, "neither `depth_m` nor `x_m`, `y_m` and `z_m` (or _mm) are among the columns");
    place = {*x, *y, *z};
  }
};

double number(const std::string& where, const std::vector<std::string_view>& line, std::size_t at) {
  const std::string_view text = at < line.size() ? line[at] : std::string_view{};
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return value;
  fail(where, "\"" + std::string(text) + "\" in column " + std::to_string(at + 1) + " is no finite number");
}

}  // namespace

RecordedMotion load_record(const std::filesystem::path& file, const Vec3d& direction) {
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(file, error)) in.open(file, std::ios::binary);
  if (!in.is_open()) fail(file.string(), "cannot be read; check the path and that you may read it");
  RecordedMotion record;
  std::optional<Layout> layout;
  std::string line;
  for (std::size_t n = 1; std::getline(in, line) && n <= kMostLines; ++n) {
    const std::string where = file.string() + ":" + std::to_string(n);
    if (trimmed(line).empty() || line.front() == '#') continue;
    const std::vector<std::string_view> words = fields(line);
    if (!layout) {
      layout.emplace(where, words);
      continue;
    }
    const double time = number(where, words, layout->time);
    if (!record.times.empty() && time <= record.times.back()) {
      fail(where, "time_s = " + std::string(words[layout->time]) + " is not later than on the line before");
    }
    const auto metres = [&](const Column& c) { return c.scale * number(where, words, c.at); };
    const auto& [x, y, z] = layout->place;
    record.times.push_back(time);
    record.positions.push_back(layout->depth ? direction * metres(*layout->depth)
                                             : Vec3d{metres(x), metres(y), metres(z)});
  }
  if (in.bad()) fail(file.string(), "cannot be read to its end");
  if (record.times.size() < 2) fail(file.string(), "holds fewer than two times; a way needs two or more");
  return record;
}

}  // namespace glisson

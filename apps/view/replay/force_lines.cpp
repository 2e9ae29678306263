// force_lines.cpp — see force_lines.h.
#include "view/replay/force_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glisson::view {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    words.push_back(line.substr(at, comma - at));
    if (comma == std::string_view::npos) return words;
    at = comma + 1;
  }
}

std::optional<double> number(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// One table, read line by line.
class Table {
 public:
  explicit Table(const std::filesystem::path& file) : stream_(file, std::ios::binary) {
    std::getline(stream_, line_);
    const std::vector<std::string_view> names = words_of(line_);
    columns_ = names.size();
    constexpr std::array<std::string_view, 3> kNames{"time_s", "depth_m", "force_N"};
    for (std::size_t k = 0; k < 3; ++k) {
      place_[k] = static_cast<std::size_t>(std::find(names.begin(), names.end(), kNames[k]) - names.begin());
      if (place_[k] == columns_)
        throw std::runtime_error(file.string() + ": no column " + std::string(kNames[k]) + " in its first line");
    }
  }

  /// Time, depth and force of the next line; none at the end, or where it was cut off.
  std::optional<std::array<double, 3>> next() {
    if (!std::getline(stream_, line_) || stream_.eof()) return {};  // a line that was finished has an end
    const std::vector<std::string_view> words = words_of(line_);
    if (words.size() != columns_) return {};
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<double> value = number(words[place_[k]]);
      if (!value) return {};
      values[k] = *value;
    }
    return values;
  }

 private:
  std::ifstream stream_;
  std::string line_;
  std::size_t columns_ = 0;
  std::array<std::size_t, 3> place_{};
};

double strength(const ForceLine& line) {
  double most = 0.0;
  for (const double f : line.force) most = std::max(most, std::isfinite(f) ? std::abs(f) : 0.0);
  return most;
}

/// Keeps of each `run` lines the strongest; the last line stays.
void merge(std::vector<ForceLine>& lines, std::size_t run) {
  const ForceLine last = lines.back();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lines.size(); i += run) {
    const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = lines.begin() + static_cast<std::ptrdiff_t>(std::min(i + run, lines.size()));
    lines[kept++] =
        *std::max_element(begin, end, [](const auto& a, const auto& b) { return strength(a) < strength(b); });
  }
  lines[kept - 1] = last;
  lines.resize(kept);
}

}  // namespace

std::vector<ForceLine> read_forces(std::span<const std::filesystem::path> files, std::size_t most) {
  std::vector<Table> tables;
  for (const auto& file : files.first(std::min(files.size(), kMostTools))) tables.emplace_back(file);
  std::vector<ForceLine> lines;
  while (!tables.empty()) {
    ForceLine line;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const auto values = tables[i].next();
      if (!values) return thinned(std::move(lines), most);
      if (i == 0) line.time = (*values)[0];
      line.depth[i] = (*values)[1];
      line.force[i] = (*values)[2];
    }
    if (!lines.empty() && line.time <= lines.back().time) continue;
    lines.push_back(line);
    if (lines.size() >= 4 * most) merge(lines, 2);
  }
  return lines;
}

std::vector<ForceLine> thinned(std::vector<ForceLine> lines, std::size_t most) {
  if (lines.size() > most) merge(lines, (lines.size() + most - 1) / most);
  return lines;
}

ForceLine forces_at(std::span<const ForceLine> lines, double time) {
  const auto after =
      std::lower_bound(lines.begin(), lines.end(), time, [](const ForceLine& x, double t) { return x.time < t; });
  if (after == lines.begin()) return lines.front();
  if (after == lines.end()) return lines.back();
  const ForceLine &a = *(after - 1), &b = *after;
  const double share = (time - a.time) / (b.time - a.time);
  ForceLine line{.time = time};
  for (std::size_t k = 0; k < kMostTools; ++k) {
    line.depth[k] = a.depth[k] * (1.0 - share) + b.depth[k] * share;
    line.force[k] = a.force[k] * (1.0 - share) + b.force[k] * share;
  }
  return line;
}

}  // namespace glisson::view

// load_record.cpp — a recorded path, or poses, from a .csv: names first, then a line for each time.
#include <array>
#include <optional>
#include <string>

#include "glisson/scene/scene.h"
#include "scene/parse/word_table.h"

namespace glisson {
namespace {

using scene::WordTable;

/// A column and the factor that takes its unit to metres.
struct Column {
  std::size_t at = 0;
  double scale = 1.0;
};

std::optional<Column> length_column(const WordTable& table, const std::string& what) {
  const std::size_t m = table.column(what + "_m"), mm = table.column(what + "_mm"), all = table.names.words.size();
  if (m < all) return Column{m, 1.0};
  if (mm < all) return Column{mm, 1e-3};
  return {};
}

/// Where time and place are in a line.
struct Layout {
  std::size_t time = 0;
  std::optional<Column> depth;
  std::array<Column, 3> place{};

  explicit Layout(const WordTable& table) : time(table.column("time_s")), depth(length_column(table, "depth")) {
    if (time == table.names.words.size()) {
      throw std::runtime_error(table.names.where +
                               ": no column `time_s`; the first line names the columns: time_s, depth_m");
    }
    if (depth) return;
    const auto x = length_column(table, "x"), y = length_column(table, "y"), z = length_column(table, "z");
    if (!x || !y || !z) {
      throw std::runtime_error(table.names.where +
                               ": neither `depth_m` nor `x_m`, `y_m` and `z_m` (or _mm) are among the columns");
    }
    place = {*x, *y, *z};
  }

  Vec3d place_of(const WordTable::Row& row, const Vec3d& direction) const {
    const auto metres = [&](const Column& c) { return c.scale * WordTable::number(row, c.at); };
    if (depth) return direction * metres(*depth);
    return {metres(place[0]), metres(place[1]), metres(place[2])};
  }
};

}  // namespace

RecordedMotion load_record(const std::filesystem::path& file, const Vec3d& direction) {
  const WordTable table = scene::read_word_table(file);
  RecordedMotion record;
  if (table.rows.size() >= 2) {
    const Layout layout(table);
    for (const WordTable::Row& row : table.rows) {
      const double time = WordTable::number(row, layout.time);
      if (!record.times.empty() && time <= record.times.back()) {
        throw std::runtime_error(row.where + ": time_s = " + row.words[layout.time] +
                                 " is not later than on the line before");
      }
      record.times.push_back(time);
      record.positions.push_back(layout.place_of(row, direction));
    }
    return record;
  }
  if (!table.names.words.empty()) Layout{table};
  throw std::runtime_error(file.string() + ": holds fewer than two times; a way needs two or more");
}

PosesMotion load_poses(const std::filesystem::path& file) {
  const WordTable table = scene::read_word_table(file);
  constexpr std::array<const char*, 8> kNames{"time_s", "x", "y", "z", "qw", "qx", "qy", "qz"};
  std::array<Column, 8> columns;
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const std::size_t at = table.column(kNames[k]);
    const bool length = k >= 1 && k <= 3;
    const auto found = length                          ? length_column(table, kNames[k])
                       : at < table.names.words.size() ? std::optional<Column>(Column{at, 1.0})
                                                       : std::nullopt;
    if (!found) {
      throw std::runtime_error(table.names.where + ": no column `" + kNames[k] + (length ? "_m` (or _mm)" : "`") +
                               "; the first line names the columns: time_s, x_m, y_m, z_m, qw, qx, qy, qz");
    }
    columns[k] = *found;
  }
  PosesMotion poses;
  for (const WordTable::Row& row : table.rows) {
    const auto number = [&](std::size_t k) { return columns[k].scale * WordTable::number(row, columns[k].at); };
    if (!poses.times.empty() && number(0) <= poses.times.back()) {
      throw std::runtime_error(row.where + ": time_s = " + row.words[columns[0].at] +
                               " is not later than on the line before");
    }
    poses.times.push_back(number(0));
    poses.positions.push_back({number(1), number(2), number(3)});
    poses.quaternions.push_back({number(4), number(5), number(6), number(7)});
    if (poses.quaternions.back() == std::array<double, 4>{}) {
      throw std::runtime_error(row.where +
                               ": the quaternion is 0, which is no rotation; that by 0 is qw = 1, qx = qy = qz = 0");
    }
  }
  if (poses.times.size() < 2)
    throw std::runtime_error(file.string() + ": holds fewer than two poses; give a line for each of two or more times");
  return poses;
}

}  // namespace glisson

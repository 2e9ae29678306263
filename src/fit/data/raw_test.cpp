#include "fit/data/raw_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/data/choose_column.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kBadRowsShown = 3;
constexpr double kLargest = 1e30;  // of any number in SI: squares and sums of it stay finite

/// A column and what turns its numbers into SI.
struct Reading {
  ChosenColumn column;
  double factor = 1.0;
  Sign sign = Sign::found;
};

struct Readings {
  std::optional<Reading> time, displacement, force;
};

std::optional<Reading> reading(std::optional<ChosenColumn> column, double size, Sign sign) {
  if (!column) return std::nullopt;
  const double factor = column->source.unit->factor * size;
  return Reading{std::move(*column), factor, sign};
}

/// A way from the column of the way, or of the strain; a force from that of the force, or of the stress.
std::optional<Reading> way_or_force(const CurveFile& file, const ColumnSpec& own, const ColumnSpec& relative, bool way,
                                    const std::optional<double>& size, scene::Problems& problems) {
  const Quantity quantity = way ? Quantity::length : Quantity::force;
  const std::string key = way ? "columns.displacement" : "columns.force";
  if (own.given) return reading(choose_column(file, own, quantity, key, problems), 1.0, own.sign);
  if (!relative.given) return reading(guess_column(file, quantity, key, problems), 1.0, own.sign);
  const std::string relative_key = way ? "columns.strain" : "columns.stress";
  if (!size) {
    problems.add({1, 1, {}}, relative_key,
                 way ? "needs the height of the specimen to be converted to a displacement; give height_mm"
                     : "needs the area of the specimen to be converted to a force; give area_mm2");
    return std::nullopt;
  }
  return reading(choose_column(file, relative, way ? Quantity::strain : Quantity::stress, relative_key, problems),
                 *size, relative.sign);
}

Readings choose(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems) {
  const ColumnsSpec& c = spec.columns;
  Readings found;
  if (c.time.given)
    found.time = reading(choose_column(file, c.time, Quantity::time, "columns.time", problems), 1.0, Sign::positive);
  else if (!spec.speed)
    found.time = reading(guess_column(file, Quantity::time, "columns.time", problems), 1.0, Sign::positive);
  found.displacement = way_or_force(file, c.displacement, c.strain, true, size.height, problems);
  found.force = way_or_force(file, c.force, c.stress, false, size.area, problems);
  return found;
}

/// Why a field is no number: in the file's words.
std::string fault_of(const CurveFile& file, const CurveFile::Row& row, const ChosenColumn& column) {
  if (column.index >= row.fields.size())
    return "has " + std::to_string(row.fields.size()) + " fields, none for " + column.source.title;
  const std::string& text = row.fields[column.index].text;
  const char* fault = parse_number(text, file.decimal) ? "\" is beyond any measurement" : "\" is no finite number";
  std::string what = text.empty() ? "is empty" : "\"" + text.substr(0, 40) + fault;
  const bool other_mark =
      !parse_number(text, file.decimal) && parse_number(text, file.decimal == ',' ? '.' : ',').has_value();
  if (other_mark)
    what += std::string(" with decimal `") + file.decimal + "`; say text.decimal, or choose another column";
  return what + " in " + column.source.title;
}

struct Rows {
  const CurveFile& file;
  const DataSpec& spec;
  scene::Problems& problems;
  std::size_t bad = 0;

  /// The numbers of the columns in a row; complains of the first that is none.
  std::optional<std::vector<double>> numbers(const CurveFile::Row& row, const std::vector<const Reading*>& readings) {
    std::vector<double> values;
    for (const Reading* r : readings) {
      const std::size_t i = r->column.index;
      const auto value = i < row.fields.size() ? parse_number(row.fields[i].text, file.decimal) : std::nullopt;
      if (!value || !(std::abs(*value * r->factor) < kLargest)) {
        complain(row, r->column);
        return std::nullopt;
      }
      values.push_back(*value * r->factor);
    }
    return values;
  }

  void complain(const CurveFile::Row& row, const ChosenColumn& column) {
    ++bad;
    if (spec.skip_bad_rows || bad > kBadRowsShown) return;
    const std::uint32_t at = column.index < row.fields.size() ? row.fields[column.index].column : 1;
    problems.add({row.line, at, {}}, "",
                 fault_of(file, row, column) + "; correct the row, or give skip_bad_rows = true");
  }

  void finish(std::size_t good) {
    const std::uint32_t line = file.rows.back().line;
    if (!spec.skip_bad_rows && bad > kBadRowsShown)
      problems.add({line, 1, {}}, "",
                   std::to_string(bad) + " of " + std::to_string(bad + good) + " rows are bad, the first " +
                       std::to_string(kBadRowsShown) + " named above");
    if (spec.skip_bad_rows && good == 0)
      problems.add({line, 1, {}}, "",
                   "all " + std::to_string(bad) + " rows are bad; check the columns and their units");
  }
};

/// −1 where the number farthest from the start lies below it. The start is the median of the first percent of the rows, of
/// one row at least and five at most: a bad first row of many decides nothing, and a sparse curve has gone nowhere yet.
double direction_of(const std::vector<double>& values, Sign sign) {
  if (sign != Sign::found) return sign == Sign::positive ? 1.0 : -1.0;
  if (values.empty()) return 1.0;
  const std::size_t rows = std::clamp<std::size_t>(values.size() / 100, 1, 5);
  std::vector<double> first(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows));
  std::nth_element(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(first.size() / 2), first.end());
  const double start = first[first.size() / 2];
  const auto farther = [&](double a, double b) { return std::abs(a - start) < std::abs(b - start); };
  return *std::max_element(values.begin(), values.end(), farther) < start ? -1.0 : 1.0;
}

/// @return whether the numbers were turned
bool turn(std::vector<double>& values, Sign sign) {
  if (direction_of(values, sign) > 0.0) return false;
  for (double& v : values) v = -v;
  return true;
}

/// The way so far over the speed.
std::vector<double> time_of(const std::vector<double>& way, double speed) {
  std::vector<double> time(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) time[i] = time[i - 1] + std::abs(way[i] - way[i - 1]) / speed;
  return time;
}

/// What is wrong with the time of row `now` after row `before`.
std::string backward(const RawTest& test, std::size_t before, std::size_t now) {
  constexpr int kDigits = 9;
  const double unit = test.time_source.unit ? test.time_source.unit->factor : 1.0;
  const std::string name = test.time_source.unit ? std::string(test.time_source.unit->name) : "s";
  std::string text = "time goes back: ";
  text.append(brief(test.time[now] / unit, kDigits))
      .append(" ")
      .append(name)
      .append(" in ")
      .append(test.time_source.title);
  text.append(" after ").append(brief(test.time[before] / unit, kDigits)).append(" ").append(name).append(" in line ");
  return text.append(std::to_string(test.lines[before]))
      .append("; it must not fall: sort the rows, split repeated tests into files, or choose another column");
}

/// Rows of one time become their mean; complains of times that go back.
void merge_times(RawTest& test, const CurveFile& file, scene::Problems& problems) {
  std::size_t kept = 0, back = 0;
  double count = 1.0;
  for (std::size_t i = 1; i < test.size(); ++i) {
    if (test.time[i] < test.time[kept] && ++back <= kBadRowsShown)
      problems.add({test.lines[i], 1, {}}, "", backward(test, kept, i));
    const bool same = test.time[i] == test.time[kept];
    test.rows_merged += same;
    count = same ? count + 1.0 : 1.0;
    if (!same) ++kept;
    const auto take = [&](std::vector<double>& v) { v[kept] = same ? v[kept] + (v[i] - v[kept]) / count : v[i]; };
    for (auto* v : {&test.time, &test.displacement, &test.force}) take(*v);
    for (CheckColumn& c : test.checks) take(c.values);
    test.lines[kept] = test.lines[i];
  }
  if (back > kBadRowsShown)
    problems.add({file.rows.back().line, 1, {}}, "", "time goes back " + std::to_string(back) + " times in all");
  const std::size_t size = test.size() > 0 ? kept + 1 : 0;
  for (auto* v : {&test.time, &test.displacement, &test.force}) v->resize(size);
  for (CheckColumn& c : test.checks) c.values.resize(size);
  test.lines.resize(size);
}

void read_checks(RawTest& test, const std::vector<ChosenColumn>& columns, const CurveFile& file,
                 const CurveFile::Row& row) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::size_t i = columns[c].index;
    const auto value = i < row.fields.size() ? parse_number(row.fields[i].text, file.decimal) : std::nullopt;
    test.checks[c].values.push_back(value ? *value * columns[c].source.unit->factor
                                          : std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

RawTest raw_test(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems) {
  RawTest test;
  test.file = file.file;
  test.names_line = file.names_line;
  test.separator = file.separator;
  test.decimal = file.decimal;
  const std::size_t before = problems.count();
  const Readings from = choose(file, spec, size, problems);
  if (problems.count() > before || !from.displacement || !from.force) return test;
  std::vector<const Reading*> readings{&*from.displacement, &*from.force};
  if (from.time) readings.push_back(&*from.time);
  const std::vector<ChosenColumn> checked = check_columns(file);
  for (const ChosenColumn& c : checked) test.checks.push_back({c.source, {}});
  Rows rows{file, spec, problems};
  for (const CurveFile::Row& row : file.rows) {
    const auto values = rows.numbers(row, readings);
    if (!values) continue;
    test.lines.push_back(row.line);
    test.displacement.push_back((*values)[0]);
    test.force.push_back((*values)[1]);
    if (from.time) test.time.push_back((*values)[2]);
    read_checks(test, checked, file, row);
  }
  rows.finish(test.lines.size());
  test.rows_skipped = rows.bad;
  for (const auto& [values, reading] :
       {std::pair{&test.displacement, &*from.displacement}, {&test.force, &*from.force}}) {
    if (turn(*values, reading->sign)) test.turned.push_back(reading->column.source.title);
  }
  if (!from.time) test.time = time_of(test.displacement, *spec.speed);
  test.displacement_source = from.displacement->column.source;
  test.force_source = from.force->column.source;
  test.time_source = from.time ? from.time->column.source : Source{"speed_mm_s", Quantity::time, nullptr};
  merge_times(test, file, problems);
  return test;
}

}  // namespace glisson::fit

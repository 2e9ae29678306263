#include "fit/data/raw_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "fit/data/choose_column.h"
#include "fit/data/clock_time.h"
#include "fit/data/samples.h"
#include "fit/data/test_columns.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kBadRowsShown = 3;
constexpr std::size_t kFewestLoading = 3;  // rows that tell a direction
constexpr double kLargest = 1e30;          // of any number in SI: squares and sums of it stay finite

/// A column and what turns its numbers into SI.
struct Reading {
  ChosenColumn column;
  double factor = 1.0;
};

Reading reading(const ChosenColumn& column) { return {column, column.source.unit->factor}; }

/// Why a field is no number: in the file's words.
std::string fault_of(const CurveFile& file, const CurveFile::Row& row, const ChosenColumn& column) {
  if (column.index >= row.fields.size())
    return "has " + std::to_string(row.fields.size()) + " fields, none for " + column.source.title;
  const std::string& text = row.fields[column.index].text;
  if (is_twofold_clock(text))
    return "\"" + text + "\" in " + column.source.title +
           " is minutes and seconds, or hours and minutes; write hours, minutes and seconds (00:" + text +
           "), or seconds alone, or choose another column";
  const char* fault = parse_number(text, file.decimal) ? "\" is beyond any measurement" : "\" is no finite number";
  std::string what = text.empty() ? "is empty" : "\"" + text.substr(0, 40) + fault;
  const bool other_mark =
      !parse_number(text, file.decimal) && parse_number(text, file.decimal == ',' ? '.' : ',').has_value();
  if (other_mark)
    what += std::string(" with decimal `") + file.decimal + "`; say text.decimal, or choose another column";
  return what + " in " + column.source.title;
}

/// Rows without a number that is needed: which of a test, and what is wrong with the first.
class LostRows {
 public:
  void add(std::size_t row, std::uint32_t line, std::uint32_t column, std::string fault) {
    rows_.push_back(row);
    lines_.push_back(line);
    if (faults_.size() < kBadRowsShown) faults_.push_back({{line, column, {}}, std::move(fault)});
  }

  std::size_t count() const { return rows_.size(); }

  /// Complains of them where they are not to be skipped, or are too many or too near to each other to be slips.
  void complain(std::size_t of, bool skip, scene::Problems& problems) const {
    if (rows_.empty()) return;
    const std::string loss = loss_of(of);
    if (skip && loss.empty()) return;
    for (const auto& [origin, fault] : faults_)
      problems.add(origin, "", fault + (loss.empty() ? "; correct the row, or give skip_bad_rows = true" : ""));
    const std::string count =
        std::to_string(rows_.size()) + " of " + std::to_string(of) + " rows are bad" +
        (rows_.size() > kBadRowsShown ? ", the first " + std::to_string(kBadRowsShown) + " named above"
                                      : std::string{});
    if (!loss.empty())
      problems.add({lines_.back(), 1, {}}, "",
                   count + ": " + loss + (skip ? ", too much for skip_bad_rows" : "") +
                       "; correct them, choose another column, or say text.separator and text.decimal");
    else if (rows_.size() > kBadRowsShown)
      problems.add({lines_.back(), 1, {}}, "", count);
  }

 private:
  struct Fault {
    scene::Origin origin;
    std::string text;
  };

  /// What of a test would be lost with these rows; empty: nothing, they are scattered slips.
  std::string loss_of(std::size_t of) const {
    constexpr double kMost = 0.05, kLongestRun = 0.01;  // of the rows
    const auto part = [&](double share, std::size_t least) {
      return std::max(least, static_cast<std::size_t>(share * static_cast<double>(of)));
    };
    if (rows_.size() == of) return "all of the test";
    if (rows_.size() > part(kMost, 1)) return "more than a twentieth of the test";
    std::size_t begin = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (i > 0 && rows_[i] != rows_[i - 1] + 1) begin = i;
      if (i - begin + 1 > part(kLongestRun, 2))
        return "lines " + std::to_string(lines_[begin]) + " to " + std::to_string(lines_[i]) + " are lost in a row";
    }
    if (!is_scattered(of))
      return "they lie together, between lines " + std::to_string(lines_.front()) + " and " +
             std::to_string(lines_.back());
    return {};
  }

  /// Whether rows drawn at random would lie like these: the largest distance of their distribution from an even one passes
  /// 1.95/√n once in a thousand draws, by Kolmogorov's law.
  bool is_scattered(std::size_t of) const {
    constexpr double kOnceInAThousand = 1.95;
    const auto n = static_cast<double>(rows_.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double place = (static_cast<double>(rows_[i]) + 0.5) / static_cast<double>(of);
      const auto before = static_cast<double>(i);
      distance = std::max({distance, std::abs(place - before / n), std::abs(place - (before + 1.0) / n)});
    }
    return distance * std::sqrt(n) <= kOnceInAThousand;
  }

  std::vector<std::size_t> rows_;
  std::vector<std::uint32_t> lines_;
  std::vector<Fault> faults_;
};

/// Whether a row has nothing in any of the columns: tests of other lengths lie beside this one.
bool is_empty_in(const CurveFile::Row& row, const std::vector<const Reading*>& readings) {
  return std::all_of(readings.begin(), readings.end(), [&](const Reading* r) {
    return r->column.index < row.fields.size() && row.fields[r->column.index].text.empty();
  });
}

/// The numbers of the columns in row `at` of a test; nothing where one of them is none.
std::optional<std::vector<double>> numbers_of(const CurveFile& file, const CurveFile::Row& row, std::size_t at,
                                              const std::vector<const Reading*>& readings, LostRows& lost) {
  std::vector<double> values;
  for (const Reading* r : readings) {
    const std::size_t i = r->column.index;
    const bool there = i < row.fields.size();
    const auto value = there ? parse_number(row.fields[i].text, file.decimal) : std::nullopt;
    if (!value || !(std::abs(*value * r->factor) < kLargest)) {
      lost.add(at, row.line, there ? row.fields[i].column : 1, fault_of(file, row, r->column));
      return std::nullopt;
    }
    values.push_back(*value * r->factor);
  }
  return values;
}

/// Median of the first percent of some rows, of one row at least and five at most: a bad first row of many decides nothing,
/// and a sparse curve has gone nowhere yet.
double start_of(std::span<const double> values) {
  const std::size_t rows = std::clamp<std::size_t>(values.size() / 100, 1, 5);
  std::vector<double> first(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows));
  std::nth_element(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(first.size() / 2), first.end());
  return first[first.size() / 2];
}

/// The row whose number is farthest from the start.
std::size_t farthest_from(double start, std::span<const double> values) {
  const auto farther = [&](double a, double b) { return std::abs(a - start) < std::abs(b - start); };
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end(), farther) - values.begin());
}

/// −1 where the number farthest from the start lies below it.
double direction_of(const std::vector<double>& values, Sign sign) {
  if (sign != Sign::found) return sign == Sign::positive ? 1.0 : -1.0;
  if (values.empty()) return 1.0;
  const double start = start_of(values);
  return values[farthest_from(start, values)] < start ? -1.0 : 1.0;
}

/// What is wrong with a driven number that no test reaches; empty: nothing.
std::string driven_fault(Drive drive, double value) {
  if (drive == Drive::stretch && !(value > 0.0)) return "a stretch is above 0, and 1 at rest";
  if (drive == Drive::frequency && !(value > 0.0)) return "a frequency is above 0";
  return {};
}

/// How a test deforms its specimen: by its name; else as it is said, or as the stretch of the file goes.
Deforming deforming_of(const DataSpec& spec, Drive drive, const std::vector<double>& driven) {
  switch (spec.test) {
    case LabTest::compression:
      return Deforming::compression;
    case LabTest::tension:
      return Deforming::tension;
    case LabTest::equibiaxial:
      return Deforming::equibiaxial;
    case LabTest::planar:
      return Deforming::planar;
    case LabTest::simple_shear:
    case LabTest::oscillation:
      return Deforming::simple_shear;
    case LabTest::torsion:
      return Deforming::torsion;
    case LabTest::indentation:
      return Deforming::indentation;
    case LabTest::relaxation:
    case LabTest::creep:
    case LabTest::cyclic:
    case LabTest::heat:
      break;
  }
  if (spec.deforming || drive != Drive::stretch || driven.empty())
    return spec.deforming.value_or(Deforming::compression);
  const auto nearer = [](double a, double b) { return std::abs(a - 1.0) < std::abs(b - 1.0); };
  return *std::max_element(driven.begin(), driven.end(), nearer) > 1.0 ? Deforming::tension : Deforming::compression;
}

/// Turns the numbers where they go down. @return whether it did
bool turn(std::vector<double>& values, double direction) {
  if (direction > 0.0) return false;
  for (double& v : values) v = -v;
  return true;
}

/// The way so far over the speed.
std::vector<double> time_of(const std::vector<double>& way, double speed) {
  std::vector<double> time(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) time[i] = time[i - 1] + std::abs(way[i] - way[i - 1]) / speed;
  return time;
}

/// Instants of a test that no time goes with: its rows.
std::vector<double> rows_as_time(std::size_t rows) {
  std::vector<double> time(rows);
  std::iota(time.begin(), time.end(), 0.0);
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

namespace {

/// Complains of numbers that a test cannot have, by line.
void require_possible(const RawTest& test, const TestColumns& columns, scene::Problems& problems) {
  std::size_t shown = 0;
  for (std::size_t i = 0; i < test.lines.size() && shown < kBadRowsShown; ++i) {
    std::string fault = driven_fault(columns.drive, test.displacement[i]);
    const Source* source = &test.displacement_source;
    double value = test.displacement[i];
    if (fault.empty() && (columns.answer == Answer::loss_modulus || columns.answer == Answer::storage_modulus) &&
        test.force[i] < 0.0) {
      fault = "a modulus of an oscillation is not below 0: a passive tissue gives no work";
      source = &test.force_source, value = test.force[i];
    }
    if (fault.empty()) continue;
    ++shown;
    problems.add({test.lines[i], 1, {}}, "",
                 source->title + " is " + brief(value / source->unit->factor) +
                     (source->unit->name == "-" ? "" : " " + std::string(source->unit->name)) + "; " + fault +
                     "; check the columns and their units");
  }
}

/// A stretch that goes the other way than the test's name.
void require_direction(const RawTest& test, const TestColumns& columns, double outward, scene::Problems& problems) {
  if (columns.drive != Drive::stretch || test.measurement.test == LabTest::cyclic) return;
  double most = 0.0;
  for (const double stretch : test.displacement) {
    if (std::abs(stretch - 1.0) > std::abs(most)) most = stretch - 1.0;
  }
  if (!(outward * most < 0.0) || test.measurement.deforming == Deforming::equibiaxial ||
      test.measurement.deforming == Deforming::planar)
    return;
  problems.add({std::max(test.names_line, 1U), 1, {}}, "",
               test.displacement_source.title + " goes to " + brief(1.0 + most) + ", which is " +
                   (most < 0.0 ? "compression" : "tension") + "; give test = \"" +
                   (most < 0.0 ? "compression" : "tension") + "\", or another column");
}

/// From the numbers of the file to those of a curve.
void convert(RawTest& test, const DataSpec& spec, const TestColumns& columns, const SpecimenSize& size,
             scene::Problems& problems) {
  if (spec.is_heat()) return;
  Measurement& m = test.measurement;
  m.deforming = deforming_of(spec, columns.drive, test.displacement);
  const double outward = m.outward();
  const std::size_t before = problems.count();
  require_possible(test, columns, problems);
  if (problems.count() == before) require_direction(test, columns, outward, problems);
  const bool free_sign = columns.drive != Drive::stretch && columns.drive != Drive::frequency;
  if (free_sign && turn(test.displacement, direction_of(test.displacement, columns.driven_sign)))
    test.turned.push_back(test.displacement_source.title);
  // a specimen may push its plates apart or pull them together, and a modulus has its sign
  const bool as_it_is = columns.answer == Answer::storage_modulus || columns.answer == Answer::loss_modulus ||
                        (columns.answer == Answer::axial_force && columns.answering_sign == Sign::found);
  std::vector<double> driven = test.displacement;
  if (columns.drive == Drive::stretch) {  // as far from rest as it goes, compressed or pulled
    for (double& x : driven) x = outward * (x - 1.0);
  }
  const Sign sign = columns.answering_sign;
  const std::optional<double> loading =
      sign == Sign::found ? direction_while_loading(test.force, driven) : std::nullopt;
  if (!as_it_is && turn(test.force, loading ? *loading : direction_of(test.force, sign)))
    test.turned.push_back(test.force_source.title);
  for (std::size_t i = 0; i < test.lines.size(); ++i) {
    double& x = test.displacement[i];
    const double own = x;
    x = driven_number(columns.drive, x, size, outward);
    if (std::isfinite(x) || problems.count() > before) continue;
    problems.add({test.lines[i], 1, {}}, "",
                 test.displacement_source.title + " is " + brief(own) + ", a strain that no specimen has: " +
                     (columns.drive == Drive::green_strain ? "Green's is above -0.5" : "it has no stretch") +
                     "; check the columns and their units");
  }
  for (double& f : test.force) f = answering_number(columns.answer, f, size);
}

/// What the curve's numbers are, and their units.
Measurement measurement_of(const DataSpec& spec, const TestColumns& columns, const SpecimenSize& size, bool timed) {
  Measurement m;
  m.test = spec.test;
  m.measured = measured_by(columns.answer);
  m.stretch = spec.prestretch;
  m.timed = timed;
  m.point = size.point;
  m.indenter = spec.indenter;
  m.unit = size.point ? "Pa" : "N";
  m.drive_unit = size.point ? "-" : "m";
  if (spec.test == LabTest::torsion || spec.deforming == Deforming::torsion) m.unit = "N m", m.drive_unit = "rad";
  if (m.measured == Measured::axial) m.unit = "N";
  if (spec.test == LabTest::oscillation) m.unit = "Pa", m.drive_unit = "Hz";
  if (spec.is_heat()) m.heat = spec.heat, m.unit = unit_of(spec.heat).unit, m.drive_unit = "s";
  return m;
}

}  // namespace

std::optional<double> direction_while_loading(std::span<const double> values, const std::vector<double>& driven) {
  constexpr double kTurn = 0.1;  // of the whole way
  const auto deepest = static_cast<std::size_t>(std::max_element(driven.begin(), driven.end()) - driven.begin());
  std::size_t first = 0;
  for (const std::size_t turn : turning_points(driven, kTurn)) {
    if (turn < deepest) first = turn;
  }
  if (deepest < first + kFewestLoading || driven.empty()) return std::nullopt;
  const std::span loading = values.subspan(first, deepest + 1 - first);
  const double start = start_of(loading);
  return loading[farthest_from(start, loading)] < start ? -1.0 : 1.0;
}

void swap_load(RawTest& test, Measured answering) {
  std::swap(test.displacement, test.force);
  std::swap(test.displacement_source, test.force_source);
  std::swap(test.measurement.unit, test.measurement.drive_unit);
  test.measurement.measured = answering;
}

RawTest raw_test(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems) {
  RawTest test;
  test.file = file.file;
  test.names_line = file.names_line;
  test.separator = file.separator;
  test.decimal = file.decimal;
  const auto columns = test_columns(file, spec, size, problems);
  if (!columns) return test;
  const Reading driven = reading(columns->driven), answering = reading(columns->answering);
  const std::optional<Reading> time = columns->time ? std::optional(reading(*columns->time)) : std::nullopt;
  std::vector<const Reading*> readings{&driven, &answering};
  if (time) readings.push_back(&*time);
  if (time && file.is_clock(time->column.index)) test.clock = file.clocks[time->column.index];
  const std::vector<ChosenColumn> checked =
      spec.test == LabTest::compression ? check_columns(file) : std::vector<ChosenColumn>{};
  for (const ChosenColumn& c : checked) test.checks.push_back({c.source, {}});
  LostRows lost;
  std::size_t rows = 0;
  for (const CurveFile::Row& row : file.rows) {
    if (is_empty_in(row, {&driven, &answering})) continue;
    const auto values = numbers_of(file, row, rows++, readings, lost);
    if (!values) continue;
    test.lines.push_back(row.line);
    test.displacement.push_back((*values)[0]);
    test.force.push_back((*values)[1]);
    if (time) test.time.push_back((*values)[2]);
    read_checks(test, checked, file, row);
  }
  lost.complain(rows, spec.skip_bad_rows, problems);
  test.rows_skipped = lost.count();
  test.displacement_source = driven.column.source;
  test.force_source = answering.column.source;
  test.measurement = measurement_of(spec, *columns, size, time || spec.speed);
  const std::size_t before = problems.count();
  convert(test, spec, *columns, size, problems);
  if (problems.count() > before) return test;
  if (spec.speed && !time) test.time = time_of(test.displacement, *spec.speed);
  if (!spec.speed && !time) test.time = rows_as_time(test.lines.size());
  test.time_source = time ? time->column.source : Source{"speed_mm_s", Quantity::time, nullptr, "speed_mm_s"};
  if (spec.test == LabTest::creep) swap_load(test, Measured::strain);
  merge_times(test, file, problems);
  return test;
}

}  // namespace glisson::fit

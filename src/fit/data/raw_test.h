// raw_test.h — the columns of a file that a fit needs, in SI, positive as the test goes: every row, nothing cleaned.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/data/data_spec.h"
#include "fit/data/units.h"
#include "scene/parse/problems.h"

namespace glisson::fit {

/// Where numbers come from, for messages about their unit.
struct Source {
  std::string title;  ///< `"Load (N)"`
  Quantity quantity = Quantity::force;
  const Unit* unit = nullptr;
  std::string key{};  ///< `columns.force`
};

/// A column that is not used, but must agree with one that is.
struct CheckColumn {
  Source source;
  std::vector<double> values;  ///< SI; NaN where the row has none
};

struct RawTest {
  std::filesystem::path file;
  std::uint32_t names_line = 0;
  std::vector<std::uint32_t> lines;  ///< of each row
  std::vector<double> time, displacement, force;
  Source time_source, displacement_source, force_source;
  std::vector<CheckColumn> checks;  ///< stresses and strains beside force and way
  std::vector<std::string> turned;  ///< titles of the columns whose sign was turned
  std::string clock;                ///< the first time, as written, where the times are those of a clock; else ""
  Measurement measurement{};
  std::size_t rows_skipped = 0;  ///< without a number in a column that is needed
  std::size_t rows_merged = 0;   ///< of the same time as the row before, averaged with it
  char separator = ',', decimal = '.';

  std::size_t size() const { return time.size(); }
};

/// Chooses the columns, reads and converts them. Complains about columns, units, rows and times that cannot be used; what
/// is returned is of use only where nothing was added to `problems`.
RawTest raw_test(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems);

/// −1 where what answers goes down as the test loads, from the last turn before the largest driven number up to that, 1 where it
/// goes up: a pull-off on the way out may be larger than the push. Nothing where the test has no such rows.
std::optional<double> direction_while_loading(std::span<const double> values, const std::vector<double>& driven);

/// What is driven and what answers change places: a creep drives its load, and the strain or depth answers.
/// @param answering  what is measured then
void swap_load(RawTest& test, Measured answering);

/// Complains about numbers that look like another unit: a way beyond the specimen, stress and force that disagree, time and
/// speed that do not give the way, stiffness that no soft tissue has; about a force against its own displacement.
void check_units(const RawTest& test, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems);

/// Complaints, `file:line:column: …`, about tests of one group of which one is a hundred times the usual or more.
std::vector<std::string> repetition_faults(const std::vector<RawTest>& tests);

}  // namespace glisson::fit

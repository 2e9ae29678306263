#include "fit/data/test_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace glisson::fit {
namespace {

/// A column that some test takes, driven or answering.
template <class Kind>
struct ColumnRole {
  Kind kind;
  std::string_view key;  ///< in [data.columns]
  ColumnSpec ColumnsSpec::*spec;
  Quantity quantity;
  ColumnMeaning meaning;
  bool needs_size = false;  ///< to be converted, or to be of use: a point has none
};

using C = ColumnsSpec;
const std::array<ColumnRole<Drive>, 8> kDrives{
    {{Drive::displacement, "displacement", &C::displacement, Quantity::length, ColumnMeaning::displacement, true},
     {Drive::strain, "strain", &C::strain, Quantity::strain, ColumnMeaning::strain},
     {Drive::stretch, "stretch", &C::stretch, Quantity::stretch, ColumnMeaning::stretch},
     {Drive::true_strain, "true_strain", &C::true_strain, Quantity::strain, ColumnMeaning::true_strain},
     {Drive::green_strain, "green_strain", &C::green_strain, Quantity::strain, ColumnMeaning::green_strain},
     {Drive::shear, "shear", &C::shear, Quantity::strain, ColumnMeaning::shear},
     {Drive::angle, "angle", &C::angle, Quantity::angle, ColumnMeaning::angle, true},
     {Drive::frequency, "frequency", &C::frequency, Quantity::frequency, ColumnMeaning::frequency}}};
const std::array<ColumnRole<Answer>, 8> kAnswers{
    {{Answer::force, "force", &C::force, Quantity::force, ColumnMeaning::force, true},
     {Answer::stress, "stress", &C::stress, Quantity::stress, ColumnMeaning::stress},
     {Answer::cauchy_stress, "cauchy_stress", &C::cauchy_stress, Quantity::stress, ColumnMeaning::cauchy_stress},
     {Answer::second_piola_stress, "second_piola_stress", &C::second_piola_stress, Quantity::stress,
      ColumnMeaning::second_piola_stress},
     {Answer::torque, "torque", &C::torque, Quantity::torque, ColumnMeaning::torque, true},
     {Answer::axial_force, "axial_force", &C::axial_force, Quantity::force, ColumnMeaning::axial_force, true},
     {Answer::storage_modulus, "storage_modulus", &C::storage_modulus, Quantity::stress,
      ColumnMeaning::storage_modulus},
     {Answer::loss_modulus, "loss_modulus", &C::loss_modulus, Quantity::stress, ColumnMeaning::loss_modulus}}};

bool takes(const DataSpec& spec, Drive drive) {
  if (spec.is_heat()) return drive == Drive::time;
  const bool sheared = spec.test == LabTest::simple_shear || spec.deforming == Deforming::simple_shear;
  const bool twisted = spec.test == LabTest::torsion || spec.deforming == Deforming::torsion;
  switch (drive) {
    case Drive::frequency:
      return spec.test == LabTest::oscillation;
    case Drive::angle:
      return twisted;
    case Drive::shear:
      return sheared;
    case Drive::displacement:
      return spec.indents() || (spec.test != LabTest::oscillation && !twisted);
    default:
      return !spec.indents() && spec.test != LabTest::oscillation && !twisted && !sheared;
  }
}

bool takes(const DataSpec& spec, Answer answer) {
  if (spec.is_heat()) return answer == Answer::value;
  const bool twisted = spec.test == LabTest::torsion || spec.deforming == Deforming::torsion;
  switch (answer) {
    case Answer::storage_modulus:
    case Answer::loss_modulus:
      return spec.test == LabTest::oscillation;
    case Answer::torque:
    case Answer::axial_force:
      return twisted;
    case Answer::force:
      return spec.test != LabTest::oscillation && !twisted;
    case Answer::stress:
      return !spec.indents() && spec.test != LabTest::oscillation && !twisted;
    default:  // creep is driven by what a machine holds: the force
      return !spec.indents() && spec.test != LabTest::oscillation && spec.test != LabTest::creep && !twisted;
  }
}

template <class Kind>
class ColumnSearch {
 public:
  ColumnSearch(std::span<const ColumnRole<Kind>> roles, const CurveFile& file, const DataSpec& spec,
               const SpecimenSize& size, scene::Problems& problems)
      : roles_(roles), file_(file), spec_(spec), size_(size), problems_(problems) {}

  Kind kind{};
  Sign sign = Sign::found;

  /// The column that is given, else the first kind of which one has a customary name.
  std::optional<ChosenColumn> choose() {
    for (const ColumnRole<Kind>& role : roles_) {
      const ColumnSpec& column = spec_.columns.*role.spec;
      if (!column.given) continue;
      kind = role.kind, sign = column.sign;
      if (!fits(role)) return {};
      return choose_column(file_, column, role.quantity, key_of(role), problems_);
    }
    const ColumnRole<Kind>* first = nullptr;
    for (const ColumnRole<Kind>& role : roles_) {
      if (!takes(spec_, role.kind) || (role.needs_size && size_.point)) continue;
      if (!first) first = &role, kind = role.kind;
      if (!has_customary(file_, role.quantity, role.meaning)) continue;
      kind = role.kind;
      if (!fits(role)) return {};
      return guess_column(file_, role.quantity, role.meaning, key_of(role), problems_);
    }
    if (first) return guess_column(file_, first->quantity, first->meaning, key_of(*first), problems_);
    problems_.add({1, 1, {}}, "",
                  "test = \"" + std::string(word_of(spec_.test)) +
                      "\" needs the specimen's size, and a point has none; give "
                      "[specimen] kind = \"cylinder\"");
    return {};
  }

 private:
  static std::string key_of(const ColumnRole<Kind>& role) { return "columns." + std::string(role.key); }

  std::string all_taken() const {
    std::string text;
    for (const ColumnRole<Kind>& role : roles_) {
      if (takes(spec_, role.kind) && !(role.needs_size && size_.point))
        text.append(text.empty() ? "columns." : ", columns.").append(role.key);
    }
    return text;
  }

  bool fits(const ColumnRole<Kind>& role) {
    const std::string test(word_of(spec_.test));
    if (!takes(spec_, kind)) {
      problems_.add({1, 1, {}}, key_of(role),
                    "does not belong to test = \"" + test + "\"; give " + all_taken() + ", or another test");
      return false;
    }
    if (role.needs_size && size_.point) {
      problems_.add({1, 1, {}}, key_of(role),
                    "needs the specimen's size, and a point has none; give " + all_taken() +
                        ", or [specimen] kind = \"cylinder\" or \"block\"");
      return false;
    }
    return has_size(role);
  }

  bool has_size(const ColumnRole<Kind>& role) {
    const bool stress = role.quantity == Quantity::stress && spec_.test != LabTest::oscillation;
    const bool strain = role.quantity == Quantity::strain || role.quantity == Quantity::stretch;
    if (stress && !size_.area)
      problems_.add({1, 1, {}}, key_of(role),
                    "needs the area of the specimen to be converted to a force; give area_mm2");
    if (strain && !size_.height)
      problems_.add({1, 1, {}}, key_of(role),
                    "needs the height of the specimen to be converted to a displacement; give height_mm");
    if (role.quantity == Quantity::angle && !size_.radius)
      problems_.add({1, 1, {}}, key_of(role), "needs a round specimen; give [specimen] kind = \"cylinder\"");
    return !(stress && !size_.area) && !(strain && !size_.height) &&
           !(role.quantity == Quantity::angle && !size_.radius);
  }

  std::span<const ColumnRole<Kind>> roles_;
  const CurveFile& file_;
  const DataSpec& spec_;
  const SpecimenSize& size_;
  scene::Problems& problems_;
};

/// The time, where the file has it; a test that goes by it needs it.
std::optional<ChosenColumn> time_column(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size,
                                        scene::Problems& problems) {
  const ColumnSpec& own = spec.columns.time;
  if (own.given) return choose_column(file, own, Quantity::time, "columns.time", problems);
  if (spec.speed || spec.test == LabTest::oscillation) return {};
  const bool by_time = !names_its_deformation(spec.test);
  const bool press = spec.test == LabTest::compression && !size.point;
  if (!by_time && !press && !has_customary(file, Quantity::time, ColumnMeaning::time)) return {};
  return guess_column(file, Quantity::time, ColumnMeaning::time, "columns.time", problems);
}

/// The column that is named, else that of the scene's own name for it, else the one of temperatures.
std::optional<ChosenColumn> value_column(const CurveFile& file, const DataSpec& spec, scene::Problems& problems) {
  const HeatUnit unit = unit_of(spec.heat);
  const Quantity quantity = unit.quantity.value_or(Quantity::strain);
  const ColumnSpec& own = spec.columns.value;
  if (own.given) return choose_column(file, own, quantity, "columns.value", problems);
  const auto same = [&](const std::string& name) { return name == spec.heat.column; };
  if (spec.heat.over.empty() && std::ranges::any_of(file.names, same)) {
    const ColumnSpec named{.given = true, .name = spec.heat.column, .number = {}, .unit = {}, .origin = {}};
    return choose_column(file, named, quantity, "columns.value", problems);
  }
  if (quantity == Quantity::temperature)
    return guess_column(file, quantity, ColumnMeaning::temperature, "columns.value", problems);
  problems.add({1, 1, {}}, "columns.value",
               "the file has no column \"" + spec.heat.column +
                   "\"; give columns.value = { name = … }, the column of " + name_of(spec.heat));
  return {};
}

std::optional<TestColumns> heat_columns(const CurveFile& file, const DataSpec& spec, scene::Problems& problems) {
  const ColumnSpec& own = spec.columns.time;
  TestColumns found{.drive = Drive::time, .answer = Answer::value, .driven = {}, .answering = {}, .time = {}};
  found.time = own.given ? choose_column(file, own, Quantity::time, "columns.time", problems)
                         : guess_column(file, Quantity::time, ColumnMeaning::time, "columns.time", problems);
  const auto value = value_column(file, spec, problems);
  if (!found.time || !value) return {};
  found.driven = *found.time, found.answering = *value;
  return found;
}

}  // namespace

HeatUnit unit_of(const HeatReading& reading) {
  if (!reading.over.empty()) return {"-", Quantity::strain};
  const std::string unit = reading.column.substr(reading.column.rfind('_') + 1);
  if (unit == "C") return {"°C", Quantity::temperature};
  if (unit == "m") return {"m", Quantity::length};
  if (unit == "m2") return {"m²", Quantity::area};
  if (unit == "m3") return {"m³", Quantity::volume};
  for (const char* other : {"J", "W", "V"}) {
    if (unit == other) return {unit, {}};
  }
  return {unit == "ohm" ? "Ω" : "-", {}};
}

std::string name_of(const HeatReading& reading) {
  return reading.column + (reading.over.empty() ? "" : " / " + reading.over) +
         (reading.variant.empty() ? "" : ", " + reading.variant);
}

bool names_its_deformation(LabTest test) {
  return test != LabTest::relaxation && test != LabTest::creep && test != LabTest::cyclic;
}

std::optional<TestColumns> test_columns(const CurveFile& file, const DataSpec& spec, const SpecimenSize& size,
                                        scene::Problems& problems) {
  if (spec.is_heat()) return heat_columns(file, spec, problems);
  const std::size_t before = problems.count();
  TestColumns found;
  found.time = time_column(file, spec, size, problems);
  ColumnSearch<Drive> drives(kDrives, file, spec, size, problems);
  const auto driven = drives.choose();
  ColumnSearch<Answer> answers(kAnswers, file, spec, size, problems);
  const auto answering = answers.choose();
  if (problems.count() > before || !driven || !answering) return {};
  found.drive = drives.kind, found.driven = *driven, found.driven_sign = drives.sign;
  found.answer = answers.kind, found.answering = *answering, found.answering_sign = answers.sign;
  return found;
}

double driven_number(Drive drive, double value, const SpecimenSize& size, double outward) {
  const double height = size.height.value_or(1.0);
  switch (drive) {
    case Drive::strain:
    case Drive::shear:
      return value * height;
    case Drive::stretch:
      return outward * (value - 1.0) * height;
    case Drive::true_strain:
      return outward * std::expm1(outward * value) * height;
    case Drive::green_strain:
      return outward * (std::sqrt(1.0 + 2.0 * outward * value) - 1.0) * height;
    case Drive::displacement:
    case Drive::angle:
    case Drive::frequency:
    case Drive::time:
      return value;
  }
  return value;
}

double answering_number(Answer answer, double value, const SpecimenSize& size) {
  const bool stress =
      answer == Answer::stress || answer == Answer::cauchy_stress || answer == Answer::second_piola_stress;
  return stress ? value * size.area.value_or(1.0) : value;
}

Measured measured_by(Answer answer) {
  switch (answer) {
    case Answer::cauchy_stress:
      return Measured::cauchy;
    case Answer::second_piola_stress:
      return Measured::second_piola;
    case Answer::torque:
      return Measured::torque;
    case Answer::axial_force:
      return Measured::axial;
    case Answer::storage_modulus:
      return Measured::storage;
    case Answer::loss_modulus:
      return Measured::loss;
    case Answer::value:
      return Measured::heat;
    default:
      return Measured::nominal;
  }
}

std::vector<DataSpec> parted(const DataSpec& spec) {
  struct Pair {
    ColumnSpec ColumnsSpec::*first;
    ColumnSpec ColumnsSpec::*second;
    const char *of_first, *of_second;
  };
  for (const Pair& pair : {Pair{&C::storage_modulus, &C::loss_modulus, " G′", " G″"},
                           Pair{&C::torque, &C::axial_force, " torque", " axial force"}}) {
    if (!(spec.columns.*pair.first).given || !(spec.columns.*pair.second).given) continue;
    DataSpec first = spec, second = spec;
    first.columns.*pair.second = {}, second.columns.*pair.first = {};
    first.group += pair.of_first, second.group += pair.of_second;
    return {std::move(first), std::move(second)};
  }
  return {spec};
}

}  // namespace glisson::fit

#include "fit/data/load_curves.h"

#include <algorithm>
#include <functional>
#include <tuple>

#include "fit/data/test_columns.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {
namespace {

/// Runs something, and keeps what it throws as a user's error.
template <class Run>
void collect(std::string& faults, Run run) {
  try {
    run();
  } catch (const SceneError& error) {
    faults.append(faults.empty() ? "" : "\n").append(error.what());
  }
}

std::filesystem::path placed(const std::filesystem::path& file, const std::filesystem::path& base) {
  return (file.is_absolute() ? file : base / file).lexically_normal();
}

RawTest load_raw(const std::filesystem::path& path, const DataSpec& spec, const SpecimenSize& size) {
  const CurveFile file = read_curve_file(path, spec.text);
  scene::Problems problems(path.string());
  RawTest test = raw_test(file, spec, size, problems);
  if (problems.count() == 0 && !spec.is_heat()) check_units(test, spec, size, problems);
  problems.throw_if_any();
  return test;
}

/// Values that FIT.toml itself says.
PreparedCurve curve_of_values(const DataSpec& spec) {
  PreparedCurve made;
  Curve& c = made.curve;
  c.name = made.account.name = name_of(spec.heat);
  c.group = spec.group, c.batch = spec.batch, c.weight = spec.weight, c.held_out = spec.held_out;
  c.time = c.displacement = spec.times, c.force = spec.values;
  c.noise = spec.deviation.value_or(0.0), c.noise_given = spec.deviation.has_value();
  Measurement& m = c.measurement;
  m.test = spec.test, m.measured = Measured::heat, m.heat = spec.heat;
  m.unit = unit_of(spec.heat).unit, m.drive_unit = "s";
  made.account.rows_read = made.account.points = spec.values.size();
  made.account.contact_how = "as recorded";
  made.account.unit = m.unit, made.account.drive_unit = m.drive_unit, made.account.row_noise = c.noise;
  return made;
}

/// Names that several files share get their folders.
void make_unique(std::vector<PreparedCurve>& curves, const DataSpec& spec) {
  for (std::size_t i = 0; i < spec.files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (curves[j].account.name == curves[i].account.name)
        curves[i].curve.name = spec.files[i].generic_string() + " (" + std::to_string(i + 1) + ")";
    }
  }
  for (PreparedCurve& c : curves) c.account.name = c.curve.name;
}

using CurvesOfTables = std::vector<std::vector<PreparedCurve>>;

bool any(const CurvesOfTables& tables, const std::function<bool(const CurveAccount&)>& is) {
  return std::any_of(tables.begin(), tables.end(), [&](const auto& curves) {
    return std::any_of(curves.begin(), curves.end(), [&](const PreparedCurve& c) { return is(c.account); });
  });
}

/// The largest force at which one curve begins in contact, where others begin before; 0 where all are alike.
double common_preload(const CurvesOfTables& tables) {
  double most = 0.0;
  for (const auto& curves : tables) {
    for (const PreparedCurve& c : curves) {
      if (c.account.contact_how == "extrapolated") most = std::max(most, c.account.first_force);
    }
  }
  const auto is_detected = [](const CurveAccount& a) { return a.contact_how == "detected"; };
  return any(tables, is_detected) ? most : 0.0;
}

}  // namespace

bool of_one_test(const DataSpec& a, const DataSpec& b) {
  const auto what = [](const DataSpec& d) {
    const ColumnsSpec& c = d.columns;
    return std::tuple(d.test, d.deforming, d.prestretch, d.indenter, d.speed, d.size.area, d.size.height,
                      c.axial_force.given, c.loss_modulus.given, d.contact.kind, d.contact.at, d.contact.threshold,
                      d.contact.zero_force, d.heat);
  };
  return what(a) == what(b);
}

TestFiles::TestFiles(std::span<const DataSpec> tables, const SpecimenSize& common, const std::filesystem::path& base) {
  for (const DataSpec& table : tables) {
    Table& t = tables_.emplace_back(Table{table, common, {}});
    if (table.size.area) t.size.area = table.size.area;
    if (table.size.height) t.size.height = table.size.height;
    for (const auto& file : table.files)
      collect(faults_, [&] { t.tests.push_back(load_raw(placed(file, base), t.spec, t.size)); });
    if (!faults_.empty() || table.unlikely || table.is_heat()) continue;
    for (const std::string& fault : repetition_faults(t.tests))
      faults_.append(faults_.empty() ? "" : "\n").append(fault);
  }
}

std::vector<std::vector<PreparedCurve>> TestFiles::curves(std::optional<ContactKind> kind) const {
  const auto prepared = [&](bool sloped, double preload) {
    std::string faults = faults_;
    CurvesOfTables all;
    for (const Table& t : tables_) {
      DataSpec spec = t.spec;
      if (kind) spec.contact.kind = *kind;
      if (sloped) spec.contact.sloped = true;
      if (preload > 0.0) spec.contact.preload = preload;
      std::vector<PreparedCurve>& curves = all.emplace_back();
      if (!spec.values.empty()) curves.push_back(curve_of_values(spec));
      for (const RawTest& test : t.tests) {
        collect(faults, [&] {
          scene::Problems problems(test.file.string());
          auto curve = prepare(test, spec, t.size, problems);
          problems.throw_if_any();
          curves.push_back(std::move(*curve));
        });
      }
    }
    if (!faults.empty()) throw SceneError(faults);
    return all;
  };
  CurvesOfTables all = prepared(false, 0.0);
  const bool sloped = any(all, [](const CurveAccount& a) { return a.sloped; });
  if (sloped) all = prepared(true, 0.0);
  if (const double preload = common_preload(all); preload > 0.0) all = prepared(sloped, preload);
  for (std::size_t i = 0; i < all.size(); ++i) make_unique(all[i], tables_[i].spec);
  return all;
}

std::vector<PreparedCurve> load_curves(const DataSpec& spec, const SpecimenSize& size,
                                       const std::filesystem::path& base) {
  return std::move(TestFiles(std::span(&spec, 1), size, base).curves().front());
}

}  // namespace glisson::fit

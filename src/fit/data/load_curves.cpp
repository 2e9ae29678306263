#include "fit/data/load_curves.h"

#include <algorithm>
#include <functional>
#include <tuple>

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
  if (problems.count() == 0) check_units(test, spec, size, problems);
  problems.throw_if_any();
  return test;
}

/// Names that several files share get their folders.
void make_unique(std::vector<PreparedCurve>& curves, const DataSpec& spec) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (curves[j].account.name == curves[i].account.name)
        curves[i].curve.name = spec.files[i].generic_string() + " (" + std::to_string(i + 1) + ")";
    }
  }
  for (PreparedCurve& c : curves) c.account.name = c.curve.name;
}

std::vector<PreparedCurve> prepare_all(const std::vector<RawTest>& tests, const DataSpec& spec,
                                       const SpecimenSize& size, std::string& faults) {
  std::vector<PreparedCurve> curves;
  for (const RawTest& test : tests) {
    collect(faults, [&] {
      scene::Problems problems(test.file.string());
      auto prepared = prepare(test, spec, size, problems);
      problems.throw_if_any();
      curves.push_back(std::move(*prepared));
    });
  }
  return curves;
}

/// The sections of a test with their raw rows: what is decided of contact is decided for all.
class TestOfTables {
 public:
  TestOfTables(std::span<const DataSpec> tables, const SpecimenSize& common, const std::filesystem::path& base) {
    for (const DataSpec& table : tables) {
      Table& t = tables_.emplace_back(Table{table, common, {}, {}});
      if (table.size.area) t.size.area = table.size.area;
      if (table.size.height) t.size.height = table.size.height;
      for (const auto& file : table.files)
        collect(faults_, [&] { t.tests.push_back(load_raw(placed(file, base), t.spec, t.size)); });
      if (!faults_.empty() || table.unlikely) continue;
      for (const std::string& fault : repetition_faults(t.tests))
        faults_.append(faults_.empty() ? "" : "\n").append(fault);
    }
  }

  std::vector<std::vector<PreparedCurve>> curves() {
    prepare_all_tables();
    const bool sloped = any([](const CurveAccount& a) { return a.sloped; });
    if (sloped) prepare_all_tables([](ContactSpec& c) { c.sloped = true; });
    const double preload = common_preload();
    if (preload > 0.0) prepare_all_tables([&](ContactSpec& c) { c.preload = preload; });
    std::vector<std::vector<PreparedCurve>> all;
    for (Table& t : tables_) {
      make_unique(t.curves, t.spec);
      all.push_back(std::move(t.curves));
    }
    return all;
  }

 private:
  struct Table {
    DataSpec spec;
    SpecimenSize size;
    std::vector<RawTest> tests;
    std::vector<PreparedCurve> curves;
  };

  /// @throws SceneError with all that is wrong
  void prepare_all_tables(const std::function<void(ContactSpec&)>& decide = [](ContactSpec&) {}) {
    for (Table& t : tables_) {
      decide(t.spec.contact);
      t.curves = prepare_all(t.tests, t.spec, t.size, faults_);
    }
    if (!faults_.empty()) throw SceneError(faults_);
  }

  bool any(const std::function<bool(const CurveAccount&)>& is) const {
    return std::any_of(tables_.begin(), tables_.end(), [&](const Table& t) {
      return std::any_of(t.curves.begin(), t.curves.end(), [&](const PreparedCurve& c) { return is(c.account); });
    });
  }

  /// The largest force at which one curve begins in contact, where others begin before; 0 where all are alike.
  double common_preload() const {
    double most = 0.0;
    const bool rested = any([&](const CurveAccount& a) {
                          if (a.contact_how == "extrapolated") most = std::max(most, a.first_force);
                          return false;
                        }) ||
                        any([](const CurveAccount& a) { return a.contact_how == "detected"; });
    return rested ? most : 0.0;
  }

  std::vector<Table> tables_;
  std::string faults_;
};

}  // namespace

bool of_one_test(const DataSpec& a, const DataSpec& b) {
  const auto what = [](const DataSpec& d) {
    const ColumnsSpec& c = d.columns;
    return std::tuple(d.test, d.deforming, d.prestretch, d.indenter, d.speed, d.size.area, d.size.height,
                      c.axial_force.given, c.loss_modulus.given, d.contact.kind, d.contact.at, d.contact.threshold,
                      d.contact.zero_force);
  };
  return what(a) == what(b);
}

std::vector<std::vector<PreparedCurve>> load_test(std::span<const DataSpec> tables, const SpecimenSize& size,
                                                  const std::filesystem::path& base) {
  return TestOfTables(tables, size, base).curves();
}

std::vector<PreparedCurve> load_curves(const DataSpec& spec, const SpecimenSize& size,
                                       const std::filesystem::path& base) {
  return std::move(load_test(std::span(&spec, 1), size, base).front());
}

}  // namespace glisson::fit

#include "fit/data/load_curves.h"

#include <algorithm>

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

/// The largest force at which one of a set begins in contact, where others begin before; 0 where all are alike.
double common_preload(const std::vector<PreparedCurve>& curves) {
  double most = 0.0;
  bool rested = false;
  for (const PreparedCurve& c : curves) {
    if (c.account.contact_how == "extrapolated") most = std::max(most, c.account.first_force);
    rested = rested || c.account.contact_how == "detected";
  }
  return rested ? most : 0.0;
}

}  // namespace

std::vector<PreparedCurve> load_curves(const DataSpec& spec, const SpecimenSize& common,
                                       const std::filesystem::path& base) {
  SpecimenSize size = common;
  if (spec.size.area) size.area = spec.size.area;
  if (spec.size.height) size.height = spec.size.height;
  std::string faults;
  std::vector<RawTest> tests;
  for (const auto& file : spec.files)
    collect(faults, [&] { tests.push_back(load_raw(placed(file, base), spec, size)); });
  if (faults.empty() && !spec.unlikely) {
    for (const std::string& fault : repetition_faults(tests)) faults.append(faults.empty() ? "" : "\n").append(fault);
  }
  std::vector<PreparedCurve> curves = prepare_all(tests, spec, size, faults);
  if (!faults.empty()) throw SceneError(faults);
  DataSpec alike = spec;
  alike.contact.preload = common_preload(curves);
  if (alike.contact.preload > 0.0) curves = prepare_all(tests, alike, size, faults);
  make_unique(curves, spec);
  return curves;
}

}  // namespace glisson::fit

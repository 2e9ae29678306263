#include "fit/laws/fit_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "fit/data/load_curves.h"
#include "fit/data/test_columns.h"
#include "fit/data/units.h"
#include "fit/model/curve_kinds.h"
#include "fit/uncertainty/further_batch.h"
#include "fit/uncertainty/validation.h"
#include "lab/indenter.h"

namespace glisson::fit {
namespace {

/// `A1`; with its test where tests of one file share a name; `A1 (2)` for the second of that name.
void make_unique(std::vector<Curve>& curves) {
  std::map<std::string, std::set<std::string>> groups;
  for (const Curve& c : curves) groups[c.name].insert(c.group);
  for (Curve& c : curves) {
    const bool other_test = std::any_of(curves.begin(), curves.end(), [&](const Curve& o) {
      return o.measurement.test != c.measurement.test || o.measurement.measured != c.measurement.measured;
    });
    if (groups[c.name].size() > 1 && other_test) c.name += ", " + c.group;
  }
  std::map<std::string, int> seen;
  for (Curve& c : curves) {
    const int number = ++seen[c.name];
    if (number > 1) c.name += " (" + std::to_string(number) + ")";
  }
}

using CurvesOfTables = std::vector<std::vector<PreparedCurve>>;

/// How far the mean of the others misses a curve, rms over the displacements that all have [N], over sets of curves
/// of about one speed; NaN where no two are.
double error_of_others(const CurvesOfTables& tables) {
  constexpr double kApart = 1.2;  // speeds farther apart are no repetitions
  std::vector<const Curve*> curves;
  for (const auto& table : tables) {
    for (const PreparedCurve& p : table) curves.push_back(&p.curve);
  }
  std::stable_sort(curves.begin(), curves.end(),
                   [](const Curve* a, const Curve* b) { return a->velocity < b->velocity; });
  double squares = 0.0, counted = 0.0;
  for (std::size_t first = 0, last = 0; first < curves.size(); first = last) {
    while (last < curves.size() && curves[last]->velocity <= kApart * curves[first]->velocity) ++last;
    const auto n = static_cast<double>(last - first);
    if (n < 2.0) continue;
    const std::vector<const Curve*> set(curves.begin() + static_cast<std::ptrdiff_t>(first),
                                        curves.begin() + static_cast<std::ptrdiff_t>(last));
    const double deviation = spread_of(set, std::numeric_limits<double>::infinity()).deviation;
    squares += n * deviation * deviation * n / (n - 1.0);
    counted += n;
  }
  return std::sqrt(squares / counted);
}

/// The curves of the sections of a test, with the contact that leaves them nearer to each other where it is to be chosen.
CurvesOfTables loaded(const std::vector<DataSpec>& tables, const SpecimenSize& size,
                      const std::filesystem::path& base) {
  const TestFiles files(tables, size, base);
  if (tables.front().contact.kind != ContactKind::automatic) return files.curves();
  CurvesOfTables detected = files.curves(ContactKind::detect);
  const double by_detection = error_of_others(detected);
  if (!std::isfinite(by_detection)) return detected;
  CurvesOfTables recorded = files.curves(ContactKind::none);
  const double as_recorded = error_of_others(recorded);
  CurvesOfTables& nearer = by_detection < as_recorded ? detected : recorded;
  for (auto& table : nearer) {
    for (PreparedCurve& p : table)
      p.account.contact_how += " (the others' mean errs by " + brief(std::min(by_detection, as_recorded), 3) +
                               " N, else " + brief(std::max(by_detection, as_recorded), 3) + " N)";
  }
  return std::move(nearer);
}

/// The curves of each section, those of one test loaded together.
CurvesOfTables load_by_tests(const std::vector<DataSpec>& parts, const SpecimenSize& size,
                             const std::filesystem::path& base) {
  CurvesOfTables all(parts.size());
  std::vector<char> done(parts.size(), 0);
  for (std::size_t first = 0; first < parts.size(); ++first) {
    if (done[first] != 0) continue;
    std::vector<std::size_t> members;
    std::vector<DataSpec> tables;
    for (std::size_t i = first; i < parts.size(); ++i) {
      if (done[i] != 0 || !of_one_test(parts[first], parts[i])) continue;
      done[i] = 1;
      members.push_back(i);
      tables.push_back(parts[i]);
    }
    CurvesOfTables curves = loaded(tables, size, base);
    for (std::size_t k = 0; k < members.size(); ++k) all[members[k]] = std::move(curves[k]);
  }
  return all;
}

/// `test 2`; where there are tests of several kinds their own names, numbered from the second of a kind on.
std::string default_group(const std::vector<DataSpec>& data, std::size_t number) {
  const LabTest test = data[number].test;
  if (test == LabTest::heat) return name_of(data[number].heat);
  const bool all_presses =
      std::all_of(data.begin(), data.end(), [](const DataSpec& d) { return d.test == LabTest::compression; });
  if (all_presses) return "test " + std::to_string(number + 1);
  const auto own = data.begin() + static_cast<std::ptrdiff_t>(number);
  const auto before = std::count_if(data.begin(), own, [&](const DataSpec& d) { return d.test == test; });
  return std::string(word_of(test)) + (before > 0 ? " " + std::to_string(before + 1) : "");
}

/// Young's modulus that a curve shows [Pa] at small strain, by its first tenth, of one that cannot be pressed together; 0: none.
double modulus_of(const Curve& c, double area, double height) {
  constexpr double kPart = 0.1;
  const Measurement& m = c.measurement;
  if (m.heat) return 0.0;
  double most = 0.0, fd = 0.0, dd = 0.0;
  for (const double d : c.displacement) most = std::max(most, std::abs(d));
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (std::abs(c.displacement[i]) > kPart * most && dd > 0.0) continue;
    fd += c.force[i] * c.displacement[i];
    dd += c.displacement[i] * c.displacement[i];
  }
  if (m.test == LabTest::oscillation) {
    double sum = 0.0;
    for (const double g : c.force) sum += g;
    return m.measured == Measured::storage ? 3.0 * sum / static_cast<double>(c.size()) : 0.0;
  }
  if (!(fd > 0.0)) return 0.0;
  if (m.indenter) {  // by the closed form, at the deepest
    const std::vector<double>&depths = m.loaded() ? c.force : c.displacement,
          &forces = m.loaded() ? c.displacement : c.force;
    const auto far = static_cast<std::size_t>(std::max_element(depths.begin(), depths.end()) - depths.begin());
    return std::max(0.0, lab::thick_layer_modulus(*m.indenter, depths[far], forces[far]));
  }
  const double stiffness = m.loaded() ? dd / fd : fd / dd;
  switch (m.deforming) {
    case Deforming::torsion:  // G = 2 M H / (π R⁴ φ) and A = π R²
      return 3.0 * stiffness * 2.0 * std::numbers::pi * height / (area * area);
    case Deforming::simple_shear:
      return 3.0 * stiffness * height / area;
    case Deforming::equibiaxial:
      return 0.5 * stiffness * height / area;
    case Deforming::planar:
      return 0.75 * stiffness * height / area;
    default:
      return stiffness * height / area;
  }
}

/// What a curve shows of the tissue's modulus, beside where it comes from.
struct ShownModulus {
  const Curve* curve;
  std::string file;
  double modulus;
};

/// Tests of one tissue differ by how fast and how far they go, not as a slip of a unit does.
/// @throws SceneError naming the one that stands alone
void require_one_tissue(std::vector<ShownModulus> shown) {
  constexpr double kMostApart = 300.0;
  if (shown.size() < 2) return;
  std::sort(shown.begin(), shown.end(), [](const auto& a, const auto& b) { return a.modulus < b.modulus; });
  const ShownModulus &least = shown.front(), &most = shown.back();
  const double ratio = most.modulus / least.modulus, middle = shown[shown.size() / 2].modulus;
  if (!(ratio > kMostApart)) return;
  const bool upper = most.modulus / middle >= middle / least.modulus && shown.size() > 2;
  const ShownModulus &one = upper ? most : least, &other = upper ? least : most;
  throw SceneError(one.file + ":1:1: \"" + one.curve->name + "\" shows a modulus of " + brief(one.modulus) +
                   " Pa at small strain, \"" + other.curve->name + "\" one of " + brief(other.modulus) +
                   " Pa; of one tissue they are within " + brief(kMostApart) +
                   " times of each other. Check the units of both files, or give unlikely = true in one's [[data]]");
}

/// Batches are named for all fitted curves or for none, and two tell nothing of how they differ.
/// @throws SceneError naming the table
void require_batches(const std::vector<DataSpec>& data) {
  std::set<std::string> batches;
  const DataSpec *without = nullptr, *with = nullptr;
  for (const DataSpec& d : data) {
    if (d.held_out) continue;
    (d.batch.empty() ? without : with) = &d;
    if (!d.batch.empty()) batches.insert(d.batch);
  }
  if (!with) return;
  if (without)
    throw SceneError(without->origin + ": names no batch, while another fitted [[data]] is of batch \"" + with->batch +
                     "\"; give `batch` in each fitted [[data]], or in none");
  if (batches.size() < kFewestBatches)
    throw SceneError(with->origin + ": batch: " + std::to_string(batches.size()) +
                     (batches.size() == 1 ? " batch is" : " batches are") +
                     " fitted; an interval for a further batch needs three or more. Give a [[data]] for each batch, or "
                     "remove `batch`");
}

}  // namespace

std::vector<std::size_t> FitCurves::indices(bool held_out) const {
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].held_out == held_out) list.push_back(c);
  }
  return list;
}

std::vector<Curve> FitCurves::chosen(const std::vector<std::size_t>& indices) const {
  std::vector<Curve> list;
  for (const std::size_t c : indices) list.push_back(curves[c]);
  return list;
}

FitCurves read_curves(const FitSpec& spec, const SpecimenSize& size, const std::filesystem::path& base) {
  require_batches(spec.data);
  FitCurves all;
  std::vector<std::pair<std::string, double>> shown;  // file and modulus of each curve; 0: nothing to compare
  std::vector<DataSpec> parts;
  for (std::size_t d = 0; d < spec.data.size(); ++d) {
    DataSpec data = spec.data[d];
    if (data.group.empty()) data.group = default_group(spec.data, d);
    for (DataSpec& part : parted(data)) parts.push_back(std::move(part));
  }
  CurvesOfTables loaded_parts = load_by_tests(parts, size, base);
  for (std::size_t d = 0; d < parts.size(); ++d) {
    const DataSpec& part = parts[d];
    for (PreparedCurve& p : loaded_parts[d]) {
      p.curve.group = part.group;
      p.curve.held_out = part.held_out;
      p.curve.weight = part.weight;
      const double area = part.size.area.value_or(size.area.value_or(0.0)),
                   height = part.size.height.value_or(size.height.value_or(0.0));
      const bool known = p.curve.measurement.indenter || (area > 0.0 && height > 0.0);
      shown.emplace_back(p.account.file.string(), known && !part.unlikely ? modulus_of(p.curve, area, height) : 0.0);
      all.curves.push_back(std::move(p.curve));
      all.accounts.push_back(p.account.text());
      if (p.account.rows_skipped > 0) all.skipped.push_back(p.account.skipped_text());
    }
  }
  make_unique(all.curves);
  std::vector<ShownModulus> moduli;
  for (std::size_t c = 0; c < all.curves.size(); ++c) {
    if (shown[c].second > 0.0) moduli.push_back({&all.curves[c], shown[c].first, shown[c].second});
  }
  require_one_tissue(std::move(moduli));
  return all;
}

std::vector<double> spreads_of(const std::vector<Curve>& curves, Weighing how) {
  if (how == Weighing::automatic && are_of_heat(curves)) how = Weighing::noise;
  if (how == Weighing::automatic) how = of_one_kind(curves) ? Weighing::common : Weighing::peak;
  std::vector<double> list;
  double squares = 0.0;
  for (const Curve& c : curves) {
    const double peak = std::max(largest_force(c), 1e-12);
    const double noise = c.noise_given ? c.noise : std::max(c.noise, 1e-3 * peak);
    list.push_back(how == Weighing::peak ? 0.01 * peak : noise);
    squares += list.back() * list.back();
  }
  if (how == Weighing::common)
    std::fill(list.begin(), list.end(), std::sqrt(squares / static_cast<double>(list.size())));
  return list;
}

Validation errors_in_common_unit(const std::vector<Curve>& curves, std::vector<Prediction> predictions) {
  const std::string unit = common_unit(curves);
  if (!unit.empty()) return validate(curves, predictions);
  std::vector<Curve> parts = curves;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const double size = size_in(unit, curves[c]);
    for (double& f : parts[c].force) f *= size;
    for (double& f : predictions[c].force) f *= size;
  }
  return validate(parts, predictions);
}

double initial_modulus(const std::vector<Curve>& curves, double area, double height) {
  if (!of_one_kind(curves) || curves.front().measurement.deforming != Deforming::compression ||
      curves.front().measurement.loaded()) {
    double logs = 0.0;
    int count = 0;
    for (const Curve& c : curves) {
      const double modulus = modulus_of(c, area, height);
      if (modulus > 0.0) logs += std::log(modulus), ++count;
    }
    return count > 0 ? std::exp(logs / count) : 1000.0;
  }
  constexpr double kPart = 0.1;
  double fd = 0.0, dd = 0.0;
  for (const Curve& c : curves) {
    const double reach = kPart * *std::max_element(c.displacement.begin(), c.displacement.end());
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (c.displacement[i] > reach) continue;
      fd += c.force[i] * c.displacement[i];
      dd += c.displacement[i] * c.displacement[i];
    }
  }
  const double stiffness = dd > 0.0 && fd > 0.0 ? fd / dd : 0.0;
  if (stiffness > 0.0) return stiffness * height / area;
  // nothing measured at the start: the secant to the farthest point
  for (const Curve& c : curves) {
    const auto far = std::max_element(c.displacement.begin(), c.displacement.end()) - c.displacement.begin();
    const auto i = static_cast<std::size_t>(far);
    if (c.displacement[i] > 0.0 && c.force[i] > 0.0) return c.force[i] / c.displacement[i] * height / area;
  }
  return 1000.0;
}

}  // namespace glisson::fit

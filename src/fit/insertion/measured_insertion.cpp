#include "fit/insertion/measured_insertion.h"

#include <algorithm>
#include <numeric>

#include "fit/data/choose_column.h"

namespace glisson::fit {
namespace {

/// The numbers of a column in SI, as the file has them: rows at one position are a drop, and are not averaged.
std::vector<double> column(const CurveFile& file, const ColumnSpec& spec, Quantity quantity, const std::string& key,
                           scene::Problems& problems) {
  const ColumnMeaning meaning = quantity == Quantity::length ? ColumnMeaning::displacement : ColumnMeaning::force;
  const std::optional<ChosenColumn> chosen = spec.given ? choose_column(file, spec, quantity, key, problems)
                                                        : guess_column(file, quantity, meaning, key, problems);
  std::vector<double> values;
  if (!chosen) return values;
  for (const CurveFile::Row& row : file.rows) {
    const bool there = chosen->index < row.fields.size();
    const auto value = there ? parse_number(row.fields[chosen->index].text, file.decimal) : std::nullopt;
    if (!value) problems.add({row.line, 1, {}}, "", "has no number in " + chosen->source.title + "; correct the row");
    values.push_back(value.value_or(0.0) * chosen->source.unit->factor);
  }
  return values;
}

ForceCurve sorted(const std::vector<double>& position, const std::vector<double>& force) {
  std::vector<std::size_t> order(position.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return position[a] < position[b]; });
  ForceCurve all;
  for (const std::size_t i : order) {
    all.position.push_back(position[i]);
    all.force.push_back(force[i]);
  }
  return all;
}

ForceCurve averaged(const ForceCurve& all) {
  ForceCurve curve;
  for (std::size_t i = 0, n = 0; i < all.position.size(); ++i) {
    const bool same = i > 0 && all.position[i] == curve.position.back();
    n = same ? n + 1 : 1;
    if (!same) curve.position.push_back(all.position[i]), curve.force.push_back(0.0);
    curve.force.back() += (all.force[i] - curve.force.back()) / static_cast<double>(n);
  }
  return curve;
}

std::vector<Drop> drops_of(const ForceCurve& all, const InsertionSpec& spec) {
  std::vector<Drop> drops;
  double last = 0.0;  // position of the last point that falls
  for (std::size_t i = 0; i < all.position.size(); ++i) {
    const double x = all.position[i];
    double least = all.force[i];
    for (std::size_t j = i; j < all.position.size() && all.position[j] <= x + spec.within; ++j)
      least = std::min(least, all.force[j]);
    if (all.force[i] - least < spec.least_drop) continue;
    const Drop here{x, all.force[i], least};
    if (drops.empty() || x - last > spec.within)
      drops.push_back(here);
    else if (here.force > drops.back().force)
      drops.back() = here;
    last = x;
  }
  return drops;
}

}  // namespace

double ForceCurve::at(double x) const {
  const auto next = std::upper_bound(position.begin(), position.end(), x) - position.begin();
  const auto i = static_cast<std::size_t>(next);
  if (i == 0) return force.front();
  if (i == position.size()) return force.back();
  return force[i - 1] + (force[i] - force[i - 1]) * (x - position[i - 1]) / (position[i] - position[i - 1]);
}

std::vector<double> MeasuredInsertion::grid(const InsertionSpec& spec, double last) const {
  constexpr double kRounding = 1e-9;  // [m]
  std::vector<double> list;
  const double end = std::min(last, curve.position.back()) + kRounding;
  for (int i = 0;; ++i) {
    const double x = i * spec.grid;
    if (x > end) return list;
    const bool near = std::any_of(drops.begin(), drops.end(),
                                  [&](const Drop& d) { return std::abs(d.position - x) <= spec.margin + kRounding; });
    if (!near && x >= curve.position.front()) list.push_back(x);
  }
}

MeasuredInsertion read_insertion(const std::filesystem::path& file, const DataSpec& data, const InsertionSpec& spec) {
  scene::Problems problems(file.string());
  const CurveFile table = read_curve_file(file, data.text);
  const auto position = column(table, data.columns.displacement, Quantity::length, "columns.displacement", problems);
  const auto force = column(table, data.columns.force, Quantity::force, "columns.force", problems);
  problems.throw_if_any();
  MeasuredInsertion measured;
  measured.name = file.stem().string();
  const ForceCurve all = sorted(position, force);
  measured.curve = averaged(all);
  measured.drops = drops_of(all, spec);
  if (measured.drops.empty())
    throw SceneError(file.string() + ": the force nowhere falls by drop_N = " + brief(spec.least_drop) + " N within " +
                     brief(1e3 * spec.within) + " mm; where does the needle pierce the surface? Give a smaller drop_N");
  return measured;
}

}  // namespace glisson::fit

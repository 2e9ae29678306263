#include "fit/fit_curves.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/data/load_curves.h"
#include "fit/data/units.h"
#include "fit/uncertainty/validation.h"

namespace glisson::fit {
namespace {

double largest_force(const Curve& curve) {
  double most = 0.0;
  for (const double f : curve.force) most = std::max(most, std::abs(f));
  return most;
}

/// `A1`, and `A1 (2)` for the second of that name.
void make_unique(std::vector<Curve>& curves) {
  std::map<std::string, int> seen;
  for (Curve& c : curves) {
    const int number = ++seen[c.name];
    if (number > 1) c.name += " (" + std::to_string(number) + ")";
  }
}

/// How far the mean of the others misses a curve of a set, rms over the displacements that all have [N].
double error_of_others(const std::vector<PreparedCurve>& set) {
  std::vector<const Curve*> curves;
  for (const PreparedCurve& p : set) curves.push_back(&p.curve);
  const Spread spread = spread_of(curves, std::numeric_limits<double>::infinity());
  const auto n = static_cast<double>(curves.size());
  return spread.deviation * std::sqrt(n / (n - 1.0));
}

/// The curves of a set, with the contact that leaves them nearer to each other where it is to be chosen.
std::vector<PreparedCurve> loaded(const DataSpec& spec, const SpecimenSize& size, const std::filesystem::path& base) {
  if (spec.contact.kind != ContactKind::automatic) return load_curves(spec, size, base);
  DataSpec detect = spec, none = spec;
  detect.contact.kind = ContactKind::detect, none.contact.kind = ContactKind::none;
  std::vector<PreparedCurve> detected = load_curves(detect, size, base);
  if (detected.size() < 2) return detected;
  std::vector<PreparedCurve> recorded = load_curves(none, size, base);
  const double by_detection = error_of_others(detected), as_recorded = error_of_others(recorded);
  std::vector<PreparedCurve>& nearer = by_detection < as_recorded ? detected : recorded;
  for (PreparedCurve& p : nearer)
    p.account.contact_how += " (the others' mean errs by " + brief(std::min(by_detection, as_recorded), 3) +
                             " N, else " + brief(std::max(by_detection, as_recorded), 3) + " N)";
  return std::move(nearer);
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
  FitCurves all;
  for (std::size_t d = 0; d < spec.data.size(); ++d) {
    DataSpec data = spec.data[d];
    if (data.group.empty()) data.group = "test " + std::to_string(d + 1);
    for (PreparedCurve& p : loaded(data, size, base)) {
      p.curve.group = data.group;
      p.curve.held_out = data.held_out;
      p.curve.weight = data.weight;
      all.curves.push_back(std::move(p.curve));
      all.accounts.push_back(p.account.text());
    }
  }
  make_unique(all.curves);
  return all;
}

std::vector<double> spreads_of(const std::vector<Curve>& curves, Weighing how) {
  std::vector<double> list;
  double squares = 0.0;
  for (const Curve& c : curves) {
    const double peak = std::max(largest_force(c), 1e-12);
    list.push_back(how == Weighing::peak ? 0.01 * peak : std::max(c.noise, 1e-3 * peak));
    squares += list.back() * list.back();
  }
  if (how == Weighing::common)
    std::fill(list.begin(), list.end(), std::sqrt(squares / static_cast<double>(list.size())));
  return list;
}

double initial_modulus(const std::vector<Curve>& curves, double area, double height) {
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

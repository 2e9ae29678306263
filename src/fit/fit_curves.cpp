#include "fit/fit_curves.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/data/load_curves.h"

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
    for (PreparedCurve& p : load_curves(data, size, base)) {
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

#include "fit/model/curve_kinds.h"

#include <algorithm>
#include <cmath>

namespace glisson::fit {

double largest_force(const Curve& curve) {
  double most = 0.0;
  for (const double f : curve.force) most = std::max(most, std::abs(f));
  return most;
}

bool same_kind(const Curve& a, const Curve& b) {
  const Measurement &m = a.measurement, &n = b.measurement;
  return m.deforming == n.deforming && m.measured == n.measured && m.unit == n.unit && m.heat == n.heat;
}

bool are_of_heat(std::span<const Curve> curves) { return !curves.empty() && curves.front().measurement.heat; }

bool of_one_kind(const std::vector<Curve>& curves) {
  return std::all_of(curves.begin(), curves.end(), [&](const Curve& c) { return same_kind(c, curves.front()); });
}

std::string common_unit(const std::vector<Curve>& curves) {
  const bool one = std::all_of(curves.begin(), curves.end(),
                               [&](const Curve& c) { return c.measurement.unit == curves.front().measurement.unit; });
  if (!one) return {};
  return curves.empty() ? "N" : curves.front().measurement.unit;
}

double size_in(const std::string& unit, const Curve& curve) {
  return unit.empty() ? 1.0 / std::max(largest_force(curve), 1e-300) : 1.0;
}

}  // namespace glisson::fit

#include "scene/build/heat_sources.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "glisson/heat/vessel_wall.h"

namespace glisson::scene {

TimeFunction<double> course(const std::vector<double>& times, const std::vector<double>& values,
                            const std::optional<double>& constant, int cycles) {
  if (!values.empty()) return table_course(times, values, cycles);
  return constant ? table_course({}, {*constant}) : TimeFunction<double>();
}

bool is_vessel(const HeatBoundarySpec& x) {
  return !x.region.empty() && (x.coefficient || !x.coefficients.empty() || x.vessel);
}

TimeFunction<double> wall_coefficient_of(const HeatBoundarySpec& x) {
  const std::optional<double> constant = x.vessel ? wall_coefficient(*x.vessel) : x.coefficient;
  return course(x.times, x.coefficients, constant, x.cycles);
}

std::vector<double> pattern_of(const HeatPowerSpec& x, const TetMesh& mesh, std::optional<int> region,
                               const std::vector<int>& hollow) {
  std::vector<double> pattern(mesh.tets.size(), 0.0);
  double whole = 0.0;
  for (std::size_t t = 0; t < pattern.size(); ++t) {
    const int of = mesh.region_of(t);
    if ((region && of != *region) || std::find(hollow.begin(), hollow.end(), of) != hollow.end()) continue;
    pattern[t] = 1.0;
    if (x.pattern) {
      const Vec3d n = unit(x.pattern->axis);
      const double a = x.pattern->across, b = x.pattern->along.value_or(a);
      double sum = 0.0;  // mean of the corners
      for (const std::uint32_t v : mesh.tets[t]) {
        const Vec3d off = mesh.vertices[v] - x.pattern->middle;
        const double z = dot(off, n), r2 = std::max(0.0, dot(off, off) - z * z);
        sum += 0.25 * std::exp(-0.5 * (r2 / (a * a) + z * z / (b * b)));
      }
      pattern[t] = sum;
    }
    whole += pattern[t] * six_rest_volume(mesh, t) / 6.0;
  }
  if (!(whole > 0.0)) {
    throw std::invalid_argument(
        "the pattern has nothing in the body: its middle lies far outside; move `middle_m`, or widen `across_mm`");
  }
  for (double& p : pattern) p /= whole;
  return pattern;
}

RadioFrequency radio_of(const HeatRadioSpec& x, const TetMesh& mesh) {
  RadioFrequency radio;
  if (x.from) {
    const Vec3d way = *x.to - *x.from;
    const Vec3d end = x.active_length ? *x.from + unit(way) * *x.active_length : *x.to;
    radio.electrode = needle_vertices(mesh, *x.from, end, x.radius);
  } else {
    radio.electrode = mesh.vertex_set(x.set);
  }
  radio.ground = mesh.vertex_set(x.ground);
  radio.voltage = course(x.times, x.voltages, x.voltage, x.cycles);
  radio.power = course(x.times, x.powers, x.power, x.cycles);
  return radio;
}

}  // namespace glisson::scene

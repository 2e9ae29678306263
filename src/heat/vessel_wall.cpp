#include "glisson/heat/vessel_wall.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/require_fields.h"
#include "base/text.h"

namespace glisson {
namespace {

constexpr double kLaminar = 2300.0;  // Reynolds number

}  // namespace

double laminar_nusselt(double graetz) {
  const auto cube = [](double x) { return x * x * x; };
  return std::cbrt(cube(3.66) + cube(0.7) + cube(1.615 * std::cbrt(graetz) - 0.7));
}

double wall_coefficient(const VesselWall& v) {
  detail::require_fields("heat: vessel", v);
  if (v.speed == 0.0) return 0.0;
  const double reynolds = v.density * v.speed * v.diameter / v.viscosity;
  if (reynolds > kLaminar) {
    throw std::invalid_argument("heat: vessel: blood of " + detail::show(v.speed) + " m/s in a diameter of " +
                                detail::number_text(1e3 * v.diameter) + " mm has a Reynolds number of " +
                                detail::number_text(reynolds, 4) +
                                ", above 2300, where flow is not laminar; give the coefficient of the wall itself");
  }
  const double graetz =
      v.length > 0.0 ? v.speed * v.diameter * v.diameter * v.heat_capacity / (v.conductivity * v.length) : 0.0;
  return laminar_nusselt(graetz) * v.conductivity / v.diameter;
}

}  // namespace glisson

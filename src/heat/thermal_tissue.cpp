#include "glisson/heat/thermal_tissue.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "heat/thermal_curve.h"

namespace glisson {

Fault ThermalTissue::check() const {
  if (freezing_ends < freezing_begins) return {};
  return {detail::show(freezing_ends) + " °C is not below the " + detail::show(freezing_begins) +
              " °C at which freezing begins; latent heat needs a range",
          "freezing_ends"};
}

ThermalState thermal_state(const ThermalTissue& tissue, double temperature) {
  return heat::ThermalCurve(tissue).at(temperature);
}

double electric_conductivity(const ThermalTissue& tissue, double temperature) {
  constexpr double kReference = 37.0, kBoils = 100.0, kDries = 5.0, kLeast = 1e-4;  // [°C], [°C], [K], share of σ
  if (tissue.electric_conductivity == 0.0) return 0.0;
  double share = 1.0 + tissue.electric_rise * (std::min(temperature, kBoils) - kReference);
  if (temperature > kBoils) share *= std::lerp(1.0, tissue.dry_share, std::min(1.0, (temperature - kBoils) / kDries));
  if (temperature < tissue.freezing_begins) share *= thermal_state(tissue, temperature).liquid;
  return tissue.electric_conductivity * std::max(kLeast, share);
}

}  // namespace glisson

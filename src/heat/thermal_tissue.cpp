#include "glisson/heat/thermal_tissue.h"

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

}  // namespace glisson

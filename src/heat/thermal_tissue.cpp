#include "glisson/heat/thermal_tissue.h"

#include "base/text.h"

namespace glisson {

Fault ThermalTissue::check() const {
  if (freezing_ends < freezing_begins) return {};
  return {detail::show(freezing_ends) + " °C is not below the " + detail::show(freezing_begins) +
              " °C at which freezing begins; latent heat needs a range",
          "freezing_ends"};
}

ThermalState thermal_state(const ThermalTissue& t, double temperature) {
  ThermalState s;
  const double above = temperature - t.freezing_begins;
  if (above >= 0.0) {
    s.capacity = t.density * t.specific_heat, s.conductivity = t.conductivity;
    s.heat = s.capacity * above, s.conducted = t.conductivity * above;
    return s;
  }
  const double range = t.freezing_begins - t.freezing_ends;
  const double between = t.density * (0.5 * (t.specific_heat + t.frozen_specific_heat) + t.latent_heat / range);
  if (temperature > t.freezing_ends) {
    s.liquid = 1.0 + above / range, s.melting = 1.0 / range;
    s.capacity = between, s.heat = between * above;
    s.conductivity = t.frozen_conductivity + s.liquid * (t.conductivity - t.frozen_conductivity);
    s.conducted = 0.5 * (t.conductivity + s.conductivity) * above;
    return s;
  }
  const double below = temperature - t.freezing_ends;
  s.liquid = 0.0, s.capacity = t.density * t.frozen_specific_heat, s.conductivity = t.frozen_conductivity;
  s.heat = -between * range + s.capacity * below;
  s.conducted = -0.5 * (t.conductivity + t.frozen_conductivity) * range + t.frozen_conductivity * below;
  return s;
}

}  // namespace glisson

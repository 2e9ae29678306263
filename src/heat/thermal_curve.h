// thermal_curve.h — a tissue's curves over temperature, with what does not depend on temperature found once.
#pragma once

#include <optional>

#include "glisson/heat/thermal_tissue.h"

namespace glisson::heat {

class ThermalCurve {
 public:
  explicit ThermalCurve(const ThermalTissue& t)
      : begins(t.freezing_begins), ends(t.freezing_ends), liquid_capacity_(t.density * t.specific_heat),
        frozen_capacity_(t.density * t.frozen_specific_heat), k_(t.conductivity), frozen_k_(t.frozen_conductivity),
        range_(begins - ends), per_range_(1.0 / range_),
        between_(t.density * (0.5 * (t.specific_heat + t.frozen_specific_heat) + t.latent_heat / range_)),
        blood_heat(t.perfusion * t.blood_heat_capacity), blood_temperature(t.blood_temperature),
        metabolic_heat(t.metabolic_heat), death(t.death) {}

  ThermalState at(double temperature) const {
    ThermalState s;
    const double above = temperature - begins;
    if (above >= 0.0) {
      s.capacity = liquid_capacity_, s.conductivity = k_;
      s.heat = s.capacity * above, s.conducted = k_ * above;
    } else if (temperature > ends) {
      s.liquid = 1.0 + above * per_range_, s.melting = per_range_;
      s.capacity = between_, s.heat = between_ * above;
      s.conductivity = frozen_k_ + s.liquid * (k_ - frozen_k_);
      s.conducted = 0.5 * (k_ + s.conductivity) * above;
    } else {
      const double below = temperature - ends;
      s.liquid = 0.0, s.capacity = frozen_capacity_, s.conductivity = frozen_k_;
      s.heat = frozen_capacity_ * below - between_ * range_;
      s.conducted = frozen_k_ * below - 0.5 * (k_ + frozen_k_) * range_;
    }
    return s;
  }
  /// The temperature at which a volume contains a heat. @param heat  [J/m³]
  double temperature_of(double heat) const {
    if (heat >= 0.0) return begins + heat / liquid_capacity_;
    if (heat > -between_ * range_) return begins + heat / between_;
    return ends + (heat + between_ * range_) / frozen_capacity_;
  }

  double begins, ends;  ///< of freezing [°C]

 private:
  double liquid_capacity_, frozen_capacity_, k_, frozen_k_, range_, per_range_, between_;

 public:
  double blood_heat, blood_temperature, metabolic_heat;  ///< w ρ_b c_b [W/(m³ K)], [°C], [W/m³]
  std::optional<TissueDeath> death;
};

}  // namespace glisson::heat

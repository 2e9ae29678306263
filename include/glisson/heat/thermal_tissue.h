// thermal_tissue.h — what a tissue is to heat: capacity, latent heat over a range, conduction, blood.
//
//   heat content per volume     H(T) = ρ c (T − T₀), with ρ L more across freezing; piecewise linear
//   conduction                  ∇·(k ∇T),  k from that of tissue to that of ice across the range
//   blood and metabolism        f (w ρ_b c_b (T_b − T) + q),  f the share that is not frozen          [Pennes1948]
//
// Latent heat is part of H, so no step of any length passes over it. Tissue that has died has no blood and no metabolism any more.
#pragma once

#include <optional>

#include "glisson/field.h"

namespace glisson {

/// When tissue dies: of cold, once it has been colder than `cold` for `cold_time` in all [GageBaust1998], or of heat, at Ω ≥ 1,
///   Ω = ∫ A exp(−E/(R T)) dt                                                                      [HenriquesMoritz1947]
/// with A and E of that work, for skin.
struct TissueDeath {
  double cold = -40.0;                    ///< [°C]
  double cold_time = 0.0;                 ///< [s]; 0: at once
  double ln_frequency_factor = 226.7847;  ///< ln A, A in 1/s: that of 3.1e98 [-]; 0: heat does not kill
  double activation_energy = 6.28e5;      ///< E [J/mol]

  template <class Take>
  static constexpr auto fields(Take take) {
    using D = TissueDeath;
    return take(
        field("cold", &D::cold, "°C", between(-200, 60), "tissue dies that has been colder than this")
            .keyed("cold_C")
            .advise("temperatures are in °C, not in K"),
        field("cold_time", &D::cold_time, "s", at_least(0), "for this long in all; 0: at once"),
        field("ln_frequency_factor", &D::ln_frequency_factor, "-", between(0, 1000),
              "ln A, A in 1/s, of the damage by heat, ∫ A exp(−E/(R T)) dt, dead from 1 on; 0: heat does not kill"),
        field("activation_energy", &D::activation_energy, "J/mol", at_least(0), "E of it"));
  }
  bool operator==(const TissueDeath&) const = default;
};

/// Temperatures are in °C. The density counts for tissue and ice alike: the mesh does not move when water expands.
struct ThermalTissue {
  double density = 1000.0;               ///< ρ [kg/m³]
  double conductivity = 0.5;             ///< k [W/(m K)]
  double frozen_conductivity = 2.0;      ///< of ice [W/(m K)]
  double specific_heat = 3600.0;         ///< c [J/(kg K)]
  double frozen_specific_heat = 1800.0;  ///< of ice [J/(kg K)]
  double latent_heat = 250e3;            ///< L [J/kg]
  double freezing_begins = -1.0;         ///< all is liquid above it [°C]
  double freezing_ends = -8.0;           ///< all is ice below it [°C]
  double perfusion = 0.0;                ///< w, volume of blood per volume of tissue and time [1/s]
  double blood_temperature = 37.0;       ///< of arteries, T_b [°C]
  double blood_heat_capacity = 3.6e6;    ///< ρ_b c_b [J/(m³ K)]
  double metabolic_heat = 0.0;           ///< q [W/m³]
  std::optional<TissueDeath> death{};    ///< none: it does not die
  /// σ at 37 °C and its rise per kelvin, of what is not frozen [S/m], [1/K]: σ(T) in electric_conductivity() below. 0: no current
  double electric_conductivity = 0.0, electric_rise = 0.02;
  double dry_share = 0.01;  ///< of σ that is left of tissue that has boiled dry [-]

  template <class Take>
  static constexpr auto fields(Take take) {
    using T = ThermalTissue;
    return take(
        field("density", &T::density, "kg/m³", above(0), "density of tissue and ice"),
        field("conductivity", &T::conductivity, "W/(m K)", above(0), "thermal conductivity"),
        field("frozen_conductivity", &T::frozen_conductivity, "W/(m K)", above(0), "that of ice"),
        field("specific_heat", &T::specific_heat, "J/(kg K)", above(0), "specific heat"),
        field("frozen_specific_heat", &T::frozen_specific_heat, "J/(kg K)", above(0), "that of ice"),
        field("latent_heat", &T::latent_heat, "J/kg", at_least(0), "heat of freezing"),
        field("freezing_begins", &T::freezing_begins, "°C", between(-100, 200), "all is liquid above it")
            .keyed("freezing_begins_C"),
        field("freezing_ends", &T::freezing_ends, "°C", between(-200, 200), "all is ice below it")
            .keyed("freezing_ends_C"),
        field("perfusion", &T::perfusion, "1/s", at_least(0), "volume of blood per volume of tissue and time"),
        field("blood_temperature", &T::blood_temperature, "°C", between(0, 60), "of arteries")
            .keyed("blood_temperature_C"),
        field("blood_heat_capacity", &T::blood_heat_capacity, "J/(m³ K)", above(0), "of blood, per volume"),
        field("metabolic_heat", &T::metabolic_heat, "W/m³", at_least(0), "heat of metabolism"),
        field("death", &T::death, "when it dies, and has no blood any more").otherwise("it does not die"),
        field("electric_conductivity", &T::electric_conductivity, "S/m", at_least(0),
              "electric conductivity at 37 °C and at the frequency of `[[heat.radio]]`; 0: it leads no current"),
        field("electric_rise", &T::electric_rise, "1/K", between(0, 0.2), "rise of that with temperature"),
        field("dry_share", &T::dry_share, "-", between(1e-6, 1),
              "what is left of it above 100 °C, where tissue boils dry"));
  }
  Fault check() const;
  bool operator==(const ThermalTissue&) const = default;
};

/// Of a tissue at a temperature, by the curves above.
struct ThermalState {
  double heat = 0.0;          ///< H, 0 where freezing begins [J/m³]
  double capacity = 0.0;      ///< dH/dT [J/(m³ K)]
  double conducted = 0.0;     ///< ∫ k dT from where freezing begins [W/m]
  double conductivity = 0.0;  ///< k [W/(m K)]
  double liquid = 1.0;        ///< f, share that is not frozen [-]
  double melting = 0.0;       ///< df/dT [1/K]
};
/// @param temperature  [°C]
ThermalState thermal_state(const ThermalTissue& tissue, double temperature);

/// Electric conductivity at a temperature [S/m]: σ (1 + a (T − 37)) [Chang2003] times the share that is not frozen. From 100 °C on it
/// falls to `dry_share` of that at 100 °C, which it has at 105 °C: the width is this program's. Never below σ/10⁴.
double electric_conductivity(const ThermalTissue& tissue, double temperature);

}  // namespace glisson

// vessel_wall.h — what heat goes between the blood of a vessel and its wall.
//
// Laminar flow in a tube whose wall is at one temperature: the mean Nusselt number over a length from where the wall begins to be colder,
//   Nu³ = 3.66³ + 0.7³ + (1.615 Gz^⅓ − 0.7)³,   Gz = u D²/(a L)                                        [VDI2010, § 1]
// with a = k/(ρ c) of blood: within 1 % of the solution of Graetz. It is 3.66 far down a long vessel, and more near the place at which blood
// meets the cold.
#pragma once

#include "glisson/field.h"

namespace glisson {

/// A vessel that blood flows through.
struct VesselWall {
  double diameter = 0.01;        ///< D [m]
  double speed = 0.1;            ///< mean over the section, u [m/s]; 0: blood stands still and brings no heat
  double length = 0.0;           ///< of the wall that is heated or cooled, L [m]; 0: so long that Nu is 3.66
  double conductivity = 0.52;    ///< of blood [W/(m K)]
  double heat_capacity = 3.6e6;  ///< of blood, ρ c [J/(m³ K)]
  double viscosity = 3.5e-3;     ///< of blood [Pa·s]
  double density = 1060.0;       ///< of blood [kg/m³]

  template <class Take>
  static constexpr auto fields(Take take) {
    using V = VesselWall;
    return take(
        field("diameter", &V::diameter, "mm", between(0.01, 100), "inner diameter").must(),
        field("speed", &V::speed, "mm/s", between(0, 5000),
              "of the blood, mean over the section; 0: it stands still and brings no heat")
            .must(),
        field("length", &V::length, "mm", at_least(0),
              "of the wall that is cooled or heated, along the flow; 0: so long that the Nusselt number is 3.66"),
        field("conductivity", &V::conductivity, "W/(m K)", above(0), "thermal conductivity of blood"),
        field("heat_capacity", &V::heat_capacity, "J/(m³ K)", above(0), "of blood, per volume"),
        field("viscosity", &V::viscosity, "Pa·s", above(0), "of blood"),
        field("density", &V::density, "kg/m³", above(0), "of blood"));
  }
};

/// Nu of that law [-]. @param graetz  Gz ≥ 0
double laminar_nusselt(double graetz);

/// h = Nu k/D [W/(m² K)]. @throws std::invalid_argument where a value is out of range, or where ρ u D/η is above 2300 and flow is not
/// laminar
double wall_coefficient(const VesselWall& vessel);

}  // namespace glisson

// heat_spec.h — what [heat] of a scene says: tissues, boundaries, probes, powers, what is read, and for how long.
//
// Values that change are tables over time: `times_s` and as many values, linear between them and constant before and after. Two entries
// of one time are a jump, before which the first holds; `cycles` runs through the table several times.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glisson/heat/heat_simulation.h"
#include "glisson/heat/thermal_tissue.h"
#include "glisson/instruments/ice.h"
#include "glisson/math.h"
#include "glisson/time_function.h"

namespace glisson {

/// A course over time: of values at times, or of one value. @param times  ascending [s]; empty: always the first value
/// @param cycles  how often it is run through, each from the end of the one before
TimeFunction<double> table_course(std::vector<double> times, std::vector<double> values, int cycles = 1);

// `origin` in the structs below is the place in the scene, for messages that need the mesh. It may be empty.

/// A tissue, of the whole body or of a region.
struct HeatTissueSpec {
  std::string region;  ///< name or number; empty: of all that no other has
  ThermalTissue tissue;
  std::string origin;
};

/// What a part of the surface, or a region, is held at or gets.
struct HeatBoundarySpec {
  std::string set;                                       ///< of vertices
  std::string region;                                    ///< in its place: all vertices of a region, such as a vessel
  std::optional<double> temperature, flux, coefficient;  ///< [°C], [W/m²], [W/(m² K)]
  std::vector<double> times, temperatures, fluxes;       ///< [s], [°C], [W/m²]
  int cycles = 1;
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using B = HeatBoundarySpec;
    constexpr std::string_view kCelsius = "temperatures are in °C, not in K";
    return take(
        field("set", &B::set, "vertex set of the surface").otherwise("`region`"),
        field("region", &B::region, "name or number of a region whose vertices are held, such as a vessel's")
            .otherwise("`set`"),
        field("temperature", &B::temperature, "°C", between(-200, 200),
              "temperature at which the vertices are held; with a coefficient that of what lies beyond the surface")
            .keyed("temperature_C")
            .advise(kCelsius),
        field("flux", &B::flux, "W/m²", "heat through the surface, into the body above 0"),
        field("coefficient", &B::coefficient, "W/(m² K)", above(0),
              "heat goes through the surface by this times the difference of temperature")
            .otherwise("held"),
        field("times", &B::times, "s", at_least(0), "times of a table, ascending").otherwise("constant"),
        field("temperatures", &B::temperatures, "°C", between(-200, 200), "in place of `temperature_C`: at these times")
            .keyed("temperatures_C")
            .advise(kCelsius)
            .otherwise("constant"),
        field("fluxes", &B::fluxes, "W/m²", "in place of `flux_W_m2`: at these times").otherwise("constant"),
        field("cycles", &B::cycles, between(1, 1000), "how often the table is run through"),
        no_key("origin", &B::origin));
  }
};

/// A probe: a line that gives heat along its active length; the rest of its shaft is insulated.
struct HeatProbeSpec {
  std::string name = "probe";
  Vec3d from{}, to{};                                             ///< tip, and a point up its shaft [m]
  std::optional<double> active_length;                            ///< from the tip [m]; none: all of it
  double radius = 0.0;                                            ///< [m]
  std::optional<double> power, temperature, coefficient;          ///< [W/m], [°C], [W/(m K)]
  std::vector<double> times, powers, temperatures, coefficients;  ///< [s] and as above
  int cycles = 1;
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using P = HeatProbeSpec;
    constexpr std::string_view kCelsius = "temperatures are in °C, not in K";
    constexpr std::string_view kNoTissue =
        "more than that no tissue bears: at a shaft of 0.75 mm radius −1000 W/m is already −252 °C";
    return take(
        field("name", &P::name, "name"), field("from", &P::from, "m", "its tip").must(),
        field("to", &P::to, "m", "a point up its shaft").must(),
        field("active_length", &P::active_length, "mm", above(0), "length from the tip on which it gives heat")
            .otherwise("up to `to_m`"),
        field("radius", &P::radius, "mm", between(0, 20), "radius on which it gives heat; 0: on its axis"),
        field("power", &P::power, "W/m", between(-1000, 20000), "power per length, below 0 where it cools")
            .advise(kNoTissue),
        field("temperature", &P::temperature, "°C", between(-200, 200), "of its surface, with a coefficient")
            .keyed("temperature_C")
            .advise(kCelsius),
        field("coefficient", &P::coefficient, "W/(m K)", at_least(0),
              "power per length and kelvin between its surface and the tissue there"),
        field("times", &P::times, "s", at_least(0), "times of a table, ascending").otherwise("constant"),
        field("powers", &P::powers, "W/m", between(-1000, 20000), "in place of `power_W_m`: at these times")
            .advise(kNoTissue)
            .otherwise("constant"),
        field("temperatures", &P::temperatures, "°C", between(-200, 200), "in place of `temperature_C`: at these times")
            .keyed("temperatures_C")
            .advise(kCelsius)
            .otherwise("constant"),
        field("coefficients", &P::coefficients, "W/(m K)", at_least(0),
              "in place of `coefficient_W_m_K`: at these times; 0: it is off, and tissue thaws by itself")
            .otherwise("constant"),
        field("cycles", &P::cycles, between(1, 1000), "how often the table is run through"),
        no_key("origin", &P::origin));
  }
};

/// Heat per volume of a region.
struct HeatPowerSpec {
  std::string region;           ///< name or number; empty: the whole body
  std::optional<double> power;  ///< [W/m³]
  std::vector<double> times, powers;
  int cycles = 1;
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using P = HeatPowerSpec;
    constexpr std::string_view kNoTissue = "more than that no tissue bears: 1e8 W/m³ boils it within three seconds";
    return take(field("region", &P::region, "name or number of a region").otherwise("the whole body"),
                field("power", &P::power, "W/m³", between(-1e8, 1e8), "heat per volume and time").advise(kNoTissue),
                field("times", &P::times, "s", at_least(0), "times of a table, ascending").otherwise("constant"),
                field("powers", &P::powers, "W/m³", between(-1e8, 1e8), "in place of `power_W_m3`: at these times")
                    .advise(kNoTissue)
                    .otherwise("constant"),
                field("cycles", &P::cycles, between(1, 1000), "how often the table is run through"),
                no_key("origin", &P::origin));
  }
};

/// A thermocouple, several along a line, or the mean over a region.
struct HeatSensorSpec {
  std::string name = "sensor";
  std::optional<Vec3d> point, from, to;  ///< [m]
  int count = 5;                         ///< along the line, ends included
  std::string region;
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = HeatSensorSpec;
    return take(field("name", &S::name, "name, of its column `NAME_C` of temperature.csv"),
                field("point", &S::point, "m", "its place at rest").otherwise(""),
                field("from", &S::from, "m", "in place of a point: the first of several along a line").otherwise(""),
                field("to", &S::to, "m", "the last of them").otherwise(""),
                field("count", &S::count, between(2, 1000), "how many along the line: `NAME_1_C` …"),
                field("region", &S::region, "in place of a point: the mean over the volume of a region").otherwise(""),
                no_key("origin", &S::origin));
  }
};

/// How much of a line is frozen, or below an isotherm: where a front is.
struct HeatFrontSpec {
  std::string name = "front";
  Vec3d from{}, to{};                 ///< [m]
  std::optional<double> temperature;  ///< [°C]; none: the share of tissue that is frozen
  std::optional<double> above;        ///< [°C]; what is colder does not count
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using F = HeatFrontSpec;
    return take(field("name", &F::name, "name, of its column `NAME_m` of heat.csv"),
                field("from", &F::from, "m", "one end of a line").must(),
                field("to", &F::to, "m", "its other end").must(),
                field("temperature", &F::temperature, "°C", between(-200, 200),
                      "the length of the line that is colder than this")
                    .keyed("temperature_C")
                    .otherwise("the length that is frozen, by the share of ice at each place")
                    .advise("temperatures are in °C, not in K"),
                field("above", &F::above, "°C", between(-200, 200),
                      "only what is not colder than this counts: the length between two isotherms")
                    .keyed("above_C")
                    .otherwise("all of it")
                    .advise("temperatures are in °C, not in K"),
                no_key("origin", &F::origin));
  }
};

/// A section through the whole body.
struct HeatPlaneSpec {
  Vec3d point{}, normal{0.0, 0.0, 1.0};

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("point", &HeatPlaneSpec::point, "m", "a point on it").keyed("point").must(),
                field("normal", &HeatPlaneSpec::normal, "across it, of any length").direction());
  }
};

/// What is colder than an isotherm: its volume, its extents, and on a plane its area and largest width.
struct HeatIsothermSpec {
  std::string name = "isotherm";
  double temperature = 0.0;  ///< [°C]
  std::string region;        ///< empty: of the whole body
  std::optional<HeatPlaneSpec> plane;
  std::string origin;

  template <class Take>
  static constexpr auto fields(Take take) {
    using I = HeatIsothermSpec;
    return take(field("name", &I::name, "name, of its columns of heat.csv: `NAME_volume_m3`, `NAME_extent_x_m` …"),
                field("temperature", &I::temperature, "°C", between(-200, 200), "what is colder than this")
                    .keyed("temperature_C")
                    .must()
                    .advise("temperatures are in °C, not in K"),
                field("region", &I::region, "region whose volume alone counts").otherwise("the whole body"),
                field("plane", &I::plane,
                      "adds what of a section is colder: `NAME_area_m2`, and its largest extent `NAME_width_m`")
                    .keyed("plane_m")
                    .otherwise("none"),
                no_key("origin", &I::origin));
  }
};

/// Mechanics beside heat: the body moves, and freezes in the shape that it has.
struct HeatIceSpec {
  IceOptions options;
  double every = 1.0;  ///< time after which each learns of the other [s]
};

/// An experiment of heat, alone or beside mechanics.
struct HeatSpec {
  std::vector<HeatTissueSpec> tissues;
  HeatOptions options;
  std::vector<HeatBoundarySpec> boundaries;
  std::vector<HeatProbeSpec> probes;
  std::vector<HeatPowerSpec> powers;
  std::vector<HeatSensorSpec> sensors;
  std::vector<HeatFrontSpec> fronts;
  std::vector<HeatIsothermSpec> isotherms;
  std::optional<HeatIceSpec> ice;  ///< none: heat alone
  double duration = 600.0;         ///< [s]
  double sample_every = 10.0;      ///< between lines of the tables; steps end there [s]
  std::string origin;
};

}  // namespace glisson

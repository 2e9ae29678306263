// heat_history.h — what each vertex of a body has been through: cold and heat, freezings, damage, death.
//
// Within a step temperature is taken as linear in time, from which times and doses follow exactly (damage by three points of Gauss).
// Death counts from the end of the step in which it comes. A vertex of several tissues goes by the one of which it has most.
#pragma once

#include <cstdint>
#include <vector>

#include "glisson/archive.h"

namespace glisson {

/// Each list has an entry a vertex.
struct HeatHistory {
  std::vector<double> coldest, hottest;  ///< so far [°C]
  /// Equivalent time at 43 °C, ∫ R^(43 − T) dt, R = ½ above 43 °C, ¼ from 39 to 43 °C, 0 below [min]   [SaparetoDewey1984]
  std::vector<double> cem43;
  std::vector<double> damage;              ///< Ω of its TissueDeath [-]; 0 where its tissue does not die
  std::vector<double> cold_time;           ///< below `cold` of its TissueDeath [s]
  std::vector<std::vector<double>> below;  ///< of each of HeatOptions::isotherms: time below it [s]
  std::vector<std::uint32_t> freezings;    ///< times that more than half of it froze; it thaws in full between two
  std::vector<std::uint8_t> frozen;        ///< 1: since the last freezing it has not thawed in full
  std::vector<std::uint8_t> dead;          ///< 1: it has died

  void archive(Archive& ar) { ar(coldest, hottest, cem43, damage, cold_time, below, freezings, frozen, dead); }
  bool operator==(const HeatHistory&) const = default;
};

/// Equivalent time at 43 °C of a temperature that goes linearly from one to another within a time [s] → [min].
double cem43(double from, double to, double time);

}  // namespace glisson

// membrane_stations.h — where along a measured curve the resistance of the tip changes, and what the curve asks of it.
//
//   force                        ╱│           the tip cuts at a level, sticks at a membrane, and the force rises as fast as
//                    rise      ╱  │           the body is stiff; the membrane breaks, and the force falls to the next level
//       level ─────────────◠ ╱    │ drop      or to the next rise, whichever is higher
//     ──── piece ──┬── piece ─────┴─── piece ──▶ position
#pragma once

#include <optional>
#include <vector>

#include "fit/insertion/insertion_run.h"

namespace glisson::fit {

struct Station {
  double position = 0.0;       ///< in the measured curve [m]
  std::optional<double> peak;  ///< measured force before the drop here [N]; none: a piece of the cutting force begins
  double depth = 0.0;          ///< in tissue at rest [m]
  double puncture = 0.0;       ///< of the tip [N]
  std::optional<double> cutting;  ///< beyond it [N]; none: as before it, since the tip never only cuts there
};

/// The puncture of the surface, every further drop, and between them the beginnings of pieces.
std::vector<Station> stations_of(const MeasuredInsertion& measured, const InsertionSpec& spec);

/// What the stations mean for a needle.
TipProfile profile_of(const std::vector<Station>& stations);

/// What a body as stiff as that of a run can meet of the measured curve between two drops.
struct GapAim {
  std::optional<double> peak;              ///< force before the drop at its end [N]
  std::vector<std::optional<double>> cut;  ///< per piece: mean of aim − run where the tip is to cut [N]; none: nowhere
  std::vector<double> level;               ///< per piece: total force while it cuts [N]
};

/// Least squares over the levels of the pieces and the force before the drop, of max(level, rise) − measured; the rise is that
/// of the run before its own drop, moved. @param first, last  stations at the gap's ends, the first a drop
GapAim aim_between(const std::vector<Station>& stations, std::size_t first, std::size_t last, std::size_t drop,
                   const MeasuredInsertion& measured, const std::vector<double>& grid, const InsertionRun& run,
                   const InsertionSpec& spec);

/// Force of a run before an inner puncture, and how fast it rose [N], [N/m].
struct RiseEnd {
  double force = 0.0, slope = 0.0;
};
RiseEnd rise_end(const InsertionRun& run, double puncture);

}  // namespace glisson::fit

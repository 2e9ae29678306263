// membrane_search.h — places and strengths of inner membranes from a measured curve, by a handful of runs of the scene itself.
#pragma once

#include <functional>

#include "fit/insertion/membrane_stations.h"

namespace glisson::fit {

struct MembraneFit {
  std::vector<Station> stations;
  TipProfile profile;
  InsertionRun run;  ///< at that profile
  std::vector<double> grid;
  double rms = 0.0;         ///< on the grid, simulated − measured [N]
  double rms_before = 0.0;  ///< the same without any membrane, at the scene's own cutting force [N]
  int runs = 0;
};

/// The first run is without membranes. From it and the drops come first places and strengths: the force before a drop, less
/// the friction of the shaft. Each further run corrects them by how far its own drops are from their aims, in position and
/// force; the nearest run is kept, also where `stop` ends the search early.
/// @throws std::runtime_error where a run does not come to its end, the surface holds, or `stop` ends it before the second run is done
MembraneFit fit_membranes(const MeasuredInsertion& measured, const InsertionSpec& spec, const InsertionScene& scene,
                          const std::atomic<bool>& stop, const std::function<void(int run, double rms)>& progress);

/// Force of a run at a position; zero before it begins.
double simulated_force(const InsertionRun& run, double x);

}  // namespace glisson::fit

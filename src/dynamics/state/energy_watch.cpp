// energy_watch.cpp — see glisson/simulation/energy_watch.h.
#include "glisson/simulation/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace glisson {

void EnergyWatch::pay(const Energies& now) {
  const auto gained = [](double before, double after) { return std::max(0.0, after - before); };
  gain_.paid += std::abs(now.initial - last_.initial) + gained(last_.work_tools, now.work_tools) +
                gained(last_.work_loads, now.work_loads) + std::abs(now.changed - last_.changed) +
                std::abs(now.removed - last_.removed);
  last_ = now;
}

void EnergyWatch::judge(EnergyGain::Of of, double time, double share, double bound) {
  gain_.most = std::max(gain_.most, share);
  if (gain_.any() || !(share > bound)) return;
  gain_.of = of;
  gain_.began = time;
}

void EnergyWatch::see(double time, const Energies& now, std::optional<double> stored) {
  pay(now);
  const double paid = gain_.paid + negligible_;
  if (!(paid > 0.0)) return;
  judge(EnergyGain::Of::elastic, time, -now.elastic / paid, kGivenBack);
  judge(EnergyGain::Of::kinetic, time, now.kinetic / paid, kMore);
  if (stored) judge(EnergyGain::Of::stored, time, *stored / paid, kMoreStored);
}

double negligible_energy(const Simulation& simulation) {
  constexpr double kStrain = 1e-6;
  const TetMesh& mesh = simulation.mesh();
  std::map<int, double> volumes;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (!simulation.is_removed(t)) volumes[mesh.region_of(t)] += six_rest_volume(mesh, t) / 6.0;
  }
  double sum = 0.0;
  for (const auto& [region, volume] : volumes) {
    const LameParameters lame = simulation.tissue(region).lame();
    sum += volume * (lame.lambda + 2.0 * lame.mu);
  }
  return 0.5 * sum * kStrain * kStrain;
}

}  // namespace glisson

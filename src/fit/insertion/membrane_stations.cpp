#include "fit/insertion/membrane_stations.h"

#include <algorithm>
#include <cmath>

namespace glisson::fit {
namespace {

constexpr double kNear = 1.5e-3;      ///< over which the slope of a rise is taken [m]
constexpr double kLeastSlope = 50.0;  ///< [N/m]
constexpr int kSteps = 200;           ///< of levels and peaks that are tried
constexpr std::size_t kFewest = 3;    ///< positions of the grid that a piece is to cut at

/// The force of a run before one of its drops, moved so that it ends elsewhere; below the membrane's touch, a straight line.
class Rise {
 public:
  Rise(const InsertionRun& run, double puncture, double touch)
      : run_(run), end_(puncture), from_(std::min(touch, puncture - kNear)), before_(rise_end(run, puncture)),
        first_((run.curve.at(from_ + kNear) - run.curve.at(from_)) / kNear) {}
  /// @param back  how far before the drop [m] @param peak  force there [N]
  double at(double back, double peak) const {
    const double x = end_ - back;
    const double force = x >= from_ ? (back > 0.0 ? run_.curve.at(x) : before_.force)
                                    : run_.curve.at(from_) - std::max(first_, kLeastSlope) * (from_ - x);
    return peak + std::min(force, before_.force) - before_.force;
  }

 private:
  const InsertionRun& run_;
  double end_, from_;
  RiseEnd before_;
  double first_;
};

struct Level {
  double value = 0.0, cost = 0.0;
};

/// The level L that makes Σ (max(L, rise) − measured)² least.
Level best_level(const std::vector<double>& measured, const std::vector<double>& rise) {
  const double top = measured.empty() ? 0.0 : *std::max_element(measured.begin(), measured.end());
  Level best{0.0, INFINITY};
  for (int k = 0; k <= kSteps; ++k) {
    Level now{top * k / kSteps, 0.0};
    for (std::size_t i = 0; i < measured.size(); ++i)
      now.cost += std::pow(std::max(now.value, rise.empty() ? 0.0 : rise[i]) - measured[i], 2);
    if (now.cost < best.cost) best = now;
  }
  return best;
}

}  // namespace

RiseEnd rise_end(const InsertionRun& run, double puncture) {
  const auto& x = run.curve.position;
  const auto next = std::lower_bound(x.begin(), x.end(), puncture) - x.begin();
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next, 2));
  const double force = std::max(run.curve.force[i - 1], run.curve.force[i - 2]);
  return {force, std::max(kLeastSlope, (force - run.curve.at(puncture - kNear)) / kNear)};
}

std::vector<Station> stations_of(const MeasuredInsertion& measured, const InsertionSpec& spec) {
  std::vector<Station> stations;
  for (std::size_t d = 0; d < measured.drops.size(); ++d) {
    const double from = measured.drops[d].position;
    const bool last = d + 1 == measured.drops.size();
    const double to = last ? measured.curve.position.back() : measured.drops[d + 1].position;
    const int pieces = std::max(1, static_cast<int>(std::lround((to - from) / spec.piece)));
    stations.push_back({from, measured.drops[d].force, 0.0, 0.0, {}});
    for (int p = 1; p < pieces; ++p) stations.push_back({from + (to - from) * p / pieces, {}, 0.0, 0.0, {}});
  }
  return stations;
}

TipProfile profile_of(const std::vector<Station>& stations) {
  TipProfile profile{stations.front().cutting.value_or(0.0), {}};
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const Station& s = stations[i];
    if (!s.peak && !s.cutting) continue;
    profile.membranes.push_back({s.depth, s.puncture, s.cutting});
  }
  return profile;
}

GapAim aim_between(const std::vector<Station>& stations, std::size_t first, std::size_t last, std::size_t drop,
                   const MeasuredInsertion& measured, const std::vector<double>& grid, const InsertionRun& run,
                   const InsertionSpec& spec) {
  const bool ends = last < stations.size();
  const double none = std::numeric_limits<double>::infinity();
  const bool broke = ends && drop <= run.inner.size();
  const double broken_at = broke ? run.inner[drop - 1] : run.puncture;
  const Rise rise(run, broken_at, broke ? run.reached(stations[last].depth) : run.contact);
  std::vector<std::vector<double>> at(last - first), forces(last - first);  // per piece
  for (const double x : grid) {
    for (std::size_t p = first; p < last; ++p) {
      const double to = p + 1 < stations.size() ? stations[p + 1].position : none;
      if (x < stations[p].position || x >= to) continue;
      at[p - first].push_back(x);
      forces[p - first].push_back(measured.curve.at(x));
    }
  }
  const auto rises = [&](std::size_t p, double peak) {
    std::vector<double> list;
    for (const double x : at[p]) list.push_back(ends ? rise.at(stations[last].position - x, peak) : 0.0);
    return list;
  };
  GapAim best;
  double least = none;
  for (int k = 0; k <= (ends ? kSteps : 0); ++k) {
    GapAim now;
    const double measured_peak = ends ? *stations[last].peak : 0.0, peak = measured_peak * (0.4 + 0.8 * k / kSteps);
    double cost = spec.peak / spec.grid * std::pow(peak - measured_peak, 2) * (ends ? 1.0 : 0.0);
    for (std::size_t p = 0; p < at.size(); ++p) {
      const Level level = best_level(forces[p], rises(p, peak));
      now.level.push_back(level.value);
      cost += level.cost;
    }
    if (ends) now.peak = peak;
    if (cost < least) least = cost, best = now;
  }
  for (std::size_t p = 0; p < at.size(); ++p) {
    const std::vector<double> rising = rises(p, best.peak.value_or(0.0));
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < at[p].size(); ++i) {
      if (rising[i] >= best.level[p]) continue;
      sum += best.level[p] - run.curve.at(at[p][i]);
      ++count;
    }
    best.cut.push_back(count < kFewest ? std::nullopt : std::optional(sum / static_cast<double>(count)));
  }
  return best;
}

}  // namespace glisson::fit

// figure3.cpp — viscous tissues at several velocities and viscosities, [Schwartz2002, fig. 3].
//
// The overhead at the start is taken 20 ms after the motion has begun. By then momentum has spread through the body
// (ρ L² / η is 6 ms at 1000 Pa·s, 32 ms at 200), and the tool has moved by 0.2 mm at most, so that the strain has not
// yet been redistributed by elasticity (η / E is 56 ms at 200 Pa·s).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "paper/curve_fit.h"
#include "paper/figures.h"

namespace glisson::app {
namespace {

constexpr double kStart_s = 0.020;  // of a motion, 0.2 mm at 10 mm/s
constexpr double kAllowed = 0.02;   // deviation from proportionality

struct Overhead {
  std::string label;
  double cause, force_N;
};

double at_start(const VariantRecorder& run, const std::string& column) {
  return interpolate(run.column("time_s"), run.column(column), kStart_s);
}

void sort_by_cause(std::vector<Overhead>& list) {
  std::sort(list.begin(), list.end(), [](const Overhead& a, const Overhead& b) { return a.cause < b.cause; });
}

/// @param per  unit of force / cause, e.g. "N per m/s"
SceneExtras proportionality(std::vector<Overhead> list, const std::string& to, const std::string& per,
                            const std::string& note) {
  SceneExtras extras;
  if (list.size() < 2) return extras;
  sort_by_cause(list);
  const double reference = list.back().force_N / list.back().cause;
  double worst = 0.0;
  nlohmann::json rows = nlohmann::json::array();
  for (const Overhead& o : list) {
    const double ratio = o.force_N / o.cause, deviation = ratio / reference - 1.0;
    worst = std::max(worst, std::abs(deviation));
    rows.push_back({o.label, fmt::format("{:.5f}", o.force_N), fmt::format("{:.6g}", ratio),
                    fmt::format("{:+.2f} %", std::round(1e4 * deviation) / 100.0 + 0.0)});
  }
  extras.tables.push_back({{"title", "Overhead at the start against " + to},
                           {"columns", {"variant", "overhead at 20 ms [N]", per, "deviation from the last row"}},
                           {"rows", std::move(rows)},
                           {"note", note}});
  extras.checks.push_back(check_json(
      fmt::format("The overhead at the start is proportional to {}", to),
      fmt::format("within {:.2f} % over a factor of {:g}", 100.0 * worst, list.back().cause / list.front().cause),
      "within 2 % [Schwartz2002, eq. 7, fig. 3]", worst <= kAllowed));
  return extras;
}

}  // namespace

SceneExtras figure3a_extras(const Finished& runs) {
  std::vector<Overhead> list;
  for (const auto& [name, run] : runs) {
    list.push_back({run->variant().label, run->variant().tools.front().motion.velocity, at_start(*run, "viscous_N")});
  }
  return proportionality(std::move(list), "velocity", "N per m/s", "Viscous part of the force, 20 ms after the start.");
}

SceneExtras figure3b_extras(const Finished& runs) {
  const auto without = runs.find("eta_0");
  if (without == runs.end()) return {};
  const double force_without = at_start(*without->second, "force_N");
  std::vector<Overhead> list;
  for (const auto& [name, run] : runs) {
    const double viscosity = run->variant().tissue.viscosity;
    if (viscosity > 0.0) list.push_back({run->variant().label, viscosity, at_start(*run, "force_N") - force_without});
  }
  return proportionality(std::move(list), "viscosity", "N per Pa·s",
                         "Force less that of the tissue without viscosity, 20 ms after the start.");
}

}  // namespace glisson::app

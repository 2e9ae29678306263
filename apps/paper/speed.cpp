// speed.cpp — the cost of an iteration, [Schwartz2002, sec. 2.4].
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "paper/curve_fit.h"
#include "paper/figures.h"
#include "program/interrupt.h"

namespace glisson::app {
namespace {

constexpr int kRounds = 25;
constexpr double kPaperFullNs = 84.6e3;  // per tet and iteration: 6.5 s / 100 / 768, 550 MHz Pentium II
constexpr double kPaperRatio = 5.0;      // full over linear

struct Timing {
  std::string name, label;
  std::vector<double> ns;  // per tet and step, one a round
};

/// Rounds over all variants in turn, so that a slow moment of the machine touches all of them; the first round warms up.
std::vector<Timing> measure(const Scene& scene) {
  std::vector<Timing> timings;
  for (const Variant& v : scene.variants) timings.push_back({v.name, v.label, {}});
  for (int round = 0; round <= kRounds && !stop_flag(); ++round) {
    for (std::size_t i = 0; i < scene.variants.size(); ++i) {
      RunObserver nobody;
      const RunSummary summary = run_variant(scene.variants[i], no_file, nobody, stop_flag());
      if (round > 0) timings[i].ns.push_back(summary.ns_per_tet_step);
    }
  }
  return timings;
}

double median_of(const std::vector<Timing>& timings, const std::string& name) {
  const auto found = std::find_if(timings.begin(), timings.end(), [&](const Timing& t) { return t.name == name; });
  return found == timings.end() ? 0.0 : median(found->ns);
}

nlohmann::json row(const std::string& label, double ns, const std::string& spread) {
  return {label, fmt::format("{:.1f}", ns), spread, fmt::format("{:.4g}", ns * 768.0 * 100.0 * 1e-6),
          fmt::format("{:.0f}", kPaperFullNs / ns)};
}

}  // namespace

SceneExtras speed_extras(const Scene& scene) {
  const std::vector<Timing> timings = measure(scene);
  SceneExtras extras;
  if (timings.front().ns.empty() || timings.back().ns.empty()) return extras;
  nlohmann::json rows = nlohmann::json::array();
  for (const Timing& t : timings) {
    const auto [least, most] = std::minmax_element(t.ns.begin(), t.ns.end());
    rows.push_back(row(t.label, median(t.ns), fmt::format("{:.1f} to {:.1f}", *least, *most)));
  }
  rows.push_back(row("paper: full, 550 MHz Pentium II", kPaperFullNs, ""));
  rows.push_back(row("paper: linear, a fifth of it", kPaperFullNs / kPaperRatio, ""));
  const double ratio = median_of(timings, "full") / median_of(timings, "linear");
  extras.tables.push_back(
      {{"title", "Cost of an iteration"},
       {"columns",
        {"model", "ns per tet and iteration", "spread", "ms per 100 iterations", "paper's full model / this"}},
       {"rows", std::move(rows)},
       {"note",
        fmt::format("Medians of {} runs of 100 iterations on one core of {}. The full model costs {:.2f} times the "
                    "linear one in single precision; the paper's cost {:g} times.",
                    kRounds, machine_text(), ratio, kPaperRatio)}});
  return extras;
}

}  // namespace glisson::app

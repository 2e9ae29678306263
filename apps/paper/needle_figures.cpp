// needle_figures.cpp — a needle in a container of liver, [Schwartz2002, fig. 4 to 6], and in bovine liver, [Okamura2004].
#include "paper/needle_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <ranges>
#include <vector>

#include "paper/curve_fit.h"

namespace glisson::app {
namespace {

constexpr double kBeforePuncture_m = 0.005;  // a depth that all velocities reach before the surface gives way
constexpr double kCarried = 0.002;           // share of the needle's impulse that the container may lack
constexpr double kFollowed_N = 0.04;         // rms from the measured force up to the puncture
constexpr double kPredicted = 2.0;           // rms of a prediction over the scatter of the curves; see prediction_check

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// What bottom and side carry along z over the whole run, in parts of what the needle pushes: 1 but for momentum left at the end.
double share_carried(const VariantRecorder& run) {
  return (sum(run.column("bottom_z_N")) + sum(run.column("side_z_N"))) / sum(run.column("force_z_N"));
}

double speed_of(const VariantRecorder& run) {
  const auto& time = run.column("time_s");
  const auto& depth = run.column("depth_m");
  const auto at = static_cast<std::size_t>(std::ranges::lower_bound(depth, kBeforePuncture_m) - depth.begin());
  return (depth.at(at) - depth.at(at / 2)) / (time.at(at) - time.at(at / 2));
}

/// The finished runs of a scene, the slowest first.
std::vector<const VariantRecorder*> by_speed(const Finished& runs) {
  std::vector<const VariantRecorder*> list;
  for (const auto& [name, run] : runs) list.push_back(run);
  std::ranges::sort(list, {}, [](const VariantRecorder* run) { return speed_of(*run); });
  return list;
}

std::string listed(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

/// Depth [mm] and force [N] of a driven tool without the inertia of its vertices, which jump to their speed at once.
nlohmann::json simulated_line(const VariantRecorder& run) {
  const auto &depth = run.column("depth_m"), &force = run.column("force_N"), &inertial = run.column("inertial_N");
  std::vector<double> x, y;
  for (std::size_t i = 0; i < depth.size(); ++i) x.push_back(depth[i] / kMilli), y.push_back(force[i] - inertial[i]);
  return {{"label", "simulated"}, {"x", x}, {"y", y}};
}

/// One panel of figures 5 and 6: the curves of a group of the fit, and the simulation at their velocity.
nlohmann::json panel(const std::string& title, const fit::FitResult& fit, const std::string& group,
                     const VariantRecorder& run) {
  nlohmann::json json = chart_json({.title = title,
                                    .x = {.column = "depth_m", .label = "depth [mm]", .scale = 1.0 / kMilli},
                                    .y = {.column = "force_N", .label = "force [N]", .scale = 1.0},
                                    .measured = {},
                                    .variants = {},
                                    .value = {}});
  json["variants"] = nlohmann::json::array();
  json["lines"] = {simulated_line(run)};
  json["points"] = nlohmann::json::array();
  for (const fit::CurveResult& c : fit.curves) {
    if (c.curve.group != group) continue;
    std::vector<double> x;
    for (const double u : c.curve.displacement) x.push_back(u / kMilli);
    json["points"].push_back({{"label", c.curve.name}, {"x", x}, {"y", c.curve.force}});
  }
  return json;
}

/// The means of five fitted and of five other specimens differ by √(2/5) t of their scatter, t Student's with 4 degrees of freedom: a
/// perfect law is within √(1 + 2/5 × 2.78²) = 2.0 times the scatter in 95 % of all draws.
nlohmann::json prediction_check(const std::string& title, const fit::GroupResult& group) {
  const double spread = group.spread.value_or(0.0);
  return check_json(fmt::format("{}: {} by the fit", title, group.held_out ? "predicted" : "met"),
                    fmt::format("{:.4f} N rms, {:.2f} times what the curves differ by among themselves", group.rms,
                                group.rms / spread),
                    fmt::format("{:g} times or less [Schwartz2002, fig. 5 and 6]", kPredicted),
                    group.rms <= kPredicted * spread);
}

nlohmann::json parameter_table(const fit::FitResult& fit) {
  nlohmann::json rows = nlohmann::json::array();
  for (const fit::ParameterResult& p : fit.parameters) {
    const auto interval = p.ci95();
    rows.push_back({p.parameter.name, fmt::format("{:.4g} {}", p.value, p.parameter.unit),
                    interval ? fmt::format("{:.4g} to {:.4g}", interval->low, interval->high) : "unknown"});
  }
  return {{"title", "Parameters fitted to five curves at 2 mm/s"},
          {"columns", {"parameter", "value", "95 % interval"}},
          {"rows", std::move(rows)},
          {"note", "The specimens were made with E = 4000 Pa, a slope of 15 000 Pa and η = 1000 Pa·s on average."}};
}

struct Panel {
  const char *title, *group, *variant;
};
constexpr Panel kPanels[] = {{"Figure 5a: 2 mm/s, the five curves that are fitted", "2 mm/s", "slow"},
                             {"Figure 5b: 2 mm/s, five others", "2 mm/s, others", "slow"},
                             {"Figure 6a: 6 mm/s", "6 mm/s", "middle"},
                             {"Figure 6b: 10 mm/s", "10 mm/s", "fast"}};

/// Root mean square of simulated less measured force at the measured points before the first fall of the force, the puncture [N].
double rms_before_puncture(const ChartSpec& chart, const VariantRecorder& run) {
  const MeasuredSpec& measured = chart.measured.front();
  std::vector<double> x = run.column(chart.x.column);
  for (double& value : x) value *= chart.x.scale;
  const auto puncture = std::adjacent_find(measured.ys.begin(), measured.ys.end(), std::greater<>{});
  double squares = 0.0;
  const auto count = static_cast<std::size_t>(puncture - measured.ys.begin());
  for (std::size_t i = 0; i < count; ++i) {
    const double off = interpolate(x, run.column(chart.y.column), measured.xs[i]) - measured.ys[i];
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
}

}  // namespace

SceneExtras figure4_extras(const Finished& runs) {
  SceneExtras extras;
  const auto list = by_speed(runs);
  if (list.size() < 2) return extras;
  std::vector<std::string> carried, forces;
  bool all_carried = true, grows = true;
  double last = 0.0;
  for (const VariantRecorder* run : list) {
    const double share = share_carried(*run);
    const double force = interpolate(run->column("depth_m"), run->column("force_N"), kBeforePuncture_m);
    carried.push_back(fmt::format("{:.2f} %", 100.0 * share));
    forces.push_back(fmt::format("{:.4f} N at {}", force, run->variant().label));
    all_carried &= std::abs(share - 1.0) <= kCarried;
    grows &= force > last;
    last = force;
  }
  extras.checks.push_back(
      check_json("Bottom and side of the container carry what the needle pushes, over the whole run", listed(carried),
                 fmt::format("100 % within {:g} %, momentum", 100.0 * kCarried), all_carried));
  extras.checks.push_back(check_json("The faster the needle, the larger its force before the puncture, 5 mm deep",
                                     listed(forces), "grows with the velocity [Schwartz2002, fig. 5 and 6]", grows));
  return extras;
}

SceneExtras figures_5_and_6_extras(const fit::FitResult& fit, const Finished& runs) {
  SceneExtras extras;
  for (const Panel& p : kPanels) {
    const auto run = runs.find(p.variant);
    const auto group = std::ranges::find(fit.groups, p.group, &fit::GroupResult::name);
    if (run == runs.end() || group == fit.groups.end()) continue;
    extras.charts.push_back(panel(p.title, fit, p.group, *run->second));
    extras.checks.push_back(prediction_check(p.title, *group));
  }
  extras.tables.push_back(parameter_table(fit));
  return extras;
}

SceneExtras bovine_extras(const Scene& scene, const Finished& runs) {
  SceneExtras extras;
  if (runs.empty() || scene.charts.empty() || scene.charts.front().measured.empty()) return extras;
  const double rms = rms_before_puncture(scene.charts.front(), *runs.begin()->second);
  extras.checks.push_back(check_json(
      "Bovine liver, measured: the simulated force follows it up to the puncture", fmt::format("{:.3f} N rms", rms),
      fmt::format("{} N rms or less, of 1.414 N [Okamura2004]", kFollowed_N), rms <= kFollowed_N));
  return extras;
}

}  // namespace glisson::app

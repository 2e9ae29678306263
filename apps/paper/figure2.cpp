// figure2.cpp — laws of stiffness in compression, [Schwartz2002, fig. 2].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "paper/curve_fit.h"
#include "paper/figures.h"

namespace glisson::app {
namespace {

constexpr double kSlowStiffness = 51.19;  // [N/m] of this triangle and split, from two independent static solutions
constexpr double kTransient_s = 0.1;      // of a start at full speed, in which the force grows fast without any law
constexpr int kFitPoints = 61;
constexpr int kModulusPoints = 200;
constexpr double kRatioAtRest = 0.755953;  // of every tetrahedron of the cube split
constexpr double kLeastRatio = 0.4;        // below what the press reaches

constexpr double kEvenStep_s = 0.002;  // steps of one length, so that what each adds to the force can be compared

/// One engine step of tissue 1: how the force grew and whether a tetrahedron crossed the threshold.
struct Growth {
  double time_s, increase_N;
  bool crossed;
};

/// Runs a variant step by step, so that the force and the state of the law are seen at the same instant.
std::vector<Growth> growth_of(Variant variant) {
  variant.simulation.step = kEvenStep_s;
  BuiltVariant built = build_variant(variant, no_file);
  const double threshold = std::get<StepLaw>(variant.tissue.law).threshold;
  const double end = run_duration(variant) - built.simulation.step_size();
  std::vector<Growth> growth;
  std::vector<bool> before;
  double force_before = 0.0;
  while (built.simulation.time() < end) {
    std::vector<bool> above;
    for (const double s : built.simulation.tet_fields().s) above.push_back(s >= threshold);
    const double time = built.simulation.time();
    if (const StepResult step = built.simulation.step(); !step.made())
      throw std::runtime_error(std::string(step.message));
    const double force = built.instruments.front()->read("elastic_N");
    if (time > kTransient_s) growth.push_back({time, force - force_before, above != before});
    before = std::move(above);
    force_before = force;
  }
  return growth;
}

nlohmann::json staircase_check(const Variant& variant) {
  const std::vector<Growth> growth = growth_of(variant);
  std::vector<double> sizes;
  for (const Growth& g : growth) sizes.push_back(std::abs(g.increase_N));
  const double step = 3.0 * median(sizes);
  int steps = 0, with_crossing = 0, calm = 0;
  double largest_calm = 0.0;
  for (const Growth& g : growth) {
    const bool is_step = std::abs(g.increase_N) > step;
    steps += is_step;
    with_crossing += is_step && g.crossed;
    calm += !g.crossed;
    if (!g.crossed) largest_calm = std::max(largest_calm, std::abs(g.increase_N));
  }
  return check_json(
      "The force of tissue 1 steps where tetrahedra cross the threshold, and nowhere else (damped variant, from 1 mm "
      "on; "
      "a force step is an increment between two time steps above three times the median one)",
      fmt::format("{} of {} force steps above {:.1f} mN; the other {} time steps grow by {:.1f} mN at most",
                  with_crossing, steps, step / kMilli, calm, largest_calm / kMilli),
      "all of them [Schwartz2002, fig. 2]", steps > 0 && with_crossing == steps);
}

nlohmann::json risers_check(const VariantRecorder& run) {
  const auto& time = run.column("time_s");
  const auto start = std::upper_bound(time.begin(), time.end(), kTransient_s) - time.begin();
  const std::span<const double> force = std::span(run.column("force_N")).subspan(static_cast<std::size_t>(start));
  const std::vector<Riser> found = risers(force);
  const bool falls = std::adjacent_find(force.begin(), force.end(), std::greater<>{}) != force.end();
  double height = 0.0;
  for (const Riser& r : found) height += r.height;
  return check_json(
      "By the paper's step and raw mean ratio, under a heavy drag, the force of tissue 1 is a staircase (from 1 mm on; "
      "a "
      "riser climbs faster than twice the median pace, by 2 % of the last force at least)",
      fmt::format("{} risers with {:.0f} % of the last force, {}", found.size(), 100.0 * height / force.back(),
                  falls ? "and it falls between them" : "no fall between them"),
      "five risers or more, no fall [Schwartz2002, fig. 2]", found.size() >= 5 && !falls);
}

/// Keeps the last elastic force along the tool's direction, and the depth.
class LastSample : public RunObserver {
 public:
  void on_built(const BuiltVariant& built) override { tool_ = built.instruments.front(); }
  void on_sample(const Sample& sample) override {
    depth = sample.instruments.front().depth;
    force = tool_->read("elastic_N");
  }
  double depth = 0.0, force = 0.0;

 private:
  std::shared_ptr<Instrument> tool_;
};

nlohmann::json slow_press_check(Variant variant) {
  PressMotion& press = variant.tools.front().motion;
  press.velocity = kMilli;
  press.depth = kMilli;
  press.hold = 1.0;
  variant.duration.reset();
  const std::atomic<bool> go_on{false};
  LastSample end;
  run_variant(variant, no_file, end, go_on);
  const double stiffness = end.force / end.depth;
  return check_json("The linear tissue, pressed by 1 mm at 1 mm/s and left to settle, has its static stiffness",
                    fmt::format("{:.2f} N/m, {:+.2f} %", stiffness, 100.0 * (stiffness / kSlowStiffness - 1.0)),
                    fmt::format("{} N/m within 0.5 %, from independent static solutions", kSlowStiffness),
                    std::abs(stiffness / kSlowStiffness - 1.0) <= 0.005);
}

/// A fitted curve as a dashed line of a chart in mm and N.
nlohmann::json fit_line(const PolynomialFit& fit, double depth_m, const std::string& label) {
  std::vector<double> x, y;
  for (int i = 0; i < kFitPoints; ++i) {
    const double depth = depth_m * i / (kFitPoints - 1);
    x.push_back(depth / kMilli);
    y.push_back(fit(depth));
  }
  return {{"label", label}, {"x", x}, {"y", y}};
}

void add_tissue2(SceneExtras& extras, const VariantRecorder& run) {
  const auto& depth = run.column("depth_m");
  const auto& force = run.column("force_N");
  const PolynomialFit line = fit_polynomial(depth, force, 1), quadratic = fit_polynomial(depth, force, 2);
  extras.checks.push_back(check_json("The force of tissue 2 is close to a second-order curve in depth",
                                     fmt::format("R² = {:.5f}", quadratic.r2), "R² ≥ 0.999 [Schwartz2002, fig. 2]",
                                     quadratic.r2 >= 0.999));
  extras.checks.push_back(check_json("… and a straight line does not describe it", fmt::format("R² = {:.4f}", line.r2),
                                     "R² < 0.99", line.r2 < 0.99));
  ChartSpec chart{.title = "Tissue 2: the force, a line and a second-order curve",
                  .x = {.column = "depth_m", .label = "depth [mm]", .scale = 1000.0},
                  .y = {.column = "force_N", .label = "force [N]", .scale = 1.0},
                  .measured = {},
                  .variants = {run.variant().name},
                  .value = {}};
  nlohmann::json json = chart_json(chart);
  json["fits"] = {fit_line(quadratic, depth.back(), fmt::format("second order, R² = {:.5f}", quadratic.r2)),
                  fit_line(line, depth.back(), fmt::format("line, R² = {:.4f}", line.r2))};
  extras.charts.push_back(std::move(json));
}

/// Figure 2a: Young's modulus against the paper's measure, of the tissues of figure 2b.
nlohmann::json modulus_chart(const Finished& runs) {
  nlohmann::json lines = nlohmann::json::array();
  for (const char* name : {"linear", "tissue1_raw", "tissue2_raw"}) {
    const auto run = runs.find(name);
    if (run == runs.end()) continue;
    const Tissue& tissue = run->second->variant().tissue;
    std::vector<double> x, y;
    for (int i = 0; i <= kModulusPoints; ++i) {
      x.push_back(kRatioAtRest + (kLeastRatio - kRatioAtRest) * i / kModulusPoints);
      y.push_back(kMilli * law_value(tissue.law, tissue.youngs_modulus, x.back()));
    }
    lines.push_back({{"label", run->second->variant().label}, {"x", x}, {"y", y}});
  }
  nlohmann::json json = chart_json({.title = "Figure 2a: Young's modulus against the mean ratio, 0.756 at rest",
                                    .x = {.column = "ratio", .label = "mean ratio [-]", .scale = 1.0},
                                    .y = {.column = "modulus", .label = "Young's modulus [kPa]", .scale = 1.0},
                                    .measured = {},
                                    .variants = {},
                                    .value = {}});
  json["variants"] = nlohmann::json::array();
  json["lines"] = std::move(lines);
  return json;
}

const Variant& variant_named(const Scene& scene, const std::string& name) {
  return *std::find_if(scene.variants.begin(), scene.variants.end(), [&](const Variant& v) { return v.name == name; });
}

}  // namespace

SceneExtras figure2_extras(const Scene& scene, const Finished& runs) {
  SceneExtras extras;
  extras.first_charts.push_back(modulus_chart(runs));
  if (const auto linear = runs.find("linear"); linear != runs.end()) {
    const PolynomialFit line = fit_polynomial(linear->second->column("depth_m"), linear->second->column("force_N"), 1);
    extras.checks.push_back(check_json("The linear tissue answers with a straight line",
                                       fmt::format("R² = {:.5f}", line.r2), "R² ≥ 0.999", line.r2 >= 0.999));
    extras.checks.push_back(slow_press_check(variant_named(scene, "linear")));
  }
  if (runs.contains("tissue1_damped")) extras.checks.push_back(staircase_check(variant_named(scene, "tissue1_damped")));
  if (const auto stairs = runs.find("tissue1_raw"); stairs != runs.end())
    extras.checks.push_back(risers_check(*stairs->second));
  if (const auto tissue2 = runs.find("tissue2"); tissue2 != runs.end()) add_tissue2(extras, *tissue2->second);
  return extras;
}

}  // namespace glisson::app

// speed_rules.cpp — tools that are slow or fast against what their steps and the tissue can follow.
#include <algorithm>
#include <cmath>
#include <memory>

#include "scene/advice/rules.h"

namespace glisson::advice {
namespace {

/// The largest speed of an instrument on its way [m/s]; 0 where that depends on forces, or it does not end.
double largest_speed(const InstrumentSpec& instrument) {
  constexpr int kLooks = 400;
  const std::shared_ptr<ToolDriver> driver = make_driver(instrument);
  const std::optional<double> end = driver->end();
  if (driver->yields() || !end || !(*end > 0.0)) return 0.0;
  const double h = *end / kLooks;
  Vec3d before = driver->start().position;
  double way = 0.0;
  for (int i = 0; i < kLooks; ++i) {
    const Vec3d now = driver->advance(i * h, h, {}).position;
    way = std::max(way, norm(now - before));
    before = now;
  }
  return way / h;
}

/// The same of a driven vertex set.
double press_speed(const ToolSpec& x) { return x.record || x.path || x.rotation || x.poses ? 0.0 : x.motion.velocity; }

/// That of whatever is driven [m/s]; 0 where that is not known.
double largest_speed(const Variant& v) {
  std::vector<double> speeds;
  for (const InstrumentSpec& x : v.instruments) speeds.push_back(largest_speed(x));
  for (const ToolSpec& x : v.tools) speeds.push_back(press_speed(x));
  if (std::ranges::any_of(speeds, [](double speed) { return !(speed > 0.0); })) return 0.0;
  return speeds.empty() ? 0.0 : std::ranges::max(speeds);
}

/// Speed of waves of pressure in a tissue at rest [m/s].
double wave_speed(const Tissue& t) { return std::sqrt((t.lame().lambda + 2.0 * t.lame().mu) / t.density); }

}  // namespace

Texts slow(const StepCase& c) {
  constexpr double kWay = 5e-6, kLongest = 5e-4;  // of a tool in a step [m], of a step [s]
  constexpr double kWorthIt = 2.0;                // in steps at rest
  if (!std::isfinite(c.rest.stable_step_s)) return {};
  const SimulationOptions& o = c.variant.simulation;
  const double fastest = largest_speed(c.variant);
  if (!capabilities(o.integrator).supports_variable_mass || o.step || o.mass_scaling_step || !(fastest > 0.0))
    return {};
  const double step = two_digits_down(std::min(kLongest, kWay / fastest));
  if (step < kWorthIt * c.rest.step_s) return {};
  const double times = step / c.rest.step_s;
  return {fill(
      "tools move by {} µm a step at most; mass_scaling = \"variable\" with mass_scaling_step_s = {} makes\n"
      "steps {} times as long while the tissue moves evenly (docs/integrators.md)",
      {digits(2, 1e6 * fastest * c.rest.step_s), digits(2, step), times < 10.0 ? digits(2, times) : whole(times)})};
}

Texts fast(const StepCase& c) {
  double fastest = wave_speed(c.variant.tissue);
  for (const RegionSpec& region : c.variant.regions) fastest = std::max(fastest, wave_speed(region.tissue));
  Texts texts;
  const auto look = [&](const std::string& name, double speed) {
    if (!(speed > fastest)) return;
    texts.push_back(fill(
        "\"{}\" moves at up to {} mm/s, where waves in the tissue have {} mm/s: it hits tissue that has not begun\n"
        "to move, and its force is that of the impact, and of the mesh. Is its speed in mm/s?",
        {name, digits(3, 1e3 * speed), digits(3, 1e3 * fastest)}));
  };
  for (const ToolSpec& x : c.variant.tools) look(x.name, press_speed(x));
  for (const InstrumentSpec& x : c.variant.instruments) look(x.name, largest_speed(x));
  return texts;
}

}  // namespace glisson::advice

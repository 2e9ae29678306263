// build_heat.cpp — from what [heat] of a variant says to its HeatSimulation, and what is read of it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/nearest.h"
#include "glisson/scene/heat_run.h"
#include "scene/build/heat_sources.h"
#include "scene/build/select.h"

namespace glisson {
namespace {

using scene::course;
using scene::region_number;

[[noreturn]] void fail_heat(const Variant& variant, const std::string& origin, const std::string& what) {
  throw SceneError((origin.empty() ? variant.scene_name : origin) + ": " + what);
}

/// Runs `make`, saying of what it throws where the scene asked for it.
template <class Make>
auto placed(const Variant& variant, const std::string& origin, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    fail_heat(variant, origin, error.what());
  }
}

const HeatSpec& heat_of(const Variant& variant) {
  if (!variant.heat) fail_heat(variant, "", "the scene has no [heat]");
  return *variant.heat;
}

std::string name_of_region(const TetMesh& mesh, int region) {
  const auto name = mesh.region_names.find(region);
  return name == mesh.region_names.end() || name->second.empty() ? std::to_string(region) : name->second;
}

std::string regions_text(const TetMesh& mesh) {
  std::set<int> numbers;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) numbers.insert(mesh.region_of(t));
  std::vector<std::string> names;
  for (const int n : numbers) names.push_back(name_of_region(mesh, n));
  return scene::listed(names);
}

/// The number of a region that has tets. @throws SceneError
int region_with_tets(const Variant& variant, const std::string& origin, const TetMesh& mesh, const std::string& name) {
  const int number = region_number(mesh, name);
  for (std::size_t t = 0; number >= 0 && t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) == number) return number;
  }
  fail_heat(variant, origin, "the body has no region \"" + name + "\"; it has: " + regions_text(mesh));
}

std::map<int, ThermalTissue> thermal_tissues(const Variant& variant, const TetMesh& mesh,
                                             const std::vector<int>& hollow) {
  std::map<int, ThermalTissue> tissues;
  const HeatSpec& heat = heat_of(variant);
  for (const HeatTissueSpec& x : heat.tissues) {
    if (!x.region.empty()) tissues[region_with_tets(variant, x.origin, mesh, x.region)] = x.tissue;
  }
  const auto rest =
      std::find_if(heat.tissues.begin(), heat.tissues.end(), [](const auto& x) { return x.region.empty(); });
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int region = mesh.region_of(t);
    if (tissues.count(region) > 0 || std::find(hollow.begin(), hollow.end(), region) != hollow.end()) continue;
    if (rest == heat.tissues.end()) {
      fail_heat(
          variant, heat.origin,
          "region \"" + name_of_region(mesh, region) +
              "\" has no thermal tissue; give a [[heat.tissue]] with that `region`, or one without for all the rest");
    }
    tissues[region] = rest->tissue;
  }
  return tissues;
}

/// Regions that blood flows through. @throws SceneError
std::vector<int> hollow_regions(const Variant& variant, const TetMesh& mesh) {
  std::vector<int> hollow;
  for (const HeatBoundarySpec& x : heat_of(variant).boundaries) {
    if (scene::is_vessel(x)) hollow.push_back(region_with_tets(variant, x.origin, mesh, x.region));
  }
  return hollow;
}

HeatSimulation heat_simulation(const Variant& variant, TetMesh mesh) {
  HeatOptions options = heat_of(variant).options;
  options.hollow = hollow_regions(variant, mesh);
  const std::map<int, ThermalTissue> tissues = thermal_tissues(variant, mesh, options.hollow);
  return placed(variant, heat_of(variant).origin, [&] { return HeatSimulation(std::move(mesh), tissues, options); });
}

std::vector<std::uint32_t> vertices_of_region(const TetMesh& mesh, int region) {
  std::set<std::uint32_t> vertices;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) == region) vertices.insert(mesh.tets[t].begin(), mesh.tets[t].end());
  }
  return {vertices.begin(), vertices.end()};
}

}  // namespace

TimeFunction<double> table_course(std::vector<double> times, std::vector<double> values, int cycles) {
  if (times.empty()) return [value = values.at(0)](double) { return value; };
  const double period = times.back();
  std::vector<double> corners;
  for (int k = 0; k < cycles; ++k) {
    for (const double t : times) corners.push_back(k * period + t);
  }
  const auto at = [times = std::move(times), values = std::move(values), period, cycles](double time) {
    // of two entries of one time the first holds there: a step that ends at a jump is made by what was before it
    double t = time;
    if (cycles > 1 && period > 0.0) t -= period * std::clamp(std::ceil(time / period) - 1.0, 0.0, cycles - 1.0);
    const auto next = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t) - times.begin());
    if (next == 0) return values.front();
    if (next == times.size()) return values.back();
    return std::lerp(values[next - 1], values[next], (t - times[next - 1]) / (times[next] - times[next - 1]));
  };
  return {at, CornerTimes(std::move(corners))};
}

BuiltHeat::BuiltHeat(const Variant& variant, const MeshLoader& load) : BuiltHeat(build_mesh(variant, load), variant) {}

BuiltHeat::BuiltHeat(TetMesh mesh, const Variant& variant) : simulation(heat_simulation(variant, std::move(mesh))) {
  add_sources(variant);
  add_sensors(variant);
  add_volumes(variant);
}

void BuiltHeat::add_sources(const Variant& variant) {
  const TetMesh& mesh = simulation.mesh();
  for (const HeatBoundarySpec& x : heat_of(variant).boundaries) {
    placed(variant, x.origin, [&] {
      const auto temperature = course(x.times, x.temperatures, x.temperature, x.cycles);
      const TimeFunction<double> coefficient = scene::wall_coefficient_of(x);
      if (scene::is_vessel(x))
        simulation.add_vessel(region_number(mesh, x.region), coefficient, temperature);
      else if (!x.region.empty())
        simulation.hold(vertices_of_region(mesh, region_with_tets(variant, x.origin, mesh, x.region)), temperature);
      else if (coefficient)
        simulation.add_convection(x.set, coefficient, temperature);
      else if (temperature)
        simulation.hold(x.set, temperature);
      else
        simulation.add_flux(x.set, course(x.times, x.fluxes, x.flux, x.cycles));
    });
  }
  for (const HeatProbeSpec& x : heat_of(variant).probes) {
    placed(variant, x.origin, [&] {
      const Vec3d way = x.to - x.from;
      LineSource line{.from = x.from, .to = x.active_length ? x.from + unit(way) * *x.active_length : x.to};
      line.radius = x.radius;
      line.power_per_length = course(x.times, x.powers, x.power, x.cycles);
      line.temperature = course(x.times, x.temperatures, x.temperature, x.cycles);
      line.coefficient = course(x.times, x.coefficients, x.coefficient, x.cycles);
      try {
        simulation.add_line_source(line);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("probe \"" + x.name + "\": " + error.what() + "; the body spans " +
                                    scene::extent_text(mesh));
      }
    });
  }
  for (const HeatPowerSpec& x : heat_of(variant).powers) {
    std::optional<int> only;
    if (!x.region.empty()) only = region_with_tets(variant, x.origin, mesh, x.region);
    placed(variant, x.origin, [&] {
      const bool by_total = x.total || !x.totals.empty();
      if (by_total) {
        simulation.add_source(scene::pattern_of(x, mesh, only, hollow_regions(variant, mesh)),
                              course(x.times, x.totals, x.total, x.cycles));
        return;
      }
      const std::vector<int> hollow = hollow_regions(variant, mesh);
      std::set<int> regions;
      if (only) regions.insert(*only);
      for (std::size_t t = 0; !only && t < mesh.tets.size(); ++t) regions.insert(mesh.region_of(t));
      if (!only) std::erase_if(regions, [&](int region) { return std::ranges::count(hollow, region) > 0; });
      for (const int region : regions) simulation.add_source(region, course(x.times, x.powers, x.power, x.cycles));
    });
  }
  for (const HeatRadioSpec& x : heat_of(variant).radios)
    placed(variant, x.origin, [&] { simulation.add_radio(scene::radio_of(x, mesh)); });
}

namespace {

/// Weights of the vertices of a region, which sum to 1.
std::vector<std::pair<std::uint32_t, double>> weights_of_region(const TetMesh& mesh, int region) {
  std::map<std::uint32_t, double> weights;
  double whole = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) != region) continue;
    whole += six_rest_volume(mesh, t);
    for (const std::uint32_t v : mesh.tets[t]) weights[v] += 0.25 * six_rest_volume(mesh, t);
  }
  for (auto& [v, weight] : weights) weight /= whole;
  return {weights.begin(), weights.end()};
}

/// What `make` finds in a body that may have lost the place; nothing where it has.
template <class Make>
auto if_there(Make make) -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

/// The mean of each region that is tissue, for a scene that names no sensor.
void BuiltHeat::add_means(const Variant& variant) {
  const TetMesh& mesh = simulation.mesh();
  const std::vector<int> hollow = hollow_regions(variant, mesh);
  std::set<int> regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) regions.insert(mesh.region_of(t));
  for (const int region : regions) {
    if (std::ranges::count(hollow, region) > 0) continue;
    means_.push_back({region, {weights_of_region(mesh, region)}});
    temperature_columns_.push_back((regions.size() == 1 ? "" : name_of_region(mesh, region) + "_") + "mean_C");
    is_mean_.push_back(1);
  }
}

void BuiltHeat::add_sensors(const Variant& variant) {
  const TetMesh& mesh = simulation.mesh();
  if (heat_of(variant).sensors.empty()) return add_means(variant);
  for (const HeatSensorSpec& x : heat_of(variant).sensors) {
    const int count = x.from ? x.count : x.region.empty() ? 1 : 0;
    for (int k = 0; k < count; ++k) {
      const Vec3d at = x.from ? *x.from + (*x.to - *x.from) * (static_cast<double>(k) / (count - 1)) : *x.point;
      points_.push_back({at, placed(variant, x.origin, [&] { return HeatPoints(mesh, std::span(&at, 1)); })});
      temperature_columns_.push_back(x.name + (x.from ? "_" + std::to_string(k + 1) : "") + "_C");
      is_mean_.push_back(0);
    }
    if (x.region.empty()) continue;
    const int region = region_with_tets(variant, x.origin, mesh, x.region);
    means_.push_back({region, {weights_of_region(mesh, region)}});
    temperature_columns_.push_back(x.name + "_C");
    is_mean_.push_back(1);
  }
}

void BuiltHeat::add_volumes(const Variant& variant) {
  const TetMesh& mesh = simulation.mesh();
  const auto column = [&](const std::string& name) { heat_columns_.push_back(name); };
  for (const char* name : {"lowest_C", "highest_C", "frozen_m3", "dead_m3"}) column(name);
  for (const HeatTissueSpec& x : heat_of(variant).tissues) {
    if (x.region.empty()) continue;
    regions_.push_back(region_number(mesh, x.region));
    column("frozen_" + x.region + "_m3"), column("dead_" + x.region + "_m3");
  }
  for (const HeatFrontSpec& x : heat_of(variant).fronts) {
    fronts_.push_back({x, placed(variant, x.origin, [&] { return HeatLine(mesh, x.from, x.to); })});
    column(x.name + "_m");
  }
  for (const HeatIsothermSpec& x : heat_of(variant).isotherms) {
    Isotherm isotherm{.spec = x, .region = {}, .plane = {}};
    if (!x.region.empty()) isotherm.region = region_with_tets(variant, x.origin, mesh, x.region);
    if (x.plane)
      isotherm.plane = placed(variant, x.origin, [&] { return HeatPlane(mesh, x.plane->point, x.plane->normal); });
    isotherms_.push_back(std::move(isotherm));
    for (const char* what : {"_volume_m3", "_extent_x_m", "_extent_y_m", "_extent_z_m"}) column(x.name + what);
    if (x.plane) column(x.name + "_area_m2"), column(x.name + "_width_m");
  }
  for (const HeatRadioSpec& x : heat_of(variant).radios) {
    for (const char* what : {"_power_W", "_voltage_V", "_ohm"}) column(x.name + what);
  }
  for (const char* name : {"stored_J", "held_J", "surface_J", "blood_J", "metabolism_J", "sources_J", "removed_J",
                           "imbalance_J", "limited_share"})
    column(name);
}

void BuiltHeat::change_mesh(TetMesh changed, std::span<const std::uint32_t> origins) {
  simulation.change_mesh(std::move(changed), origins);
  const TetMesh& mesh = simulation.mesh();
  for (Point& x : points_)
    x.place = if_there([&] { return HeatPoints(mesh, std::span(&x.at, 1)); }).value_or(HeatPoints());
  for (auto& [region, mean] : means_) mean.weights = weights_of_region(mesh, region);
  for (Front& x : fronts_) x.line = if_there([&] { return HeatLine(mesh, x.spec.from, x.spec.to); });
  for (Isotherm& x : isotherms_) {
    if (x.spec.plane) x.plane = if_there([&] { return HeatPlane(mesh, x.spec.plane->point, x.spec.plane->normal); });
  }
}

void BuiltHeat::read_isotherms(std::span<const double> t, std::vector<double>& row) const {
  for (const Isotherm& x : isotherms_) {
    const double level = x.spec.temperature;
    const IsothermExtent extent = isotherm_extent(simulation.mesh(), t, level);
    const Vec3d size = extent.high - extent.low;
    row.push_back(x.region ? simulation.volume_below(level, x.region) : extent.volume);
    row.insert(row.end(), {size.x, size.y, size.z});
    if (!x.spec.plane) continue;
    const HeatPlane::Section section = x.plane ? x.plane->below(t, level) : HeatPlane::Section{0.0, 0.0};
    row.insert(row.end(), {section.area, section.width});
  }
}

HeatSample BuiltHeat::read() const {
  const std::span<const double> t = simulation.temperature();
  HeatSample sample{.temperatures = {simulation.time()}, .heat = {simulation.time()}};
  auto point = points_.begin();
  auto mean = means_.begin();
  for (const char is_mean : is_mean_) {
    double value = 0.0;
    if (is_mean == 0) {
      value = point->place.size() > 0 ? point->place.read(t).front() : kNone;
      ++point;
    } else {
      for (const auto& [v, weight] : mean->second.weights) value += weight * t[v];
      if (mean->second.weights.empty()) value = kNone;
      ++mean;
    }
    sample.temperatures.push_back(value);
  }
  std::vector<double>& row = sample.heat;
  const auto [low, high] = std::minmax_element(t.begin(), t.end());
  row.insert(row.end(), {*low, *high, simulation.frozen_volume(), simulation.dead_volume()});
  for (const int region : regions_)
    row.insert(row.end(), {simulation.frozen_volume(region), simulation.dead_volume(region)});
  const std::vector<double> frozen = fronts_.empty() ? std::vector<double>() : simulation.frozen_share();
  for (const Front& x : fronts_) {
    if (!x.line) {
      row.push_back(kNone);
      continue;
    }
    const double colder = x.spec.temperature ? x.line->length_below(t, *x.spec.temperature) : x.line->integral(frozen);
    row.push_back(x.spec.above ? colder - x.line->length_below(t, *x.spec.above) : colder);
  }
  read_isotherms(t, row);
  for (const RadioState& x : simulation.state().radio) row.insert(row.end(), {x.power, x.voltage, x.resistance});
  const HeatLedger l = simulation.ledger();
  row.insert(row.end(), {l.stored, l.held, l.surface, l.blood, l.metabolism, l.sources, l.removed, l.imbalance(),
                         simulation.state().limited_share});
  return sample;
}

}  // namespace glisson

#include "glisson/heat/heat_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "heat/heat_simulation_impl.h"
#include "mesh/inspect/tet_locator.h"
#include "mesh/topology/faces.h"
#include "mesh/topology/require_valid.h"

namespace glisson {
namespace {

using heat::Flows;
using heat::HeatBody;
using heat::HeatStepper;
using heat::SurfaceHeat;

constexpr double kShorter = 0.3, kLonger = 2.0;  // of a step to the next
constexpr double kAccepted = 1.5;                // of the tolerance
constexpr int kMostHalvings = 12, kMostTries = 60;
constexpr double kTouched = 1.0;   // a change that counts in full for the volume that errors are a mean over [K]
constexpr int kSamplesPerTet = 4;  // of a line source, in the length of a tet
constexpr int kLeastAround = 8;    // of its samples around it

const std::map<int, ThermalTissue>& checked(const std::map<int, ThermalTissue>& tissues) {
  for (const auto& [region, tissue] : tissues)
    detail::require_fields("thermal tissue of region " + std::to_string(region), tissue);
  return tissues;
}

TetMesh checked(TetMesh mesh) {
  detail::require_indices(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!(six_rest_volume(mesh, t) > 0.0)) {
      throw std::invalid_argument("heat: tet " + std::to_string(t) +
                                  " has no volume, or is turned inside out; `glisson mesh` mends that");
    }
  }
  return mesh;
}

HeatOptions checked(const HeatOptions& options) {
  detail::require_fields("heat", options);
  return options;
}

const char* name_of(SurfaceHeat::What what) {
  switch (what) {
    case SurfaceHeat::What::flux:
      return "flux";
    case SurfaceHeat::What::convection:
      return "ambient temperature";
    case SurfaceHeat::What::line:
      break;
  }
  return "temperature of a line source";
}

double value_of(const TimeFunction<double>& f, double time, const char* what) {
  const double value = f(time);
  if (std::isfinite(value)) return value;
  throw std::invalid_argument(std::string("heat: the ") + what + " at " + detail::show(time) + " s is not finite");
}

}  // namespace

HeatSimulation::Impl::Impl(TetMesh given, const std::map<int, ThermalTissue>& tissues, const HeatOptions& options)
    : mesh_(checked(std::move(given))), tissues_(checked(tissues)), options_(checked(options)),
      body_(mesh_, tissues_, options_.hollow), held_(mesh_.vertices.size(), 0) {
  rebuild();
  now_.temperature.assign(held_.size(), options.temperature);
  now_.history = history_->begin(now_.temperature);
  for (std::size_t i = 0; i < held_.size(); ++i) now_.heat.push_back(body_.state(i, options.temperature).heat);
}

void HeatSimulation::Impl::hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature) {
  for (const std::uint32_t v : vertices) {
    if (v >= now_.temperature.size()) throw std::invalid_argument("heat: there is no vertex " + std::to_string(v));
  }
  for (const std::uint32_t v : vertices) held_[v] = 1;
  holds_.push_back({{vertices.begin(), vertices.end()}, std::move(temperature)});
}

SurfaceHeat HeatSimulation::Impl::surface_of(const std::string& set) const {
  std::vector<char> in(mesh_.vertices.size(), 0);
  for (const std::uint32_t v : mesh_.vertex_set(set)) in[v] = 1;
  std::map<std::uint32_t, double> area;
  for (const Triangle& t : boundary_triangles(mesh_)) {
    if (in[t[0]] + in[t[1]] + in[t[2]] < 3) continue;
    const std::span<const Vec3d> x = positions_.empty() ? mesh_.vertices : positions_;
    const Vec3d &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    for (const std::uint32_t v : t) area[v] += norm(cross(b - a, c - a)) / 6.0;
  }
  if (area.empty()) {
    throw std::invalid_argument("heat: the set \"" + set +
                                "\" has no triangle of the surface; name a set with all corners of some");
  }
  SurfaceHeat surface;
  for (const auto& [v, a] : area) surface.vertices.push_back(v), surface.area.push_back(a);
  return surface;
}

bool HeatSimulation::Impl::is_hollow(int region) const {
  return std::find(options_.hollow.begin(), options_.hollow.end(), region) != options_.hollow.end();
}

SurfaceHeat HeatSimulation::Impl::wall_of(int region) const {
  if (!is_hollow(region)) {
    throw std::invalid_argument("heat: region " + std::to_string(region) +
                                " is tissue and no vessel; name it in HeatOptions::hollow");
  }
  std::map<std::uint32_t, double> area;
  detail::for_each_face(mesh_, {}, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() != 2) return;
    const int a = mesh_.region_of(sides[0].tet), b = mesh_.region_of(sides[1].tet);
    if ((a == region) == (b == region) || is_hollow(a == region ? b : a)) return;
    std::array<Vec3d, 3> x;
    const Tet& t = mesh_.tets[sides[0].tet];
    const auto& corners = detail::kFaceCorners[sides[0].corner];
    const std::span<const Vec3d> at = positions_.empty() ? mesh_.vertices : positions_;
    for (std::size_t c = 0; c < 3; ++c) x[c] = at[t[corners[c]]];
    for (const std::uint8_t c : corners) area[t[c]] += norm(detail::area_vector(x)) / 3.0;
  });
  if (area.empty())
    throw std::invalid_argument("heat: the vessel of region " + std::to_string(region) + " has no face to tissue");
  SurfaceHeat wall;
  for (const auto& [v, a] : area) wall.vertices.push_back(v), wall.area.push_back(a);
  return wall;
}

void HeatSimulation::Impl::add_convection(SurfaceHeat surface, Place place, TimeFunction<double> coefficient,
                                          TimeFunction<double> ambient) {
  surface.what = SurfaceHeat::What::convection;
  surfaces_.push_back({std::move(place), std::move(surface), std::move(ambient), std::move(coefficient)});
}

void HeatSimulation::Impl::add_radio(RadioFrequency radio) {
  std::vector<const ThermalTissue*> tissue_of;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    const int region = mesh_.region_of(t);
    tissue_of.push_back(is_hollow(region) ? nullptr : &tissues_.at(region));
  }
  radio_.emplace_back(mesh_, std::move(tissue_of), std::move(radio));
  now_.radio.emplace_back();
}

void HeatSimulation::Impl::add_line(const LineSource& source) {
  if (!source.power_per_length && !source.temperature) {
    throw std::invalid_argument(
        "heat: a line source gives no heat; give power_per_length, or temperature and coefficient");
  }
  if (static_cast<bool>(source.temperature) != static_cast<bool>(source.coefficient)) {
    throw std::invalid_argument(
        std::string("heat: a line source has a ") +
        (source.temperature ? "temperature and no coefficient" : "coefficient and no temperature") +
        "; c (T_s − T) needs both");
  }
  const std::map<std::uint32_t, double> share = shares_of_line(source);
  if (source.power_per_length) sources_.push_back({source, {share.begin(), share.end()}, source.power_per_length});
  if (!source.temperature) return;
  SurfaceHeat line{.what = SurfaceHeat::What::line, .vertices = {}, .area = {}};
  for (const auto& [v, length] : share) line.vertices.push_back(v), line.area.push_back(length);
  surfaces_.push_back({source, std::move(line), source.temperature, source.coefficient});
}

namespace {

/// Points around a line, as offsets from it; the line itself where it has no radius.
std::vector<Vec3d> around(const Vec3d& along, double radius, double spacing) {
  if (radius == 0.0) return {Vec3d{}};
  const Vec3d n = unit(along), other = std::abs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}, u = unit(cross(other, n)),
              v = cross(n, u);
  const double whole = 2.0 * std::numbers::pi;
  const int count = std::max(kLeastAround, static_cast<int>(std::ceil(whole * radius / spacing)));
  std::vector<Vec3d> offsets;
  for (int k = 0; k < count; ++k)
    offsets.push_back(u * (radius * std::cos(whole * k / count)) + v * (radius * std::sin(whole * k / count)));
  return offsets;
}

}  // namespace

/// Of each vertex the length of a line that it stands for [m].
std::map<std::uint32_t, double> HeatSimulation::Impl::shares_of_line(const LineSource& source, bool whole) const {
  const detail::TetLocator locator(mesh_, {});
  const Vec3d way = source.to - source.from;
  const double length = norm(way);
  if (!(length > 0.0)) throw std::invalid_argument("heat: a line source has no length");
  if (!(source.radius >= 0.0) || !std::isfinite(source.radius))
    throw std::invalid_argument("heat: a line source has a radius of " + detail::show(source.radius) +
                                " m; allowed: ≥ 0");
  const double tet = std::cbrt(6.0 * volume(mesh_) / static_cast<double>(mesh_.tets.size()));
  const int n = std::max(1, static_cast<int>(std::ceil(kSamplesPerTet * length / tet)));
  const std::vector<Vec3d> offsets = around(way, source.radius, tet / kSamplesPerTet);
  std::map<std::uint32_t, double> share;
  for (int k = 0; k < n; ++k) {
    for (const Vec3d& offset : offsets) {
      const Vec3d x = source.from + way * ((k + 0.5) / n) + offset;
      const auto at = locator.locate(x);
      if (!at && !whole) continue;
      if (!at) {
        throw std::invalid_argument("heat: a line source leaves the body at (" + detail::number_text(1e3 * x.x) + ", " +
                                    detail::number_text(1e3 * x.y) + ", " + detail::number_text(1e3 * x.z) + ") mm");
      }
      const double part = length / n / static_cast<double>(offsets.size());
      for (std::size_t c = 0; c < 4; ++c) share[mesh_.tets[at->tet][c]] += at->weights[c] * part;
    }
  }
  return share;
}

double HeatSimulation::Impl::next_corner() const {
  double next = std::numeric_limits<double>::infinity();
  for (const Held& x : holds_) next = std::min(next, x.temperature.corners.after(now_.time));
  for (const TimedSurface& x : surfaces_)
    next = std::min({next, x.value.corners.after(now_.time), x.coefficient.corners.after(now_.time)});
  for (const Source& x : sources_) next = std::min(next, x.power.corners.after(now_.time));
  for (const heat::JouleHeat& x : radio_) {
    next = std::min({next, x.radio().voltage.corners.after(now_.time), x.radio().power.corners.after(now_.time)});
  }
  return next;
}

std::vector<SurfaceHeat> HeatSimulation::Impl::surfaces_at(double time) {
  std::vector<SurfaceHeat> surfaces;
  for (TimedSurface& x : surfaces_) {
    x.heat.value = value_of(x.value, time, name_of(x.heat.what));
    if (x.coefficient) {
      const bool line = x.heat.what == SurfaceHeat::What::line;
      x.heat.coefficient =
          value_of(x.coefficient, time, line ? "coefficient of a line source" : "coefficient of convection");
      if (x.heat.coefficient < 0.0) {
        throw std::invalid_argument(std::string("heat: the coefficient of ") + (line ? "a line source" : "convection") +
                                    " at " + detail::show(time) + " s is " + detail::show(x.heat.coefficient) +
                                    (line ? " W/(m K); allowed: ≥ 0" : " W/(m² K); allowed: ≥ 0"));
      }
    }
    surfaces.push_back(x.heat);
  }
  return surfaces;
}

std::vector<double> HeatSimulation::Impl::sources_at(double time) const {
  std::vector<double> sum(now_.temperature.size(), 0.0);
  for (const Source& x : sources_) {
    const double power = value_of(x.power, time, "power of a source");
    for (const auto& [v, share] : x.shares) sum[v] += share * power;
  }
  for (std::size_t k = 0; k < radio_.size(); ++k) {
    const double voltage = radio_[k].voltage_at(time, 1.0 / now_.radio[k].resistance), scale = voltage * voltage;
    if (scale == 0.0) continue;
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += scale * radio_[k].heat()[v];
  }
  return sum;
}

void HeatSimulation::Impl::find_potentials() {
  for (std::size_t k = 0; k < radio_.size(); ++k) {
    RadioState& now = now_.radio[k];
    now.resistance = 1.0 / radio_[k].solve(now_.temperature, stepper_->blocks(), now.potential);
  }
}

std::optional<HeatSimulation::Impl::Trial> HeatSimulation::Impl::make(double h) {
  Trial trial;
  trial.temperature = now_.temperature;
  const double end = now_.time + h;
  for (const Held& x : holds_) {
    const double t = value_of(x.temperature, end, "held temperature");
    for (const std::uint32_t v : x.vertices) trial.temperature[v] = t;
  }
  const std::vector<SurfaceHeat> surfaces = surfaces_at(end);
  trial.sources = sources_at(end);
  const HeatStepper::Input in{h, now_.heat, trial.sources, held_, now_.history.dead, surfaces};
  const std::vector<double> here = trial.temperature;
  if (!now_.rate.empty()) {
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (held_[i] == 0) trial.temperature[i] += h * now_.rate[i];
    }
  }
  trial.iterations = stepper_->step(in, trial.temperature, trial.flows);
  if (trial.iterations < 0 && !now_.rate.empty()) {
    trial.temperature = here;
    trial.iterations = stepper_->step(in, trial.temperature, trial.flows);
  }
  if (trial.iterations < 0) return std::nullopt;
  if (now_.rate.empty()) return trial;
  // backward Euler errs by h²/2 T″, the straight line from the step before by h (h + h₀)/2 T″ to the other side
  double sum = 0.0, touched = 0.0;
  for (std::size_t i = 0; i < now_.temperature.size(); ++i) {
    const double off = trial.temperature[i] - now_.temperature[i] - h * now_.rate[i], volume = body_.volume(i);
    sum += volume * off * off;
    touched += volume * std::min(1.0, std::abs(trial.temperature[i] - options_.temperature) / kTouched);
  }
  if (touched > 0.0) trial.error = std::sqrt(sum / touched) * h / (2.0 * h + now_.step_before);
  return trial;
}

// What has flowed into a vertex is its heat, and gives its temperature.
void HeatSimulation::Impl::accept(double h, Trial& trial) {
  now_.rate.resize(now_.temperature.size());
  const std::vector<double> earlier = now_.temperature;
  for (std::size_t i = 0; i < now_.temperature.size(); ++i) {
    const double before = now_.heat[i], in = h * (trial.flows.sum(i) + trial.sources[i]);
    double now = trial.temperature[i];
    if (held_[i] != 0) {
      now_.heat[i] = body_.state(i, now).heat;
      now_.ledger.held += now_.heat[i] - before - in;
    } else {
      now_.heat[i] = before + in;
      if (body_.volume(i) == 0.0)
        now = now_.temperature[i];
      else
        now = body_.temperature_of(i, now_.heat[i], now);
    }
    now_.ledger.stored += now_.heat[i] - before;
    now_.ledger.blood += h * trial.flows.blood[i], now_.ledger.metabolism += h * trial.flows.metabolism[i];
    now_.ledger.surface += h * trial.flows.surface[i],
        now_.ledger.sources += h * (trial.sources[i] + trial.flows.lines[i]);
    now_.rate[i] = (now - now_.temperature[i]) / h, now_.temperature[i] = now;
  }
  history_->add(h, earlier, now_.temperature, stepper_->blocks(), now_.history);
  now_.limited_share = trial.flows.limited;
  for (std::size_t k = 0; k < radio_.size(); ++k) {
    RadioState& radio = now_.radio[k];
    radio.voltage = radio_[k].voltage_at(now_.time + h, 1.0 / radio.resistance);
    radio.power = radio.voltage * radio.voltage / radio.resistance;
  }
  now_.time += h, now_.step_before = h, ++now_.steps;
}

bool HeatSimulation::Impl::make_given(double h, int halvings, int& iterations) {
  find_potentials();
  if (std::optional<Trial> trial = make(h)) {
    iterations += trial->iterations;
    accept(h, *trial);
    return true;
  }
  return halvings < kMostHalvings && make_given(0.5 * h, halvings + 1, iterations) &&
         make_given(0.5 * h, halvings + 1, iterations);
}

HeatStep HeatSimulation::Impl::step_up_to(double most) {
  most = std::min(most, next_corner() - now_.time);
  if (options_.step > 0.0) {
    HeatStep result{.step = std::min(options_.step, most)};
    const HeatState before = now_;
    if (make_given(result.step, 0, result.iterations)) return result;
    now_ = before;
    return {HeatStatus::not_converged, result.step, result.iterations};
  }
  find_potentials();
  HeatStep result;
  double h = now_.wanted > 0.0 ? now_.wanted : options_.first_step;
  for (int tries = 0; tries < kMostTries; ++tries) {
    h = h >= most ? most : std::min(h, std::max(0.5 * most, most - h));  // not a tiny one at the end
    std::optional<Trial> trial = make(h);
    const double longer =
        !trial ? 0.5
               : (trial->error > 0.0 ? std::clamp(0.9 * std::sqrt(options_.tolerance / trial->error), kShorter, kLonger)
                                     : kLonger);
    if (!trial || trial->error > kAccepted * options_.tolerance) {
      h *= std::min(0.9, longer);
      continue;
    }
    result.iterations += trial->iterations, result.step = h;
    accept(h, *trial);
    now_.wanted = std::min(options_.longest_step, longer < 1.0 ? h * longer : std::max(now_.wanted, h * longer));
    return result;
  }
  return {HeatStatus::not_converged, h, result.iterations};
}

HeatSimulation::HeatSimulation(TetMesh mesh, std::map<int, ThermalTissue> tissues, const HeatOptions& options)
    : impl_(std::make_unique<Impl>(std::move(mesh), tissues, options)) {}
HeatSimulation::HeatSimulation(HeatSimulation&&) noexcept = default;
HeatSimulation& HeatSimulation::operator=(HeatSimulation&&) noexcept = default;
HeatSimulation::~HeatSimulation() = default;

void HeatSimulation::hold(const std::string& set, TimeFunction<double> temperature) {
  impl_->hold(impl_->mesh_.vertex_set(set), std::move(temperature));
}
void HeatSimulation::hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature) {
  impl_->hold(vertices, std::move(temperature));
}
void HeatSimulation::add_flux(const std::string& set, TimeFunction<double> flux) {
  impl_->surfaces_.push_back({set, impl_->surface_of(set), std::move(flux)});
}
void HeatSimulation::add_convection(const std::string& set, double coefficient, TimeFunction<double> ambient) {
  if (!(coefficient > 0.0) || !std::isfinite(coefficient)) {
    throw std::invalid_argument("heat: a coefficient of convection of " + detail::show(coefficient) +
                                " W/(m² K) is out of range; allowed: > 0");
  }
  impl_->add_convection(
      impl_->surface_of(set), set, [coefficient](double) { return coefficient; }, std::move(ambient));
}
void HeatSimulation::add_convection(const std::string& set, TimeFunction<double> coefficient,
                                    TimeFunction<double> ambient) {
  impl_->add_convection(impl_->surface_of(set), set, std::move(coefficient), std::move(ambient));
}
void HeatSimulation::add_vessel(int region, TimeFunction<double> coefficient, TimeFunction<double> blood) {
  SurfaceHeat wall = impl_->wall_of(region);
  // what flows in it is at the temperature of the blood, for those that look at it
  std::vector<char> inside(impl_->held_.size(), 0);
  for (std::size_t t = 0; t < impl_->mesh_.tets.size(); ++t) {
    if (impl_->mesh_.region_of(t) != region) continue;
    for (const std::uint32_t v : impl_->mesh_.tets[t]) inside[v] = impl_->body_.volume(v) == 0.0 ? 1 : 0;
  }
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < inside.size(); ++v) {
    if (inside[v] != 0) vertices.push_back(v);
  }
  impl_->hold(vertices, blood);
  impl_->add_convection(std::move(wall), region, std::move(coefficient), std::move(blood));
}
void HeatSimulation::add_source(int region, TimeFunction<double> power_per_volume) {
  const std::map<std::uint32_t, double> share = impl_->shares_of_region(region);
  if (share.empty()) throw std::invalid_argument("heat: the mesh has no region " + std::to_string(region));
  if (impl_->is_hollow(region)) throw std::invalid_argument("heat: region " + std::to_string(region) + " is hollow");
  impl_->sources_.push_back({region, {share.begin(), share.end()}, std::move(power_per_volume)});
}
void HeatSimulation::add_source(std::span<const double> power_per_volume, TimeFunction<double> scale) {
  const TetMesh& mesh = impl_->mesh_;
  if (power_per_volume.size() != mesh.tets.size()) {
    throw std::invalid_argument("heat: a pattern of power has " + std::to_string(power_per_volume.size()) +
                                " values for " + std::to_string(mesh.tets.size()) + " tets");
  }
  std::map<std::uint32_t, double> share;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!std::isfinite(power_per_volume[t])) {
      throw std::invalid_argument("heat: a pattern of power at tet " + std::to_string(t) + " is " +
                                  detail::show(power_per_volume[t]) + " W/m³, which is no number");
    }
    if (impl_->is_hollow(mesh.region_of(t)) || power_per_volume[t] == 0.0) continue;
    for (const std::uint32_t v : mesh.tets[t]) share[v] += power_per_volume[t] * six_rest_volume(mesh, t) / 24.0;
  }
  impl_->sources_.push_back({Impl::Pattern{}, {share.begin(), share.end()}, std::move(scale)});
}
void HeatSimulation::add_radio(RadioFrequency radio) { impl_->add_radio(std::move(radio)); }
void HeatSimulation::add_line_source(const LineSource& source) { impl_->add_line(source); }

HeatStep HeatSimulation::step() { return impl_->step_up_to(std::numeric_limits<double>::infinity()); }

HeatStep HeatSimulation::step_towards(double time) {
  const double now = impl_->now_.time;
  if (!std::isfinite(time) || time <= now) {
    throw std::invalid_argument("heat: step_towards: " + detail::show(time) + " s does not lie ahead of " +
                                detail::show(now) + " s");
  }
  const HeatStep step = impl_->step_up_to(time - now);
  if (step.status == HeatStatus::ok && time - impl_->now_.time < 1e-12 * time) impl_->now_.time = time;
  return step;
}

HeatStep HeatSimulation::advance_to(double time) {
  if (!std::isfinite(time)) throw std::invalid_argument("heat: advance_to: " + detail::show(time) + " s is not a time");
  HeatStep last;
  while (impl_->now_.time < time && last.status == HeatStatus::ok) last = step_towards(time);
  return last;
}

double HeatSimulation::time() const { return impl_->now_.time; }
const TetMesh& HeatSimulation::mesh() const { return impl_->mesh_; }
std::span<const double> HeatSimulation::temperature() const { return impl_->now_.temperature; }
HeatLedger HeatSimulation::ledger() const { return impl_->now_.ledger; }
const HeatState& HeatSimulation::state() const { return impl_->now_; }
std::size_t HeatSimulation::steps() const { return impl_->now_.steps; }
const HeatWork& HeatSimulation::work() const { return impl_->stepper_->work(); }
void HeatSimulation::count_time() { impl_->stepper_->count_time(); }

}  // namespace glisson

#include "glisson/heat/heat_simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "heat/heat_step.h"
#include "mesh/inspect/tet_locator.h"
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

double value_of(const TimeFunction<double>& f, double time, const char* what) {
  const double value = f(time);
  if (std::isfinite(value)) return value;
  throw std::invalid_argument(std::string("heat: the ") + what + " at " + detail::show(time) + " s is not finite");
}

/// Share of a tet's volume below a level of a linear field with these values at its corners.
double share_below(std::array<double, 4> t, double level) {
  std::sort(t.begin(), t.end());
  const auto [a, b, c, d] = t;
  if (level <= a) return 0.0;
  if (level >= d) return 1.0;
  const auto along = [level](double from, double to) { return (level - from) / (to - from); };
  if (level <= b) return along(a, b) * along(a, c) * along(a, d);
  if (level >= c) return 1.0 - along(d, a) * along(d, b) * along(d, c);
  // a wedge of three tets, whose corners cut the edges ac, ad, bc and bd
  const double ac = along(a, c), ad = along(a, d), bc = along(b, c), bd = along(b, d);
  return ac * ad + bd * ac * (1.0 - ad) + (1.0 - ac) * bd * bc;
}

}  // namespace

class HeatSimulation::Impl {
 public:
  Impl(TetMesh given, const std::map<int, ThermalTissue>& tissues, const HeatOptions& options)
      : mesh_(checked(std::move(given))), options_(checked(options)), body_(mesh_, checked(tissues)),
        stepper_(body_, options_.threads > 0 ? options_.threads : detail::threads_for(body_.size())),
        held_(mesh_.vertices.size(), 0) {
    now_.temperature.assign(held_.size(), options.temperature);
    for (std::size_t i = 0; i < held_.size(); ++i) now_.heat.push_back(body_.state(i, options.temperature).heat);
  }

  struct Held {
    std::vector<std::uint32_t> vertices;
    TimeFunction<double> temperature;
  };
  struct TimedSurface {
    SurfaceHeat heat;
    TimeFunction<double> value;
  };
  /// Power by vertex where a function of time is 1.
  struct Source {
    std::vector<std::pair<std::uint32_t, double>> shares;
    TimeFunction<double> power;
  };

  TetMesh mesh_;
  HeatOptions options_;
  HeatBody body_;
  HeatStepper stepper_;
  std::vector<Held> holds_;
  std::vector<TimedSurface> surfaces_;
  std::vector<Source> sources_;

  HeatState now_;
  std::vector<char> held_;

  void hold(std::span<const std::uint32_t> vertices, TimeFunction<double> temperature);
  SurfaceHeat surface_of(const std::string& set) const;
  void add_line(const LineSource& source);
  HeatStep step_up_to(double most);

 private:
  struct Trial {
    std::vector<double> temperature;
    Flows flows;
    std::vector<double> sources;
    int iterations = 0;
    double error = 0.0;  // [K]
  };
  std::optional<Trial> make(double h);
  /// A step of this length, in halves where it does not converge at once.
  bool make_given(double h, int halvings, int& iterations);
  void accept(double h, Trial& trial);
  double next_corner() const;
};

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
    const Vec3d &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
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

void HeatSimulation::Impl::add_line(const LineSource& source) {
  const detail::TetLocator locator(mesh_, {});
  const Vec3d way = source.to - source.from;
  const double length = norm(way);
  if (!(length > 0.0)) throw std::invalid_argument("heat: a line source has no length");
  const double tet = std::cbrt(6.0 * volume(mesh_) / static_cast<double>(mesh_.tets.size()));
  const int n = std::max(1, static_cast<int>(std::ceil(kSamplesPerTet * length / tet)));
  std::map<std::uint32_t, double> share;
  for (int k = 0; k < n; ++k) {
    const Vec3d x = source.from + way * ((k + 0.5) / n);
    const auto at = locator.locate(x);
    if (!at) {
      throw std::invalid_argument("heat: a line source leaves the body at (" + detail::number_text(1e3 * x.x) + ", " +
                                  detail::number_text(1e3 * x.y) + ", " + detail::number_text(1e3 * x.z) + ") mm");
    }
    for (std::size_t c = 0; c < 4; ++c) share[mesh_.tets[at->tet][c]] += at->weights[c] * length / n;
  }
  sources_.push_back({{share.begin(), share.end()}, source.power_per_length});
}

double HeatSimulation::Impl::next_corner() const {
  double next = std::numeric_limits<double>::infinity();
  for (const Held& x : holds_) next = std::min(next, x.temperature.corners.after(now_.time));
  for (const TimedSurface& x : surfaces_) next = std::min(next, x.value.corners.after(now_.time));
  for (const Source& x : sources_) next = std::min(next, x.power.corners.after(now_.time));
  return next;
}

std::optional<HeatSimulation::Impl::Trial> HeatSimulation::Impl::make(double h) {
  Trial trial;
  trial.temperature = now_.temperature;
  const double end = now_.time + h;
  for (const Held& x : holds_) {
    const double t = value_of(x.temperature, end, "held temperature");
    for (const std::uint32_t v : x.vertices) trial.temperature[v] = t;
  }
  std::vector<SurfaceHeat> surfaces;
  for (TimedSurface& x : surfaces_) {
    x.heat.value = value_of(x.value, end, x.heat.coefficient > 0.0 ? "ambient temperature" : "flux");
    surfaces.push_back(x.heat);
  }
  trial.sources.assign(now_.temperature.size(), 0.0);
  for (const Source& x : sources_) {
    const double power = value_of(x.power, end, "power of a source");
    for (const auto& [v, share] : x.shares) trial.sources[v] += share * power;
  }
  const HeatStepper::Input in{h, now_.heat, trial.sources, held_, surfaces};
  const std::vector<double> here = trial.temperature;
  if (!now_.rate.empty()) {
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (held_[i] == 0) trial.temperature[i] += h * now_.rate[i];
    }
  }
  trial.iterations = stepper_.step(in, trial.temperature, trial.flows);
  if (trial.iterations < 0 && !now_.rate.empty()) {
    trial.temperature = here;
    trial.iterations = stepper_.step(in, trial.temperature, trial.flows);
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
    now_.ledger.surface += h * trial.flows.surface[i], now_.ledger.sources += h * trial.sources[i];
    now_.rate[i] = (now - now_.temperature[i]) / h, now_.temperature[i] = now;
  }
  now_.limited_share = trial.flows.limited;
  now_.time += h, now_.step_before = h, ++now_.steps;
}

bool HeatSimulation::Impl::make_given(double h, int halvings, int& iterations) {
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
  impl_->surfaces_.push_back({impl_->surface_of(set), std::move(flux)});
}
void HeatSimulation::add_convection(const std::string& set, double coefficient, TimeFunction<double> ambient) {
  if (!(coefficient > 0.0) || !std::isfinite(coefficient)) {
    throw std::invalid_argument("heat: a coefficient of convection of " + detail::show(coefficient) +
                                " W/(m² K) is out of range; allowed: > 0");
  }
  SurfaceHeat surface = impl_->surface_of(set);
  surface.coefficient = coefficient;
  impl_->surfaces_.push_back({std::move(surface), std::move(ambient)});
}
void HeatSimulation::add_source(int region, TimeFunction<double> power_per_volume) {
  std::map<std::uint32_t, double> share;
  for (std::size_t t = 0; t < impl_->mesh_.tets.size(); ++t) {
    if (impl_->mesh_.region_of(t) != region) continue;
    for (const std::uint32_t v : impl_->mesh_.tets[t]) share[v] += six_rest_volume(impl_->mesh_, t) / 24.0;
  }
  if (share.empty()) throw std::invalid_argument("heat: the mesh has no region " + std::to_string(region));
  impl_->sources_.push_back({{share.begin(), share.end()}, std::move(power_per_volume)});
}
void HeatSimulation::add_line_source(const LineSource& source) { impl_->add_line(source); }

HeatStep HeatSimulation::step() { return impl_->step_up_to(std::numeric_limits<double>::infinity()); }

HeatStep HeatSimulation::advance_to(double time) {
  if (!std::isfinite(time)) throw std::invalid_argument("heat: advance_to: " + detail::show(time) + " s is not a time");
  HeatStep last;
  while (impl_->now_.time < time) {
    last = impl_->step_up_to(time - impl_->now_.time);
    if (last.status != HeatStatus::ok) return last;
    if (time - impl_->now_.time < 1e-12 * time) impl_->now_.time = time;
  }
  return last;
}

double HeatSimulation::time() const { return impl_->now_.time; }
const TetMesh& HeatSimulation::mesh() const { return impl_->mesh_; }
std::span<const double> HeatSimulation::temperature() const { return impl_->now_.temperature; }
HeatLedger HeatSimulation::ledger() const { return impl_->now_.ledger; }
const HeatState& HeatSimulation::state() const { return impl_->now_; }
void HeatSimulation::load_state(HeatState state) {
  const std::size_t n = impl_->held_.size();
  if (state.temperature.size() != n || state.heat.size() != n || (!state.rate.empty() && state.rate.size() != n)) {
    throw std::invalid_argument("heat: load_state: the state is of " + std::to_string(state.temperature.size()) +
                                " vertices, this mesh has " + std::to_string(n));
  }
  impl_->now_ = std::move(state);
}
std::size_t HeatSimulation::steps() const { return impl_->now_.steps; }
const HeatWork& HeatSimulation::work() const { return impl_->stepper_.work(); }
void HeatSimulation::count_time() { impl_->stepper_.count_time(); }

double HeatSimulation::frozen_volume() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < impl_->now_.temperature.size(); ++i) {
    for (const heat::Part& p : impl_->body_.parts(i)) {
      sum += p.volume * (1.0 - impl_->body_.curve(p.tissue).at(impl_->now_.temperature[i]).liquid);
    }
  }
  return sum;
}

double HeatSimulation::volume_below(double temperature) const {
  double sum = 0.0;
  for (std::size_t t = 0; t < impl_->mesh_.tets.size(); ++t) {
    std::array<double, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = impl_->now_.temperature[impl_->mesh_.tets[t][c]];
    sum += six_rest_volume(impl_->mesh_, t) / 6.0 * share_below(corners, temperature);
  }
  return sum;
}

}  // namespace glisson

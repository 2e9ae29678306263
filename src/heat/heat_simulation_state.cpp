// heat_simulation_state.cpp — the state of a HeatSimulation: given back, written, read; volumes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <istream>
#include <iterator>
#include <ostream>
#include <stdexcept>

#include "heat/heat_simulation_impl.h"
#include "heat/share_below.h"

namespace glisson {
namespace {

/// A number that follows from all coordinates and tets of a mesh [FNV-1a].
std::uint64_t fingerprint(const TetMesh& mesh) {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 1099511628211ULL; };
  for (const Vec3d& x : mesh.vertices) {
    for (std::size_t i = 0; i < 3; ++i) add(std::bit_cast<std::uint64_t>(x[i] + 0.0));
  }
  for (const Tet& t : mesh.tets) {
    for (const std::uint32_t v : t) add(v);
  }
  return hash;
}

/// Whether a history has an entry for each vertex and isotherm, and flags that are flags.
bool is_of(const HeatHistory& x, std::size_t n, std::size_t isotherms) {
  const auto flags = [n](const std::vector<std::uint8_t>& list) {
    return list.size() == n && std::all_of(list.begin(), list.end(), [](std::uint8_t f) { return f < 2; });
  };
  bool right = x.below.size() == isotherms && x.freezings.size() == n && flags(x.frozen) && flags(x.dead);
  for (const auto* of : {&x.coldest, &x.hottest, &x.cem43, &x.damage, &x.cold_time}) right = right && of->size() == n;
  for (const std::vector<double>& of : x.below) right = right && of.size() == n;
  return right;
}

constexpr std::string_view kMagic = "GLISSONH2";

}  // namespace

void HeatSimulation::load_state(HeatState state) {
  const std::size_t n = impl_->held_.size();
  if (state.temperature.size() != n || state.heat.size() != n || (!state.rate.empty() && state.rate.size() != n)) {
    throw std::invalid_argument("heat: load_state: the state is of " + std::to_string(state.temperature.size()) +
                                " vertices, this mesh has " + std::to_string(n));
  }
  if (!is_of(state.history, n, impl_->options_.isotherms.size()))
    throw std::invalid_argument("heat: load_state: the state has the history of another mesh, or of other isotherms");
  if (state.radio.size() != impl_->radio_.size())
    throw std::invalid_argument("heat: load_state: the state has the radio frequency of another simulation");
  impl_->now_ = std::move(state);
}

void HeatSimulation::save(std::ostream& out) const {
  Archive contents;
  std::uint64_t mesh = fingerprint(impl_->mesh_);
  HeatState state = impl_->now_;
  contents(mesh, impl_->options_.isotherms, state);
  out << kMagic << contents.bytes();
  if (!out.flush()) throw std::runtime_error("heat: the state could not be written; is there room on the disk?");
}

void HeatSimulation::load(std::istream& in) {
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!bytes.starts_with(kMagic)) {
    throw std::runtime_error("heat: this is no state of a HeatSimulation; it does not begin with " +
                             std::string(kMagic));
  }
  Archive contents(bytes.substr(kMagic.size()));
  std::uint64_t mesh = 0;
  std::vector<double> isotherms;
  HeatState state;
  contents(mesh, isotherms, state);
  const std::size_t n = impl_->held_.size();
  contents.check(contents.left() == 0 && mesh == fingerprint(impl_->mesh_) && isotherms == impl_->options_.isotherms);
  contents.check(state.temperature.size() == n && state.heat.size() == n &&
                 (state.rate.empty() || state.rate.size() == n) && is_of(state.history, n, isotherms.size()));
  for (const auto* of : {&state.temperature, &state.heat, &state.rate})
    contents.check(std::all_of(of->begin(), of->end(), [](double x) { return std::isfinite(x); }));
  contents.check(state.radio.size() == impl_->radio_.size());
  for (const RadioState& x : state.radio) {
    contents.check(x.potential.empty() || x.potential.size() == n);
    contents.check(std::all_of(x.potential.begin(), x.potential.end(), [](double p) { return std::isfinite(p); }));
  }
  contents.check(std::isfinite(state.time) && std::isfinite(state.step_before) && std::isfinite(state.wanted));
  contents.check(state.time >= 0.0 && state.step_before >= 0.0 && state.wanted >= 0.0);
  impl_->now_ = std::move(state);
}

void HeatState::archive(Archive& ar) {
  ar(time, steps, temperature, heat, rate, step_before, wanted, limited_share, history, radio);
  ar(ledger.stored, ledger.held, ledger.surface, ledger.blood, ledger.metabolism, ledger.sources, ledger.removed);
}

double HeatSimulation::frozen_volume(std::optional<int> region) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < impl_->now_.temperature.size(); ++i) {
    for (const heat::Part& p : impl_->body_.parts(i)) {
      if (region && impl_->body_.region_of(p.tissue) != *region) continue;
      sum += p.volume * (1.0 - impl_->body_.curve(p.tissue).at(impl_->now_.temperature[i]).liquid);
    }
  }
  return sum;
}

std::vector<double> HeatSimulation::frozen_share() const {
  std::vector<double> share;
  for (std::size_t i = 0; i < impl_->now_.temperature.size(); ++i) {
    double frozen = 0.0;
    for (const heat::Part& p : impl_->body_.parts(i))
      frozen += p.volume * (1.0 - impl_->body_.curve(p.tissue).at(impl_->now_.temperature[i]).liquid);
    const double all = impl_->body_.volume(i);
    share.push_back(all > 0.0 ? frozen / all : 0.0);
  }
  return share;
}

double HeatSimulation::volume_below(double temperature, std::optional<int> region) const {
  double sum = 0.0;
  for (std::size_t t = 0; t < impl_->mesh_.tets.size(); ++t) {
    if ((region && impl_->mesh_.region_of(t) != *region) || impl_->is_hollow(impl_->mesh_.region_of(t))) continue;
    std::array<double, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = impl_->now_.temperature[impl_->mesh_.tets[t][c]];
    sum += six_rest_volume(impl_->mesh_, t) / 6.0 * heat::share_below(corners, temperature);
  }
  return sum;
}

double HeatSimulation::dead_volume(std::optional<int> region) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < impl_->now_.temperature.size(); ++i) {
    if (impl_->now_.history.dead[i] == 0) continue;
    for (const heat::Part& p : impl_->body_.parts(i)) {
      if (!region || impl_->body_.region_of(p.tissue) == *region) sum += p.volume;
    }
  }
  return sum;
}

}  // namespace glisson

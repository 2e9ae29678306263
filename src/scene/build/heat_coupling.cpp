// heat_coupling.cpp — heat and mechanics in turn.
//
//   mechanics ── to t + every ──▶ positions ─▶ heat ── to t + every ──▶ shares of ice ─▶ Ice ─▶ mechanics …
//
// Each goes by what the other was at the end of its last part: an error of the first order in `every`.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "glisson/archive.h"
#include "glisson/scene/heat_run.h"

namespace glisson {
namespace {

constexpr double kMoves = 1e-4;  // of the mean edge of a tet: so far vertices may move before conduction follows
constexpr double kLeastChange = 1.0 / 256;  // of a share of ice
constexpr double kSameTime = 1e-9;          // of `every`
constexpr double kColdest = -273.15;        // [°C]

double mean_edge(const TetMesh& mesh) {
  return std::cbrt(6.0 * volume(mesh) / static_cast<double>(std::max<std::size_t>(1, mesh.tets.size())));
}

TetMesh without_removed(const BodyView& body) {
  TetMesh mesh = body.mesh;
  mesh.tets.clear(), mesh.regions.clear(), mesh.fibres.clear();
  for (std::size_t t = 0; t < body.mesh.tets.size(); ++t) {
    if (body.is_removed(t)) continue;
    mesh.tets.push_back(body.mesh.tets[t]);
    if (!body.mesh.regions.empty()) mesh.regions.push_back(body.mesh.regions[t]);
  }
  return mesh;
}

}  // namespace

struct HeatCoupling::State {
  /// What of the body's heat a state in memory has.
  struct Saved {
    HeatState heat;
    TetMesh mesh;
    std::vector<std::uint32_t> origins;
    std::vector<Vec3d> positions;
    std::uint64_t parts = 0;
    std::string trouble;
    RunSummary::End end = RunSummary::End::finished;
  };

  State(const Variant& v, const TetMesh& mesh)
      : variant(v), start(mesh), heat(mesh, v), ice(std::make_shared<Ice>(v.heat->ice->options)),
        every(std::min(v.heat->ice->every, v.heat->duration)), moves(kMoves * mean_edge(mesh)) {}

  Variant variant;
  TetMesh start;
  BuiltHeat heat;
  std::shared_ptr<Ice> ice;
  double every, moves;                 ///< [s], [m]
  std::vector<std::uint32_t> origins;  ///< of all vertices that were added
  std::vector<Vec3d> positions;        ///< that heat knows of [m]; empty: those at rest
  std::uint64_t parts = 0;             ///< that have been made
  std::string trouble;
  RunSummary::End end = RunSummary::End::finished;
  mutable std::shared_ptr<const Saved> saved;  ///< the present state, where it was asked for

  double due() const { return every * static_cast<double>(parts + 1); }
  void follow(std::vector<Vec3d> now);
  bool advance(double time);
  void freeze(Simulation& simulation);
  void stop(RunSummary::End how, std::string why) { end = how, trouble = std::move(why); }
};

/// Conduction follows vertices that have moved by more than can be neglected.
void HeatCoupling::State::follow(std::vector<Vec3d> now) {
  const std::span<const Vec3d> last = positions.empty() ? heat.simulation.mesh().vertices : positions;
  bool moved = false;
  for (std::size_t v = 0; v < now.size() && !moved; ++v) moved = norm(now[v] - last[v]) > moves;
  if (!moved) return;
  heat.simulation.set_positions(now);
  positions = std::move(now);
}

bool HeatCoupling::State::advance(double time) {
  HeatSimulation& s = heat.simulation;
  while (s.time() < time) {
    const HeatStep step = s.step_towards(time);
    if (step.status != HeatStatus::ok) {
      stop(RunSummary::End::stopped_not_converged,
           "heat: a step of " + detail::number_text(step.step) +
               " s did not converge; look for a power or coefficient that is too large, or give a smaller "
               "`heat.tolerance_K`");
      return false;
    }
  }
  const double coldest = *std::min_element(s.temperature().begin(), s.temperature().end());
  if (coldest >= kColdest) return true;
  stop(RunSummary::End::stopped_too_cold,
       "heat: " + detail::number_text(coldest) +
           " °C is below absolute zero; take a smaller power, or a temperature through a coefficient in its place");
  return false;
}

/// Gives the tets the ice that their vertices have.
void HeatCoupling::State::freeze(Simulation& simulation) {
  const std::vector<double> of_vertex = heat.simulation.frozen_share();
  const std::vector<Tet>& all = simulation.mesh().tets;
  std::vector<std::uint32_t> tets;
  std::vector<double> shares;
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    double share = 0.0;
    for (const std::uint32_t v : all[t]) share += 0.25 * of_vertex[v];
    if (share < kLeastChange) share = 0.0;
    if (share > 1.0 - kLeastChange) share = 1.0;
    const double now = ice->share(t);
    if (share == now || (std::abs(share - now) < kLeastChange && share != 0.0 && share != 1.0)) continue;
    tets.push_back(t), shares.push_back(share);
  }
  if (tets.empty()) return;
  try {
    ice->set_shares(simulation, tets, shares);
  } catch (const std::invalid_argument& refused) {
    stop(RunSummary::End::stopped_unstable, refused.what());
  }
}

HeatCoupling::HeatCoupling(const Variant& variant, const TetMesh& mesh)
    : state_(std::make_unique<State>(variant, mesh)) {}
HeatCoupling::~HeatCoupling() = default;

const BuiltHeat& HeatCoupling::heat() const { return state_->heat; }
const std::shared_ptr<Ice>& HeatCoupling::ice() const { return state_->ice; }
const std::string& HeatCoupling::trouble() const { return state_->trouble; }
RunSummary::End HeatCoupling::end() const { return state_->end; }
int HeatCoupling::most_drag_stages() const { return kMostDragStages; }
void HeatCoupling::attached(const BodyView&, double) {}

void HeatCoupling::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  State& s = *state_;
  s.saved = nullptr;
  s.origins.insert(s.origins.end(), origins.begin(), origins.end());
  try {
    s.heat.change_mesh(without_removed(body), origins);
  } catch (const std::invalid_argument& refused) {
    return s.stop(RunSummary::End::stopped_not_converged, refused.what());
  }
  for (const std::uint32_t v : origins) {
    if (!s.positions.empty()) s.positions.push_back(Vec3d(s.positions[v]));
  }
}

void HeatCoupling::between_steps(Simulation& simulation) {
  State& s = *state_;
  const double time = simulation.time();
  if (!s.trouble.empty()) return;
  if (simulation.steps() == 0 && s.parts == 0) return s.freeze(simulation);  // what is frozen at the start
  if (time < s.due() - kSameTime * s.every) return;
  s.saved = nullptr;
  s.parts = static_cast<std::uint64_t>(std::floor(time / s.every + kSameTime));
  s.follow(simulation.positions());
  if (s.advance(time)) s.freeze(simulation);
}

double HeatCoupling::next_corner(double after) const {
  const double every = state_->every, part = std::floor(after / every) + 1.0;
  return part * every > after ? part * every : (part + 1.0) * every;
}

void HeatCoupling::archive(Archive& ar) {
  State& s = *state_;
  HeatState heat = s.heat.simulation.state();
  std::vector<Vec3d> positions = s.positions;
  ar(heat, positions, s.parts);
  if (!ar.reads()) return;
  s.saved = nullptr;
  const std::size_t vertices = s.heat.simulation.mesh().vertices.size();
  ar.check(positions.empty() || positions.size() == vertices);
  try {
    s.heat.simulation.load_state(std::move(heat));
  } catch (const std::invalid_argument&) {
    ar.check(false);
  }
  s.positions = std::move(positions);
  s.heat.simulation.set_positions(s.positions.empty() ? s.heat.simulation.mesh().vertices : s.positions);
}

std::shared_ptr<const void> HeatCoupling::save_state() const {
  const State& s = *state_;
  if (s.saved == nullptr) {
    s.saved = std::make_shared<const State::Saved>(State::Saved{s.heat.simulation.state(), s.heat.simulation.mesh(),
                                                                s.origins, s.positions, s.parts, s.trouble, s.end});
  }
  return s.saved;
}

/// A heat that has never been cut follows the mesh of an earlier state: it begins anew there.
void HeatCoupling::load_state(const std::shared_ptr<const void>& state, const BodyView*) {
  State& s = *state_;
  if (state == s.saved) return;
  auto saved = std::static_pointer_cast<const State::Saved>(state);
  if (saved->mesh.tets != s.heat.simulation.mesh().tets || saved->origins != s.origins) {
    s.heat = BuiltHeat(s.start, s.variant);
    s.heat.change_mesh(saved->mesh, saved->origins);
  }
  s.origins = saved->origins, s.positions = saved->positions, s.parts = saved->parts;
  s.trouble = saved->trouble, s.end = saved->end;
  s.heat.simulation.load_state(saved->heat);
  s.heat.simulation.set_positions(s.positions.empty() ? s.heat.simulation.mesh().vertices : s.positions);
  s.saved = std::move(saved);
}

}  // namespace glisson

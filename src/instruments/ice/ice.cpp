#include "glisson/instruments/ice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "dynamics/simulation_parts.h"
#include "element/body.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"
#include "instruments/ice/ice_state.h"

namespace glisson {
namespace {

constexpr double kLeastVolume = 0.05;  ///< of the volume at rest, at which a tet begins to freeze
constexpr double kMostRise = 2.0;      ///< how much more strain than now the stable step covers

std::array<Vec3d, 4> rest_corners(const TetMesh& mesh, const Tet& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]};
}

/// Tets that begin to freeze, of the tissues of a simulation.
class NewTets {
 public:
  explicit NewTets(const Simulation& simulation) : simulation_(simulation) {}

  /// None where the tet is nearly flat. @param at  vertex → displacement [m]
  template <class At>
  std::optional<IceTet> make(std::uint32_t number, const At& at) {
    const TetMesh& mesh = simulation_.mesh();
    const int region = mesh.region_of(number);
    auto known = blocks_.find(region);
    if (known == blocks_.end()) known = blocks_.emplace(region, make_block(simulation_.tissue(region), 0, 0)).first;
    IceTet tet{.number = number,
               .corners = mesh.tets[number],
               .rest = element_rest(rest_corners(mesh, mesh.tets[number])),
               .elastic = known->second.elastic,
               .drag = known->second.viscous,
               .ice = {}};
    const Mat3d F = deformation_gradient(gradient_of(tet, at));
    tet.ice.volume_ratio = determinant(F);
    if (!(tet.ice.volume_ratio > kLeastVolume)) return {};
    tet.ice.inverse = inverse(F);
    return tet;
  }

 private:
  const Simulation& simulation_;
  std::map<int, TissueBlock> blocks_;
};

void require_shares(std::size_t tet_count, std::span<const std::uint32_t> tets, std::span<const double> shares) {
  if (tets.size() != shares.size()) {
    throw std::invalid_argument("ice: " + std::to_string(shares.size()) + " shares were given for " +
                                std::to_string(tets.size()) + " tets; give one each");
  }
  for (std::size_t k = 0; k < tets.size(); ++k) {
    if (tets[k] >= tet_count) {
      throw std::invalid_argument("ice: tet " + std::to_string(tets[k]) + " is outside the mesh, 0 to " +
                                  std::to_string(tet_count - 1));
    }
    if (shares[k] >= 0.0 && shares[k] <= 1.0) continue;
    throw std::invalid_argument("ice: the share of tet " + std::to_string(tets[k]) + " is " + detail::show(shares[k]) +
                                ", outside the allowed range, 0 (melted) to 1 (frozen)");
  }
}

}  // namespace

Ice::Ice(const IceOptions& options) {
  detail::require_fields("ice", options);
  state_ = std::make_unique<State>(options);
}
Ice::~Ice() = default;

const IceOptions& Ice::options() const { return state_->options; }
std::size_t Ice::frozen_tets() const { return state_->frozen->tets.size(); }
double Ice::energy() const { return state_->energy; }
double Ice::changed_energy() const { return state_->changed; }

double Ice::share(std::uint32_t tet) const {
  const FrozenTets& all = *state_->frozen;
  return tet < all.place_of.size() && all.place_of[tet] > 0 ? all.tets[all.place_of[tet] - 1].share : 0.0;
}

Mat3d Ice::stress(std::uint32_t tet) const {
  const FrozenTets& all = *state_->frozen;
  if (share(tet) == 0.0) return {};
  const std::size_t k = all.place_of[tet] - 1;
  const IceTet& t = all.tets[k];
  const IceResponse r(t.ice, t.elastic, state_->drag(t), state_->H[k], state_->Hdot[k]);
  const Mat3d F = deformation_gradient(state_->H[k]);
  return scaled(ice_piola(t.ice, r.F_r, r.elastic + r.viscous) * transposed(F), 1.0 / determinant(F));
}

void Ice::set_shares(Simulation& simulation, std::span<const std::uint32_t> tets, std::span<const double> shares) {
  SimulationParts::refuse_inside_step(SimulationParts::inside(simulation), "Ice::set_shares");
  Scheme& scheme = SimulationParts::scheme(simulation);
  if (std::ranges::none_of(scheme.interactions(), [this](const auto& x) { return x.get() == this; })) {
    throw std::invalid_argument("ice: it is not attached to this simulation; attach it first");
  }
  require_shares(state_->tet_count, tets, shares);
  const std::span<const Vec3d> u = simulation.displacement();
  const auto at = [u](std::uint32_t v) { return u[v]; };
  State next = *state_;
  FrozenTets frozen = *next.frozen;
  NewTets fresh(simulation);
  bool some_thawed = false;
  for (std::size_t k = 0; k < tets.size(); ++k) {
    std::uint32_t place = frozen.place_of[tets[k]];
    if (place == 0) {
      if (shares[k] == 0.0 || simulation.is_removed(tets[k])) continue;
      const std::optional<IceTet> tet = fresh.make(tets[k], at);
      if (!tet) continue;
      frozen.tets.push_back(*tet);
      place = frozen.place_of[tets[k]] = static_cast<std::uint32_t>(frozen.tets.size());
    }
    IceTet& tet = frozen.tets[place - 1];
    next.set_share(tet, gradient_of(tet, at), shares[k]);
    some_thawed = some_thawed || shares[k] == 0.0;
  }
  if (some_thawed) std::erase_if(frozen.tets, [](const IceTet& t) { return t.share == 0.0; });
  next.replace(std::move(frozen));
  next.evaluate(at, [](std::uint32_t, const Vec3d&) {});
  std::swap(*state_, next);
  try {
    scheme.interactions_changed();
  } catch (const std::invalid_argument& refused) {
    std::swap(*state_, next);
    scheme.interactions_changed();
    throw std::invalid_argument(std::string("ice: ") + refused.what() +
                                "; or integrator = \"implicit\", whose steps have no such limit");
  }
}

void Ice::attached(const BodyView& body, double) {
  State fresh(state_->options);
  fresh.is_long = state_->is_long;
  if (!fresh.is_long && fresh.options.viscosity_factor != 1.0) {
    throw std::invalid_argument("ice: viscosity_factor = " + detail::show(fresh.options.viscosity_factor) +
                                " needs integrator = \"implicit\" or \"quasi_static\", since short steps take viscous "
                                "forces of the step before; "
                                "allowed with others: 1");
  }
  fresh.tet_count = body.mesh.tets.size();
  fresh.masses = std::make_shared<const std::vector<double>>(body.masses.begin(), body.masses.end());
  fresh.replace({});
  *state_ = std::move(fresh);
}

void Ice::body_changed(const BodyView& body, std::span<const std::uint32_t>) {
  State& s = *state_;
  const auto at = [&](std::uint32_t v) { return body.displacement[v]; };
  s.masses = std::make_shared<const std::vector<double>>(body.masses.begin(), body.masses.end());
  FrozenTets next;
  for (std::size_t k = 0; k < s.frozen->tets.size(); ++k) {
    IceTet t = s.frozen->tets[k];
    if (body.is_removed(t.number)) {
      s.changed -= t.energy(s.H[k]);
      continue;
    }
    t.corners = body.mesh.tets[t.number];
    const ElementRest rest = element_rest(rest_corners(body.mesh, t.corners));
    if (rest.s != t.rest.s) {  // vertices are other points of the material, which is strained as before
      const double before = t.energy(s.H[k]);
      const Mat3d F_r = since_frozen(t.ice, s.H[k]);
      t.rest = rest;
      const Mat3d F = deformation_gradient(gradient_of(t, at)), shape = inverse(F) * F_r;
      t.ice.inverse = shape, t.ice.volume_ratio = 1.0 / determinant(shape);
      s.changed += t.energy(gradient_of(t, at)) - before;
    }
    next.tets.push_back(t);
  }
  s.replace(std::move(next));
  s.evaluate(at, [](std::uint32_t, const Vec3d&) {});
}

std::span<const std::uint32_t> Ice::reach(double, double) {
  if (state_->is_long || !state_->is_renamed) return {};
  return state_->frozen->vertices;
}

std::optional<std::span<const std::uint32_t>> Ice::keeps() {
  if (state_->is_long || !std::exchange(state_->is_renamed, false)) return {};
  return state_->frozen->vertices;
}

int Ice::most_drag_stages() const { return kMostDragStages; }
void Ice::set_long_steps(bool are_long) { state_->is_long = are_long; }

void Ice::add_forces(const InteractionStep& step) {
  if (state_->is_long || state_->frozen->tets.empty()) return;
  state_->evaluate([&](std::uint32_t v) { return step.vertices[step.place_of[v]].displacement; },
                   [&](std::uint32_t v, const Vec3d& f) { step.vertices[step.place_of[v]].elastic += f; });
}

void Ice::add_forces_at(std::span<const Vec3d> displacement, std::span<Vec3d> force) {
  state_->evaluate([&](std::uint32_t v) { return displacement[v]; },
                   [&](std::uint32_t v, const Vec3d& f) { force[v] += f; });
}

void Ice::add_viscous_forces_at(std::span<const Vec3d>, std::span<const Vec3d> velocity, std::span<Vec3d> force) {
  State& s = *state_;
  if (s.options.viscosity_factor == 1.0) return;
  for (std::size_t k = 0; k < s.frozen->tets.size(); ++k) {
    const IceTet& t = s.frozen->tets[k];
    s.Hdot[k] = gradient_of(t, [&](std::uint32_t v) { return velocity[v]; });
    const IceResponse r(t.ice, t.elastic, s.drag(t), s.H[k], s.Hdot[k]);
    push_corners(t, ice_piola(t.ice, r.F_r, r.viscous), [&](std::uint32_t v, const Vec3d& f) { force[v] += f; });
  }
}

void Ice::add_tet_stiffness(std::vector<TetStiffness>& all, double rate) const {
  const State& s = *state_;
  for (std::size_t k = 0; k < s.frozen->tets.size(); ++k) {
    const IceTet& t = s.frozen->tets[k];
    const IceResponse r(t.ice, t.elastic, s.drag(t), s.H[k], s.Hdot[k]);
    all.push_back({t.number, ice_tangent(t.ice, t.elastic, s.drag(t), r, rate)});
  }
}

double Ice::squared_frequency() const {
  return state_->frozen->squared_frequency * (1.0 + kMostRise * (state_->rise - 1.0));
}

bool Ice::add_stiffness_bound(std::vector<VertexStiffness>& all) const {
  const FrozenTets& f = *state_->frozen;
  const double rise = 1.0 + kMostRise * (state_->rise - 1.0);
  for (std::size_t k = 0; k < f.vertices.size(); ++k) all.push_back({f.vertices[k], rise * f.bounds[k]});
  return true;
}

void Ice::state_set(std::span<const Vec3d> displacement) {
  state_->evaluate([&](std::uint32_t v) { return displacement[v]; }, [](std::uint32_t, const Vec3d&) {});
}

void Ice::archive(Archive& ar) {
  State& s = *state_;
  std::vector<IceTet> tets = s.frozen->tets;
  ar(tets);
  if (ar.reads()) {
    std::vector<char> seen(s.tet_count, 0);
    for (const IceTet& t : tets) {
      ar.check(t.number < s.tet_count && std::exchange(seen[t.number], 1) == 0);
      ar.check(std::ranges::all_of(t.corners, [&](std::uint32_t v) { return v < s.masses->size(); }));
      ar.check(t.rest.volume > 0.0 && t.share > 0.0 && t.share <= 1.0 && t.ice.amount >= 0.0 && t.elastic.mu > 0.0);
    }
    FrozenTets next;
    next.tets = std::move(tets);
    s.replace(std::move(next));
  }
  ar.same_size(s.H), ar.same_size(s.Hdot);
  ar(s.is_renamed, s.energy, s.rise, s.changed);
}

std::shared_ptr<const void> Ice::save_state() const { return std::make_shared<const State>(*state_); }

void Ice::load_state(const std::shared_ptr<const void>& state, const BodyView*) {
  *state_ = *std::static_pointer_cast<const State>(state);
}

}  // namespace glisson

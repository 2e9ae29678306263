// simulation.cpp — the public face of a body in motion: checks what comes in, and hands on.
#include "glisson/simulation/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/require_fields.h"
#include "base/text.h"
#include "dynamics/contact_fields.h"
#include "dynamics/schemes/changer.h"
#include "dynamics/schemes/make_scheme.h"
#include "dynamics/simulation_impl.h"
#include "dynamics/simulation_parts.h"
#include "dynamics/state/checkpoint.h"
#include "dynamics/step/mass_scaling.h"
#include "element/block_response.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

void require_options(const SimulationOptions& o) {
  detail::require_fields("simulation", o);
  const Capabilities can = capabilities(o.integrator);
  if (o.drag_stages > 1 && !can.supports_drag_stages) {
    throw std::invalid_argument(
        "simulation: drag_stages = " + std::to_string(o.drag_stages) +
        " is outside the allowed range, 1 with "
        "every integrator but central_difference: semi_implicit and implicit take the viscous force at the "
        "end of the step");
  }
  if (o.mass_scaling == MassScalingKind::variable && (!can.supports_variable_mass || o.step || !o.mass_scaling_step)) {
    throw std::invalid_argument(
        "simulation: mass_scaling = \"variable\" needs the integrator central_difference, step = \"auto\" and a "
        "mass_scaling_step [s], which is the longest step; take mass_scaling = \"fixed\", or set these");
  }
  if (o.precision == Precision::adaptive && !can.supports_adaptive_precision) {
    throw std::invalid_argument("simulation: precision = \"adaptive\" is not supported by the integrator " +
                                std::string(word_of(o.integrator)) +
                                "; take central_difference, or precision = \"single\" or \"double\"");
  }
  if (o.branches == StaticBranches::relaxed && o.integrator != Integrator::quasi_static) {
    throw std::invalid_argument("simulation: branches = \"relaxed\" is for the integrator quasi_static, not " +
                                std::string(word_of(o.integrator)) +
                                ", in which Maxwell branches and viscosity follow time in any case; leave it out");
  }
  if (!o.mass_scaling_step || !can.any_step_is_stable) return;
  throw std::invalid_argument(
      "simulation: mass_scaling_step [s] = " + detail::show(*o.mass_scaling_step) +
      " is outside the allowed range, none with the integrators implicit and quasi_static, which need "
      "no mass for their step");
}

std::uint64_t fingerprint_of(const TetMesh& mesh, const Body& body) {
  std::uint64_t hash = hash_numbers(std::span<const Vec3d>(mesh.vertices));
  hash = hash_numbers(std::span<const Tet>(mesh.tets), hash);
  for (const TissueBlock& block : body.blocks) {
    const std::array<double, 6> moduli{block.elastic.lambda, block.elastic.mu,     block.viscous.lambda,
                                       block.viscous.mu,     block.tissue.density, static_cast<double>(block.end)};
    hash = hash_numbers(std::span<const double>(moduli), hash);
  }
  return hash;
}

std::uint32_t kind_of(const SimulationOptions& o) {
  return static_cast<std::uint32_t>(o.integrator) + 16U * static_cast<std::uint32_t>(o.implicit.scheme) +
         256U * static_cast<std::uint32_t>(o.precision) +
         4096U * static_cast<std::uint32_t>(o.branches == StaticBranches::follow);
}

}  // namespace

/// Lets the last vertices of the mesh be copies of these.
void Simulation::Impl::add_copies(std::span<const std::uint32_t> origins) {
  for (const std::uint32_t origin : origins) {
    const auto copy = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(scheme->body().rest_positions[copy]);
    for (auto& [name, set] : mesh.vertex_sets) {
      if (std::binary_search(set.begin(), set.end(), origin)) set.push_back(copy);
    }
  }
}

std::size_t Simulation::Impl::block_of(int region) const {
  const Body& body = scheme->body();
  const auto region_of = [&](const TissueBlock& block) { return mesh.region_of(body.mesh_tet[block.begin]); };
  const auto found = std::ranges::find(body.blocks, region, region_of);
  if (found != body.blocks.end()) return static_cast<std::size_t>(found - body.blocks.begin());
  std::ostringstream known;
  for (const TissueBlock& block : body.blocks) {
    const int number = region_of(block);
    known << (&block == body.blocks.data() ? "" : ", ") << number;
    if (const auto name = mesh.region_names.find(number); name != mesh.region_names.end()) {
      known << " (\"" << name->second << "\")";
    }
  }
  throw std::invalid_argument("tissue of region " + std::to_string(region) +
                              ": no tet of the mesh is in this region; there are " + known.str());
}

Simulation::Simulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options) {
  require_options(options);
  Body body = build_body(mesh, tissues);
  const std::uint64_t fingerprint = fingerprint_of(mesh, body);
  impl_.reset(new Impl{std::move(mesh), make_scheme(std::move(body), options), kind_of(options), fingerprint});
}

Scheme& SimulationParts::scheme(Inside& inside) { return *inside.scheme; }
const Scheme& SimulationParts::scheme(const Simulation& simulation) { return *simulation.inside().scheme; }
std::weak_ptr<const Scheme> SimulationParts::weak_scheme(const Simulation& simulation) {
  return simulation.inside().scheme;
}
const TetMesh& SimulationParts::mesh(const Inside& inside) { return inside.mesh; }
ConstraintId SimulationParts::add_constraint(Simulation& simulation, Constraint constraint) {
  return inside(simulation).add("fix", std::move(constraint));
}
void SimulationParts::refuse_inside_step(const Inside& inside, const char* name, bool between_steps) {
  inside.refuse_while_busy(name, between_steps ? Inside::Busy::between_steps : Inside::Busy::no);
}
SplitReport SimulationParts::split_faces(Inside& inside, std::span<const Triangle> faces,
                                         std::span<const VertexMove> moves) {
  return inside.split_faces(faces, moves);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation::Impl& Simulation::inside() const {
  if (impl_ != nullptr) return *impl_;
  throw std::logic_error("simulation: it was moved from; it can be assigned to or destroyed, and no more");
}

thread_local const Simulation::Impl::Asking* Simulation::Impl::Asking::innermost = nullptr;

bool Simulation::Impl::Asking::is_going_on(const Impl& inside) {
  const Asking* asking = innermost;
  while (asking != nullptr && &asking->inside_ != &inside) asking = asking->outer_;
  return asking != nullptr;
}

void Simulation::Impl::refuse_while_busy(const std::string& name, Busy most) const {
  const bool asks = Asking::is_going_on(*this);
  if (busy <= most && !asks) return;
  if (busy == Busy::between_steps && !asks) {
    throw std::logic_error(name + ": it was called from Interaction::between_steps, which may change the body, but " +
                           "neither step nor go to another state; call it after the step");
  }
  throw std::logic_error(name + ": it was called from inside a step or a change, by a motion, load, driver or " +
                         "interaction; call it after the step" +
                         (most == Busy::no ? "" : ", or from Interaction::between_steps"));
}

Simulation::Impl::Guard::Guard(Impl& inside, const char* name, Busy most) : inside_(inside), before_(inside.busy) {
  inside.refuse_while_busy(name, most);
  inside.busy = Busy::yes;
}

/// @param name  of the member that was called
ConstraintId Simulation::Impl::add(const char* name, Constraint constraint) {
  const Guard guard(*this, name, Busy::between_steps);
  begin_setup();
  return scheme->add_constraint(std::move(constraint));
}

ConstraintId Simulation::fix(std::span<const std::uint32_t> vertices, Axes axes) {
  return inside().add("fix", {{vertices.begin(), vertices.end()}, axes, {}, 0.0, {}, {kAtRest, kAtRest, kAtRest}});
}
ConstraintId Simulation::fix(std::string_view set, Axes axes) { return fix(mesh().vertex_set(std::string(set)), axes); }

ConstraintId Simulation::drive(std::span<const std::uint32_t> vertices, Motion motion, Axes axes, double from) {
  if (!motion) throw std::invalid_argument("drive: no motion was given; fix() holds vertices where they are");
  return inside().add("drive", {{vertices.begin(), vertices.end()}, axes, std::move(motion), from, {}});
}

ConstraintId Simulation::drive(std::string_view set, Motion motion, Axes axes, double from) {
  return drive(mesh().vertex_set(std::string(set)), std::move(motion), axes, from);
}

ConstraintId Simulation::drive_rigidly(std::span<const std::uint32_t> vertices, PoseMotion motion, Axes axes,
                                       double from) {
  if (!motion) throw std::invalid_argument("drive_rigidly: no motion was given; fix() holds vertices where they are");
  return inside().add("drive_rigidly", {{vertices.begin(), vertices.end()}, axes, {}, from, std::move(motion)});
}

ConstraintId Simulation::drive_rigidly(std::string_view set, PoseMotion motion, Axes axes, double from) {
  return drive_rigidly(mesh().vertex_set(std::string(set)), std::move(motion), axes, from);
}

void Simulation::add_load(std::string_view set, Vec3d force, TimeFunction<double> scale) {
  add_load(mesh().vertex_set(std::string(set)), force, std::move(scale));
}

void Simulation::add_load(std::span<const std::uint32_t> vertices, Vec3d force, TimeFunction<double> scale) {
  add_surface_load(vertices, {.force = force}, std::move(scale));
}

void Simulation::add_surface_load(std::span<const std::uint32_t> vertices, const SurfaceLoad& load,
                                  TimeFunction<double> scale) {
  const Impl::Guard guard(inside(), "add_load", Impl::Busy::between_steps);
  inside().begin_setup();
  inside().scheme->add_load(vertices, load, std::move(scale));
}

void Simulation::add_surface_load(std::string_view set, const SurfaceLoad& load, TimeFunction<double> scale) {
  add_surface_load(mesh().vertex_set(std::string(set)), load, std::move(scale));
}

void Simulation::attach(std::shared_ptr<Interaction> interaction) {
  if (interaction == nullptr) throw std::invalid_argument("attach: no interaction was given");
  if (interaction->is_attached_) {
    throw std::invalid_argument("attach: " + interaction->label() +
                                " acts on a simulation already, and on no other one after it: make a new one of the "
                                "same options");
  }
  Impl& me = inside();
  const Impl::Guard guard(me, "attach", Impl::Busy::between_steps);
  const bool acts = interaction->acts_in_steps();
  if (acts) me.scheme->attach(interaction, me.view());
  interaction->is_attached_ = true;
  me.busy = Impl::Busy::between_steps;
  try {
    interaction->between_steps(*this);
  } catch (...) {
    interaction->is_attached_ = acts;  // one that only sets up may be tried again
    throw;
  }
}

RemovalReport Simulation::remove_tets(std::span<const std::uint32_t> tets) {
  Impl& me = inside();
  const Impl::Guard guard(me, "remove_tets", Impl::Busy::between_steps);
  me.keep_version();
  RemovalReport report = Changer(*me.scheme).remove(tets);
  me.begin_version();
  me.removed.resize(me.mesh.tets.size(), 0);
  for (const std::uint32_t t : tets) me.removed[t] = 1;
  me.tell_change({});
  return report;
}

SplitReport Simulation::Impl::split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  const Guard guard(*this, "split_faces", Busy::between_steps);
  keep_version();
  auto [report, changed] = Changer(*scheme).split(faces, moves);
  begin_version();
  const Body& body = scheme->body();
  for (const VertexMove& m : moves) mesh.vertices[m.vertex] = m.rest;
  add_copies(report.origins);
  for (const std::uint32_t e : changed) mesh.tets[body.mesh_tet[e]] = body.elements[e];
  tell_change(report.origins);
  return report;
}

SplitReport Simulation::split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  return inside().split_faces(faces, moves);
}

void Simulation::set_tissue(int region, const Tissue& tissue) { set_tissues({{region, tissue}}); }

void Simulation::set_tissues(const std::map<int, Tissue>& tissues) {
  Impl& me = inside();
  const Impl::Guard guard(me, "set_tissues", Impl::Busy::between_steps);
  BlockTissues others;
  for (const auto& [region, tissue] : tissues) {
    const std::size_t b = me.block_of(region);
    if (tissue == me.scheme->body().blocks[b].tissue) continue;
    others.emplace_back(b, tissue);
  }
  if (others.empty()) return;
  me.keep_version();
  const bool masses = Changer(*me.scheme).set_tissues(others);
  me.begin_version();
  if (masses) me.tell_change({});
}

const Tissue& Simulation::tissue(int region) const {
  return inside().scheme->body().blocks[inside().block_of(region)].tissue;
}

bool Simulation::is_removed(std::uint32_t tet) const {
  const std::size_t tets = inside().mesh.tets.size();
  if (tet < tets) return inside().scheme->state().is_removed(tet);
  throw std::invalid_argument("is_removed: tet " + std::to_string(tet) + " is outside the mesh, 0 to " +
                              std::to_string(tets - 1));
}

TetMesh Simulation::present_mesh() const {
  TetMesh present = inside().mesh;
  present.tets.clear();
  present.regions.clear();
  present.fibres.clear();
  for (std::uint32_t t = 0; t < inside().mesh.tets.size(); ++t) {
    if (is_removed(t)) continue;
    present.tets.push_back(inside().mesh.tets[t]);
    if (!inside().mesh.regions.empty()) present.regions.push_back(inside().mesh.regions[t]);
    if (!inside().mesh.fibres.empty()) present.fibres.push_back(Vec3d(inside().mesh.fibres[t]));
  }
  return present;
}

StepResult Simulation::step() {
  Impl& me = inside();
  const Impl::Guard guard(me, "step");
  if (me.scheme->state().steps == 0) me.begin_run();
  const StepResult result = me.scheme->step();
  me.busy = Impl::Busy::between_steps;
  const std::size_t acting = result.made() ? me.scheme->interactions().size() : 0;  // of these, some may attach others
  for (std::size_t i = 0; i < acting; ++i) me.scheme->interactions()[i]->between_steps(*this);
  return result;
}

StepResult Simulation::advance_to(double time) {
  inside().refuse_while_busy("advance_to");
  if (!std::isfinite(time)) {
    throw std::invalid_argument("advance_to: time [s] = " + detail::show(time) +
                                " is not finite; give the time to stop at, and loop over step() to run without end");
  }
  set_step_end(time);
  StepResult last;
  while (last.made() && this->time() + 0.5 * step_size() < time) last = step();
  return last;
}

double Simulation::time() const { return inside().scheme->state().time; }
double Simulation::step_size() const {
  const Impl::Asking asking(inside());  // for what interactions call
  return inside().scheme->step_size();
}
double Simulation::next_corner(double after) const {
  const Impl::Asking asking(inside());
  return inside().scheme->next_corner(after);
}
void Simulation::set_step_end(double time) {
  const Impl::Guard guard(inside(), "set_step_end", Impl::Busy::between_steps);
  inside().scheme->set_step_end(time);
}
void Simulation::set_interrupt(std::function<bool(const StepProgress&)> asks) {
  const Impl::Guard guard(inside(), "set_interrupt", Impl::Busy::between_steps);
  inside().scheme->set_interrupt(std::move(asks));
}
double Simulation::stable_step() const { return inside().scheme->stable_step(); }
std::uint64_t Simulation::steps() const { return inside().scheme->state().steps; }
const TetMesh& Simulation::mesh() const { return inside().mesh; }
std::span<const double> Simulation::masses() const { return inside().scheme->body().masses; }
std::span<const Vec3d> Simulation::displacement() const { return inside().scheme->displacement(); }
std::span<const Vec3d> Simulation::velocity() const { return inside().scheme->velocity(); }

std::vector<Vec3d> Simulation::positions() const {
  std::vector<Vec3d> x = inside().mesh.vertices;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += displacement()[i];
  return x;
}

void Simulation::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  const Impl::Guard guard(inside(), "set_state");
  inside().scheme->set_state(displacement, velocity);
}

ForceParts Simulation::force(ConstraintId constraint) const { return inside().scheme->force(constraint); }

Vec3d Simulation::torque(ConstraintId constraint, const Vec3d& about) const {
  return inside().scheme->torque(constraint, about);
}

const MassScaling& Simulation::mass_scaling() const { return inside().scheme->state().mass_scaling; }

std::vector<LimitingTet> Simulation::limiting_tets(std::size_t most) const {
  const bool counts = inside().scheme->capabilities().viscosity_limits_step;
  return glisson::limiting_tets(inside().scheme->body(), most, counts ? 1.0 : 0.0);
}

double Simulation::force_time() const { return inside().scheme->force_time(); }

double Simulation::linear_share() const { return inside().scheme->linear_share(); }

const EngineInfo& Simulation::engine_info() const { return inside().scheme->info(); }

Energies Simulation::energies() const {
  const Impl::Asking asking(inside());
  Energies energies = inside().scheme->energies();
  if (!inside().scheme->state().options.track_energies) return energies;
  for (const auto& x : inside().scheme->interactions()) {
    energies.elastic += x->changed_energy() - x->released_energy();
    energies.fracture += x->released_energy();
    energies.changed += x->changed_energy();
  }
  return energies;
}

std::optional<double> Simulation::stored_energy() const {
  const Impl::Asking asking(inside());
  const Scheme& scheme = *inside().scheme;
  const double ahead = time() - force_time();
  std::vector<Vec3d> u(displacement().begin(), displacement().end());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= velocity()[i] * ahead;
  double sum = 0.0;
  for (std::size_t b = 0; b < scheme.body().blocks.size(); ++b) {
    const BlockResponse response(scheme.body(), scheme.body().blocks[b]);
    if (!response.stores_energy()) return {};
    const BranchMemory memory = scheme.branch_memory(b);
    sum += response.energy(u, &memory);
  }
  for (const auto& interaction : scheme.interactions()) sum += interaction->energy();
  return sum;
}

std::optional<double> Simulation::energy_drift() const {
  const std::optional<double> stored = stored_energy();
  if (!stored) return stored;
  return energies().elastic - *stored;
}

TetFields Simulation::tet_fields() const {
  const Scheme& scheme = *inside().scheme;
  std::vector<BranchMemory> memory;
  for (std::size_t b = 0; b < scheme.body().blocks.size(); ++b) memory.push_back(scheme.branch_memory(b));
  return glisson::tet_fields(scheme.body(), displacement(), velocity(), memory);
}

ContactFields Simulation::contact_fields() const {
  const Impl::Asking asking(inside());
  const auto interactions = inside().scheme->interactions();
  if (interactions.empty()) return {};
  return glisson::contact_fields(present_mesh(), positions(), interactions);
}

std::uint64_t Simulation::state_hash() const { return hash_numbers(velocity(), hash_numbers(displacement())); }

}  // namespace glisson

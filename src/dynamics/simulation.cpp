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

struct Simulation::Impl {
  TetMesh mesh;
  std::shared_ptr<Scheme> scheme;  ///< driven sets read it while it lives
  std::uint32_t kind;              ///< integrator, time scheme and precision
  std::uint64_t fingerprint;       ///< of mesh and tissues at the start
  std::vector<char> removed{};     ///< per tet; empty: none

  /// Block of a region. @throws std::invalid_argument where it has none
  std::size_t block_of(int region) const;
  BodyView view() const { return {mesh, removed, scheme->body().masses, scheme->displacement()}; }
  std::uint64_t told = 0;  ///< changes that interactions have been told of, or would have been

  void tell_change(std::span<const std::uint32_t> origins) {
    ++told;
    if (!scheme->interactions().empty()) scheme->tell_change(view(), origins);
  }
  SplitReport split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves);
  void add_copies(std::span<const std::uint32_t> origins);
  std::span<const std::uint32_t> follow_body();
  void archive(Archive& ar);
};

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

/// Takes over a body that was read. @return of which vertices the last ones are copies
std::span<const std::uint32_t> Simulation::Impl::follow_body() {
  const Body& body = scheme->body();
  const std::vector<std::uint32_t>& copies = scheme->state().copies;
  const std::size_t known = mesh.vertices.size() - (body.vertex_count - copies.size());
  const std::span<const std::uint32_t> origins = std::span(copies).subspan(known);
  add_copies(origins);
  mesh.vertices = body.rest_positions;
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    mesh.tets[body.mesh_tet[e]] = body.elements[e];
    if (body.rest[e].volume != 0.0) continue;
    removed.resize(mesh.tets.size(), 0);
    removed[body.mesh_tet[e]] = 1;
  }
  return origins;
}

void Simulation::Impl::archive(Archive& ar) {
  std::uint32_t its_kind = kind;
  std::uint64_t its_fingerprint = fingerprint;
  ar(its_kind, its_fingerprint);
  if (its_kind != kind) {
    throw std::runtime_error("checkpoint: it was written with another integrator, time scheme or precision");
  }
  if (its_fingerprint != fingerprint) {
    throw std::runtime_error("checkpoint: it was written with another mesh or other tissues");
  }
  std::uint64_t to_tell = told;
  ar(to_tell);
  scheme->archive_body(ar);
  if (ar.reads()) {
    const std::span<const std::uint32_t> origins = follow_body();
    if (to_tell != told) tell_change(origins);
    told = to_tell;
  }
  scheme->archive_motion(ar);
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
const Scheme& SimulationParts::scheme(const Simulation& simulation) { return *simulation.impl_->scheme; }
std::weak_ptr<const Scheme> SimulationParts::weak_scheme(Simulation& simulation) { return simulation.impl_->scheme; }
const TetMesh& SimulationParts::mesh(const Inside& inside) { return inside.mesh; }
SplitReport SimulationParts::split_faces(Inside& inside, std::span<const Triangle> faces,
                                         std::span<const VertexMove> moves) {
  return inside.split_faces(faces, moves);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

ConstraintId Simulation::fix(std::span<const std::uint32_t> vertices, Axes axes) { return drive(vertices, {}, axes); }
ConstraintId Simulation::fix(std::string_view set, Axes axes) { return drive(set, {}, axes); }

ConstraintId Simulation::drive(std::span<const std::uint32_t> vertices, Motion motion, Axes axes, double from) {
  return impl_->scheme->add_constraint({{vertices.begin(), vertices.end()}, axes, std::move(motion), from, {}});
}

ConstraintId Simulation::drive(std::string_view set, Motion motion, Axes axes, double from) {
  return drive(mesh().vertex_set(std::string(set)), std::move(motion), axes, from);
}

ConstraintId Simulation::drive_rigidly(std::span<const std::uint32_t> vertices, PoseMotion motion, Axes axes,
                                       double from) {
  if (!motion) throw std::invalid_argument("drive_rigidly: no motion was given; fix() holds vertices where they are");
  return impl_->scheme->add_constraint({{vertices.begin(), vertices.end()}, axes, {}, from, std::move(motion)});
}

ConstraintId Simulation::drive_rigidly(std::string_view set, PoseMotion motion, Axes axes, double from) {
  return drive_rigidly(mesh().vertex_set(std::string(set)), std::move(motion), axes, from);
}

void Simulation::add_load(std::string_view set, Vec3d force, TimeFunction<double> scale) {
  add_load(mesh().vertex_set(std::string(set)), force, std::move(scale));
}

void Simulation::add_load(std::span<const std::uint32_t> vertices, Vec3d force, TimeFunction<double> scale) {
  impl_->scheme->add_load(vertices, {.force = force}, std::move(scale));
}

void Simulation::add_surface_load(std::span<const std::uint32_t> vertices, const SurfaceLoad& load,
                                  TimeFunction<double> scale) {
  impl_->scheme->add_load(vertices, load, std::move(scale));
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
  if (interaction->acts_in_steps()) impl_->scheme->attach(interaction, impl_->view());
  interaction->between_steps(*this);
  interaction->is_attached_ = true;
}

RemovalReport Simulation::remove_tets(std::span<const std::uint32_t> tets) {
  RemovalReport report = Changer(*impl_->scheme).remove(tets);
  impl_->removed.resize(impl_->mesh.tets.size(), 0);
  for (const std::uint32_t t : tets) impl_->removed[t] = 1;
  impl_->tell_change({});
  return report;
}

SplitReport Simulation::Impl::split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  auto [report, changed] = Changer(*scheme).split(faces, moves);
  const Body& body = scheme->body();
  for (const VertexMove& m : moves) mesh.vertices[m.vertex] = m.rest;
  add_copies(report.origins);
  for (const std::uint32_t e : changed) mesh.tets[body.mesh_tet[e]] = body.elements[e];
  tell_change(report.origins);
  return report;
}

SplitReport Simulation::split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  return impl_->split_faces(faces, moves);
}

void Simulation::set_tissue(int region, const Tissue& tissue) { set_tissues({{region, tissue}}); }

void Simulation::set_tissues(const std::map<int, Tissue>& tissues) {
  BlockTissues others;
  for (const auto& [region, tissue] : tissues) {
    const std::size_t b = impl_->block_of(region);
    if (tissue == impl_->scheme->body().blocks[b].tissue) continue;
    others.emplace_back(b, tissue);
  }
  if (others.empty()) return;
  const bool masses = Changer(*impl_->scheme).set_tissues(others);
  if (masses) impl_->tell_change({});
}

const Tissue& Simulation::tissue(int region) const {
  return impl_->scheme->body().blocks[impl_->block_of(region)].tissue;
}

bool Simulation::is_removed(std::uint32_t tet) const {
  const std::size_t tets = impl_->mesh.tets.size();
  if (tet < tets) return impl_->scheme->state().is_removed(tet);
  throw std::invalid_argument("is_removed: tet " + std::to_string(tet) + " is outside the mesh, 0 to " +
                              std::to_string(tets - 1));
}

TetMesh Simulation::present_mesh() const {
  TetMesh present = impl_->mesh;
  present.tets.clear();
  present.regions.clear();
  present.fibres.clear();
  for (std::uint32_t t = 0; t < impl_->mesh.tets.size(); ++t) {
    if (is_removed(t)) continue;
    present.tets.push_back(impl_->mesh.tets[t]);
    if (!impl_->mesh.regions.empty()) present.regions.push_back(impl_->mesh.regions[t]);
    if (!impl_->mesh.fibres.empty()) present.fibres.push_back(Vec3d(impl_->mesh.fibres[t]));
  }
  return present;
}

StepResult Simulation::step() {
  const StepResult result = impl_->scheme->step();
  for (std::size_t i = 0; result.made() && i < impl_->scheme->interactions().size(); ++i) {
    impl_->scheme->interactions()[i]->between_steps(*this);
  }
  return result;
}

StepResult Simulation::advance_to(double time) {
  set_step_end(time);
  StepResult last;
  while (last.made() && this->time() + 0.5 * step_size() < time) last = step();
  return last;
}

double Simulation::time() const { return impl_->scheme->state().time; }
double Simulation::step_size() const { return impl_->scheme->step_size(); }
double Simulation::next_corner(double after) const { return impl_->scheme->next_corner(after); }
void Simulation::set_step_end(double time) { impl_->scheme->set_step_end(time); }
double Simulation::stable_step() const { return impl_->scheme->stable_step(); }
std::uint64_t Simulation::steps() const { return impl_->scheme->state().steps; }
const TetMesh& Simulation::mesh() const { return impl_->mesh; }
std::span<const double> Simulation::masses() const { return impl_->scheme->body().masses; }
std::span<const Vec3d> Simulation::displacement() const { return impl_->scheme->displacement(); }
std::span<const Vec3d> Simulation::velocity() const { return impl_->scheme->velocity(); }

std::vector<Vec3d> Simulation::positions() const {
  std::vector<Vec3d> x = impl_->mesh.vertices;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += displacement()[i];
  return x;
}

void Simulation::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  impl_->scheme->set_state(displacement, velocity);
}

ForceParts Simulation::force(ConstraintId constraint) const { return impl_->scheme->force(constraint); }

Vec3d Simulation::torque(ConstraintId constraint, const Vec3d& about) const {
  return impl_->scheme->torque(constraint, about);
}

const MassScaling& Simulation::mass_scaling() const { return impl_->scheme->state().mass_scaling; }

std::vector<LimitingTet> Simulation::limiting_tets(std::size_t most) const {
  const bool counts = impl_->scheme->capabilities().viscosity_limits_step;
  return glisson::limiting_tets(impl_->scheme->body(), most, counts ? 1.0 : 0.0);
}

double Simulation::force_time() const { return impl_->scheme->force_time(); }

double Simulation::linear_share() const { return impl_->scheme->linear_share(); }

const EngineInfo& Simulation::engine_info() const { return impl_->scheme->info(); }

Energies Simulation::energies() const {
  Energies energies = impl_->scheme->energies();
  if (!impl_->scheme->state().options.track_energies) return energies;
  for (const auto& x : impl_->scheme->interactions()) {
    energies.elastic -= x->released_energy();
    energies.fracture += x->released_energy();
  }
  return energies;
}

std::optional<double> Simulation::stored_energy() const {
  const Scheme& scheme = *impl_->scheme;
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
  const Scheme& scheme = *impl_->scheme;
  std::vector<BranchMemory> memory;
  for (std::size_t b = 0; b < scheme.body().blocks.size(); ++b) memory.push_back(scheme.branch_memory(b));
  return glisson::tet_fields(scheme.body(), displacement(), velocity(), memory);
}

ContactFields Simulation::contact_fields() const {
  const auto interactions = impl_->scheme->interactions();
  if (interactions.empty()) return {};
  return glisson::contact_fields(present_mesh(), positions(), interactions);
}

void Simulation::save(std::ostream& out) const {
  Archive contents;
  impl_->archive(contents);
  write_checkpoint(contents, out);
}

void Simulation::load(std::istream& in) {
  Archive contents = read_checkpoint(in);
  impl_->archive(contents);
  contents.check(contents.left() == 0);
}

std::uint64_t Simulation::state_hash() const { return hash_numbers(velocity(), hash_numbers(displacement())); }

}  // namespace glisson

// simulation_state.cpp — going back and forth in time: states in memory, and checkpoints.
//
//   save_state   version of the body ── shared, filled when it is about to change          load_state   another version? lay it out
//                interactions ───────── a copy of each                                                  interactions, then motion
//                motion ─────────────── bytes of the scheme's archive
#include <algorithm>
#include <stdexcept>

#include "dynamics/simulation_impl.h"
#include "dynamics/simulation_parts.h"
#include "dynamics/state/checkpoint.h"

namespace glisson {

double State::time() const { return contents_ != nullptr ? contents_->time : 0.0; }

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

/// For the states that are of this version.
void Simulation::Impl::keep_version() {
  if (version->is_filled || version.use_count() == 1) return;
  version->mesh = mesh, version->removed = removed, version->told = told;
  version->body = scheme->state().version();
  version->layout = scheme->save_layout();
  version->is_filled = true;
}

State Simulation::Impl::save() {
  auto contents = std::make_shared<State::Contents>();
  contents->scheme = scheme;
  contents->version = version;
  contents->time = scheme->state().time;
  contents->constraints = scheme->state().constraints.all().size();
  contents->loads = scheme->load_count();
  for (const auto& interaction : scheme->interactions()) contents->interactions.push_back(interaction->save_state());
  Archive motion;
  motion.set_in_memory();
  scheme->archive_clock(motion);
  scheme->archive_motion(motion);
  contents->motion = motion.take_bytes();
  contents->factor = scheme->save_factor();
  State state;
  state.contents_ = std::move(contents);
  return state;
}

/// Where reset() goes. A body that is made for changes is copied now, so that its first cut does not have to wait for that.
void Simulation::Impl::begin_run() {
  start = save();
  if (scheme->state().options.mesh_changes) keep_version();
}

std::string Simulation::Impl::refuses(const State& state) const {
  if (!state) return "this state is of no simulation; take one that save_state() returned";
  const State::Contents& saved = *state.contents_;
  if (saved.scheme.lock() != scheme) {
    return "this state is of another simulation; write that one by save(), and read it here by load()";
  }
  const auto added = [&](const std::string& what) {
    return what + " has been added since this state was saved, at " + std::to_string(saved.time) +
           " s; save a state after all is added, or build a new simulation";
  };
  const auto& constraints = scheme->state().constraints.all();
  if (constraints.size() != saved.constraints) {
    const Constraint& c = constraints[saved.constraints];
    return added(std::string(c.moves() ? "a motion" : "a support") + " of " + std::to_string(c.vertices.size()) +
                 " vertices (no. " + std::to_string(saved.constraints + 1) + ")");
  }
  if (scheme->load_count() != saved.loads) return added("load no. " + std::to_string(saved.loads + 1));
  const auto interactions = scheme->interactions();
  if (interactions.size() != saved.interactions.size()) {
    return added(interactions[saved.interactions.size()]->label());
  }
  return {};
}

void Simulation::Impl::load(const State::Contents& saved) {
  const bool is_other_body = saved.version != version;
  if (is_other_body) {
    keep_version();
    version = saved.version;
    mesh = version->mesh, removed = version->removed, told = version->told;
    scheme->load_version(*version->body, version->layout);
  }
  Archive motion(saved.motion);
  motion.set_in_memory();
  scheme->archive_clock(motion);
  const auto interactions = scheme->interactions();
  if (is_other_body) {
    const BodyView body = view();
    for (std::size_t i = 0; i < interactions.size(); ++i) interactions[i]->load_state(saved.interactions[i], &body);
  } else {
    for (std::size_t i = 0; i < interactions.size(); ++i) interactions[i]->load_state(saved.interactions[i], nullptr);
  }
  scheme->archive_motion(motion);
  scheme->load_factor(saved.factor);
}

State Simulation::save_state() const {
  inside().refuse_while_busy("save_state");
  const Impl::Asking asking(inside());
  return inside().save();
}

void Simulation::load_state(const State& state) {
  const Impl::Guard guard(inside(), "load_state");
  const std::string why = inside().refuses(state);
  if (!why.empty()) throw std::invalid_argument("load_state: " + why);
  inside().load(*state.contents_);
}

void Simulation::reset() {
  inside().refuse_while_busy("reset");
  if (inside().start) load_state(State(inside().start));
}

void Simulation::save(std::ostream& out) const {
  inside().refuse_while_busy("save");
  const Impl::Asking asking(inside());
  Archive contents;
  inside().archive(contents);
  write_checkpoint(contents, out);
}

/// What is read has changed from the start on; so has this body, but otherwise: it goes back to the start first.
void Simulation::load(std::istream& in) {
  const Impl::Guard guard(inside(), "load");
  Impl& me = inside();
  const Archive read = read_checkpoint(in);
  const State before = me.save();
  me.keep_version();
  try {
    if (me.start && me.start.contents_->version != me.version && me.refuses(me.start).empty()) {
      me.load(*me.start.contents_);
    }
    Archive contents = read;
    const std::uint64_t changes = me.scheme->state().changes;
    me.archive(contents);
    contents.check(contents.left() == 0);
    if (me.scheme->state().changes != changes) me.begin_version();
  } catch (...) {
    me.version = std::make_shared<SavedVersion>();  // whatever it is now, it is none that is known
    me.load(*before.contents_);
    throw;
  }
}

}  // namespace glisson

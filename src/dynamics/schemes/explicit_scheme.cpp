#include "dynamics/schemes/explicit_scheme.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "dynamics/state/make_body.h"
#include "dynamics/step/step_rules.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

/// @throws std::invalid_argument where the tissue's viscous force cannot be taken in stages
void require_stages_for(const Tissue& tissue, int stages) {
  if (stages == 1 || is_small(tissue) || !(tissue.viscosity > 0.0)) return;
  throw std::invalid_argument(
      "tissue \"" + tissue.name + "\": drag_stages = " + std::to_string(stages) +
      ", but stages of the viscous force are for tissue of small strain, without `hyperelastic` and with "
      "kinematics = \"small\"; take drag_stages = 1, or model relaxation by maxwell branches");
}

}  // namespace

ExplicitScheme::ExplicitScheme(Body body, const SimulationOptions& options, Drag drag)
    : Scheme(std::move(body), options), moving_(make_moving_body(state_.body, state_.gamma, options, info_)),
      stiffening_(moving_->advance(0.0, {}, false).stiffening), drag_(make_viscous_drag(state_)),
      pace_(make_pace({state_, drag, ledger_}, stiffening_)) {
  for (const TissueBlock& block : state_.body.blocks) require_stages_for(block.tissue, options.drag_stages);
  moving_->list_above(pace_->list_above(), pace_->single_limits());
  if (!options.mesh_changes) return;
  moving_->apply({}, state_.changer().stars(), state_.gamma);
  pace_->prepare_changes(state_.changer().stars());
}

const ExplicitScheme::StateCopy& ExplicitScheme::read_state() const {
  if (!copy_is_current_.load(std::memory_order_acquire)) {
    const std::lock_guard lock(filling_);
    if (copy_is_current_.load(std::memory_order_relaxed)) return copy_;
    copy_.displacement.resize(state_.body.vertex_count);
    copy_.velocity.resize(state_.body.vertex_count);
    moving_->read_state(copy_.displacement, copy_.velocity);
    copy_is_current_.store(true, std::memory_order_release);
  }
  return copy_;
}

void ExplicitScheme::acts_on(std::span<const std::uint32_t> vertices) {
  held_.insert(held_.end(), vertices.begin(), vertices.end());
  std::sort(held_.begin(), held_.end());
  held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
  watch(vertices);
}

void ExplicitScheme::watch(std::span<const std::uint32_t> vertices) {
  const std::vector<std::uint32_t> before = active_vertices();
  moving_->watch(vertices, held_);
  active_changed(before);
}

void ExplicitScheme::active_changed(std::span<const std::uint32_t> before) {
  kick_.follow(before, moving_->active());
  drag_->follow(before, moving_->active());
  interactions_.find_places(moving_->active(), state_.body.vertex_count);
}

/// Returns the vertices to the body that nothing acts on any more.
void ExplicitScheme::let_go() {
  const std::vector<std::uint32_t> before = active_vertices(), named = interactions_.named();
  std::vector<std::uint32_t> kept;
  std::set_union(held_.begin(), held_.end(), named.begin(), named.end(), std::back_inserter(kept));
  if (kept.size() == before.size()) return;
  moving_->watch_only(kept);
  active_changed(before);
}

/// Takes vertices that interactions hold still, and nothing else acts on, from those active.
void ExplicitScheme::bring_to_rest() {
  std::vector<std::uint32_t> resting = interactions_.resting();
  std::erase_if(resting, [&](std::uint32_t v) { return std::binary_search(held_.begin(), held_.end(), v); });
  if (!std::ranges::equal(resting, moving_->resting(), {}, {}, &RestingVertex::vertex)) moving_->rest(resting);
}

std::vector<std::uint32_t> ExplicitScheme::active_vertices() const {
  std::vector<std::uint32_t> vertices;
  for (const ActiveVertex& w : moving_->active()) vertices.push_back(w.vertex);
  return vertices;
}

void ExplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  moving_->set_state(displacement, velocity);
  interactions_.state_set(displacement);
  drag_->state_set();
  pace_->state_set(added(), *moving_);
  moving_->list_above(pace_->list_above(), pace_->single_limits());
  take_stiffness(moving_->advance(0.0, {}, false));
  copy_is_current_ = false;
  if (!state_.options.track_energies) return;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < velocity.size(); ++i)
    kinetic += 0.5 * state_.body.masses[i] * dot(velocity[i], velocity[i]);
  double elastic = secant_energy(state_.body, displacement);
  for (const auto& x : interactions_.all()) elastic += x->energy() + x->released_energy() - x->changed_energy();
  ledger_.reset(kinetic, elastic);
}

/// Brings the vertices that interactions may act on in this step to hand, before the body moves the others.
void ExplicitScheme::begin_interactions(double h) {
  if (interactions_.empty()) return;
  const std::span<const std::uint32_t> newcomers = interactions_.newcomers(state_.time, h, state_.body.vertex_count);
  if (interactions_.rest_changed() || !newcomers.empty() || interactions_.has_left()) bring_to_rest();
  if (!newcomers.empty()) watch(newcomers);
  if (interactions_.has_left()) let_go();
}

void ExplicitScheme::constrain_interactions() {
  if (interactions_.empty()) return;
  interactions_.constrain(kick_.mobility());
  kick_.push(interactions_.impulses());
}

void ExplicitScheme::attach(std::shared_ptr<Interaction> interaction, const BodyView& body) {
  if (const int most = interaction->most_drag_stages(); state_.options.drag_stages > most) {
    throw std::invalid_argument("attach: " + interaction->label() +
                                " acts on a body with drag_stages = " + std::to_string(state_.options.drag_stages) +
                                ", which is outside the allowed range with it, 1 to " + std::to_string(most) +
                                ": tissue would be too soft under it, since the stages do not have all of its forces; "
                                "take fewer stages, or integrator = implicit");
  }
  interaction->attached(body, state_.time);
  if (state_.options.track_energies) ledger_.bring_in(0.0, interaction->energy());
  interactions_.add(std::move(interaction));
  interactions_.find_places(moving_->active(), state_.body.vertex_count);
  pace_->set_added(added());
}

/// Interactions, springs, surfaces that loads follow.
AddedBeside ExplicitScheme::added() {
  const double loads = state_.loads.squared_frequency(state_.body);
  if (!pace_->gives_mass()) {
    return {.squared_frequency = added_frequency() + loads, .with_mass = 0.0, .to_bear = {}};
  }
  to_bear_.clear();
  const Interactions::Frequency seen = interactions_.find_frequency(to_bear_);
  return {.squared_frequency = seen.of_others + loads, .with_mass = seen.of_bounded, .to_bear = to_bear_};
}

void ExplicitScheme::loads_changed(bool may_refuse) {
  if (state_.loads.follows()) static_cast<void>(state_.loads_at(state_.time, displacement()));
  pace_->set_added(added());
  if (!may_refuse || pace_->bears()) return;
  throw std::invalid_argument("load: with it, " + pace_->too_large());
}

void ExplicitScheme::tell_change(const BodyView& body, std::span<const std::uint32_t> origins) {
  if (interactions_.empty()) return;
  interactions_.find_places(moving_->active(), state_.body.vertex_count);
  interactions_.body_changed(body, origins);
  pace_->set_added(added());
}

void ExplicitScheme::interactions_changed() {
  pace_->set_added(added());
  if (!pace_->bears()) throw std::invalid_argument("with it, " + pace_->too_large());
}

void ExplicitScheme::book(double h, const Advance& seen) {
  KickWork work = kick_.work(moving_->active());
  add(work.before, seen.work.before);
  add(work.after, seen.work.after);
  add_interface(work);
  ledger_.book(h, work.before, work.after, work.kinetic + seen.work.kinetic, only_relaxes(state_.body));
  if (!interactions().empty()) ledger_.store_in_instruments(tool_energy());
  if (seen.brought_in != 0.0) ledger_.bring_in(0.0, seen.brought_in);
}

void ExplicitScheme::add_interface(KickWork& work) const {
  if (!interactions_.empty()) kick_.add_interface(moving_->active(), interactions_.book(), work);
}

void ExplicitScheme::tell_moved() {
  if (!interactions_.empty()) interactions_.moved();
}

void ExplicitScheme::take_stiffness(const Advance& seen) {
  stiffening_ = seen.stiffening;
  stiff_ = seen.stiff;
}

bool ExplicitScheme::kick(double) {
  kick_.kick(moving_->active());
  kick_.impose_motions(moving_->active());
  return true;
}

StepResult ExplicitScheme::step() {
  if (!pace_->accept({stiffening_, stiff_, kick_, *moving_})) {
    message_ = "tissue or tools have stiffened, and " + pace_->too_large();
    return {StepStatus::step_too_large, {}, message_};
  }
  moving_->list_above(pace_->list_above(), pace_->single_limits());
  const double h = choose_step(pace_->step());
  if (!(state_.time + h > state_.time)) {
    return {StepStatus::step_too_large,
            {},
            "the tissue has become so stiff that a stable step does not advance time; press "
            "less deep, soften the law, or take the implicit integrator"};
  }
  take_hold(h);
  prepare_to_give_up();
  begin_interactions(h);
  drag_->begin(*moving_);
  const Advance& seen = moving_->advance(h, state_.gravity_at(state_.time), state_.options.track_energies);
  take_stiffness(seen);
  copy_is_current_ = false;
  if (!seen.finite) {
    message_ = not_finite_at(state_.time);
    return {StepStatus::not_finite, seen.inverted, message_};
  }

  kick_.begin(h);
  for (RestingVertex& r : moving_->resting()) r.force += kick_.gravity() * state_.body.masses[r.vertex];
  interactions_.begin(state_.time, h, moving_->active(), moving_->resting(), state_.body.rest_positions,
                      state_.options.track_energies);
  drag_->tissue_pushed(moving_->active());
  interactions_.add_forces();
  if (!kick(h)) {
    message_ = why_given_up(h);
    return {StepStatus::not_converged, {}, message_};
  }
  constrain_interactions();
  drag_->end(moving_->active(), kick_, interactions_);
  if (state_.options.track_energies) book(h, seen);
  for (ActiveVertex& w : moving_->active()) w.displacement += w.velocity * h;
  moving_->place_active();
  copy_is_current_ = false;  // of what a callback asked for within the step
  state_.time += h;
  ++state_.steps;
  tell_moved();
  pace_->step_made(h);
  if (!interactions().empty() || state_.loads.depends_on_state()) pace_->follow_added(added());
  const StepStatus status = seen.inverted.empty() ? StepStatus::ok : StepStatus::inverted;
  return {status, seen.inverted, {}, interactions_.is_met()};
}

ForceParts ExplicitScheme::force(ConstraintId constraint) const {
  static_cast<void>(state_.constraints.at(constraint));
  return kick_.force(moving_->active(), constraint.index);
}

Vec3d ExplicitScheme::torque(ConstraintId constraint, const Vec3d& about) const {
  static_cast<void>(state_.constraints.at(constraint));
  return kick_.torque(moving_->active(), constraint.index, about);
}

void ExplicitScheme::take_body(Archive& ar) {
  bool bounded = pace_->follows_changes();
  ar(bounded);
  if (!ar.reads() || moving_->supports_tissues()) {
    moving_->archive_layout(ar, state_.gamma);
  } else {
    std::unique_ptr<MovingBody> fresh = make_moving_body(state_.body, state_.gamma, state_.options, info_);
    fresh->archive_layout(ar, state_.gamma);
    fresh->watch(active_vertices(), held_);
    moving_ = std::move(fresh);
  }
  if (!ar.reads()) return;
  info_ = info_of(*moving_, state_.body);
  copy_is_current_ = false;
  pace_->body_read(bounded ? &state_.changer().stars() : nullptr);
}

namespace {

struct SavedExplicitLayout {
  bool follows_changes;  ///< the control of the step
  std::shared_ptr<const void> moving;
};

}  // namespace

std::shared_ptr<const void> ExplicitScheme::save_layout() {
  return std::make_shared<const SavedExplicitLayout>(
      SavedExplicitLayout{pace_->follows_changes(), moving_->save_layout()});
}

void ExplicitScheme::load_layout(const std::shared_ptr<const void>& layout) {
  const auto& saved = *std::static_pointer_cast<const SavedExplicitLayout>(layout);
  if (!moving_->supports_tissues()) moving_ = make_moving_body(state_.body, state_.gamma, state_.options, info_);
  moving_->load_layout(saved.moving, state_.gamma);
  info_ = info_of(*moving_, state_.body);
  pace_->body_read(saved.follows_changes ? &state_.changer().stars() : nullptr);
  active_changed({});
}

/// As in a body that was just made: the vertices that are read act, and no others.
void ExplicitScheme::act_on_only(std::span<const std::uint32_t> vertices) {
  moving_->rest({});
  moving_->watch_only({});
  active_changed({});
  watch(vertices);
}

void ExplicitScheme::archive_motion(Archive& ar) {
  if (ar.reads()) drag_->body_changed();
  std::vector<std::uint32_t> active = active_vertices();
  ar.all_below(active, state_.body.vertex_count);
  ar.all_below(held_, state_.body.vertex_count);
  ar.check(std::is_sorted(held_.begin(), held_.end()));
  if (ar.reads()) act_on_only(active);
  ar.check(moving_->active().size() == active.size());
  moving_->archive_state(ar, state_.body.vertex_count);
  if (ar.reads()) copy_is_current_ = false;
  for (ActiveVertex& w : moving_->active()) ar(w.elastic, w.viscous);
  ar.same_size(stiffening_);
  ar(kick_, stiff_, ledger_);
  for (const StiffElement& s : stiff_) ar.check(s.element < state_.body.elements.size());
  pace_->archive(ar, *moving_);
  ar(interactions_);
  drag_->archive(ar, active.size());
  if (!ar.reads()) return;
  bring_to_rest();
  const std::vector<std::uint32_t> named = interactions_.named();
  ar.check(std::includes(active.begin(), active.end(), held_.begin(), held_.end()));
  ar.check(std::includes(active.begin(), active.end(), named.begin(), named.end()));
  moving_->list_above(pace_->list_above(), pace_->single_limits());
  pace_->added_read(added());
}

void ExplicitScheme::take_over(const BodyChange& change) {
  drag_->body_changed();
  moving_->apply(change, state_.changer().stars(), state_.gamma);
  pace_->mesh_changed(change, state_.changer().stars());
  copy_is_current_ = false;
}

/// The same state in a body of another kind, for tissues that the present kind does not have.
void ExplicitScheme::build_anew(const TissueChange& change) {
  std::vector<std::pair<std::size_t, std::vector<Sym3<double>>>> kept;
  for (std::size_t b = 0; b < state_.body.blocks.size(); ++b) {
    const bool changes = std::find(change.blocks.begin(), change.blocks.end(), b) != change.blocks.end();
    if (!changes && !state_.body.blocks[b].tissue.maxwell.empty()) kept.emplace_back(b, moving_->branch_stresses(b));
  }
  const StateCopy state = read_state();
  const std::vector<std::uint32_t> active = active_vertices();
  moving_ = make_moving_body(state_.body, state_.gamma, state_.options, info_);
  moving_->set_state(state.displacement, state.velocity);
  moving_->watch(active, held_);
  bring_to_rest();
  for (const auto& [b, stresses] : kept) moving_->set_branch_stresses(b, stresses);
}

/// Brings other tissues into the body; what is told of the last kick stays.
void ExplicitScheme::follow_tissues(const TissueChange& change) {
  drag_->body_changed();
  const std::vector<ActiveVertex> told(moving_->active().begin(), moving_->active().end());
  if (moving_->supports_tissues()) {
    moving_->tissues_changed(change.blocks, state_.gamma);
    info_ = info_of(*moving_, state_.body);
  } else {
    build_anew(change);
  }
  for (std::size_t i = 0; i < change.blocks.size(); ++i) {
    moving_->set_branch_stresses(change.blocks[i], change.branch_stresses[i]);
  }
  if (!change.past.empty()) {
    Archive past(change.past);
    moving_->archive_past(past);
  }
  moving_->list_above(pace_->list_above(), pace_->single_limits());
  take_stiffness(moving_->advance(0.0, {}, false));
  std::copy(told.begin(), told.end(), moving_->active().begin());
  copy_is_current_ = false;
}

std::string ExplicitScheme::past() {
  Archive past;
  moving_->archive_past(past);
  return past.bytes();
}

void ExplicitScheme::require_tissues(const BlockTissues& tissues) const {
  Scheme::require_tissues(tissues);
  for (const auto& [block, tissue] : tissues) require_stages_for(tissue, state_.options.drag_stages);
}

void ExplicitScheme::take_tissues(const TissueChange& change) {
  follow_tissues(change);
  const std::span<const Vec3d> u = displacement();
  const bool undeformed = std::all_of(u.begin(), u.end(), [](const Vec3d& d) { return d == Vec3d{}; });
  pace_->tissues_changed(stiffening_, undeformed);
  stiff_.clear();  // the level of the blocks is above all of them now
  moving_->list_above(pace_->list_above(), pace_->single_limits());
}

void ExplicitScheme::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  drag_->body_changed();
  std::vector<std::uint32_t> followers;
  const std::size_t held = held_.size();
  for (std::uint32_t i = 0; i < origins.size(); ++i) {
    const auto is_origin = [&](const ActiveVertex& w) { return w.vertex == origins[i]; };
    const std::span<const ActiveVertex> active = moving_->active();
    if (std::any_of(active.begin(), active.end(), is_origin)) followers.push_back(first_new + i);
    if (std::binary_search(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(held), origins[i])) {
      held_.push_back(first_new + i);
    }
  }
  interactions_.follow(origins, first_new);
  if (!followers.empty()) watch(followers);
}

}  // namespace glisson

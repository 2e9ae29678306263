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
      stiffening_(moving_->advance(0.0, {}, false).stiffening), masses_(state_),
      control_(std::make_unique<StepControl>(state_.body, state_.gamma, drag, options, stiffening_)) {
  for (const TissueBlock& block : state_.body.blocks) require_stages_for(block.tissue, options.drag_stages);
  moving_->list_above(control_->list_above(), control_->single_limits());
  if (!options.mesh_changes) return;
  moving_->apply({}, state_.changer().stars(), state_.gamma);
  control_->prepare_changes(state_.changer().stars());
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

/// Tells the body what supports and motions hold by now, for stages of drag.
void ExplicitScheme::hold_in_stages() {
  if (state_.options.drag_stages == 1) return;
  std::vector<char> holding;
  for (std::size_t c = 0; c < state_.base.size(); ++c) holding.push_back(state_.holds(c) ? 1 : 0);
  if (told_ == holding) return;
  held_components_ = state_.held_components();
  moving_->hold_in_stages(held_components_);
  told_ = std::move(holding);
}

/// Tells the body what interactions held in the last step and forces from outside then, for stages of drag.
void ExplicitScheme::hold_rows_in_stages() {
  if (state_.options.drag_stages == 1) return;
  moving_->push_in_stages(kick_.outer());
  if (held_rows_.empty()) return moving_->project_stages(nullptr);
  inverse_mass_.clear();
  for (const ActiveVertex& w : moving_->active()) {
    const double m = state_.body.inertia(w.vertex);
    Vec3d& inverse = inverse_mass_.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inverse[axis] = m > 0.0 && held_components_[3 * w.vertex + axis] == 0 ? 1.0 / m : 0.0;
    }
  }
  stage_holds_.set(held_rows_, moving_->active(), inverse_mass_);
  moving_->project_stages(stage_holds_.empty() ? nullptr : &stage_holds_);
}

std::vector<std::uint32_t> ExplicitScheme::active_vertices() const {
  std::vector<std::uint32_t> vertices;
  for (const ActiveVertex& w : moving_->active()) vertices.push_back(w.vertex);
  return vertices;
}

void ExplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  moving_->set_state(displacement, velocity);
  interactions_.state_set(displacement);
  kick_.forget_outer();
  held_rows_.clear();
  control_->state_set(added());
  masses_.state_set();
  take_stiff_masses();
  moving_->list_above(control_->list_above(), control_->single_limits());
  take_stiffness(moving_->advance(0.0, {}, false));
  copy_is_current_ = false;
  if (!state_.options.track_energies) return;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < velocity.size(); ++i)
    kinetic += 0.5 * state_.body.masses[i] * dot(velocity[i], velocity[i]);
  double elastic = secant_energy(state_.body, displacement);
  for (const auto& x : interactions_.all()) elastic += x->energy() + x->released_energy();
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
  control_->set_added(added());
}

/// Interactions, springs, surfaces that loads follow.
AddedBeside ExplicitScheme::added() {
  const double loads = state_.loads.squared_frequency(state_.body);
  if (state_.options.mass_scaling != MassScalingKind::variable) {
    return {.squared_frequency = added_frequency() + loads, .with_mass = 0.0, .to_bear = {}};
  }
  to_bear_.clear();
  const Interactions::Frequency seen = interactions_.find_frequency(to_bear_);
  return {.squared_frequency = seen.of_others + loads, .with_mass = seen.of_bounded, .to_bear = to_bear_};
}

void ExplicitScheme::loads_changed(bool may_refuse) {
  if (state_.loads.follows()) static_cast<void>(state_.loads_at(state_.time, displacement()));
  control_->set_added(added());
  const bool given = state_.options.step.has_value() && state_.options.enforce_stability;
  if (!may_refuse || !given || control_->step() <= control_->stable_step()) return;
  throw std::invalid_argument("load: with it, " + control_->too_large());
}

void ExplicitScheme::tell_change(const BodyView& body, std::span<const std::uint32_t> origins) {
  if (interactions_.empty()) return;
  interactions_.find_places(moving_->active(), state_.body.vertex_count);
  interactions_.body_changed(body, origins);
  control_->set_added(added());
}

void ExplicitScheme::book(double h, const KickWork& free) {
  KickWork work = kick_.work(moving_->active());
  add(work.before, free.before);
  add(work.after, free.after);
  add_interface(work);
  ledger_.book(h, work.before, work.after, work.kinetic + free.kinetic, only_relaxes(state_.body));
  if (!interactions().empty()) ledger_.store_in_instruments(tool_energy());
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

/// Gives vertices the mass that their tets lack at the step of variable mass scaling.
void ExplicitScheme::take_stiff_masses() {
  const std::optional<std::span<const VertexMass>> wanted = control_->new_masses();
  if (!wanted) return;
  const double kinetic = masses_.take(*wanted, *moving_);
  if (state_.options.track_energies) ledger_.bring_in(kinetic, 0.0);
}

/// How fast tets change shape whose changes count.
std::span<const ShapeRate> ExplicitScheme::shape_rates() {
  shape_rates_.clear();
  if (!control_->may_be_violent()) return shape_rates_;
  for (const StiffElement& stiff : stiff_) {
    if (!control_->is_violent(stiff)) continue;
    const Tet& t = state_.body.elements[stiff.element];
    const Vec3d origin = moving_->velocity_of(t[0]);
    std::array<Vec3d, 3> difference;
    for (std::size_t a = 0; a < 3; ++a) difference[a] = moving_->velocity_of(t[a + 1]) - origin;
    const double squared = squared_norm(displacement_gradient(state_.body.rest[stiff.element].s, difference));
    shape_rates_.push_back({stiff, std::sqrt(squared)});
  }
  return shape_rates_;
}

bool ExplicitScheme::kick(double) {
  kick_.kick(moving_->active());
  kick_.impose_motions(moving_->active());
  return true;
}

StepResult ExplicitScheme::step() {
  if (state_.options.mass_scaling == MassScalingKind::variable) {
    control_->take_inertia(masses_.weigh(kick_.outer_action(moving_->active()), *moving_));
  }
  if (!control_->accept(stiffening_, stiff_)) {
    message_ = "tissue or tools have stiffened, and " + control_->too_large();
    return {StepStatus::step_too_large, {}, message_};
  }
  take_stiff_masses();
  control_->limit_shape_change(shape_rates());
  moving_->list_above(control_->list_above(), control_->single_limits());
  const double h = choose_step(control_->step());
  if (!(state_.time + h > state_.time)) {
    return {StepStatus::step_too_large,
            {},
            "the tissue has become so stiff that a stable step does not advance time; press "
            "less deep, soften the law, or take the implicit integrator"};
  }
  take_hold(h);
  prepare_to_give_up();
  hold_in_stages();
  begin_interactions(h);
  hold_rows_in_stages();
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
  if (state_.options.drag_stages > 1) kick_.remember_tissue(moving_->active());
  interactions_.add_forces();
  if (!kick(h)) {
    message_ = why_given_up(h);
    return {StepStatus::not_converged, {}, message_};
  }
  constrain_interactions();
  if (state_.options.drag_stages > 1) kick_.remember_outer(moving_->active()), interactions_.tell_held(held_rows_);
  if (state_.options.track_energies) book(h, seen.work);
  if (state_.options.track_energies && seen.brought_in != 0.0) ledger_.bring_in(0.0, seen.brought_in);
  for (ActiveVertex& w : moving_->active()) w.displacement += w.velocity * h;
  moving_->place_active();
  copy_is_current_ = false;  // of what a callback asked for within the step
  state_.time += h;
  ++state_.steps;
  masses_.step_made(h);
  tell_moved();
  if (!interactions().empty() || state_.loads.depends_on_state()) control_->follow_added(added());
  return {seen.inverted.empty() ? StepStatus::ok : StepStatus::inverted, seen.inverted, {}};
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
  bool bounded = control_->follows_changes();
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
  control_->body_read(bounded ? &state_.changer().stars() : nullptr);
}

namespace {

struct SavedExplicitLayout {
  bool follows_changes;  ///< the control of the step
  std::shared_ptr<const void> moving;
};

}  // namespace

std::shared_ptr<const void> ExplicitScheme::save_layout() {
  return std::make_shared<const SavedExplicitLayout>(
      SavedExplicitLayout{control_->follows_changes(), moving_->save_layout()});
}

void ExplicitScheme::load_layout(const std::shared_ptr<const void>& layout) {
  const auto& saved = *std::static_pointer_cast<const SavedExplicitLayout>(layout);
  if (!moving_->supports_tissues()) moving_ = make_moving_body(state_.body, state_.gamma, state_.options, info_);
  moving_->load_layout(saved.moving, state_.gamma);
  info_ = info_of(*moving_, state_.body);
  control_->body_read(saved.follows_changes ? &state_.changer().stars() : nullptr);
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
  told_.reset();
  std::vector<std::uint32_t> active = active_vertices();
  ar.all_below(active, state_.body.vertex_count);
  ar.all_below(held_, state_.body.vertex_count);
  ar.check(std::is_sorted(held_.begin(), held_.end()));
  if (ar.reads()) act_on_only(active);
  ar.check(moving_->active().size() == active.size());
  moving_->archive_state(ar, state_.body.vertex_count);
  copy_is_current_ = false;
  for (ActiveVertex& w : moving_->active()) ar(w.elastic, w.viscous);
  masses_.archive(ar, *moving_);
  ar.same_size(stiffening_);
  ar(kick_, stiff_, ledger_);
  for (const StiffElement& s : stiff_) ar.check(s.element < state_.body.elements.size());
  ar(*control_, interactions_);
  if (state_.options.drag_stages > 1) ar(held_rows_);
  if (!ar.reads()) return;
  bring_to_rest();
  const std::vector<std::uint32_t> named = interactions_.named();
  ar.check(std::includes(active.begin(), active.end(), held_.begin(), held_.end()));
  ar.check(std::includes(active.begin(), active.end(), named.begin(), named.end()));
  moving_->list_above(control_->list_above(), control_->single_limits());
  control_->added_read(added());
}

void ExplicitScheme::take_over(const BodyChange& change) {
  told_.reset();
  moving_->apply(change, state_.changer().stars(), state_.gamma);
  control_->mesh_changed(change, state_.changer().stars());
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
  told_.reset();
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
  moving_->list_above(control_->list_above(), control_->single_limits());
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
  control_->tissues_changed(stiffening_, undeformed);
  stiff_.clear();  // the level of the blocks is above all of them now
  moving_->list_above(control_->list_above(), control_->single_limits());
}

void ExplicitScheme::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  told_.reset();
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

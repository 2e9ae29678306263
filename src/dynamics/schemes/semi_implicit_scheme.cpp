#include "dynamics/schemes/semi_implicit_scheme.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

namespace glisson {
namespace {

constexpr double kMargin = 0.85,
                 kLeeway = 1.5;  ///< a step that the factor is made for, and how much longer ones it serves for
constexpr int kMostContactSweeps = 30000;  ///< of contact in a step
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr int kMostShortenings = 8;    ///< of an automatic step in which it is not found, each by half …
constexpr double kStepRegrowth = 1.1;  ///< … and how fast steps grow again

}  // namespace

SemiImplicitScheme::SemiImplicitScheme(Body body, const SimulationOptions& options)
    : ExplicitScheme(std::move(body), options, Drag::at_once), viscous_(ViscousSystem::needed(state_.body)) {
  contact_.set_last(kMostContactSweeps);
  watch_all_if_viscous();
}

void SemiImplicitScheme::watch_all_if_viscous() {
  if (!viscous_) return;
  std::vector<std::uint32_t> all(state_.body.vertex_count);
  std::iota(all.begin(), all.end(), 0U);
  watch(all);
}

void SemiImplicitScheme::attach(std::shared_ptr<Interaction> interaction, const BodyView& body) {
  if (!viscous_ || !interaction->constrains_long_steps()) {
    ExplicitScheme::attach(interaction, body);
    all_.push_back(std::move(interaction));
    return;
  }
  require_long_steps(*interaction);
  attach_for_long_steps(*interaction, body);
  all_.push_back(interaction);
  contact_.add(std::move(interaction));
  follow_interactions();
  built_for_ = 0.0;
}

void SemiImplicitScheme::tell_change(const BodyView& body, std::span<const std::uint32_t> origins) {
  ExplicitScheme::tell_change(body, origins);
  if (!contact_.acts()) return;
  contact_.body_changed(body, origins);
  follow_interactions();
}

void SemiImplicitScheme::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  ExplicitScheme::follow(origins, first_new);
  contact_.follow(origins, first_new);
}

void SemiImplicitScheme::take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  ExplicitScheme::take_state(displacement, velocity);
  if (contact_.acts()) contact_.state_set(displacement);
}

void SemiImplicitScheme::take_over(const BodyChange& change) {
  ExplicitScheme::take_over(change);
  built_for_ = 0.0;
}

double SemiImplicitScheme::added_frequency() const {
  return ExplicitScheme::added_frequency() + contact_.interactions().squared_frequency();
}

double SemiImplicitScheme::tool_energy() const {
  return ExplicitScheme::tool_energy() + contact_.interactions().tool_energy();
}

/// An automatic step follows the stiffest tets all the time; the factor is kept as long as its step is nearly as long.
double SemiImplicitScheme::choose_step(double h) const {
  if (!contact_.acts() || state_.options.step) return h;
  h = std::min(h, most_step_);
  return built_for_ <= h && h <= kLeeway * built_for_ ? built_for_ : h * kMargin;
}

void SemiImplicitScheme::loads_changed(bool may_refuse) {
  ExplicitScheme::loads_changed(may_refuse);
  built_for_ = 0.0;
}

void SemiImplicitScheme::require_tissues(const BlockTissues& tissues) const {
  ExplicitScheme::require_tissues(tissues);
  for (const auto& [block, tissue] : tissues) {
    if (!(tissue.viscosity > 0.0) || viscous_ || interactions_.empty()) continue;
    throw std::invalid_argument("tissue \"" + tissue.name + "\": viscosity = " + std::to_string(tissue.viscosity) +
                                " Pa s, but the integrator semi_implicit does not support the first "
                                "viscosity after instruments, needles and membranes have been attached; " +
                                "attach them to tissue with some viscosity, or take integrator = central_difference");
  }
}

void SemiImplicitScheme::take_tissues(const TissueChange& change) {
  ExplicitScheme::take_tissues(change);
  viscous_ = ViscousSystem::needed(state_.body) || contact_.acts();
  watch_all_if_viscous();
  built_for_ = 0.0;
}

std::size_t SemiImplicitScheme::holding() const {
  const auto holds = [](const auto& base) { return !base.empty(); };
  return static_cast<std::size_t>(std::count_if(state_.base.begin(), state_.base.end(), holds));
}

/// Per component: by supports, motions and bonds.
std::vector<char> SemiImplicitScheme::held_components() const {
  std::vector<char> held = state_.held_components();
  for (const std::uint32_t v : contact_.interactions().held_still()) {
    held[3 * v] = held[3 * v + 1] = held[3 * v + 2] = 1;
  }
  return held;
}

void SemiImplicitScheme::build(double h) {
  built_holding_ = holding();
  for (auto* field : {&impulse_, &change_, &drag_}) field->assign(state_.body.vertex_count, Vec3d{});
  std::vector<char> held = held_components();
  still_.assign(state_.body.vertex_count, 0);
  for (const std::uint32_t v : contact_.interactions().held_still()) still_[v] = 1;
  const std::size_t most =
      contact_.acts() ? std::numeric_limits<std::size_t>::max() : ViscousSystem::kMostTets;  // contact needs a factor
  system_.build(state_.body, state_.gamma, h, std::move(held), state_.loads.dashpots(), most);
  built_for_ = h;
}

void SemiImplicitScheme::load_layout(const std::shared_ptr<const void>& layout) {
  ExplicitScheme::load_layout(layout);
  built_for_ = 0.0;
}

void SemiImplicitScheme::archive_motion(Archive& ar) {
  ExplicitScheme::archive_motion(ar);
  double h = built_for_;
  std::vector<double> last = system_.last();
  ar(h, last);
  if (contact_.acts()) ar(contact_, most_step_);
  if (!ar.reads()) return;
  viscous_ = ViscousSystem::needed(state_.body) || contact_.acts();
  ar.check(!viscous_ || moving_->active().size() == state_.body.vertex_count);
  const bool is_built = ar.in_memory() && h > 0.0 && h == built_for_ && system_.is_for(held_components());
  if (!is_built) built_for_ = 0.0;
  if (!(h > 0.0)) return;
  if (!is_built) build(h);
  ar.check(system_.set_last(last));
}

/// @return whether interactions hold other vertices still than before
bool SemiImplicitScheme::begin_contact(double h) {
  start_.clear(), before_.clear();
  for (const ActiveVertex& w : moving_->active()) start_.push_back(w.displacement), before_.push_back(w.velocity);
  return contact_.begin(h, start_, false);
}

/// Finds the change of the velocities, and adds the impulses of interactions to those known. @return false where these are not found
bool SemiImplicitScheme::solve(double h) {
  if (!contact_.acts()) {
    system_.solve(impulse_, change_);
    return true;
  }
  const std::size_t n = change_.size();
  contact_push_.resize(n);
  for (std::size_t i = 0; i < n; ++i) contact_push_[i] = impulse_[i] + contact_.forces()[i] * h;
  system_.solve(contact_push_, change_);
  end_.resize(n);
  for (std::size_t i = 0; i < n; ++i) end_[i] = start_[i] + (before_[i] + change_[i]) * h;
  if (!contact_.correct(end_)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    contact_push_[i] = contact_.forces()[i] * h;
    impulse_[i] += contact_push_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (system_.is_free(3 * i + axis)) change_[i][axis] = (end_[i][axis] - start_[i][axis]) / h - before_[i][axis];
    }
  }
  return true;
}

void SemiImplicitScheme::prepare_to_give_up() {
  if (!viscous_ || !contact_.acts()) return;
  before_step_.active.assign(moving_->active().begin(), moving_->active().end());
  before_step_.past = past();
  kick_.keep_last(before_step_.kick);
  before_step_.interactions = interactions_.save();
}

void SemiImplicitScheme::give_up(double h) {
  contact_.give_up();
  std::copy(before_step_.active.begin(), before_step_.active.end(), moving_->active().begin());
  Archive past(before_step_.past);
  moving_->archive_past(past);
  kick_.go_back(before_step_.kick);
  interactions_.load(before_step_.interactions);
  if (!state_.options.step) most_step_ = 0.5 * h;
}

std::string SemiImplicitScheme::why_given_up(double h) const {
  std::ostringstream text;
  text << "contact was not found in a step of " << h << " s: no place of the tools has forces that tissue, bonds and "
       << "the force on a pushed tool agree with. Ways out: "
       << (state_.options.step ? "step_s = \"auto\" or a smaller step, " : "")
       << "a smaller force or a larger mass_kg on a tool that is pushed, slower motions, or the integrator "
          "\"central_difference\", whose short steps do not look for the end of a step";
  return text.str();
}

StepResult SemiImplicitScheme::step() {
  StepResult result = ExplicitScheme::step();
  for (int k = 0; k < kMostShortenings && result.status == StepStatus::not_converged && !state_.options.step; ++k) {
    result = ExplicitScheme::step();
  }
  result.contact_met = result.contact_met && contact_.is_met();
  if (result.made()) most_step_ = most_step_ < step_size() ? most_step_ * kStepRegrowth : kNoLimit;
  return result;
}

bool SemiImplicitScheme::kick(double h) {
  if (!viscous_) return ExplicitScheme::kick(h);
  const bool others_rest = contact_.acts() && begin_contact(h);
  if (h != built_for_ || holding() != built_holding_ || others_rest) build(h);
  const std::span<ActiveVertex> active = moving_->active();  // all vertices, in their order
  const std::span<const Vec3d> loads = kick_.loads(active);
  for (std::size_t i = 0; i < active.size(); ++i) {
    ActiveVertex& w = active[i];
    const Vec3d load = kick_.keep(i, w, loads);
    const ActiveKick::Kicked& at = kick_.all()[i];
    impulse_[i] = (w.elastic + w.viscous + at.weight + load - at.drag(w.velocity)) * h;
  }
  kick_.impose_motions(active);
  for (std::size_t i = 0; i < active.size(); ++i) {  // held components of the change are known now, others 0
    if (!(state_.body.masses[i] > 0.0) || still_[i] != 0) active[i].velocity = {};
    change_[i] = active[i].velocity - kick_.all()[i].velocity_before;
  }
  if (!solve(h)) {
    give_up(h);
    return false;
  }
  system_.held_drag(change_, drag_);
  for (std::size_t i = 0; i < active.size(); ++i) {
    ActiveVertex& w = active[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double inertia = kick_.all()[i].mass + h * (kick_.all()[i].damping + kick_.all()[i].dashpot[axis]);
      const bool free = system_.is_free(3 * i + axis);
      if (free) w.velocity[axis] = kick_.all()[i].velocity_before[axis] + change_[i][axis];
      // C (v₊ − v₋): of free components from the equation itself, so that the books are exact
      w.viscous[axis] -= free ? (impulse_[i][axis] - inertia * change_[i][axis]) / h : drag_[i][axis];
    }
  }
  return true;
}

void SemiImplicitScheme::constrain_interactions() {
  if (!viscous_) return ExplicitScheme::constrain_interactions();
  if (contact_.acts()) kick_.push(contact_push_);  // others add forces only
}

void SemiImplicitScheme::add_interface(KickWork& work) const {
  if (!contact_.acts()) return ExplicitScheme::add_interface(work);
  std::vector<Vec3d> after;
  for (const ActiveVertex& w : moving_->active()) after.push_back(w.velocity);
  const double h = built_for_;
  const auto add = [h](KickPower& power, const std::array<double, 3>& lost) {
    power.contact += lost[0] / h, power.friction += lost[1] / h, power.fracture += lost[2] / h;
  };
  add(work.before, contact_.lost_at(before_, &InterfaceBook::Page::tools_before));
  add(work.after, contact_.lost_at(after, &InterfaceBook::Page::tools_after));
}

/// What interactions hold still, and what acts on it besides them, where no support holds it.
std::vector<RestingVertex> SemiImplicitScheme::resting() const {
  std::vector<RestingVertex> all;
  const std::vector<char> supported = state_.held_components();
  for (const std::uint32_t v : contact_.interactions().held_still()) {
    const ActiveVertex& w = moving_->active()[v];
    const ActiveKick::Kicked& at = kick_.all()[v];
    Vec3d force = w.elastic + w.viscous + at.load + at.contact + at.weight;
    for (std::size_t axis = 0; axis < 3; ++axis) force[axis] = supported[3 * v + axis] != 0 ? 0.0 : force[axis];
    all.push_back({v, force});
  }
  return all;
}

void SemiImplicitScheme::tell_moved() {
  ExplicitScheme::tell_moved();
  if (!contact_.acts()) return;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    end_[i] = moving_->active()[i].displacement, before_[i] = moving_->active()[i].velocity;
  }
  contact_.made(end_, before_, resting());
}

}  // namespace glisson

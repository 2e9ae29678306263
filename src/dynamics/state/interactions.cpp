#include "dynamics/state/interactions.h"

#include <algorithm>

#include "base/sort_out.h"
#include "glisson/simulation/integrator.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

using detail::sort_out;

namespace {

bool is_among(std::span<const std::uint32_t> ascending, std::uint32_t vertex) {
  return std::binary_search(ascending.begin(), ascending.end(), vertex);
}

}  // namespace

int Interaction::most_drag_stages() const { return kMostDragStagesBesideOthers; }

std::string Interaction::refuses_long_steps() const {
  return "acts in short steps; take integrator = " + supporting_integrators();
}

std::shared_ptr<const void> Interaction::save_state() const {
  return std::make_shared<const std::string>(archived(const_cast<Interaction&>(*this)));  // writing changes nothing
}

void Interaction::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  if (other_body != nullptr) body_changed(*other_body, {});
  restore(*this, *std::static_pointer_cast<const std::string>(state));
}

std::span<const std::uint32_t> Interactions::newcomers(double time, double h, std::size_t vertex_count) {
  newcomers_.clear();
  left_ = rest_changed_ = false;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    name(k, all_[k]->reach(time, h), vertex_count);
    if (const auto kept = all_[k]->keeps(); kept && lets_go_) keep(k, *kept);
    take_rests(k);
  }
  sort_out(newcomers_);
  return newcomers_;
}

void Interactions::take_rests(std::size_t interaction) {
  const auto rests = all_[interaction]->rests();
  if (!rests) return;
  rests_[interaction].assign(rests->begin(), rests->end());
  sort_out(rests_[interaction]);
  rest_changed_ = true;
}

void Interactions::forget_named() {
  for (std::vector<std::uint32_t>& mine : named_) mine.clear();
}

void Interactions::ask_rests() {
  for (std::size_t k = 0; k < all_.size(); ++k) take_rests(k);
}

std::vector<std::uint32_t> Interactions::held_still() const {
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& mine : rests_) all.insert(all.end(), mine.begin(), mine.end());
  sort_out(all);
  return all;
}

/// Adds what an interaction has named; those not active yet are newcomers.
void Interactions::name(std::size_t interaction, std::span<const std::uint32_t> vertices, std::size_t vertex_count) {
  std::vector<std::uint32_t>& mine = named_[interaction];
  const std::size_t before = mine.size();
  for (const std::uint32_t v : vertices) {
    if (v >= vertex_count || is_among({mine.data(), before}, v)) continue;
    mine.push_back(v);
    if (v >= place_of_.size() || place_of_[v] == InteractionStep::kNowhere) newcomers_.push_back(v);
  }
  if (mine.size() > before) sort_out(mine);
}

/// Drops what an interaction does not keep.
void Interactions::keep(std::size_t interaction, std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> kept(vertices.begin(), vertices.end());
  sort_out(kept);
  const std::size_t dropped = std::erase_if(named_[interaction], [&](std::uint32_t v) { return !is_among(kept, v); });
  left_ = left_ || dropped > 0;
}

std::vector<std::uint32_t> Interactions::named() const {
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& mine : named_) all.insert(all.end(), mine.begin(), mine.end());
  sort_out(all);
  return all;
}

std::vector<std::uint32_t> Interactions::resting() const {
  std::vector<std::uint32_t> all = held_still();
  const std::vector<std::uint32_t> acted_on = named();
  std::erase_if(all, [&](std::uint32_t v) { return is_among(acted_on, v); });
  return all;
}

void Interactions::follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) {
  for (std::vector<std::uint32_t>& mine : named_) {
    const std::size_t before = mine.size();
    for (std::uint32_t i = 0; i < origins.size(); ++i) {
      if (is_among({mine.data(), before}, origins[i])) mine.push_back(first_new + i);
    }
  }
}

void Interactions::find_places(std::span<const ActiveVertex> active, std::size_t vertex_count) {
  if (all_.empty()) return;
  place_of_.assign(vertex_count, InteractionStep::kNowhere);
  for (std::uint32_t k = 0; k < active.size(); ++k) place_of_[active[k].vertex] = k;
  impulses_.assign(active.size(), Vec3d{});
}

void Interactions::begin(double time, double h, std::span<ActiveVertex> active, std::span<const RestingVertex> resting,
                         std::span<const Vec3d> rest, bool accounted) {
  std::fill(impulses_.begin(), impulses_.end(), Vec3d{});
  step_.time = time;
  step_.h = h;
  step_.vertices = active;
  step_.place_of = place_of_;
  step_.rest = rest;
  step_.resting = resting;
  step_.mobility = {};
  step_.impulses = impulses_;
  step_.interface_book = nullptr;
  if (!accounted || all_.empty()) return;
  book_.begin(active.size());
  step_.interface_book = &book_;
}

void Interactions::add_forces() {
  if (!all_.empty()) solver_.begin(step_);
  for (const std::shared_ptr<Interaction>& x : all_) x->add_forces(step_);
}

void Interactions::constrain(std::span<const Vec3d> mobility) {
  step_.mobility = mobility;
  step_.is_long = false;
  solver_.solve(all_, step_);
}

int Interactions::constrain(std::span<const Vec3d> free, StepMobility& mobility, int most) {
  step_.mobility = free;
  step_.is_long = true;
  return solver_.solve_coupled(all_, step_, mobility, most);
}

void Interactions::list_held(HeldRows& held) const {
  held.clear();
  if (!all_.empty()) solver_.list_held(step_, held);
}

Interactions::Saved Interactions::save() const {
  Saved saved;
  for (const std::shared_ptr<Interaction>& x : all_) saved.push_back(x->save_state());
  return saved;
}

void Interactions::load(const Saved& saved, const BodyView* other_body) {
  for (std::size_t k = 0; k < all_.size(); ++k) all_[k]->load_state(saved[k], other_body);
}

bool Interactions::overshoot() {
  return std::any_of(all_.begin(), all_.end(), [&](const auto& x) { return x->overshoots(step_); });
}

void Interactions::moved() {
  for (const std::shared_ptr<Interaction>& x : all_) x->moved(step_);
}

void Interactions::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  for (const std::shared_ptr<Interaction>& x : all_) x->body_changed(body, origins);
}

void Interactions::state_set(std::span<const Vec3d> displacement) {
  for (const std::shared_ptr<Interaction>& x : all_) x->state_set(displacement);
}

double Interactions::tool_energy() const {
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : all_) sum += x->tool_energy();
  return sum;
}

Interactions::Frequency Interactions::find_frequency(std::vector<VertexStiffness>& bounds) const {
  Frequency sum;
  for (const std::shared_ptr<Interaction>& x : all_) {
    (x->add_stiffness_bound(bounds) ? sum.of_bounded : sum.of_others) += x->squared_frequency();
  }
  return sum;
}

double Interactions::squared_frequency() const {
  double sum = 0.0;
  for (const std::shared_ptr<Interaction>& x : all_) sum += x->squared_frequency();
  return sum;
}

void Interactions::archive(Archive& ar) {
  auto count = static_cast<std::uint32_t>(all_.size());
  ar(count);
  ar.check(count == all_.size());
  if (!ar.in_memory()) {
    for (const std::shared_ptr<Interaction>& x : all_) x->archive(ar);
  }
  for (auto* lists : {&named_, &rests_}) {
    for (std::vector<std::uint32_t>& mine : *lists) {
      ar.all_below(mine, place_of_.size());
      ar.check(std::is_sorted(mine.begin(), mine.end()));
    }
  }
  ar.same_size(impulses_);
}

}  // namespace glisson

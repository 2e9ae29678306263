// needle_tip.cpp — what a needle's tip does between steps: it meets the surface, breaks it, cuts on, and comes back.
//
//   outside ──contact──▶ pressing ──puncture──▶ inside ──withdrawn──▶ outside, or beyond the track behind
//      ▲                    │ release  ▲           │ region boundary: inner puncture
//      └────────────────────┘          │           │ membrane: inner puncture
//                                      └──contact──┴ through the far side: exit
#include <algorithm>
#include <cmath>

#include "instruments/needle/needle_state.h"

namespace glisson {
namespace {

constexpr int kSearches = 4;     ///< of the rest position of the tip, a step
constexpr int kBisections = 12;  ///< of a region's boundary
constexpr double kClose = 1e-7;  ///< of the rest position of the tip [m]
constexpr double kTouch =
    1e-6;  ///< of the zone: nearer it touches, so that rounding does not choose the step of contact
constexpr double kNear = 1e-6;        ///< [m]: so much farther than the tip reaches a vertex counts as near
constexpr double kLetGo = 0.05;       ///< of the zone: a tip that far off the surface has let go of it
constexpr double kRise = 0.02;        ///< of the force of puncture: a rise by this ends the drop
constexpr double kSmoothing = 0.01;   ///< of the force for that [s]
constexpr double kLongestDrop = 0.5;  ///< [s]: after it, the least force so far counts

}  // namespace

void PressingWork::add(double new_depth, double new_force, double cutting) {
  work += 0.5 * (force + new_force) * (new_depth - depth);
  depth = new_depth;
  force = new_force;
  if (new_force <= cutting) {
    work_at_cutting = work;
    depth_at_cutting = depth;
  }
}

double PressingWork::free_energy(double cutting) const {
  return work - work_at_cutting - cutting * (depth - depth_at_cutting);
}

/// The surface that the needle's line meets next, seen from the hand: has the tip come through it?
void Needle::look_for_contact(const InteractionStep& step) {
  State& s = *state_;
  const Vec3d at = s.entered > 0 ? pose_.position + s.bend_tip : pose_.position;
  const Vec3d from = at - direction() * s.options.length;
  const double farthest = s.options.length + kTouch * s.options.zone;
  bool near = false;
  s.aside = 0.0;
  for (const std::uint32_t v : s.entry_vertices) {
    const std::uint32_t place = step.place_of[v];
    if (place == InteractionStep::kNowhere) continue;
    const Vec3d x = step.position(place);
    near = near || dot(x - from, direction()) <= farthest + kNear;
    s.aside = std::max(s.aside, norm(across(x - step.rest[v], direction())));
  }
  if (s.aside > s.aside_named) s.look = true;
  if (!near) return;  // all lie beyond the tip, and triangles between them
  std::vector<SurfaceHit> hits;
  for (const std::size_t t : s.near_triangles) {
    std::array<Vec3d, 3> present, rest;
    bool known = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t v = s.surface[t][a], place = step.place_of[v];
      known = known && place != InteractionStep::kNowhere;
      rest[a] = step.rest[v];
      if (known) present[a] = step.position(place);
    }
    const auto hit = known ? meet(from, direction(), present, rest) : std::nullopt;
    if (hit && hit->way >= 0.0 && hit->way <= farthest) hits.push_back(*hit);
  }
  put_in_order(hits);
  const auto next =
      std::ranges::find_if(hits, [&](const SurfaceHit& hit) { return s.is_next_entry(hit, from, direction()); });
  shaft::Row met;
  if (next == hits.end() || !s.place(met, next->rest)) return;
  s.look = true;
  add_event(step.time + step.h, depth(), "contact");
  s.meets_hole(next->rest) ? s.enter_hole() : s.touch(std::move(met), direction());
}

/// The tip on the unbroken surface: it may break it, or let go.
void Needle::press_on(const InteractionStep& step) {
  State& s = *state_;
  if (!shaft::read(step, s.tip)) return;
  const double gap = dot(s.tip.position - pose_.position, direction());
  if (gap > kLetGo * s.options.zone) {
    s.let_go();
    add_event(step.time + step.h, depth(), "release");
    return;
  }
  const double force = tip_force(), cutting = s.resistance(s.region).cutting;
  if (!(force > 0.0)) return;
  const double pressed = dot(pose_.position - s.tip.rest, direction());
  s.pressing.add(pressed, force, cutting);
  const Rupture& r = s.options.rupture;
  const bool breaks = r.force ? force >= *r.force
                      : r.toughness
                          ? s.pressing.free_energy(cutting) >= *r.toughness * s.options.diameter * r.membrane_thickness
                          : force >= cutting;
  if (breaks) pierce(step);
}

void Needle::pierce(const InteractionStep& step) {
  State& s = *state_;
  s.begin_track();
  const double force = tip_force() + dot(forces_.friction, direction());
  s.drop = {true, force, force, force, forces_at_end() ? step.time + step.h : step.time, depth()};
  add_event(step.time + step.h, depth(), "puncture");
  if (!s.tries) tell_puncture(pose_.position, 0.5 * s.options.diameter);
}

/// The tip in the tissue: where it cut, the path ends where it is now.
void Needle::go_on(const InteractionStep& step) {
  State& s = *state_;
  const Vec3d at = pose_.position + s.bend_tip;
  if (shaft::read(step, s.entry()) && dot(s.entry().position - pose_.position, direction()) > kLetGo * s.options.zone) {
    s.leave_track();
    add_event(step.time + step.h, depth(), "release");
    return;
  }
  if (s.is_through()) return go_through(step, at);
  if (!shaft::read(step, s.tip)) {
    s.look = !s.tip.weights.empty();  // without: the tissue there is gone, and no looking brings it back
    return;
  }
  const double gap = dot(s.tip.position - at, direction());
  watch_withdrawal(step, gap);
  if (!s.tip_cuts) return;
  if (s.next_region || s.at_membrane) {
    s.at_membrane ? s.pass_membrane() : s.enter(*s.next_region);
    add_event(step.time + step.h, depth(), "inner puncture");
  }
  s.cut_to(step, at, direction());
  if (s.tip_out) add_event(step.time + step.h, depth(), "exit");
}

/// The tip in a track that is open at its far end, or beyond that.
void Needle::go_through(const InteractionStep& step, const Vec3d& at) {
  State& s = *state_;
  if (!shaft::read(step, s.far_end())) return;
  const double gap = dot(s.far_end().position - at, direction());
  const bool comes_out = !s.tip_out && gap < 0.0, comes_back = s.tip_out && gap > kLetGo * s.options.zone;
  if (comes_out || comes_back) s.look = true, s.tip_out = comes_out;
  if (comes_out) add_event(step.time + step.h, depth(), "exit");
  if (!s.tip_out || comes_out) return watch_withdrawal(step, gap);
  look_for_contact(step);
}

/// @param gap  of the track's end before the tip [m]
void Needle::watch_withdrawal(const InteractionStep& step, double gap) {
  State& s = *state_;
  if (!s.withdraws && gap > kLetGo * s.options.zone && dot(pose_.position - before_.position, direction()) < 0.0) {
    s.withdraws = true;
    add_event(step.time + step.h, depth(), "withdrawal");
  }
  if (gap <= 0.0) s.withdraws = false;
}

/// Finds the rest position of what is at the tip now, and ends the path there.
void Needle::State::cut_to(const InteractionStep& step, const Vec3d& at, const Vec3d& direction) {
  bool ends = false;  // at the far side
  for (int search = 0; search < kSearches; ++search) {
    const Vec3d way = at - tip.position;
    if (norm(way) < kClose || dot(way, direction) <= 0.0) break;
    Vec3d next = tip.rest + way * std::min(1.0, 0.5 * options.spacing / norm(way));
    const bool meets = stop_at_membrane(next, direction);
    const std::optional<Vec3d> out = way_out(next);
    const auto found = out ? std::nullopt : zones->locator().locate(next);
    const int there = found ? mesh->region_of(found->tet) : region;
    const bool enters = there != region;
    shaft::Row moved;
    if (!place(moved, out ? *out : enters ? last_before(next, there) : next)) break;
    if (!shaft::read(step, moved)) {  // tissue that is not active yet: the rest of the way in the next step
      look = true;
      break;
    }
    tip = std::move(moved);
    ends = out.has_value();
    if (ends) break;
    at_membrane = meets && !enters && membranes[broken].puncture > cutting();
    if (enters && resistance(there).puncture > cutting()) next_region = there;
    if (at_membrane || next_region) break;
    if (enters) enter(there);
    if (meets && !enters) pass_membrane();
  }
  while (norm(tip.rest - nodes.back().rest) >= options.spacing) {
    const Vec3d way = tip.rest - nodes.back().rest;
    shaft::Row node;
    if (!place(node, nodes.back().rest + way * (options.spacing / norm(way))) || !shaft::read(step, node)) break;
    add_node(std::move(node), bend_tip);
  }
  if (ends) come_out();
}

void Needle::State::enter(int region_number) {
  region = region_number;
  next_region.reset();
  cutting_beyond.reset();
}

void Needle::State::pass_membrane() {
  const InnerMembrane& passed = membranes[broken++];
  at_membrane = false;
  if (passed.cutting) cutting_beyond = passed.cutting;
}

/// Takes `next` back to the first membrane that is not broken. @return whether it reaches that
bool Needle::State::stop_at_membrane(Vec3d& next, const Vec3d& direction) const {
  if (broken == membranes.size()) return false;
  const double ahead = dot(next - tip.rest, direction), clear = membranes[broken].depth - rest_depth(direction);
  if (clear > ahead) return false;
  next = tip.rest + (next - tip.rest) * std::max(0.0, clear / ahead);
  return true;
}

/// The last point on the way from the tip to `next` that is not in the region there yet.
Vec3d Needle::State::last_before(const Vec3d& next, int there) const {
  double inside = 0.0, beyond = 1.0;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (inside + beyond);
    const auto found = zones->locator().locate(tip.rest + (next - tip.rest) * middle);
    (found && mesh->region_of(found->tet) == there ? beyond : inside) = middle;
  }
  return tip.rest + (next - tip.rest) * inside;
}

void Needle::watch_drop(double time, double h) {
  DropWatch& d = state_->drop;
  if (!d.armed) return;
  d.force += (dot(forces_.total(), direction()) - d.force) * (1.0 - std::exp(-h / kSmoothing));
  if (d.force < d.least) {
    d.least = d.force;
    d.time = time;
    d.depth = force_depth();
  }
  if (d.force < d.least + kRise * d.puncture_force && time - d.time < kLongestDrop) return;
  d.armed = false;
  add_event(d.time, d.depth, "drop");
}

void Needle::moved(const InteractionStep& step) {
  watch_drop(forces_at_end() ? step.time + step.h : step.time, step.h);
  state_->read_ends(step);
  switch (state_->stage) {
    case NeedleStage::outside:
      look_for_contact(step);
      break;
    case NeedleStage::pressing:
      press_on(step);
      break;
    case NeedleStage::inside:
      go_on(step);
      break;
  }
}

}  // namespace glisson

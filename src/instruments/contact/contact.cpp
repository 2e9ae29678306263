// contact.cpp — a rigid tool against the surface: which points, then their impulses, then what the tool feels.
//
//   reach: pose at t + h ─▶ patches it might touch        declare: vertices ─▶ solver ─▶ triangles ─▶ solver ─▶ solved: forces
//
// The driver is asked in reach(), before the step, so that the way the tool will go is known when vertices are named.
#include "glisson/instruments/contact.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_fields.h"
#include "glisson/simulation/integrator.h"
#include "glisson/simulation/simulation.h"
#include "instruments/contact/contact_state.h"

namespace glisson {
namespace {

constexpr double kQuiet = 5e-3;  // without contact for so long, a tool has let go [s]

const ContactOptions& checked(const ContactOptions& options) {
  detail::require_fields("contact tool \"" + options.name + "\"", options);
  return options;
}

/// How a shape is drawn.
struct FormOf {
  using Kind = InstrumentForm::Kind;
  InstrumentForm operator()(const FlatPunch& x) const {
    return {.kind = Kind::punch, .radius = x.radius, .length = x.length};
  }
  InstrumentForm operator()(const Ball& x) const { return {.kind = Kind::ball, .radius = x.radius}; }
  InstrumentForm operator()(const NeedleShape& x) const {
    return {.kind = Kind::probe, .radius = 0.5 * x.diameter, .length = x.length, .tip = x.tip_length()};
  }
  InstrumentForm operator()(const Plate&) const { return {.kind = Kind::plate}; }
  InstrumentForm operator()(const CylinderWall& x) const { return {.kind = Kind::wall, .radius = x.radius}; }
  InstrumentForm operator()(const Block& x) const { return {.kind = Kind::block, .size = x.size}; }
};

}  // namespace

ContactTool::ContactTool(const ContactOptions& options, std::shared_ptr<ToolDriver> driver)
    : Instrument(checked(options).name, std::move(driver), options.direction), state_(std::make_unique<State>()) {
  state_->options = options;
  state_->solid.traits = traits_of(state_->options.shape);
  state_->solid.friction = options.bonded ? std::numeric_limits<double>::infinity() : options.friction;
  state_->solid.push_out_speed = options.push_out_speed;
  state_->solid.shape = &state_->options.shape;
}

ContactTool::~ContactTool() = default;

const ContactOptions& ContactTool::options() const { return state_->options; }
InstrumentForm ContactTool::form() const { return std::visit(FormOf{}, state_->options.shape); }
bool ContactTool::touches() const {
  const auto bears = [](double impulse) { return impulse != 0.0; };
  return std::any_of(state_->pressed.begin(), state_->pressed.end(), bears);
}
double ContactTool::contact_area() const { return state_->area; }
ContactTool::Effort ContactTool::effort() const { return state_->effort; }
ContactPressure ContactTool::contact_pressure() const {
  return {state_->bearing_vertices, state_->pressures, state_->bearing_forces};
}
double ContactTool::largest_pressure() const {
  const std::vector<double>& p = state_->pressures;
  return p.empty() ? 0.0 : std::max(0.0, *std::max_element(p.begin(), p.end()));
}

bool ContactTool::add_contact(std::span<Vec3d> force, std::span<double> pressing) const {
  const State& s = *state_;
  for (std::size_t i = 0; i < s.bearing_vertices.size(); ++i) {
    force[s.bearing_vertices[i]] += s.bearing_forces[i];
    pressing[s.bearing_vertices[i]] += s.bearing_normal[i];
  }
  return true;
}

/// At the end away from the tip: where the solid ends along its z.
Vec3d ContactTool::handle() const {
  const InstrumentForm f = form();
  const double end = f.kind == InstrumentForm::Kind::ball    ? 2.0 * f.radius
                     : f.kind == InstrumentForm::Kind::block ? f.size.z
                                                             : f.length;
  return force_pose().to_space({0.0, 0.0, end});
}

std::span<const InstrumentColumn> ContactTool::record_columns() const {
  static const std::vector<InstrumentColumn> columns = [] {
    std::vector<InstrumentColumn> all(pose_columns().begin(), pose_columns().end());
    all.push_back(
        {"contact_area_m2", [](const Instrument& x) { return static_cast<const ContactTool&>(x).contact_area(); }});
    all.push_back({"contact_pressure_most_Pa",
                   [](const Instrument& x) { return static_cast<const ContactTool&>(x).largest_pressure(); }});
    return all;
  }();
  return columns;
}

std::string ContactTool::refuses_long_steps() const { return driver_refuses_long_steps(); }

void ContactTool::attached(const BodyView& body, double) {
  set_bounds(body);
  state_->reach.attach(body);
  if (forces_at_end()) state_->require_outside(body, pose_, direction());
  if (state_->options.bonded) state_->bond_first(body, pose_);
}

void ContactTool::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  give_to_copies(state_->bonds, body.mesh.vertices.size(), origins);
  state_->reach.attach(body);
}

std::span<const std::uint32_t> ContactTool::reach(double time, double h) {
  State& s = *state_;
  begin_step();
  InteractionStep step;
  step.time = time, step.h = h;
  drive(step);
  s.solid.earlier = s.solid.before, s.solid.last_h = s.last_h;
  s.solid.before = before_, s.solid.after = pose_;
  s.last_h = h;
  s.trial.clear();
  const std::optional<Vec3d> free = free_end();
  if (!free) return s.reach.ask({&s.solid, 1}, h);
  std::array<ContactSolid, 2> ways{s.solid, s.solid};
  ways[1].after.position = *free;
  return s.reach.ask(ways, h);
}

std::optional<std::span<const std::uint32_t>> ContactTool::keeps() { return state_->reach.keeps(); }

void ContactTool::declare(const InteractionStep& step, StepRows& rows, int round) {
  State& s = *state_;
  if (!step.is_long) return s.declare_short(step, rows.group(), round);
  if (round == 0) {
    s.solid.yields = rows.group().yields = find_end(step);
    s.solid.after = pose_;
  }
  s.declare_long(step, rows.group(), round);
}

void ContactTool::solved(const InteractionStep& step, const StepRows& rows) {
  State& s = *state_;
  move_to_end();
  s.solid.after = pose_;
  forces_ = {};
  s.found(step, rows.group());
  if (s.options.bonded) s.bond(step, rows.group(), forces_);
  s.collect(step, rows.group(), forces_);

  const double time = forces_at_end() ? step.time + step.h : step.time;
  if (touches()) {
    if (!s.in_contact) add_event(time, force_depth(), "contact");
    s.in_contact = true, s.last_touch = time, s.last_depth = force_depth();
  } else if (s.in_contact && time > s.last_touch + kQuiet) {
    s.in_contact = false;
    add_event(s.last_touch, s.last_depth, "release");
  }
}

int ContactTool::most_drag_stages() const { return kMostDragStagesBesideOthers; }

void ContactTool::moved(const InteractionStep& step) {
  state_->reach.look(step);
  state_->weigh(step);
}

void ContactTool::archive(Archive& ar) {
  State& s = *state_;
  archive_motion(ar);
  ar(s.in_contact, s.begun, s.last_touch, s.last_depth, s.account, s.last_h, s.solid.before, s.found_inside);
  ar(s.bonds, s.last_pressing, s.last_bonds, s.reach);
  const std::size_t vertices = s.reach.surface().body_vertices();
  for (const auto& [v, place] : s.bonds) ar.check(v < vertices);
  for (const auto& [v, force] : s.last_bonds) ar.check(v < vertices);
  for (const auto& [t, force] : s.last_pressing) ar.check(std::max({t[0], t[1], t[2]}) < vertices);
}

namespace {

struct SavedContact {
  std::shared_ptr<const void> motion;
  ContactKept kept;
  ContactReach::Seen seen;
  Pose before;  ///< of the solid
  double taken = 0.0;
};

}  // namespace

std::shared_ptr<const void> ContactTool::save_state() const {
  const State& s = *state_;
  return std::make_shared<const SavedContact>(
      SavedContact{save_motion(), s, s.reach.seen(), s.solid.before, s.account.taken()});
}

void ContactTool::load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) {
  const SavedContact& saved = *std::static_pointer_cast<const SavedContact>(state);
  State& s = *state_;
  load_motion(*std::static_pointer_cast<const SavedMotion>(saved.motion));
  static_cast<ContactKept&>(s) = saved.kept;
  if (other_body != nullptr) s.reach.set_body(*other_body);
  s.reach.set_seen(saved.seen);
  s.solid.before = saved.before;
  s.account.set_taken(saved.taken);
}

}  // namespace glisson

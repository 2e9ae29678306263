// contact.cpp — a rigid tool against the surface: which points, then their impulses, then what the tool feels.
//
//   reach: pose at t + h ─▶ patches it might touch        constrain: vertices ─▶ solve ─▶ triangles ─▶ solve ─▶ forces
//
// The driver is asked in reach(), before the step, so that the way the tool will go is known when vertices are named.
#include "glisson/contact.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "instruments/contact_state.h"

namespace glisson {
namespace {

constexpr double kQuiet = 5e-3;  // without contact for so long, a tool has let go [s]

void require(const ContactOptions& o) {
  const auto refuse = [&](const char* what, double value, const char* range) {
    std::ostringstream text;
    text << "contact tool " << o.name << ": " << what << " = " << value << " is outside the allowed range, " << range;
    throw std::invalid_argument(text.str());
  };
  if (!(o.friction >= 0.0)) refuse("friction [-]", o.friction, ">= 0; infinite: it never slips");
  if (!(o.push_out_speed > 0.0) || !std::isfinite(o.push_out_speed)) {
    refuse("push_out_speed [m/s]", o.push_out_speed, "> 0 and finite");
  }
  if (!std::isfinite(norm(o.direction))) refuse("length of direction", norm(o.direction), "finite and not 0");
  require_valid(o.shape);
}

const ContactOptions& checked(const ContactOptions& options) {
  require(options);
  return options;
}

}  // namespace

ContactTool::ContactTool(const ContactOptions& options, std::shared_ptr<ToolDriver> driver)
    : Instrument(checked(options).name, std::move(driver), options.direction), state_(std::make_unique<State>()) {
  state_->options = options;
  if (!is_sound(pose_)) {
    throw std::invalid_argument("contact tool " + options.name +
                                ": its driver starts at a pose that is not finite, or whose axes are no rotation");
  }
  state_->solid.traits = traits_of(state_->options.shape);
  state_->solid.friction = options.bonded ? std::numeric_limits<double>::infinity() : options.friction;
  state_->solid.push_out_speed = options.push_out_speed;
  state_->solid.shape = &state_->options.shape;
}

ContactTool::~ContactTool() = default;

const ContactOptions& ContactTool::options() const { return state_->options; }
bool ContactTool::touches() const { return !state_->bearing.empty(); }
double ContactTool::contact_area() const { return state_->area; }
ContactTool::Effort ContactTool::effort() const { return state_->effort; }
ContactPressure ContactTool::contact_pressure() const { return {state_->bearing_vertices, state_->pressures}; }

void ContactTool::attached(const BodyView& body, double) { state_->reach.attach(body); }

void ContactTool::body_changed(const BodyView& body, std::span<const std::uint32_t> origins) {
  const auto first = body.mesh.vertices.size() - origins.size();
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const auto bond = state_->bonds.find(origins[i]);
    if (bond != state_->bonds.end()) state_->bonds[static_cast<std::uint32_t>(first + i)] = bond->second;
  }
  state_->reach.attach(body);
}

std::span<const std::uint32_t> ContactTool::reach(double time, double h) {
  State& s = *state_;
  if (s.lost) return {};
  InteractionStep step;
  step.time = time, step.h = h;
  drive(step);
  if (!is_sound(pose_)) {
    pose_ = before_, s.lost = true;
    add_event(time, force_depth(), "lost");
    return {};
  }
  s.solid.before = before_, s.solid.after = pose_;
  return s.reach.ask(s.solid, h);
}

void ContactTool::constrain(const InteractionStep& step) {
  State& s = *state_;
  forces_ = {};
  s.rows.clear(), s.bearing.clear(), s.effort = {};
  if (s.lost) return;
  s.add_vertices(step);
  s.effort.vertices = s.rows.size();
  if (!s.rows.empty()) s.effort.sweeps = solve(s.rows, step);
  if (s.solid.traits.presses_between) s.add_triangles(step);
  s.effort.triangles = s.rows.size() - s.effort.vertices;
  if (s.effort.triangles > 0) s.effort.sweeps += solve(s.rows, step);
  if (s.options.bonded) s.bond(step, forces_);
  s.collect(step, forces_);

  if (touches()) {
    if (!s.in_contact) add_event(step.time, force_depth(), "contact");
    s.in_contact = true, s.last_touch = step.time, s.last_depth = force_depth();
  } else if (s.in_contact && step.time > s.last_touch + kQuiet) {
    s.in_contact = false;
    add_event(s.last_touch, s.last_depth, "release");
  }
}

void ContactTool::moved(const InteractionStep& step) {
  state_->reach.look(step);
  state_->weigh(step);
}

std::vector<double> ContactTool::past() const {
  const State& s = *state_;
  std::vector<double> past;
  save_motion(past);
  past.insert(past.end(), {s.lost ? 1.0 : 0.0, s.in_contact ? 1.0 : 0.0, s.last_touch, s.last_depth,
                           static_cast<double>(s.bonds.size())});
  for (const auto& [vertex, y] : s.bonds) past.insert(past.end(), {static_cast<double>(vertex), y.x, y.y, y.z});
  s.reach.save(past);
  return past;
}

bool ContactTool::restore(std::span<const double> past) {
  State& s = *state_;
  if (!restore_motion(past) || past.size() < 5) return false;
  s.lost = past[0] != 0.0, s.in_contact = past[1] != 0.0;
  s.last_touch = past[2], s.last_depth = past[3];
  const double bonds = past[4];
  past = past.subspan(5);
  if (!(bonds >= 0.0 && 4.0 * bonds <= static_cast<double>(past.size()))) return false;
  s.bonds.clear();
  for (double i = 0.0; i < bonds; ++i, past = past.subspan(4)) {
    const double limit = static_cast<double>(s.reach.surface().body_vertices());
    if (!(past[0] >= 0.0 && past[0] < limit)) return false;
    s.bonds[static_cast<std::uint32_t>(past[0])] = {past[1], past[2], past[3]};
  }
  return s.reach.restore(past) && past.empty();
}

}  // namespace glisson

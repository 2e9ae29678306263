#include "glisson/instruments/instrument.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/require_fields.h"
#include "contact/shape_traits.h"
#include "contact/tool_yield.h"
#include "glisson/archive.h"
#include "glisson/simulation/integrator.h"

namespace glisson {
namespace {

constexpr const char* kRejected = "pose rejected";
constexpr double kReach = 10.0;                      // of the body's diagonal: farther from it no pose makes sense
constexpr double kProbe = 1e-3, kLeastProbe = 1e-4;  // more force, of itself and [N], that shows how a tool yields

/// A component of the forces along the direction.
template <Vec3d ToolForces::*part>
double along(const Instrument& x) {
  return dot(x.forces().*part, x.direction());
}

constexpr std::array<InstrumentColumn, 5> kCommonColumns{{
    {"depth_m", [](const Instrument& x) { return x.force_depth(); }},
    {"force_x_N", [](const Instrument& x) { return x.force().x; }},
    {"force_y_N", [](const Instrument& x) { return x.force().y; }},
    {"force_z_N", [](const Instrument& x) { return x.force().z; }},
    {"force_N", [](const Instrument& x) { return dot(x.force(), x.direction()); }},
}};
constexpr std::array<InstrumentColumn, 3> kContactColumns{{
    {"normal_N", along<&ToolForces::normal>},
    {"friction_N", along<&ToolForces::friction>},
    {"cutting_N", along<&ToolForces::cutting>},
}};

/// Components of vectors that are read off an instrument.
template <Vec3d ToolForces::*part, std::size_t axis>
double component(const Instrument& x) {
  return (x.forces().*part)[axis];
}
template <std::size_t axis>
double position(const Instrument& x) {
  return x.force_pose().position[axis];
}
template <std::size_t axis>
double handle_torque(const Instrument& x) {
  return x.handle_torque()[axis];
}

/// Unit quaternion w, x, y, z of a rotation, w ≥ 0.
std::array<double, 4> quaternion(const Mat3d& R) {
  std::array<double, 4> squares;  // 4 q_i²
  for (std::size_t i = 0; i < 4; ++i) {
    squares[i] = 1.0;
    for (std::size_t k = 0; k < 3; ++k) squares[i] += i == 0 || i == k + 1 ? R(k, k) : -R(k, k);
  }
  const auto most = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const double root = std::sqrt(squares[most]);
  const std::array<double, 3> odd{R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)};
  std::array<double, 4> q{};
  q[most] = 0.5 * root;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == most) continue;
    q[i] = 0.5 / root * (most == 0 ? odd[i - 1] : i == 0 ? odd[most - 1] : R(i - 1, most - 1) + R(most - 1, i - 1));
  }
  if (q[0] < 0.0) {
    for (double& x : q) x = -x;
  }
  return q;
}
template <std::size_t number>
double rotation(const Instrument& x) {
  return quaternion(x.force_pose().axes)[number];
}

constexpr std::array<InstrumentColumn, 23> kPoseColumns{{
    {"position_x_m", position<0>},
    {"position_y_m", position<1>},
    {"position_z_m", position<2>},
    {"rotation_w", rotation<0>},
    {"rotation_x", rotation<1>},
    {"rotation_y", rotation<2>},
    {"rotation_z", rotation<3>},
    {"torque_x_N_m", component<&ToolForces::torque, 0>},
    {"torque_y_N_m", component<&ToolForces::torque, 1>},
    {"torque_z_N_m", component<&ToolForces::torque, 2>},
    {"handle_torque_x_N_m", handle_torque<0>},
    {"handle_torque_y_N_m", handle_torque<1>},
    {"handle_torque_z_N_m", handle_torque<2>},
    {"normal_x_N", component<&ToolForces::normal, 0>},
    {"normal_y_N", component<&ToolForces::normal, 1>},
    {"normal_z_N", component<&ToolForces::normal, 2>},
    {"friction_x_N", component<&ToolForces::friction, 0>},
    {"friction_y_N", component<&ToolForces::friction, 1>},
    {"friction_z_N", component<&ToolForces::friction, 2>},
    {"cutting_x_N", component<&ToolForces::cutting, 0>},
    {"cutting_y_N", component<&ToolForces::cutting, 1>},
    {"cutting_z_N", component<&ToolForces::cutting, 2>},
    {"friction_size_N", [](const Instrument& x) { return norm(x.forces().friction); }},
}};

}  // namespace

bool Pose::is_sound() const {
  double off = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto& m = axes.m;
      const double product = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
      off += std::abs(product - (i == j ? 1.0 : 0.0));
    }
  }
  return std::isfinite(norm(position)) && off < 1e-6 && determinant(axes) > 0.0;
}

Fault Pose::check() const {
  if (is_sound()) return {};
  return {"are no rotation; give three perpendicular unit vectors, right-handed, as its columns", "axes"};
}

bool PoseBounds::holds(const Pose& pose) const { return pose.is_sound() && norm(pose.position - middle) <= reach; }

std::string PoseBounds::fault_of(const Pose& pose) const {
  const Vec3d& x = pose.position;
  std::ostringstream text;
  if (!std::isfinite(norm(x))) {
    text << "its position (" << x.x << ", " << x.y << ", " << x.z << ") m is not finite; leave such poses out";
  } else if (!pose.is_sound()) {
    text << "its axes are no rotation; give three perpendicular unit vectors, right-handed, as columns";
  } else {
    text << "its position (" << x.x << ", " << x.y << ", " << x.z << ") m is " << norm(x - middle)
         << " m from the middle of the body, where the allowed range is 0 to " << reach
         << " m, ten diagonals of the body; is it in metres?";
  }
  return text.str();
}

Instrument::Instrument(std::string name, std::shared_ptr<ToolDriver> driver, const Vec3d& direction)
    : name_(std::move(name)), driver_(std::move(driver)), direction_(direction) {
  if (driver_ == nullptr) throw std::invalid_argument("instrument " + name_ + ": no driver was given");
  if (!(norm(direction) > 0.0)) throw std::invalid_argument("instrument " + name_ + ": its direction is zero");
  direction_ = unit(direction);
  pose_ = before_ = driver_->start();
  detail::require_fields("instrument " + name_ + ": start", pose_);
  start_ = pose_.position;
}

double Instrument::depth() const { return dot(pose().position - start_, direction_); }

std::span<const InstrumentColumn> Instrument::common_columns() { return kCommonColumns; }
std::span<const InstrumentColumn> Instrument::own_columns() const { return kContactColumns; }
std::span<const InstrumentColumn> Instrument::pose_columns() { return kPoseColumns; }

std::vector<InstrumentColumn> Instrument::columns() const {
  std::vector<InstrumentColumn> all(kCommonColumns.begin(), kCommonColumns.end());
  all.insert(all.end(), own_columns().begin(), own_columns().end());
  all.insert(all.end(), record_columns().begin(), record_columns().end());
  return all;
}

double Instrument::read(std::string_view column) const {
  for (const InstrumentColumn& x : columns()) {
    if (x.name == column) return x.read(*this);
  }
  throw std::out_of_range(label() + " has no column \"" + std::string(column) + "\"");
}

void Instrument::drive(const InteractionStep& step) {
  force_depth_ = depth();
  earlier_ = before_, last_step_ = step_;
  before_ = pose_, step_ = step.h;
  time_ = step.time;
  const Pose next = driver_->advance(step.time, step.h, {-forces_.total(), -forces_.torque});
  if (accepts(next)) pose_ = next;
}

void Instrument::begin_step() {
  if (yields_ != nullptr) yields_->force = -forces_.total();
}

/// Where a force on the tool takes it, however far: the tissue may hold it back. Where it is, if that is not finite.
Vec3d Instrument::end_under(const Vec3d& force) {
  const Pose end = driver_->advance_under(time_, step_, {force, -forces_.torque});
  return std::isfinite(norm(end.position)) ? end.position : pose_.position;
}

ToolYield* Instrument::find_end(const InteractionStep& step) {
  if (yields_ == nullptr || !step.is_long) return nullptr;
  ToolYield& tool = *yields_;
  const double probe = kProbe * norm(tool.force) + kLeastProbe;
  const Vec3d free = end_under({}), end = end_under(tool.force);
  for (std::size_t j = 0; j < 3; ++j) {
    Vec3d more = tool.force;
    more[j] += probe;
    const Vec3d way = (end_under(more) - end) * (1.0 / probe);
    for (std::size_t i = 0; i < 3; ++i) tool.compliance(i, j) = way[i];
  }
  tool.held_back = end - free;
  pose_.position = end;
  return &tool;
}

void Instrument::move_to_end() {
  if (yields_ == nullptr) return;
  yields_->force = yields_->found;
  const Pose end = driver_->advance_under(time_, step_, {yields_->force, -forces_.torque});
  if (accepts(end)) pose_.position = end.position;
}

std::optional<Vec3d> Instrument::free_end() const {
  if (yields_ == nullptr) return {};
  const Pose free = driver_->advance_under(time_, step_, {});
  return bounds_.holds(free) ? free.position : pose_.position;
}

void Instrument::set_long_steps(bool are_long) {
  at_end_ = are_long;
  if (are_long && driver_->yields()) yields_ = std::make_shared<ToolYield>();
}

/// Counts a pose that makes no sense, the first as an event; the tool stays where it is then.
bool Instrument::accepts(const Pose& pose) {
  if (bounds_.holds(pose)) return true;
  ++rejected_;
  const auto is_told = [](const InstrumentEvent& e) { return e.event == kRejected; };
  if (std::none_of(events_.begin(), events_.end(), is_told)) add_event(time_, depth(), kRejected);
  return false;
}

void Instrument::set_bounds(const BodyView& body) {
  if (body.mesh.vertices.empty()) return;
  Vec3d low = body.mesh.vertices.front(), high = low;
  for (const Vec3d& x : body.mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]), high[axis] = std::max(high[axis], x[axis]);
    }
  }
  const PoseBounds bounds{(low + high) * 0.5, kReach * norm(high - low)};
  if (!bounds.holds(pose_)) throw std::invalid_argument("instrument " + name_ + ": start: " + bounds.fault_of(pose_));
  bounds_ = bounds;
  driver_->set_bounds(bounds_);
}

std::string Instrument::driver_refuses_long_steps() const {
  if (!driver_->yields() || driver_->yields_in_long_steps()) return {};
  return "is moved by a force in short steps only; give it a path in time, or take integrator = " +
         supporting_integrators();
}

ToolVelocity Instrument::velocity_at(const Vec3d& x) const {
  ToolVelocity velocity;
  if (at_end_) {
    const Vec3d moved = x - before_.to_space(pose_.to_own(x));
    if (step_ > 0.0) velocity.before = velocity.after = moved * (1.0 / step_);
    return velocity;
  }
  const Vec3d own = before_.to_own(x);
  if (last_step_ > 0.0) velocity.before = (x - earlier_.to_space(own)) * (1.0 / last_step_);
  if (step_ > 0.0) velocity.after = (pose_.to_space(own) - x) * (1.0 / step_);
  return velocity;
}

struct Instrument::SavedMotion {
  InstrumentState state;
  std::shared_ptr<const void> driver;
};

std::shared_ptr<const Instrument::SavedMotion> Instrument::save_motion() const {
  return std::make_shared<const SavedMotion>(SavedMotion{*this, driver_->save_state()});
}

void Instrument::load_motion(const SavedMotion& saved) {
  static_cast<InstrumentState&>(*this) = saved.state;
  driver_->load_state(saved.driver);
}

std::shared_ptr<const void> ToolDriver::save_state() const {
  return std::make_shared<const std::string>(archived(const_cast<ToolDriver&>(*this)));  // writing changes nothing
}

void ToolDriver::load_state(const std::shared_ptr<const void>& state) {
  restore(*this, *std::static_pointer_cast<const std::string>(state));
}

void archive(Archive& ar, Pose& pose) { ar(pose.position, pose.axes); }
void archive(Archive& ar, InstrumentEvent& event) { ar(event.time, event.depth, event.event); }

void Instrument::archive_motion(Archive& ar) {
  ar(pose_, before_, earlier_, step_, last_step_, forces_.normal, forces_.friction, forces_.cutting, forces_.torque,
     force_depth_, events_);
  driver_->archive(ar);
}

}  // namespace glisson

#include "contact/row_group.h"

#include <algorithm>

#include "base/two_across.h"
#include "glisson/contact/step_rows.h"

namespace glisson {

void RowGroup::clear() {
  earlier.swap(points);
  points.clear(), holds.clear(), discs.clear(), pushes.clear();
  walls.clear(), pressed.clear();
  shaft.reset();
  account = nullptr, yields = nullptr;
  others_act = corrected = false;
  sweeps = last_sweeps = 0;
}

double solve(HoldRow& row, const InteractionStep& step) {
  const Vec3d change = row.velocity - step.vertices[row.place].velocity, &a = step.mobility[row.place];
  Vec3d impulse{a.x > 0.0 ? change.x / a.x : 0.0, a.y > 0.0 ? change.y / a.y : 0.0, a.z > 0.0 ? change.z / a.z : 0.0};
  if (row.softness > 0.0) impulse = (row.impulse + impulse) * (1.0 / (1.0 + row.softness)) - row.impulse;
  step.push(row.place, impulse);
  row.impulse += impulse;
  return norm(Vec3d{a.x * impulse.x, a.y * impulse.y, a.z * impulse.z}) * step.h;
}

/// The impulse that would stop it, with its own taken off, or as much less as its size allows; of tissue that cannot move, all.
double solve(DiscRow& row, const InteractionStep& step) {
  Vec3d tissue{};
  for (std::size_t c = 0; c < 4; ++c) tissue += step.vertices[row.places[c]].velocity * row.weights[c];
  const Vec3d off = row.velocity - tissue;
  const Vec3d slip = off - row.line * (dot(row.line, off) / dot(row.line, row.line)),
              free = slip + row.impulse * row.mobility;
  const double speed = norm(free);
  const double size = !(speed > 0.0) ? 0.0 : row.mobility > 0.0 ? std::min(row.most, speed / row.mobility) : row.most;
  const Vec3d wanted = size > 0.0 ? free * (size / speed) : Vec3d{}, change = wanted - row.impulse;
  if (change == Vec3d{}) return 0.0;
  for (std::size_t c = 0; c < 4; ++c) step.push(row.places[c], change * row.weights[c]);
  row.impulse = wanted;
  return norm(change) * row.mobility * step.h;
}

StepRows::StepRows() : group_(std::make_unique<RowGroup>()) {}
StepRows::~StepRows() = default;
StepRows::StepRows(StepRows&&) noexcept = default;
StepRows& StepRows::operator=(StepRows&&) noexcept = default;

std::size_t StepRows::hold(std::uint32_t place, const Vec3d& velocity, const std::optional<ToolVelocity>& tool) {
  group_->holds.push_back({.place = place, .velocity = velocity, .tool = tool});
  return group_->holds.size() - 1;
}

void StepRows::push(std::uint32_t place, const Vec3d& impulse) {
  group_->pushes.push_back({.place = place, .impulse = impulse});
}

std::size_t StepRows::press(const InteractionStep& step, std::uint32_t place, const Wall& wall) {
  static const Shape half_space = Plate{};  // all of z ≥ 0 in its own frame
  const Vec3d z = unit(wall.normal) * -1.0;
  const auto [x, y] = two_across(z);
  ContactSolid& solid = group_->walls.emplace_back();
  solid.shape = &half_space, solid.traits = traits_of(half_space), solid.friction = wall.friction;
  for (std::size_t i = 0; i < 3; ++i) {
    solid.before.axes(i, 0) = x[i], solid.before.axes(i, 1) = y[i], solid.before.axes(i, 2) = z[i];
  }
  solid.before.position = wall.point;
  solid.after = solid.earlier = solid.before;
  solid.after.position += wall.velocity * step.h, solid.earlier.position -= wall.velocity * step.h;
  solid.last_h = step.h;
  ContactRow row;
  row.places[0] = place, row.solid = &solid;
  const bool comes_near = prepare(row, step);
  if (comes_near) group_->points.push_back(row);
  group_->pressed.push_back(comes_near ? std::optional(group_->points.size() - 1) : std::nullopt);
  return group_->pressed.size() - 1;
}

Vec3d StepRows::pressing_impulse(std::size_t row) const {
  const std::optional<std::size_t>& point = group_->pressed.at(row);
  return point ? group_->points[*point].impulse() : Vec3d{};
}

std::size_t StepRows::press_count() const { return group_->pressed.size(); }
std::size_t StepRows::hold_count() const { return group_->holds.size(); }
Vec3d StepRows::holding_impulse(std::size_t row) const { return group_->holds.at(row).impulse; }

}  // namespace glisson

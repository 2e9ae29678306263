#include "dynamics/state/constraints.h"

#include <algorithm>

namespace glisson {
namespace {

/// Of a constraint that shares components with others; the others have no such list, before and after.
void archive_own_axes(Archive& ar, Constraint& c) {
  if (c.own_axes.empty()) return;
  std::vector<char> own;
  for (const Axes& axes : c.own_axes) own.push_back(static_cast<char>(axes.x + 2 * axes.y + 4 * axes.z));
  ar(own);
  if (!ar.reads()) return;
  ar.check(own.size() == c.vertices.size());
  c.own_axes.clear();
  for (const char bits : own) {
    const Axes axes{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
    for (std::size_t axis = 0; axis < 3; ++axis) ar.check(!has_axis(axes, axis) || has_axis(c.axes, axis));
    c.own_axes.push_back(axes);
  }
}

}  // namespace

Vec3d masked(const Vec3d& v, const Axes& axes) { return {axes.x ? v.x : 0.0, axes.y ? v.y : 0.0, axes.z ? v.z : 0.0}; }

Target::Target(const Constraint& c, double time) : turns_(static_cast<bool>(c.rigid)) {
  if (turns_) pose_ = c.rigid(time);
  if (c.motion) pose_.position = c.motion(time);
}

Contradiction::Contradiction(std::uint32_t at, std::size_t along, std::size_t by)
    : std::invalid_argument(
          "constraint: component " + std::string(1, "xyz"[along]) + " of vertex " + std::to_string(at) +
          " is held by two constraints (or named twice in one) that do not move alike; take it out of "
          "one of the sets"),
      vertex(at), axis(along), holder(by) {}

bool Constraints::is_shared(const std::vector<std::uint32_t>& holder, const Constraint& added, std::uint32_t vertex,
                            std::size_t axis) const {
  const std::uint32_t by = holder[3 * vertex + axis];
  if (by == kFree) return false;
  const Constraint& first = by < all_.size() ? all_[by] : added;
  const Course course = added.courses[axis];
  if (course == kOwnCourse || first.courses[axis] != course || first.from != added.from)
    throw Contradiction(vertex, axis, by);
  return true;
}

ConstraintId Constraints::add(Constraint constraint) {
  if (constraint.vertices.empty())
    throw std::invalid_argument("constraint: the vertex set is empty; name at least one vertex");
  const std::size_t vertex_count = holder_.size() / 3;
  const auto index = static_cast<std::uint32_t>(all_.size());
  std::vector<std::uint32_t> holder = holder_;  // taken over only when the whole set is sound
  std::vector<Axes> own(constraint.vertices.size(), constraint.axes);
  bool shares = false;
  for (std::size_t k = 0; k < constraint.vertices.size(); ++k) {
    const std::uint32_t v = constraint.vertices[k];
    if (v >= vertex_count) {
      throw std::invalid_argument("constraint: vertex " + std::to_string(v) + " is outside the mesh, 0 to " +
                                  std::to_string(vertex_count - 1));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!has_axis(constraint.axes, axis)) continue;
      if (is_shared(holder, constraint, v, axis)) {
        drop_axis(own[k], axis);
        shares = true;
      } else {
        holder[3 * v + axis] = index;
      }
    }
  }
  if (shares) constraint.own_axes = std::move(own);
  holder_ = std::move(holder);
  all_.push_back(std::move(constraint));
  return {all_.size() - 1};
}

std::vector<std::vector<std::size_t>> Constraints::add_copies(std::span<const std::uint32_t> origins) {
  const auto first = static_cast<std::uint32_t>(holder_.size() / 3);
  for (const std::uint32_t origin : origins) {
    for (std::size_t axis = 0; axis < 3; ++axis) holder_.push_back(std::uint32_t(holder_[3 * origin + axis]));
  }
  std::vector<std::vector<std::size_t>> copied(all_.size());
  for (std::size_t c = 0; c < all_.size(); ++c) {
    std::vector<std::uint32_t>& vertices = all_[c].vertices;
    const std::size_t before = vertices.size();
    for (std::uint32_t i = 0; i < origins.size(); ++i) {
      const auto end = vertices.begin() + static_cast<std::ptrdiff_t>(before);
      const auto found = std::find(vertices.begin(), end, origins[i]);
      if (found == end) continue;
      const auto place = static_cast<std::size_t>(found - vertices.begin());
      copied[c].push_back(place);
      vertices.push_back(first + i);
      std::vector<Axes>& own = all_[c].own_axes;
      if (!own.empty()) own.push_back(Axes(own[place]));
    }
  }
  return copied;
}

void Constraints::archive(Archive& ar, std::size_t vertices) {
  auto count = static_cast<std::uint64_t>(all_.size());
  ar(count);
  ar.check(count == all_.size());
  std::vector<std::uint32_t> holder(3 * vertices, kFree);
  for (std::size_t index = 0; index < all_.size(); ++index) {
    Constraint& c = all_[index];
    const Constraint here = c;
    ar(c.vertices, c.axes.x, c.axes.y, c.axes.z, c.from);
    archive_own_axes(ar, c);
    if (!ar.reads()) continue;
    const std::size_t known = here.vertices.size();
    ar.check(here.axes.x == c.axes.x && here.axes.y == c.axes.y && here.axes.z == c.axes.z && here.from == c.from &&
             known <= c.vertices.size());
    ar.check(std::equal(here.vertices.begin(), here.vertices.end(), c.vertices.begin()));
    for (std::size_t k = 0; k < c.vertices.size(); ++k) {
      const std::uint32_t v = c.vertices[k];
      ar.check(v < vertices);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!has_axis(c.axes_of(k), axis)) continue;
        ar.check(holder[3 * v + axis] == kFree);
        holder[3 * v + axis] = static_cast<std::uint32_t>(index);
      }
    }
  }
  if (ar.reads()) holder_ = std::move(holder);
}

const Constraint& Constraints::at(ConstraintId id) const {
  if (id.index < all_.size()) return all_[id.index];
  throw std::invalid_argument("constraint id " + std::to_string(id.index) + " does not exist; the simulation has " +
                              std::to_string(all_.size()));
}

}  // namespace glisson

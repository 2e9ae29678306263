#include "dynamics/state/constraints.h"

#include <algorithm>
#include <stdexcept>

namespace glisson {

Vec3d masked(const Vec3d& v, const Axes& axes) { return {axes.x ? v.x : 0.0, axes.y ? v.y : 0.0, axes.z ? v.z : 0.0}; }

Target::Target(const Constraint& c, double time) : turns_(static_cast<bool>(c.rigid)) {
  if (turns_) pose_ = c.rigid(time);
  if (c.motion) pose_.position = c.motion(time);
}

ConstraintId Constraints::add(Constraint constraint) {
  if (constraint.vertices.empty())
    throw std::invalid_argument("constraint: the vertex set is empty; name at least one vertex");
  const std::size_t vertex_count = held_.size() / 3;
  std::vector<char> held = held_;  // taken over only when the whole set is sound
  for (const std::uint32_t v : constraint.vertices) {
    if (v >= vertex_count) {
      throw std::invalid_argument("constraint: vertex " + std::to_string(v) + " is outside the mesh, 0 to " +
                                  std::to_string(vertex_count - 1));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (has_axis(constraint.axes, axis) && held[3 * v + axis] != 0) {
        throw std::invalid_argument(
            "constraint: component " + std::string(1, "xyz"[axis]) + " of vertex " + std::to_string(v) +
            " is held by two constraints (or named twice in one); take it out of one of the sets");
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (has_axis(constraint.axes, axis)) held[3 * v + axis] = 1;
    }
  }
  held_ = std::move(held);
  all_.push_back(std::move(constraint));
  return {all_.size() - 1};
}

std::vector<std::vector<std::size_t>> Constraints::add_copies(std::span<const std::uint32_t> origins) {
  const auto first = static_cast<std::uint32_t>(held_.size() / 3);
  for (const std::uint32_t origin : origins) {
    for (std::size_t axis = 0; axis < 3; ++axis) held_.push_back(char(held_[3 * origin + axis]));
  }
  std::vector<std::vector<std::size_t>> copied(all_.size());
  for (std::size_t c = 0; c < all_.size(); ++c) {
    std::vector<std::uint32_t>& vertices = all_[c].vertices;
    const std::size_t before = vertices.size();
    for (std::uint32_t i = 0; i < origins.size(); ++i) {
      const auto end = vertices.begin() + static_cast<std::ptrdiff_t>(before);
      const auto found = std::find(vertices.begin(), end, origins[i]);
      if (found == end) continue;
      copied[c].push_back(static_cast<std::size_t>(found - vertices.begin()));
      vertices.push_back(first + i);
    }
  }
  return copied;
}

void Constraints::archive(Archive& ar, std::size_t vertices) {
  auto count = static_cast<std::uint64_t>(all_.size());
  ar(count);
  ar.check(count == all_.size());
  std::vector<char> held(3 * vertices, 0);
  for (Constraint& c : all_) {
    const Constraint here = c;
    ar(c.vertices, c.axes.x, c.axes.y, c.axes.z, c.from);
    if (!ar.reads()) continue;
    const std::size_t known = here.vertices.size();
    ar.check(here.axes.x == c.axes.x && here.axes.y == c.axes.y && here.axes.z == c.axes.z && here.from == c.from &&
             known <= c.vertices.size());
    ar.check(std::equal(here.vertices.begin(), here.vertices.end(), c.vertices.begin()));
    for (const std::uint32_t v : c.vertices) {
      ar.check(v < vertices);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!has_axis(c.axes, axis)) continue;
        ar.check(held[3 * v + axis] == 0);
        held[3 * v + axis] = 1;
      }
    }
  }
  if (ar.reads()) held_ = std::move(held);
}

const Constraint& Constraints::at(ConstraintId id) const {
  if (id.index < all_.size()) return all_[id.index];
  throw std::invalid_argument("constraint id " + std::to_string(id.index) + " does not exist; the simulation has " +
                              std::to_string(all_.size()));
}

}  // namespace glisson

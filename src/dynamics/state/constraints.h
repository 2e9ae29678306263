// constraints.h — which vertex components are held or driven, and by which constraint.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// How a component moves, as far as two constraints may share it: those of one course prescribe the same displacement.
using Course = std::uint64_t;
inline constexpr Course kOwnCourse = 0;  ///< like that of no other constraint
inline constexpr Course kAtRest = 1;     ///< where it is; further numbers are the caller's

/// A set of vertices that is held (no motion) or driven along a path.
struct Constraint {
  std::vector<std::uint32_t> vertices;
  Axes axes;
  Motion motion;                    ///< none: held at rest
  double from = 0.0;                ///< time at which it takes hold [s]; the vertices are free before it
  PoseMotion rigid;                 ///< in place of `motion`: they move as a rigid body
  std::array<Course, 3> courses{};  ///< of its components
  std::vector<Axes> own_axes{};     ///< per vertex, without components that others hold; empty: all have `axes`

  bool moves() const { return motion || rigid; }
  /// The components of a vertex, by its place in the list, that this constraint holds and no other.
  const Axes& axes_of(std::size_t place) const { return own_axes.empty() ? axes : own_axes[place]; }
};

/// Two constraints ask different things of a component.
class Contradiction : public std::invalid_argument {
 public:
  Contradiction(std::uint32_t at, std::size_t along, std::size_t by);

  std::uint32_t vertex;
  std::size_t axis;
  std::size_t holder;  ///< index of the constraint that holds it; that of the new one where it is named twice in it
};

/// Where a constraint wants its vertices at a time. Its base, per vertex, says where from: the displacement that `motion` is added
/// to, or, of a rigid motion, the place in the coordinates that move [m].
class Target {
 public:
  Target(const Constraint& constraint, double time);

  Vec3d base_of(const Vec3d& rest, const Vec3d& displacement) const {
    return turns_ ? pose_.to_own(rest + displacement) : displacement - pose_.position;
  }
  Vec3d displacement(const Vec3d& base, const Vec3d& rest) const {
    return turns_ ? pose_.to_space(base) - rest : base + pose_.position;
  }
  /// Displacement since an earlier target.
  Vec3d since(const Target& earlier, const Vec3d& base) const {
    return turns_ ? pose_.to_space(base) - earlier.pose_.to_space(base) : pose_.position - earlier.pose_.position;
  }

 private:
  bool turns_;
  Pose pose_;
};

/// All constraints of a body. A component belongs to one of them at most: to the first of those whose course is the same, which
/// bears its force.
class Constraints {
 public:
  explicit Constraints(std::size_t vertex_count) : holder_(3 * vertex_count, kFree) {}

  /// @throws std::invalid_argument for an empty set or a vertex out of range; Contradiction for a component that another
  ///         constraint holds on another course
  ConstraintId add(Constraint constraint);

  /// Lets new vertices, numbered on from the last, follow what holds the vertices they are copies of.
  /// @return per constraint: which of its vertices have copies, as positions in its list; the copies come last in it
  std::vector<std::vector<std::size_t>> add_copies(std::span<const std::uint32_t> origins);

  /// What came with splits. @throws std::runtime_error where what is read held or drove other vertices before
  /// @param vertices  of the body
  void archive(Archive& ar, std::size_t vertices);

  std::span<const Constraint> all() const { return all_; }
  const Constraint& at(ConstraintId id) const;
  bool holds(std::size_t vertex, std::size_t axis) const { return holder_[3 * vertex + axis] != kFree; }

 private:
  static constexpr std::uint32_t kFree = 0xFFFF'FFFF;
  /// Whether the component of a vertex is held already on the course of a constraint to be added.
  bool is_shared(const std::vector<std::uint32_t>& holder, const Constraint& added, std::uint32_t vertex,
                 std::size_t axis) const;

  std::vector<Constraint> all_;
  std::vector<std::uint32_t> holder_;  ///< per vertex component: which constraint
};

inline bool has_axis(const Axes& axes, std::size_t axis) { return axis == 0 ? axes.x : (axis == 1 ? axes.y : axes.z); }
inline void drop_axis(Axes& axes, std::size_t axis) { (axis == 0 ? axes.x : (axis == 1 ? axes.y : axes.z)) = false; }

/// The components of `v` along `axes`, the others 0.
Vec3d masked(const Vec3d& v, const Axes& axes);

}  // namespace glisson

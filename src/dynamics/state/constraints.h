// constraints.h — which vertex components are held or driven, and by which constraint.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// A set of vertices that is held (no motion) or driven along a path.
struct Constraint {
  std::vector<std::uint32_t> vertices;
  Axes axes;
  Motion motion;      ///< none: held at rest
  double from = 0.0;  ///< time at which it takes hold [s]; the vertices are free before it
  PoseMotion rigid;   ///< in place of `motion`: they move as a rigid body

  bool moves() const { return motion || rigid; }
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

/// All constraints of a body; a component belongs to one of them at most.
class Constraints {
 public:
  explicit Constraints(std::size_t vertex_count) : held_(3 * vertex_count, 0) {}

  /// @throws std::invalid_argument for an empty set, a vertex out of range or a component held already
  ConstraintId add(Constraint constraint);

  /// Lets new vertices, numbered on from the last, follow what holds the vertices they are copies of.
  /// @return per constraint: which of its vertices have copies, as positions in its list; the copies come last in it
  std::vector<std::vector<std::size_t>> add_copies(std::span<const std::uint32_t> origins);

  /// What came with splits. @throws std::runtime_error where what is read held or drove other vertices before
  /// @param vertices  of the body
  void archive(Archive& ar, std::size_t vertices);

  std::span<const Constraint> all() const { return all_; }
  const Constraint& at(ConstraintId id) const;
  bool holds(std::size_t vertex, std::size_t axis) const { return held_[3 * vertex + axis] != 0; }

 private:
  std::vector<Constraint> all_;
  std::vector<char> held_;  ///< per vertex component
};

inline bool has_axis(const Axes& axes, std::size_t axis) { return axis == 0 ? axes.x : (axis == 1 ? axes.y : axes.z); }

/// The components of `v` along `axes`, the others 0.
Vec3d masked(const Vec3d& v, const Axes& axes);

}  // namespace glisson

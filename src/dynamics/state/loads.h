// loads.h — gravity and forces from outside, per vertex.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// Forces spread over vertex sets, each with its own course in time.
class Loads {
 public:
  explicit Loads(std::size_t vertex_count) : force_(vertex_count) {}

  /// @throws std::invalid_argument for an empty set, a vertex out of range or a force that is not finite
  void add(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale);

  /// New vertices, numbered on from the last, share the loads of those they are copies of by equal parts.
  void add_copies(std::span<const std::uint32_t> origins);

  /// What came with splits. @throws std::runtime_error where what is read loaded other vertices before
  /// @param vertices  of the body
  void archive(Archive& ar, std::size_t vertices);

  /// Forces at time t [N], one per vertex.
  std::span<const Vec3d> at(double time);

 private:
  struct Load {
    std::vector<std::uint32_t> vertices;
    std::vector<double> share;  ///< of `force`, per vertex
    Vec3d force;
    std::function<double(double)> scale;
  };
  std::vector<Load> loads_;
  std::vector<Vec3d> force_;
};

}  // namespace glisson

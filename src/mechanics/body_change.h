// body_change.h — removing elements from a body and splitting it along faces, while it moves.
//
// Numbers stay: an element that is removed keeps its number and has no volume, stiffness or mass from then on;
// a vertex that is doubled gets its copy at the end. So whoever holds numbers of tets or vertices may go on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mechanics/body.h"
#include "mesh/split_faces.h"
#include "mesh/vertex_stars.h"

namespace glisson {

/// What has become different in a body.
struct BodyChange {
  std::vector<std::uint32_t> removed;         ///< elements, ascending
  std::vector<detail::CornerChange> corners;  ///< of elements: corners that hold another vertex now
  std::vector<std::uint32_t> origins;         ///< the last vertices are copies of these
  std::vector<std::uint32_t> touched;         ///< vertices with another mass than before, new ones included; ascending
};

/// Changes a body and keeps the tets around each vertex at hand for it.
class BodyChanger {
 public:
  /// @param body  must outlive this; changed by nobody else
  /// Cost: O(tets), 30 bytes a tet.
  explicit BodyChanger(Body& body);

  const detail::VertexStars& stars() const { return stars_; }
  bool is_removed(std::uint32_t mesh_tet) const { return quarter_masses_[element_of_[mesh_tet]] == 0.0; }
  /// Split faces that are closed still, all their vertices being at the rim of the cut.
  std::size_t closed_faces() const { return closed_.size(); }

  /// Elements of tets of the mesh, ascending, without those that are gone already.
  /// @throws std::invalid_argument for a number that is no tet's
  std::vector<std::uint32_t> living_elements(std::span<const std::uint32_t> mesh_tets) const;

  /// Takes elements out.
  /// @param elements  as living_elements gives them
  BodyChange remove(std::span<const std::uint32_t> elements);

  /// Opens the body along inner faces (mesh/split_faces.h).
  /// @param faces  three vertices each
  /// @throws std::invalid_argument as plan_split; nothing is changed then
  BodyChange split(std::span<const Triangle> faces);

 private:
  void weigh(std::vector<std::uint32_t>& vertices);

  Body& body_;
  detail::VertexStars stars_;
  std::vector<std::uint32_t> element_of_;
  /// Of each element [kg], 0 where it is removed; side by side, since a change sums many.
  std::vector<double> quarter_masses_;
  std::vector<Triangle> closed_;
};

}  // namespace glisson

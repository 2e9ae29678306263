// body_change.h — removing elements from a body, moving its vertices at rest and splitting it along faces, while it moves.
//
// Numbers stay: an element that is removed keeps its number and has no volume, stiffness or mass from then on;
// a vertex that is doubled gets its copy at the end. So whoever holds numbers of tets or vertices may go on.
// A vertex that is moved at rest goes to another point of the material; the material stays where it is, so that the
// vertex takes displacement and velocity of that point.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "element/body.h"
#include "glisson/archive.h"
#include "mesh/cut/split_faces.h"
#include "mesh/topology/vertex_stars.h"

namespace glisson {

/// A vertex that is another point of the material from now on, and its state there.
struct MovedVertex {
  std::uint32_t vertex = 0;
  Vec3d displacement;  ///< [m]
  Vec3d velocity;      ///< [m/s]
};

/// What has become different in a body.
struct BodyChange {
  std::vector<std::uint32_t> removed;         ///< elements, ascending
  std::vector<detail::CornerChange> corners;  ///< of elements: corners that hold another vertex now
  std::vector<std::uint32_t> origins;         ///< the last vertices are copies of these
  std::vector<std::uint32_t> touched;         ///< vertices with another mass than before, new ones included; ascending
  std::vector<std::uint32_t> reshaped{};      ///< elements with another shape at rest; ascending
  std::vector<MovedVertex> moved{};           ///< before copies are made
};

/// Barycentric coordinates of a point of the material in an element at rest.
std::array<double, 4> weights_at(const Body& body, std::uint32_t element, const Vec3d& point);

/// An element and where in it a point is.
struct Located {
  std::uint32_t element = 0;
  std::array<double, 4> weights{};
};
/// The element in which a point of the material lies, or from which it is least outside (by its smallest weight).
/// @param elements  not empty
Located locate(const Body& body, std::span<const std::uint32_t> elements, const Vec3d& point);

/// Displacement and velocity of a vertex.
using StateOf = std::function<std::pair<Vec3d, Vec3d>(std::uint32_t)>;

/// Changes a body and keeps a list of the tets around each vertex for it.
class BodyChanger {
 public:
  /// @param body  must outlive this; changed by nobody else; elements without volume have been removed
  /// Cost: O(tets), 30 bytes a tet.
  explicit BodyChanger(Body& body);

  const detail::VertexStars& stars() const { return stars_; }
  bool is_removed(std::uint32_t mesh_tet) const { return quarter_masses_[element_of_[mesh_tet]] == 0.0; }
  /// Split faces that are closed still, all their vertices being at the rim of the cut.
  std::size_t closed_faces() const { return closed_.size(); }
  const std::vector<Triangle>& closed() const { return closed_; }
  void set_closed(std::vector<Triangle> faces) { closed_ = std::move(faces); }

  /// Elements of tets of the mesh, ascending, without those that are gone already.
  /// @throws std::invalid_argument for a number that is no tet's
  std::vector<std::uint32_t> living_elements(std::span<const std::uint32_t> mesh_tets) const;

  /// Takes elements out.
  /// @param elements  as living_elements gives them
  BodyChange remove(std::span<const std::uint32_t> elements);

  /// Opens the body along inner faces (mesh/cut/split_faces.h).
  /// @param faces  three vertices each
  /// @throws std::invalid_argument as plan_split; nothing is changed then
  BodyChange split(std::span<const Triangle> faces) { return cut(faces, {}, {}); }

  /// Moves vertices at rest, one after the other, and then opens the body along faces.
  /// @param state  of a vertex before the change
  /// @throws std::invalid_argument as plan_split, and naming a vertex that is none, goes to no finite place, or turns a tet
  ///         over; nothing is changed then
  BodyChange cut(std::span<const Triangle> faces, std::span<const VertexMove> moves, const StateOf& state);
  /// What elements weigh has changed in the body.
  void masses_changed();
  /// What the body does not show: split faces that are closed. @throws std::runtime_error where they are none of its vertices
  void archive(Archive& ar);
  /// Elements around vertices that are to be moved, ascending.
  std::vector<std::uint32_t> elements_around(std::span<const VertexMove> moves) const;

 private:
  void weigh(std::vector<std::uint32_t>& vertices);
  void require_moves(std::span<const VertexMove> moves);
  void place(const VertexMove& move);
  void move(std::span<const VertexMove> moves, const StateOf& state, BodyChange& change);

  Body& body_;
  detail::VertexStars stars_;
  std::vector<std::uint32_t> element_of_;
  /// Of each element [kg], 0 where it is removed; side by side, since a change sums many.
  std::vector<double> quarter_masses_;
  std::vector<Triangle> closed_;
};

}  // namespace glisson

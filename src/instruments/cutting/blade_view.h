// blade_view.h — a body as a blade meets it: where the points of the material are that were the mesh's vertices at first.
//
// Vertices are moved onto a cut while it is made. Were crossings looked for on the mesh so changed, each would be a
// borderline case: the blade goes on through vertices that lie on its path. So it meets the mesh as it was before any
// move: a vertex that was moved is sought where its first point of the material is now, in one of the tets around it.
// Each point is shifted by a millionth of a tet, another way at each, so that no edge meets a blade exactly at its end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/schemes/scheme.h"
#include "glisson/instruments/cutting.h"
#include "mesh/cut/cut_sheet.h"

namespace glisson {

class BladeView {
 public:
  explicit BladeView(Scheme& scheme);

  /// Takes in vertices that have come since the last call.
  void follow_copies();
  /// The present positions become those before.
  void step_on() { before_ = now_; }
  /// Finds the positions at displacements of the vertices [m]: the present ones.
  void look(const BladeEdge& from, const BladeEdge& to, std::span<const Vec3d> u);

  /// Edges of the mesh that the blade crosses on its way, while the body goes from its positions before to the present.
  std::vector<detail::EdgeCrossing> crossings(const BladeEdge& from, const BladeEdge& to);
  /// Elements near the blade by their present and former positions.
  const std::vector<std::uint32_t>& near() const { return near_; }

  std::span<const Vec3d> first_rest() const { return first_; }
  std::span<const Vec3d> now() const { return now_; }
  std::span<const std::uint32_t> root() const { return root_; }
  double typical_edge() const { return typical_edge_; }

  void archive(Archive& ar);

 private:
  Vec3d position(std::uint32_t vertex, const Vec3d& displacement, std::span<const Vec3d> u, bool near) const;
  void find_near(const Vec3d& low, const Vec3d& high);

  Scheme& scheme_;
  double typical_edge_ = 0.0, longest_edge_ = 0.0;
  std::vector<std::uint32_t> root_;  ///< per vertex: the one it is a copy of, first of all
  std::vector<Vec3d> first_;         ///< per vertex: its first place at rest, shifted a little [m]
  std::vector<Vec3d> before_, now_;  ///< where that point of the material was and is [m]
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint32_t> near_;
};

}  // namespace glisson

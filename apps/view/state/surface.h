// surface.h — the skin of a body, and what a frame says of it: places in 16 bits, a field in 8.
//
//   keyframe   rest positions, marks, triangles and what they are, surfaces of inner regions; sent when the skin becomes another
//   frame      displacement from the keyframe as 16-bit fractions of the largest, a field as 8-bit fractions of its range:
//              7 bytes a vertex, an error of 1.5e-5 of the largest displacement
//
// A frame needs its keyframe and no other frame, so any of them can be dropped.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/state/command.h"
#include "view/state/snapshot.h"

namespace glisson::view {

/// Of the box about a mesh [m].
double diagonal(const TetMesh& mesh);

class Surface {
 public:
  /// @param whole  with the tets and all vertices inside, which come last
  explicit Surface(std::shared_ptr<const BodyShape> shape, bool whole = false);

  const BodyShape& shape() const { return *shape_; }
  std::size_t size() const { return vertices_.size(); }
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }  ///< in surface vertices
  const std::vector<std::uint8_t>& kinds() const { return kinds_; }           ///< SurfaceKind of each triangle
  struct Region {
    std::string name;
    std::vector<std::uint32_t> triangles;  ///< in surface vertices
  };
  const std::vector<Region>& regions() const { return regions_; }  ///< inside the body
  /// In surface vertices, four each; empty unless it is whole.
  const std::vector<std::uint32_t>& tets() const { return tets_; }
  const std::string& tissue() const { return tissue_; }  ///< name of the largest region
  /// Mesh vertex of a surface vertex.
  std::uint32_t mesh_vertex(std::size_t i) const { return vertices_[i]; }
  /// 1 held, 2 driven, 0 free or inside.
  std::uint8_t mark(std::size_t i) const { return i < outer_ ? shape_->marks[vertices_[i]] : std::uint8_t{0}; }
  const Vec3d& rest(std::size_t i) const { return shape_->mesh.vertices[vertices_[i]]; }

  /// Displacements beyond are drawn there [m]: a piece that was cut free flies on for ever where nothing damps it, and with 10 m
  /// for the largest one the 16 bits of the others would be 0.3 mm each. Ten diagonals of the body at rest.
  double rim() const { return rim_; }
  /// Whether some of the surface has left for beyond the rim.
  bool strays(const Snapshot& state) const;
  std::size_t pieces() const { return pieces_; }  ///< that the body is in

  /// A field at each surface vertex: the contact pressure [Pa], or the mean over the tets around it of s [-], q [-],
  /// p = −⅓ tr σ or von Mises' stress of the stress that makes the forces [Pa]. Cost: a pass over the tets at the surface;
  /// stress makes a body of them first, and where tets share their volume change of those that touch them, too.
  std::vector<double> field(Field field, const Snapshot& state);

 private:
  void number_vertices();
  void number_inside();
  std::uint32_t number_of(std::uint32_t vertex);
  std::vector<std::uint32_t> numbered(const std::vector<Triangle>& triangles);
  void count_pieces();
  template <class OfTet>
  std::vector<double> mean(OfTet of_tet) const;
  std::vector<double> of_stress(Field field, const Snapshot& state);
  std::vector<double> of_record(Field field, const Snapshot& state) const;

  struct NearTet {
    Tet tet;
    std::uint32_t number = 0;        ///< in the shape's mesh
    std::array<Vec3d, 3> gradients;  ///< ∂N/∂X of its vertices 1, 2, 3 [1/m]
  };
  std::shared_ptr<const BodyShape> shape_;
  std::vector<std::uint32_t> vertices_, triangles_, tets_;
  std::vector<std::uint8_t> kinds_;
  std::vector<Region> regions_;
  std::string tissue_;
  std::size_t outer_ = 0;              ///< vertices at the boundary
  std::vector<std::uint32_t> number_;  ///< surface vertex of each mesh vertex, or none
  std::vector<NearTet> near_;          ///< tets with a vertex at the surface
  std::vector<double> tets_around_;    ///< of each surface vertex
  std::size_t pieces_ = 0;
  double rim_ = 0.0;
  std::shared_ptr<const std::map<int, Tissue>> tissues_;  ///< that near_fields_ are of
  std::optional<PartFields> near_fields_;                 ///< of the tets with a vertex at the surface
};

}  // namespace glisson::view

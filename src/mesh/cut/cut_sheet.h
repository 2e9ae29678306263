// cut_sheet.h — which faces part when a blade passes through a mesh: a cut as topology, crossing by crossing.
//
//            ╱╲              edges crossed so far are kept with each tet, in the material, until the blade has gone
//       ── ╱─×─×── ▸         through: then its corners fall in two groups, and it goes with one of them
//         ╱______╲
//
//   A crossed edge has one end on the cut: the nearer one, unless the other is on it already. So each tet gone through has
//   one group of corners that are all on the cut, and stays with the other group. Faces part
//     · between two tets gone through that stay with different groups at the face they share, all of whose corners are
//       on the cut then,
//     · where a tet has left a face, all of whose corners are on the cut, to the neighbour beyond.
//   What is on one side of the blade's path is so parted from what is on the other, whatever the geometry: the set of faces
//   has no gaps. How near it lies to the path is a matter of moving the corners that are on the cut onto it (cut_snap.h).
//
// Crossings are taken in the order of time, each tet settled when it is gone through and never again, so that a path in
// many steps parts the same faces as one in few. A tet that would hang on nothing goes with its neighbours instead.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "glisson/archive.h"
#include "glisson/mesh.h"
#include "mesh/topology/vertex_stars.h"

namespace glisson::detail {

/// Corners of a tet's six edges.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kEdgeCorners{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// An edge of the mesh that the blade has passed.
struct EdgeCrossing {
  std::uint32_t low = 0, high = 0;  ///< its vertices, low < high
  double at = 0.0;                  ///< from low to high, 0 … 1
  double time = 0.0;
};

/// A tet that the blade has reached.
struct CutTet {
  static constexpr double kNotCrossed = -1.0;
  std::uint32_t tet = 0;
  std::array<double, 6> at{kNotCrossed, kNotCrossed, kNotCrossed, kNotCrossed, kNotCrossed, kNotCrossed};
  bool through = false;    ///< the blade has gone through
  std::uint8_t stays = 0;  ///< the corners, a bit each, that it stays with
  bool crossed(std::size_t edge) const { return at[edge] != kNotCrossed; }
  void archive(Archive& ar);
};

/// What crossings have led to.
struct CutFaces {
  std::vector<Triangle> faces;         ///< that part
  std::vector<std::uint32_t> through;  ///< tets that were gone through
};

class CutSheet {
 public:
  CutSheet(std::size_t tets, std::size_t vertices) : place_of_(tets, kNone), on_cut_(vertices, 0) {}

  /// Takes crossings in.
  /// @param tets   as they are now; those in `stars` live
  /// @param crossings  one at most of each edge
  CutFaces take(std::span<const Tet> tets, const VertexStars& stars, std::vector<EdgeCrossing> crossings);

  /// New vertices, numbered on from the last: copies of these.
  void add_copies(std::span<const std::uint32_t> origins);

  /// The next crossings are of another cut. A crossing near one of a cut before is taken to be at the same place, so that
  /// going over a cut again opens nothing.
  void begin_another();

  /// None where the blade has not reached the tet.
  const CutTet* find(std::uint32_t tet) const { return place_of_[tet] == kNone ? nullptr : &cut_[place_of_[tet]]; }

  /// All that is kept. @throws std::runtime_error where what is read is not that of such a mesh
  void archive(Archive& ar);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Mesh {
    std::span<const Tet> tets;
    const VertexStars& stars;
  };

  CutTet& record(std::uint32_t tet);
  const CutTet* earlier(std::uint32_t tet) const;
  double as_before(std::span<const std::uint32_t> around, const Mesh& mesh, const EdgeCrossing& crossing) const;
  std::uint8_t stayed_before(const CutTet& cut, std::uint8_t one) const;
  void settle(const Mesh& mesh, std::uint32_t tet, CutFaces& out);
  std::uint8_t cover(const Tet& tet, const CutTet& cut, std::uint8_t one);
  void put_on_cut(const Tet& tet, std::uint8_t corners);
  bool parts(const Mesh& mesh, std::uint32_t tet, std::uint32_t other, const Triangle& face) const;
  bool hangs_on(const Mesh& mesh, std::uint32_t tet) const;
  bool all_hang_on(const Mesh& mesh, std::uint32_t tet) const;

  std::vector<std::uint32_t> place_of_;  ///< per tet: in cut_
  std::vector<CutTet> cut_, before_;     ///< of this cut; of those before, ascending by tet
  std::vector<char> on_cut_;             ///< per vertex
};

}  // namespace glisson::detail

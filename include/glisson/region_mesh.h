// region_mesh.h — tetrahedra for several regions that functions of a point describe.
//
// A region is a function: negative inside, positive outside, of the size of the distance to its surface near it. Shapes
// (glisson/implicit.h), formulas and, by a distance to each label, images can all be written so. Where regions overlap, the
// first in the list wins: tumour over vessel over parenchyma.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/mesh_size.h"

namespace glisson {

/// An axis-aligned box [m].
struct Bounds {
  Vec3d min{}, max{};
};

/// A part of the body.
struct BodyRegion {
  std::string name;
  /// Negative inside [m]. May not fall short of the distance to the surface by much near it, nor exceed it outside.
  /// Called from one thread.
  std::function<double(const Vec3d&)> distance;
  Bounds bounds;      ///< holds the whole region [m]
  bool hole = false;  ///< stays empty, and takes precedence like a region
};

struct RegionMeshOptions {
  double edge = 0.005;              ///< mean length of the edges [m], > 0
  std::size_t max_tets = 20000000;  ///< more are refused before any memory is taken, 1 to 10⁹
  /// Called repeatedly with the fraction done, 0 to 1; returning false stops the work.
  std::function<bool(double)> progress{};
  std::vector<MeshSize> sizes{};  ///< places with shorter edges; where they overlap, the shortest counts
  double growth = kGrowth;        ///< edge over distance at which edges grow away from these [-], 0.05 to 1
  /// Wanted edge at a point [m]; the shortest of it, `sizes` and `edge` counts. Finite, at least 1/256 of `edge`. Called for points in
  /// the box of the body and up to two edges beyond, from one thread. Empty: `edge` and `sizes` alone.
  std::function<double(const Vec3d&)> size_at{};

  template <class Take>
  static constexpr auto fields(Take take) {
    using R = RegionMeshOptions;
    return take(edge_field<R>(), max_tets_field<R>(), no_key("progress", &R::progress), sizes_field<R>(),
                growth_field<R>(), no_key("size_at", &R::size_at));
  }
};

/// Result for a region.
struct RegionVolume {
  std::string name;
  int number = 0;  ///< in TetMesh::regions: the place in the list of regions, from 1
  std::size_t tets = 0;
  double volume = 0.0;  ///< [m³]
};

/// The figures of a mesh of regions.
struct RegionMeshReport {
  double min_dihedral_deg = 0.0, max_dihedral_deg = 0.0;
  double seconds = 0.0;
  std::vector<RegionVolume> regions;     ///< holes left out, in the order of the list
  std::vector<std::uint32_t> poor_tets;  ///< with a dihedral angle below 10° or above 165°
  std::vector<std::string> warnings;     ///< one sentence each, with the way out
};

struct RegionMesh {
  TetMesh mesh;  ///< region k of the list has number k + 1 and its name
  RegionMeshReport report;
};

/// Thrown when `progress` returns false.
class MeshingStopped : public std::runtime_error {
 public:
  MeshingStopped() : std::runtime_error("the mesher was stopped") {}
};

/// Thrown when a region is left without a tet.
class RegionLost : public std::invalid_argument {
 public:
  RegionLost(std::string region, const std::string& what) : std::invalid_argument(what), name(std::move(region)) {}
  std::string name;
};

/// Meshes regions by a body-centred lattice whose vertices are drawn onto the interfaces and whose edges are cut at the
/// interfaces, then improves the tets until all dihedral angles are between 10° and 165°.
///                                                   [LabelleShewchuk2007; BronsonLevineWhitaker2012]
/// Interfaces are shared: the tets of two regions meet in common faces. Parts thinner than two edges may be lost.
/// Same input, same bytes.
/// @throws std::invalid_argument  naming the region or option, its value and the way out: no region, an edge that is not
///   positive or longer than a region is wide, regions that are empty, a value of `size_at` that is out of range, more than max_tets or
///   than there is memory for
/// @throws RegionLost, an invalid_argument  where a region is too thin for the edge, or covered by others
/// @throws MeshingStopped  when `progress` returns false
/// Cost: some 10 µs and 150 bytes a tet, up to 100 µs where many thin parts meet.
RegionMesh mesh_regions(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options);

/// The wanted edge at the centre of each tet of a mesh [m].
/// @throws std::invalid_argument  as mesh_regions, for edge, sizes, growth and size_at
std::vector<double> edges_asked(const TetMesh& mesh, const std::vector<BodyRegion>& regions,
                                const RegionMeshOptions& options);

}  // namespace glisson

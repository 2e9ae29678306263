// mesh.h — tetrahedral meshes: the type, the generators, the surface, the inspection.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson {

using Tet = std::array<std::uint32_t, 4>;
using Triangle = std::array<std::uint32_t, 3>;

/// A conforming tetrahedral mesh at rest, with named vertex sets and tet regions.
///
/// Tetrahedra are positively oriented: (x1−x0)·((x2−x0)×(x3−x0)) > 0.
struct TetMesh {
  std::vector<Vec3d> vertices;                                    ///< rest positions [m]
  std::vector<Tet> tets;                                          ///< four vertex indices each
  std::vector<int> regions;                                       ///< region number of each tet; empty: all in region 0
  std::map<int, std::string> region_names;                        ///< names of regions, where the file gives them
  std::map<std::string, std::vector<std::uint32_t>> vertex_sets;  ///< sorted vertex indices
  std::vector<Vec3d> fibres{};  ///< direction of each tet's fibres, any length, 0 for none; empty: the tissue's

  /// A set by its name. @throws std::invalid_argument naming the sets there are
  const std::vector<std::uint32_t>& vertex_set(const std::string& name) const;
  int region_of(std::size_t tet) const { return regions.empty() ? 0 : regions[tet]; }
  bool operator==(const TetMesh&) const = default;
};

/// A vertex and its new rest position.
struct VertexMove {
  std::uint32_t vertex = 0;
  Vec3d rest{};  ///< [m]
};

/// Six times the signed rest volume of a tetrahedron [m³].
double six_rest_volume(const TetMesh& mesh, std::size_t tet);

/// Total rest volume [m³].
double volume(const TetMesh& mesh);

/// Mean ratio of a tetrahedron, 12 (3V)^⅔ / Σ l² in (0, 1], 1 for the regular one, 0 where V ≤ 0.
///                                                                        [LiuJoe1994, eq. 1]
double regular_mean_ratio(const TetMesh& mesh, std::size_t tet);

/// The dihedral angles of a tet at its edges 01, 02, 03, 12, 13, 23 [degrees].
std::array<double, 6> dihedral_angles(const TetMesh& mesh, std::size_t tet);

/// Counts of the dihedral angles of all tets, six each, in bins of `bin_deg` degrees from 0° to 180°.
std::vector<std::size_t> dihedral_histogram(const TetMesh& mesh, double bin_deg = 10.0);

/// How a cube is split into six tetrahedra.
enum class BoxSplit { kuhn, alternating };
template <>
inline constexpr Word<BoxSplit> kWords<BoxSplit>[] = {
    {"kuhn", BoxSplit::kuhn, "every cube along its (0,0,0)–(1,1,1) diagonal"},
    {"alternating", BoxSplit::alternating, "mirrored in every second cube, no preferred diagonal"}};

struct BoxOptions {
  std::array<int, 3> cells{4, 4, 8};  ///< cubes along x, y, z; 1 or more each
  Vec3d size{0.04, 0.04, 0.08};       ///< edge lengths [m]
  Vec3d origin{0.0, 0.0, 0.0};        ///< lowest corner [m]
  BoxSplit split = BoxSplit::kuhn;

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("cells", &BoxOptions::cells, between(1, 10000), "cubes along x, y and z"),
                field("size", &BoxOptions::size, "m", above(0), "edge lengths of the box"),
                field("origin", &BoxOptions::origin, "m", "lowest corner"),
                field("split", &BoxOptions::split, "how a cube is split in six"));
  }
  Fault check() const;
};

/// A box of cubes split in six tetrahedra each, with the vertex sets x_min, x_max, y_min, y_max,
/// z_min, z_max. The default is the mesh of the paper's figure 1: 225 vertices, 768 tetrahedra.
/// @throws std::invalid_argument naming the option, its value and the allowed range
TetMesh box_mesh(const BoxOptions& options);

struct CylinderOptions {
  double radius = 0.05;  ///< [m]
  double height = 0.06;  ///< [m]; axis along z from z = 0
  int radial_cells = 8;  ///< rings of cells from axis to wall, 1 or more
  int axial_cells = 8;   ///< layers, 1 or more
  double grading = 1.0;  ///< width of the outermost ring over that of the innermost

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("radius", &CylinderOptions::radius, "m", above(0), "radius"),
        field("height", &CylinderOptions::height, "m", above(0), "height"),
        field("radial_cells", &CylinderOptions::radial_cells, between(1, 2000), "rings from the axis to the wall"),
        field("axial_cells", &CylinderOptions::axial_cells, between(1, 10000), "layers along the axis"),
        field("grading", &CylinderOptions::grading, "-", between(1, 10000),
              "width of the outermost ring over that of the innermost")
            .advise("1 makes all rings equally wide"));
  }
  Fault check() const;
};

/// A cylinder about the z axis, rings graded toward the axis, with the vertex sets bottom, top, wall, axis.
/// @throws std::invalid_argument naming the option, its value and the allowed range
TetMesh cylinder_mesh(const CylinderOptions& options);

/// The boundary triangles of a mesh, outward oriented, in vertex numbers of the mesh and the order of its tets.
/// @throws std::invalid_argument as inspect
std::vector<Triangle> boundary_triangles(const TetMesh& mesh);

/// Per vertex: 1 where it belongs to a tet; others have no mass and bear nothing.
std::vector<char> vertices_in_tets(const TetMesh& mesh);

/// Lowest and highest corner of the box around the tets of a mesh [m]. The mesh has at least one.
std::pair<Vec3d, Vec3d> box_of(const TetMesh& mesh);

/// Content and defects of a mesh; `warnings` describes the defects in sentences.
struct MeshReport {
  std::size_t vertices = 0, tets = 0, boundary_triangles = 0;
  Vec3d box_min, box_max;                                  ///< bounding box of the vertices in use [m]
  double volume = 0.0;                                     ///< [m³]
  double worst_mean_ratio = 0.0, median_mean_ratio = 0.0;  ///< regular_mean_ratio; 1 is best
  std::size_t worst_tet = 0;
  std::vector<std::uint32_t> reoriented_tets;  ///< were inverted in the file, now reoriented
  std::vector<std::uint32_t> duplicate_tets;   ///< same four vertices as an earlier tet
  std::vector<std::uint32_t> degenerate_tets;  ///< zero volume or a vertex twice
  std::vector<std::uint32_t> unused_vertices;  ///< in no tet
  std::size_t non_manifold_faces = 0;          ///< faces shared by more than two tets
  std::size_t pieces = 0;                      ///< face-connected components
  std::vector<std::string> warnings;           ///< one sentence each, with element numbers and a remedy
};

/// Examines a mesh without changing it (reoriented_tets then lists tets with negative volume).
/// @throws std::invalid_argument for a vertex number out of range or regions of another length than tets
/// Cost: about 0.3 s and 80 bytes a tet for a million tets.
MeshReport inspect(const TetMesh& mesh);

/// Reorients inverted tets and then inspects; every reader calls it before it returns a mesh. @throws as inspect
MeshReport orient_and_inspect(TetMesh& mesh);

/// @throws std::invalid_argument with the first index, size or orientation at fault
void require_valid(const TetMesh& mesh);

}  // namespace glisson

// io.h — reads meshes, writes meshes and frames. Links VTK; the core library never does.
// The functions may be called from several threads at once, each for its own file.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "glisson/mesh.h"

namespace glisson {

/// A file that cannot be used: what() gives file, line or element, the value, and what to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ImportedMesh {
  TetMesh mesh;
  MeshReport report;
};

/// Reads a tetrahedral mesh: .vtu, .vtk (legacy), .msh (Gmsh 2.2 and 4.1, ASCII and binary), .inp (Abaqus). Named groups of the file
/// (Gmsh physical names; integer cell arrays such as "region") become regions and vertex sets: in VTK files the cell
/// array "region", the point arrays "set:NAME" and the field arrays "region:NAME" that write_vtu writes. A cell array
/// "fibre" (also "fibres", "fiber", "fibers", "fibre_direction") of three components gives TetMesh::fibres. Cells that
/// are not tets of 4 or 10 nodes, these by their corners, are skipped and counted in the report; inverted tets are reoriented and reported.
/// Degenerate or duplicate tets are kept and reported. A frame of a run gives the body at rest, and the report says so.
/// @param scale  factor applied to all coordinates (0.001 for a file in millimetres), > 0; none: 1, or 0.001 where the body would be
///   more than 2 m across, which the report says
/// @throws FileError if the file cannot be used as it is
ImportedMesh read_mesh(const std::filesystem::path& file, std::optional<double> scale = 1.0);

/// The output of `glisson info MESH`: counts, box, extent, volume, shape, pieces and warnings, one per line.
/// @param name  the file, as the user wrote it
/// @param mesh  if given, its regions and vertex sets are listed too
std::string format_report(const std::string& name, const MeshReport& report, const TetMesh* mesh = nullptr);

/// A field on the vertices or tets of a mesh, `components` numbers each (1, 3 or 9).
struct Field {
  std::string name;  ///< with its unit, e.g. "displacement_m"
  int components = 1;
  std::vector<double> values;
  bool single = false;  ///< whether files keep it in single precision
};

/// Writes a .vtu (binary, appended) with the mesh's regions and vertex sets and the given fields.
/// @param positions  current vertex positions [m], as many as mesh.vertices; empty: rest positions
void write_vtu(const std::filesystem::path& file, const TetMesh& mesh, std::span<const Vec3d> positions = {},
               std::span<const Field> vertex_fields = {}, std::span<const Field> tet_fields = {});

/// Writes a .vtp of triangles in space, such as a tool's surface [m].
/// @throws std::invalid_argument for a triangle of a point that does not exist
void write_vtp(const std::filesystem::path& file, std::span<const Vec3d> points, std::span<const Triangle> triangles);

/// Writes a .pvd collection of (time [s], file relative to the .pvd). Replaces the file atomically, so an
/// interrupted run leaves a readable collection of the frames written so far.
void write_pvd(const std::filesystem::path& file, std::span<const std::pair<double, std::filesystem::path>> frames);

/// Reads such a collection, up to the first missing time or file, or file outside the collection's folder.
/// @throws FileError if the file cannot be read or is not a collection
std::vector<std::pair<double, std::filesystem::path>> read_pvd(const std::filesystem::path& file);

/// A frame as write_vtu wrote it.
struct ReadFrame {
  TetMesh mesh;  ///< as stored: in frames of a run at rest [m], with the array displacement_m
  std::vector<Field> vertex_fields, tet_fields;
  std::vector<std::string> arrays{};  ///< names of those of the file, on vertices and then on tets, without sets
};
/// Reads a .vtu that has only tetrahedra, without changes, and those of the named fields that it has.
/// @throws FileError if the file cannot be used as it is
ReadFrame read_frame(const std::filesystem::path& file, std::span<const std::string> fields);

}  // namespace glisson

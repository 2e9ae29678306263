// raw_mesh.h — what a format's reader hands on, before the checks that are the same for every format.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "glisson/io.h"

namespace glisson::detail {

/// A tet of ten nodes: its corners, and the nodes in the middles of its edges 01, 12, 02, 03, 13, 23.
struct CurvedTet {
  Tet corners{};
  std::array<std::uint32_t, 6> middles{};
};

/// A mesh as the file gives it: tets possibly inverted, coordinates not yet scaled.
struct RawMesh {
  TetMesh mesh;
  std::map<std::string, std::size_t> skipped;    ///< kind of cell → how many were left out
  std::vector<CurvedTet> curved;                 ///< those whose corners are among the tets of the mesh
  std::vector<std::string> notes;                ///< sentences for the report
  std::vector<Field> vertex_fields, tet_fields;  ///< those that were asked for
  std::vector<std::string> arrays;               ///< names of all that could be asked for
};

/// @throws FileError "NAME: WHAT"
[[noreturn]] void fail(const std::string& name, const std::string& what);

/// All of a file. @throws FileError
std::string read_bytes(const std::filesystem::path& file);

/// Scales, checks, turns inverted tets and reports.
/// @param name   the file as the user wrote it
/// @param scale  > 0, or none as read_mesh has it
/// @throws FileError for coordinates that are not finite, vertex numbers out of range, no tetrahedra
ImportedMesh finish_import(RawMesh raw, const std::string& name, std::optional<double> scale);

/// The reader of each format, from the bytes of a file. @throws FileError
RawMesh read_gmsh(std::string_view bytes, const std::string& name);
RawMesh read_vtu(std::string_view bytes, const std::string& name);
/// @param fields  names of arrays to read besides
RawMesh read_vtu_with(std::string_view bytes, const std::string& name, std::span<const std::string> fields);
RawMesh read_legacy_vtk(std::string_view bytes, const std::string& name);
RawMesh read_abaqus(std::string_view bytes, const std::string& name);

/// Reads a mesh from memory as if it were the file `name`, whose ending tells the format. @throws as read_mesh
ImportedMesh read_mesh_bytes(std::string_view bytes, const std::string& name, std::optional<double> scale = 1.0);

}  // namespace glisson::detail

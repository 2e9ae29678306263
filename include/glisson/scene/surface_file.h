// surface_file.h — closed surfaces of triangles from .stl, .obj and .ply.
#pragma once

#include <filesystem>
#include <vector>

#include "glisson/implicit.h"
#include "glisson/mesh.h"

namespace glisson {

/// A surface as a file has it: closed or not, points as often as they are written.
struct TriangleSurface {
  std::vector<Vec3d> points;  ///< [m]
  std::vector<Triangle> triangles;
};

/// Whether a name ends as one of the formats that read_surface knows.
bool is_surface_file(const std::filesystem::path& file);

/// Reads .stl (text and binary), .obj (polygons as fans) or .ply (text and binary).
/// @param scale  factor on coordinates, > 0; 0.001 for a file in millimetres
/// @throws std::invalid_argument  `FILE:LINE: what is wrong and the way out`, in binary files `FILE, byte N: …`: a file that is missing,
///   empty or cut off, of another ending, that says other than its format allows, numbers that are not finite, no triangles
TriangleSurface read_surface(const std::filesystem::path& file, double scale = 1.0);

/// The body within it, closed by repair_surface where it does not close.
/// @throws as read_surface and, with the file's name, as repair_surface and surface_solid
SurfaceShape load_surface(const std::filesystem::path& file, double scale = 1.0);

}  // namespace glisson

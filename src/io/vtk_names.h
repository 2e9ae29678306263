// vtk_names.h — the names under which a TetMesh's regions and sets travel in VTK files.
#pragma once

#include <string>
#include <string_view>

namespace glisson::detail {

/// Integer cell arrays taken as region numbers, the first one that a file has. Ours is the first; the others are what
/// meshio, Gmsh, Medit, Abaqus and FEBio exports are called.
inline constexpr const char* kRegionArrays[] = {"region",       "Region",   "regions",   "gmsh:physical", "medit:ref",
                                                "MaterialIds",  "material", "Material",  "material_id",   "MaterialID",
                                                "ElementBlock", "part_id",  "cell_tags", "subdomain"};

/// Cell arrays of three components taken as directions of fibres, ours first.
inline constexpr const char* kFibreArrays[] = {"fibre",  "fibres",          "fiber",
                                               "fibers", "fibre_direction", "fiber_direction"};

/// Frames of runs have this point array, meshes do not.
inline constexpr std::string_view kDisplacementArray = "displacement_m";

/// Point arrays "set:NAME" hold 1 for the vertices in the set and 0 for the others.
inline constexpr std::string_view kSetPrefix = "set:";

/// Field arrays "region:NAME" hold the numbers of the regions of that name.
inline constexpr std::string_view kRegionNamePrefix = "region:";

/// A user's name with % and what XML cannot hold as it is written %XX: VTK leaves the names of field arrays bare.
std::string escape_name(std::string_view name);
/// The inverse; a % that no two hexadecimal digits follow stays.
std::string unescape_name(std::string_view text);

}  // namespace glisson::detail

// mesh_pieces.h — the pieces of each region in a mesh, by faces of tets, and specks of regions that the lattice made.
#pragma once

#include <map>

#include "glisson/mesh.h"

namespace glisson::image {

/// Pieces of each region that has tets.
std::map<int, std::size_t> mesh_pieces(const TetMesh& mesh);

/// Gives pieces of less than `speck` [m³] to the region that they share most area with, but for the largest so many of each region; those
/// that touch no other tet by a face are removed, with the vertices that only they have.
/// @param kept  pieces to keep of each region, the largest @return how many went
std::size_t absorb_specks(TetMesh& mesh, double speck, const std::map<int, std::size_t>& kept);

}  // namespace glisson::image

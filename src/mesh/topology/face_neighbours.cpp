#include "mesh/topology/face_neighbours.h"

#include <algorithm>
#include <tuple>

#include "mesh/topology/faces.h"

namespace glisson::detail {
namespace {

struct Side {
  Triangle face;  // ascending vertex numbers
  std::uint32_t tet;
  std::uint8_t corner;
  bool turned;  // whether sorting took an odd permutation
};

std::vector<Side> sorted_sides(std::span<const Tet> tets) {
  std::vector<Side> sides;
  sides.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    for (std::uint8_t corner = 0; corner < 4; ++corner) {
      const auto& c = kFaceCorners[corner];
      Triangle face{tets[t][c[0]], tets[t][c[1]], tets[t][c[2]]};
      const bool turned = (face[0] > face[1]) != ((face[1] > face[2]) != (face[0] > face[2]));
      std::sort(face.begin(), face.end());
      sides.push_back({face, t, corner, turned});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.face, a.tet) < std::tie(b.face, b.tet); });
  return sides;
}

}  // namespace

std::vector<Neighbours> face_neighbours(std::span<const Tet> tets) {
  std::vector<Neighbours> neighbours(tets.size(), {kNoTet, kNoTet, kNoTet, kNoTet});
  const std::vector<Side> sides = sorted_sides(tets);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.face != b.face || a.turned == b.turned) continue;
    neighbours[a.tet][a.corner] = b.tet;
    neighbours[b.tet][b.corner] = a.tet;
    ++i;
  }
  return neighbours;
}

}  // namespace glisson::detail

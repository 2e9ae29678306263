#include "mesh/topology/faces.h"

#include <tuple>

#include "mesh/topology/buckets.h"

namespace glisson::detail {
namespace {

auto key_of(const FaceSide& side) { return std::tuple(side.middle, side.highest); }

/// The face opposite `corner` as (smallest vertex, side).
std::pair<std::uint32_t, FaceSide> side_of(const Tet& tet, std::uint32_t index, std::uint8_t corner) {
  const auto& c = kFaceCorners[corner];
  Triangle v{tet[c[0]], tet[c[1]], tet[c[2]]};
  std::sort(v.begin(), v.end());
  return {v[0], {v[1], v[2], index, corner}};
}

}  // namespace

void for_each_face(const TetMesh& mesh, const std::vector<bool>& skipped,
                   const std::function<void(std::span<const FaceSide>)>& visit) {
  auto sides = make_buckets<FaceSide>(mesh.vertices.size(), [&](const auto& sink) {
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
      if (!skipped.empty() && skipped[t]) continue;
      for (std::uint8_t corner = 0; corner < 4; ++corner) {
        const auto [smallest, side] = side_of(mesh.tets[t], t, corner);
        sink(smallest, side);
      }
    }
  });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::span<FaceSide> bucket = sides.bucket(v);
    std::sort(bucket.begin(), bucket.end(), [](const FaceSide& a, const FaceSide& b) {
      return std::tuple(a.middle, a.highest, a.tet) < std::tuple(b.middle, b.highest, b.tet);
    });
    for (std::size_t i = 0; i < bucket.size();) {
      std::size_t end = i + 1;
      while (end < bucket.size() && key_of(bucket[end]) == key_of(bucket[i])) ++end;
      visit(bucket.subspan(i, end - i));
      i = end;
    }
  }
}

}  // namespace glisson::detail

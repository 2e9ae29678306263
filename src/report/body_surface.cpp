// body_surface.cpp — see body_surface.h.
#include "report/body_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "mesh/topology/faces.h"

namespace glisson {
namespace {

/// Of each tet; bit i: the face opposite corner i satisfies `wanted`, which sees all sides of a face.
std::vector<std::uint8_t> faces_where(const TetMesh& mesh, const std::vector<bool>& removed,
                                      const std::function<bool(std::span<const detail::FaceSide>)>& wanted) {
  std::vector<std::uint8_t> faces(mesh.tets.size(), 0);
  detail::for_each_face(mesh, removed, [&](std::span<const detail::FaceSide> sides) {
    if (!wanted(sides)) return;
    for (const detail::FaceSide& side : sides)
      faces[side.tet] = static_cast<std::uint8_t>(faces[side.tet] | (1u << side.corner));
  });
  return faces;
}

bool alone(std::span<const detail::FaceSide> sides) { return sides.size() == 1; }

Triangle face_of(const Tet& tet, std::size_t corner) {
  const auto& c = detail::kFaceCorners[corner];
  return {tet[c[0]], tet[c[1]], tet[c[2]]};
}

/// Calls `visit(tet, corner)` for every face whose bit is set, in the order of the tets.
template <class Visit>
void for_each_marked(const std::vector<std::uint8_t>& faces, Visit visit) {
  for (std::size_t t = 0; t < faces.size(); ++t) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if ((faces[t] >> corner & 1u) != 0) visit(t, corner);
    }
  }
}

std::string name_of(const TetMesh& mesh, int region) {
  const auto found = mesh.region_names.find(region);
  return found == mesh.region_names.end() ? std::string() : found->second;
}

/// The region with the largest volume at rest.
int largest_region(const TetMesh& mesh) {
  std::map<int, double> volumes;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) volumes[mesh.region_of(t)] += six_rest_volume(mesh, t);
  const auto largest = std::max_element(volumes.begin(), volumes.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest == volumes.end() ? 0 : largest->first;
}

void add_regions(BodySurface& surface, const TetMesh& mesh, const std::vector<bool>& removed) {
  const int host = largest_region(mesh);
  surface.tissue = name_of(mesh, host);
  if (mesh.regions.empty()) return;
  const std::vector<std::uint8_t> borders = faces_where(mesh, removed, [&](std::span<const detail::FaceSide> sides) {
    return std::any_of(sides.begin(), sides.end(), [&](const detail::FaceSide& side) {
      return sides.size() == 1 || mesh.regions[side.tet] != mesh.regions[sides[0].tet];
    });
  });
  std::map<int, std::vector<Triangle>> regions;
  for_each_marked(borders, [&](std::size_t t, std::size_t corner) {
    if (mesh.regions[t] != host) regions[mesh.regions[t]].push_back(face_of(mesh.tets[t], corner));
  });
  for (auto& [number, triangles] : regions) {
    const std::string name = name_of(mesh, number);
    surface.regions.push_back({name.empty() ? "region " + std::to_string(number) : name, std::move(triangles)});
  }
}

std::array<std::uint32_t, 3> sorted(Triangle triangle) {
  std::array<std::uint32_t, 3> key{triangle[0], triangle[1], triangle[2]};
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

SkinFaces::SkinFaces(const TetMesh& first) : skin_(faces_where(first, {}, alone)) {}

BodySurface SkinFaces::surface(const TetMesh& mesh, const std::function<bool(std::uint32_t)>& removed) const {
  std::vector<bool> gone;
  if (removed) {
    gone.resize(mesh.tets.size());
    for (std::uint32_t t = 0; t < gone.size(); ++t) gone[t] = removed(t);
  }
  BodySurface surface;
  for_each_marked(faces_where(mesh, gone, alone), [&](std::size_t t, std::size_t corner) {
    const bool skin = t < skin_.size() && (skin_[t] >> corner & 1u) != 0;
    surface.outer.push_back(face_of(mesh.tets[t], corner));
    surface.kinds.push_back(skin ? SurfaceKind::skin : SurfaceKind::cut);
  });
  add_regions(surface, mesh, gone);
  return surface;
}

std::vector<Triangle> torn_triangles(std::span<const std::shared_ptr<Capsule>> capsules) {
  std::vector<Triangle> torn;
  for (const auto& capsule : capsules) {
    for (std::size_t i = 0; i < capsule->triangles().size(); ++i) {
      if (capsule->is_torn(i) || capsule->open_share()[i] > 0.5) torn.push_back(capsule->triangles()[i]);
    }
  }
  return torn;
}

void mark_torn(BodySurface& surface, const std::vector<Triangle>& torn) {
  std::set<std::array<std::uint32_t, 3>> open;
  for (const Triangle& triangle : torn) open.insert(sorted(triangle));
  for (std::size_t i = 0; i < surface.outer.size() && !open.empty(); ++i) {
    if (surface.kinds[i] == SurfaceKind::skin && open.contains(sorted(surface.outer[i])))
      surface.kinds[i] = SurfaceKind::torn;
  }
}

}  // namespace glisson

// body_sets.cpp — see body_sets.h.
#include "image/body_sets.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/text.h"
#include "image/distance_map.h"

namespace glisson::image {
namespace {

constexpr double kOnBorder = 0.05;  ///< voxels from the plane that closes the body: the mesher's slack

bool on_border(const GroupImage& labels, const Vec3d& p) {
  const Vec3d index = labels.grid.index(p);
  for (std::size_t a = 0; a < 3; ++a) {
    if (labels.cut[2 * a] && std::abs(index[a] + 0.5) < kOnBorder) return true;
    if (labels.cut[2 * a + 1] && std::abs(index[a] - (static_cast<double>(labels.grid.size[a]) - 0.5)) < kOnBorder)
      return true;
  }
  return false;
}

}  // namespace

namespace {

constexpr double kOffBorder = 0.12;  ///< edges that the mesher may leave a vertex off its surface
constexpr double kLeastAngle = 10.0, kLargestAngle = 165.0;  ///< [degrees]

/// How far the dihedral angles of some tets are within 10° and 165°; negative where one is not [degrees].
double spare_angle(const TetMesh& mesh, const std::vector<std::uint32_t>& tets) {
  double spare = 180.0;
  for (const std::uint32_t t : tets) {
    if (!(six_rest_volume(mesh, t) > 0.0)) return -180.0;
    for (const double angle : dihedral_angles(mesh, t))
      spare = std::min({spare, angle - kLeastAngle, kLargestAngle - angle});
  }
  return spare;
}

}  // namespace

void flatten_border(TetMesh& mesh, const GroupImage& labels, double edge) {
  if (std::find(labels.cut.begin(), labels.cut.end(), true) == labels.cut.end()) return;
  std::vector<std::vector<std::uint32_t>> near(mesh.vertices.size());
  std::vector<char> outside(mesh.vertices.size(), 0);
  for (const Triangle& t : boundary_triangles(mesh)) {
    for (const std::uint32_t v : t) outside[v] = 1;
  }
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) {
      if (outside[v]) near[v].push_back(t);
    }
  }
  const Vec3d spacing = labels.grid.spacing();
  for (std::uint32_t v = 0; v < outside.size(); ++v) {
    if (!outside[v]) continue;
    const Vec3d from = mesh.vertices[v];
    Vec3d index = labels.grid.index(from);
    bool moved = false;
    for (std::size_t f = 0; f < 6; ++f) {
      const std::size_t a = f / 2;
      const double plane = f % 2 == 0 ? -0.5 : static_cast<double>(labels.grid.size[a]) - 0.5;
      if (!labels.cut[f] || index[a] == plane || std::abs(index[a] - plane) * spacing[a] > kOffBorder * edge) continue;
      index[a] = plane;
      moved = true;
    }
    if (!moved) continue;
    const double before = spare_angle(mesh, near[v]);
    mesh.vertices[v] = labels.grid.world(index);
    if (spare_angle(mesh, near[v]) < std::min(before, 0.0)) mesh.vertices[v] = from;
  }
}

double NearLabels::at(const Vec3d& p) const {
  const Vec3d index = grid.index(p);
  std::array<std::size_t, 3> nearest{};
  for (std::size_t a = 0; a < 3; ++a)
    nearest[a] = static_cast<std::size_t>(std::clamp(std::round(index[a]), 0.0, static_cast<double>(grid.size[a] - 1)));
  return distance[grid.at(nearest[0], nearest[1], nearest[2])];
}

std::vector<NearLabels> near_labels(const LabelImage& image, const std::vector<LabelGroup>& groups) {
  std::vector<NearLabels> out;
  const Vec3d spacing = image.grid.spacing();
  for (const LabelGroup& group : groups) {
    std::vector<char> set(image.voxels.size());
    for (std::size_t v = 0; v < set.size(); ++v)
      set[v] = std::find(group.labels.begin(), group.labels.end(), image.voxels[v]) != group.labels.end();
    std::vector<float> distance = distance_to(image.grid.size, spacing, set);
    const auto half = static_cast<float>(0.5 * std::min({spacing.x, spacing.y, spacing.z}));
    for (float& d : distance) d = std::max(0.0F, d - half);
    out.push_back({group.name, image.grid, std::move(distance)});
  }
  return out;
}

void add_body_sets(TetMesh& mesh, const GroupImage& labels, const std::vector<NearLabels>& beside, double within) {
  const std::vector<Triangle> triangles = boundary_triangles(mesh);
  std::vector<char> outside(mesh.vertices.size(), 0), border(mesh.vertices.size(), 0);
  bool any_border = false;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) outside[v] = 1;
  }
  for (std::uint32_t v = 0; v < outside.size(); ++v) {
    border[v] = outside[v] && on_border(labels, mesh.vertices[v]);
    any_border = any_border || border[v];
  }
  std::map<int, std::set<std::uint32_t>> surfaces;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) {
      if (outside[v]) surfaces[mesh.regions[t]].insert(v);
    }
  }
  for (const auto& [region, name] : mesh.region_names) {
    const std::set<std::uint32_t>& own = surfaces[region];
    mesh.vertex_sets[name + "_surface"].assign(own.begin(), own.end());
  }
  if (any_border) {
    for (std::uint32_t v = 0; v < border.size(); ++v) {
      if (border[v]) mesh.vertex_sets["image_border"].push_back(v);
    }
  }
  for (const NearLabels& labels_beside : beside) {
    std::vector<std::uint32_t>& set = mesh.vertex_sets[labels_beside.name];
    double least = 1e300;
    for (std::uint32_t v = 0; v < outside.size(); ++v) {
      if (!outside[v]) continue;
      const double distance = labels_beside.at(mesh.vertices[v]);
      least = std::min(least, distance);
      if (distance <= within) set.push_back(v);
    }
    if (!set.empty()) continue;
    throw std::invalid_argument(
        "no vertex of the body's surface lies within " + detail::number_text(1e3 * within) + " mm of \"" +
        labels_beside.name + "\"" +
        (least < 1.0 ? "; the nearest is " + detail::number_text(1e3 * least, 3) + " mm away: give beside_mm" : ""));
  }
}

}  // namespace glisson::image

// liver_sets.cpp — vertex sets of the liver's surface: where it is held, and what it faces.
//
// Each is found by the place and the outward normal of a vertex of the surface, in millimetres before scaling; what holds the liver is
// as [Gray1918, p. 1193] lists it.
#include <algorithm>
#include <cmath>

#include "mesher/organs/liver_parts.h"

namespace glisson::detail {
namespace {

/// The surface of the liver, by vertex of the mesh.
struct Outside {
  std::vector<Triangle> triangles;
  std::vector<Vec3d> normals;      ///< unit; 0 inside
  std::vector<char> off;           ///< of the gallbladder alone
  double to_mm = 1e3, edge = 8.0;  ///< of the mesh [mm]
  const TetMesh& mesh;

  Outside(const TetMesh& from, const LiverOptions& options)
      : triangles(boundary_triangles(from)), normals(from.vertices.size()), off(from.vertices.size(), 1),
        to_mm(1e3 / options.scale), edge(to_mm * options.edge), mesh(from) {
    for (const Triangle& t : triangles) {
      const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Vec3d n = cross(b - a, c - a);
      for (const std::uint32_t v : t) normals[v] += n;
    }
    for (Vec3d& n : normals) n = norm(n) > 0.0 ? unit(n) : Vec3d{};
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (mesh.region_names.at(mesh.regions[t]) == "gallbladder") continue;
      for (const std::uint32_t v : mesh.tets[t]) off[v] = 0;
    }
  }
  Vec3d place(std::uint32_t v) const { return mesh.vertices[v] * to_mm; }

  /// Vertices of the liver's own surface that satisfy a condition on normal and place, ascending.
  template <class Condition>
  std::vector<std::uint32_t> where(Condition condition) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < normals.size(); ++v) {
      if (off[v] == 0 && norm(normals[v]) > 0.0 && condition(normals[v], place(v))) found.push_back(v);
    }
    return found;
  }
};

std::vector<char> marked(const std::vector<std::uint32_t>& set, std::size_t vertices) {
  std::vector<char> mark(vertices, 0);
  for (const std::uint32_t v : set) mark[v] = 1;
  return mark;
}

/// Vertices beside a set, one triangle out.
std::vector<std::uint32_t> rim(const Outside& outside, const std::vector<std::uint32_t>& set) {
  const std::vector<char> inside = marked(set, outside.normals.size());
  std::vector<char> beside(inside.size(), 0);
  for (const Triangle& t : outside.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](std::uint32_t v) { return inside[v] != 0; })) continue;
    for (const std::uint32_t v : t) beside[v] = inside[v] == 0 && outside.off[v] == 0 ? 1 : 0;
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t v = 0; v < beside.size(); ++v) {
    if (beside[v] != 0) found.push_back(v);
  }
  return found;
}

/// Takes out of a set what others have.
void take_out(std::vector<std::uint32_t>& set, const std::vector<const std::vector<std::uint32_t>*>& others) {
  for (const auto* other : others) {
    std::erase_if(set, [&](std::uint32_t v) { return std::binary_search(other->begin(), other->end(), v); });
  }
}

Solid vena_cava_solid() {
  TubeShape tube;
  for (const LiverParts::Point& p : vena_cava()) tube.points.push_back({p.at, p.radius});
  return tube;
}

/// Folds of peritoneum. None shares a vertex with the bare area or another, so that all can be held at once.
void add_ligaments(const Outside& outside, TetMesh& mesh) {
  auto& sets = mesh.vertex_sets;
  const std::vector<std::uint32_t>& bare = sets["bare_area"];
  std::vector<std::uint32_t> coronary = rim(outside, bare), right = coronary;
  std::erase_if(right, [&](std::uint32_t v) { return outside.place(v).x > -60.0; });
  // From the upper face of the left lobe, behind.
  std::vector<std::uint32_t> left =
      outside.where([](const Vec3d& n, const Vec3d& p) { return n.y > 0.3 && n.z > 0.3 && p.x > 40.0 && p.x < 100.0; });
  // From the umbilical notch over front and dome to the vena cava.
  std::vector<std::uint32_t> falciform = outside.where([&](const Vec3d& n, const Vec3d& p) {
    const double x = 20.0 - 14.0 * (p.y + 52.0) / 92.0;
    return (n.y < -0.3 || n.z > 0.3) && p.y < 40.0 && p.z > 0.0 &&
           std::abs(p.x - x) < std::max(2.0, 0.6 * outside.edge);
  });
  take_out(left, {&bare, &right});
  take_out(coronary, {&right, &left});
  take_out(falciform, {&bare, &right, &left, &coronary});
  sets["right_triangular_ligament"] = std::move(right);
  sets["left_triangular_ligament"] = std::move(left);
  sets["coronary_ligament"] = std::move(coronary);
  sets["falciform_ligament"] = std::move(falciform);
}

}  // namespace

void add_liver_sets(TetMesh& mesh, const LiverOptions& options) {
  const Outside outside(mesh, options);
  auto& sets = mesh.vertex_sets;
  // Bare: the back of the right lobe and about the vena cava, above the kidney.
  sets["bare_area"] = outside.where(
      [](const Vec3d& n, const Vec3d& p) { return n.y > 0.5 && p.z > -20.0 && p.x > -75.0 && p.x < 25.0; });
  sets["dome"] = outside.where([](const Vec3d& n, const Vec3d&) { return n.z > 0.3; });
  sets["visceral_face"] = outside.where([](const Vec3d& n, const Vec3d&) { return n.z < -0.3; });
  const Solid cava = vena_cava_solid();
  sets["vena_cava"] =
      outside.where([&](const Vec3d&, const Vec3d& p) { return cava.distance(p) < 1.5 + 0.1 * outside.edge; });
  add_ligaments(outside, mesh);
  if (!options.gallbladder) return;
  auto& gallbladder = sets["gallbladder"];
  for (std::uint32_t v = 0; v < outside.off.size(); ++v) {
    if (outside.off[v] != 0 && norm(outside.normals[v]) > 0.0) gallbladder.push_back(v);
  }
}

}  // namespace glisson::detail

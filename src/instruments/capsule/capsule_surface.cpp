#include "instruments/capsule/capsule_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mesh/topology/faces.h"

namespace glisson {
namespace {

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::string text_of(const Triangle& t) {
  return std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]);
}

std::vector<TetFace> surface_of(const BodyView& body) {
  std::vector<bool> skipped(body.removed.empty() ? 0 : body.mesh.tets.size(), false);
  for (std::size_t t = 0; t < skipped.size(); ++t) skipped[t] = body.is_removed(t);
  std::vector<TetFace> faces;
  detail::for_each_face(body.mesh, skipped, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() == 1) faces.push_back({sides[0].tet, sides[0].corner});
  });
  std::sort(faces.begin(), faces.end(),
            [](const TetFace& a, const TetFace& b) { return a.tet != b.tet ? a.tet < b.tet : a.corner < b.corner; });
  return faces;
}

/// Keeps the faces on a list of triangles, each of which has to be one.
void keep_listed(const CapsuleOptions& options, const TetMesh& mesh, std::vector<TetFace>& faces) {
  std::vector<Triangle> wanted;
  for (const Triangle& t : options.triangles) wanted.push_back(sorted(t));
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<Triangle> found;
  std::erase_if(faces, [&](const TetFace& f) {
    const Triangle t = sorted(corners_of(mesh, f));
    const bool is_listed = std::binary_search(wanted.begin(), wanted.end(), t);
    if (is_listed) found.push_back(t);
    return !is_listed;
  });
  std::sort(found.begin(), found.end());
  for (const Triangle& t : wanted) {
    if (std::binary_search(found.begin(), found.end(), t)) continue;
    throw std::invalid_argument(options.name + ".triangles: " + text_of(t) +
                                " is not at the surface of the body; take triangles of boundary_triangles(mesh)");
  }
}

/// Keeps the faces all of whose vertices are on a list.
void keep_within(const CapsuleOptions& options, const TetMesh& mesh, std::vector<TetFace>& faces) {
  std::vector<char> is_listed(mesh.vertices.size(), 0);
  for (const std::uint32_t v : options.vertices) {
    if (v >= is_listed.size()) {
      throw std::invalid_argument(options.name + ".vertices: " + std::to_string(v) +
                                  " is no vertex; they go from 0 to " + std::to_string(is_listed.size() - 1));
    }
    is_listed[v] = 1;
  }
  std::erase_if(faces, [&](const TetFace& f) {
    const Triangle t = corners_of(mesh, f);
    return !std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return is_listed[v] != 0; });
  });
}

/// Weights of the point of a triangle nearest to p: inside by projection, else on the nearest edge.
std::array<double, 3> nearest_weights(const std::array<Vec3d, 3>& x, const Vec3d& p) {
  const Vec3d d1 = x[1] - x[0], d2 = x[2] - x[0], n = cross(d1, d2);
  const double nn = dot(n, n);
  if (nn > 0.0) {
    const double b = dot(cross(p - x[0], d2), n) / nn, c = dot(cross(d1, p - x[0]), n) / nn;
    if (b >= 0.0 && c >= 0.0 && b + c <= 1.0) return {1.0 - b - c, b, c};
  }
  std::array<double, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vec3d edge = x[j] - x[i];
    const double length = dot(edge, edge);
    const double s = length > 0.0 ? std::clamp(dot(p - x[i], edge) / length, 0.0, 1.0) : 0.0;
    const double distance = norm(x[i] + edge * s - p);
    if (distance < least) least = distance, best = {}, best[i] = 1.0 - s, best[j] = s;
  }
  return best;
}

/// Signed area that a disc about the origin shares with the triangle (origin, a, b).
double share_of_edge(const std::array<double, 2>& a, const std::array<double, 2>& b, double radius) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  const double length = dx * dx + dy * dy, along = a[0] * dx + a[1] * dy, wide = a[0] * a[0] + a[1] * a[1];
  if (!(length > 0.0)) return 0.0;
  const auto sector = [&](double s0, double s1) {  // from a + s0 d to a + s1 d, outside the disc
    const double x0 = a[0] + s0 * dx, y0 = a[1] + s0 * dy, x1 = a[0] + s1 * dx, y1 = a[1] + s1 * dy;
    return 0.5 * radius * radius * std::atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1);
  };
  const double root = along * along - length * (wide - radius * radius);
  if (!(root > 0.0)) return sector(0.0, 1.0);
  const double s0 = std::clamp((-along - std::sqrt(root)) / length, 0.0, 1.0);
  const double s1 = std::clamp((-along + std::sqrt(root)) / length, 0.0, 1.0);
  return sector(0.0, s0) + 0.5 * (s1 - s0) * (a[0] * dy - a[1] * dx) + sector(s1, 1.0);
}

}  // namespace

Triangle corners_of(const TetMesh& mesh, const TetFace& face) {
  const Tet& tet = mesh.tets[face.tet];
  const auto& c = detail::kFaceCorners[face.corner];
  return {tet[c[0]], tet[c[1]], tet[c[2]]};
}

std::vector<TetFace> capsule_faces(const CapsuleOptions& options, const BodyView& body) {
  std::vector<TetFace> faces = surface_of(body);
  if (!options.triangles.empty()) keep_listed(options, body.mesh, faces);
  if (!options.vertices.empty()) keep_within(options, body.mesh, faces);
  if (faces.empty()) {
    throw std::invalid_argument(options.name +
                                ".vertices: no triangle of the surface has all its vertices among these " +
                                std::to_string(options.vertices.size()) +
                                "; give a vertex set that covers part of the surface, such as z_max of a box");
  }
  return faces;
}

double squared_distance_of_box(const std::array<Vec3d, 3>& x, const Vec3d& p) {
  const auto off = [](double a, double b, double c, double at) {
    return std::max({std::min({a, b, c}) - at, at - std::max({a, b, c}), 0.0});
  };
  const Vec3d d{off(x[0].x, x[1].x, x[2].x, p.x), off(x[0].y, x[1].y, x[2].y, p.y), off(x[0].z, x[1].z, x[2].z, p.z)};
  return dot(d, d);
}

PointOnTriangle nearest_point(std::span<const Triangle> triangles, std::span<const Vec3d> positions,
                              std::span<const char> counts, const Vec3d& place, std::size_t first) {
  PointOnTriangle best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto look_at = [&](std::size_t t) {
    const std::array<Vec3d, 3> x{positions[triangles[t][0]], positions[triangles[t][1]], positions[triangles[t][2]]};
    if (squared_distance_of_box(x, place) > best.distance * best.distance * (1.0 + 1e-12)) return;
    const std::array<double, 3> w = nearest_weights(x, place);
    const double distance = norm(x[0] * w[0] + x[1] * w[1] + x[2] * w[2] - place);
    const bool is_first = distance == best.distance && t < best.triangle;  // of equals, whatever was looked at first
    if (distance < best.distance || is_first) best = {t, w, distance};
  };
  if (first < triangles.size() && counts[first] != 0) look_at(first);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (counts[t] != 0) look_at(t);
  }
  return best;
}

double overlap_with_disc(const std::array<std::array<double, 2>, 3>& triangle, double radius) {
  double area = 0.0;
  for (std::size_t i = 0; i < 3; ++i) area += share_of_edge(triangle[i], triangle[(i + 1) % 3], radius);
  return std::abs(area);
}

Neighbours find_neighbours(std::span<const Triangle> triangles, std::span<const Vec3d> positions, double distance) {
  std::vector<std::pair<double, std::uint32_t>> by_x;  // a sweep: only those within the distance along x are compared
  std::vector<Vec3d> centre, normal;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    centre.push_back((positions[triangles[t][0]] + positions[triangles[t][1]] + positions[triangles[t][2]]) *
                     (1.0 / 3.0));
    normal.push_back(cross(positions[triangles[t][1]] - positions[triangles[t][0]],
                           positions[triangles[t][2]] - positions[triangles[t][0]]));
    by_x.emplace_back(centre[t].x, t);
  }
  std::sort(by_x.begin(), by_x.end());
  Neighbours near;
  near.first.push_back(0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto start = near.list.size();
    auto at = std::lower_bound(by_x.begin(), by_x.end(), std::pair{centre[t].x - distance, std::uint32_t{0}});
    for (; at != by_x.end() && at->first <= centre[t].x + distance; ++at) {
      const Vec3d d = centre[at->second] - centre[t];
      if (dot(d, d) > distance * distance || dot(normal[at->second], normal[t]) < 0.0) continue;
      near.list.push_back(at->second);
    }
    std::sort(near.list.begin() + static_cast<std::ptrdiff_t>(start), near.list.end());
    near.first.push_back(static_cast<std::uint32_t>(near.list.size()));
  }
  return near;
}

}  // namespace glisson

// cylinder_mesh.cpp — a cylinder about z whose cells shrink toward its axis, where an indenter presses.
//
// Cross-section: a point on the axis and rings of 6, 12, 18 … points. Ring k has k points in each of its six
// sectors, so the ring between k − 1 and k is filled with 2k − 1 triangles a sector and all of them stay near
// equilateral. Ring widths grow outward by a constant ratio.
//
//            ring 2   o───o───o          Every triangle extruded through a layer is a prism, cut in three
//                      \ / \ /           tetrahedra. The diagonal of each side of the prism rises from the
//            ring 1     o───o            vertex of lower number in the cross-section to the one of higher
//                        \ /             number: two prisms agree on their common side, so the mesh
//            axis         o              conforms.
#include <algorithm>
#include <numbers>

#include "base/require_fields.h"
#include "base/text.h"
#include "glisson/mesh.h"

namespace glisson {
namespace {

constexpr double kMaxPrisms = 2e8;

struct Disc {
  std::vector<double> x, y;         // [m]
  std::vector<Triangle> triangles;  // anticlockwise seen from +z
  std::uint32_t wall_begin = 0;     // points from here on lie on the outermost ring
};

/// Radii of the rings 0 (the axis) to n [m]; widths w, w g, w g² … with g^(n−1) = grading.
std::vector<double> ring_radii(const CylinderOptions& options) {
  const int n = options.radial_cells;
  const double growth = n > 1 ? std::pow(options.grading, 1.0 / (n - 1)) : 1.0;
  std::vector<double> radii{0.0};
  double width = 1.0;
  for (int k = 0; k < n; ++k, width *= growth) radii.push_back(radii.back() + width);
  const double scale = options.radius / radii.back();
  for (double& r : radii) r *= scale;
  radii.back() = options.radius;
  return radii;
}

/// Number of point j of ring k, counted around the whole ring.
std::uint32_t ring_point(std::uint32_t k, std::uint32_t j) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + j % (6 * k); }

void add_ring_triangles(std::uint32_t k, std::vector<Triangle>& triangles) {
  for (std::uint32_t sector = 0; sector < 6; ++sector) {
    const std::uint32_t outer = sector * k, inner = sector * (k - 1);
    for (std::uint32_t j = 0; j < k; ++j) {
      triangles.push_back({ring_point(k, outer + j), ring_point(k, outer + j + 1), ring_point(k - 1, inner + j)});
      if (j + 1 == k) break;
      triangles.push_back(
          {ring_point(k - 1, inner + j), ring_point(k, outer + j + 1), ring_point(k - 1, inner + j + 1)});
    }
  }
}

Disc make_disc(const CylinderOptions& options) {
  const std::vector<double> radii = ring_radii(options);
  Disc disc{{0.0}, {0.0}, {}, 0};
  for (std::uint32_t k = 1; k < radii.size(); ++k) {
    disc.wall_begin = static_cast<std::uint32_t>(disc.x.size());
    for (std::uint32_t j = 0; j < 6 * k; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / (6.0 * k);
      disc.x.push_back(radii[k] * std::cos(angle));
      disc.y.push_back(radii[k] * std::sin(angle));
    }
    add_ring_triangles(k, disc.triangles);
  }
  return disc;
}

/// Adds the three tetrahedra of a prism; `below` and `above` number the first point of its two layers.
void add_prism(Triangle triangle, std::uint32_t below, std::uint32_t above, TetMesh& mesh) {
  std::sort(triangle.begin(), triangle.end());
  const auto [a, b, c] = triangle;
  const Tet prism[3] = {{below + a, below + b, below + c, above + c},
                        {below + a, below + b, above + b, above + c},
                        {below + a, above + a, above + b, above + c}};
  for (const Tet& tet : prism) {
    mesh.tets.push_back(tet);
    if (six_rest_volume(mesh, mesh.tets.size() - 1) < 0.0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
  }
}

void add_sets(const Disc& disc, std::uint32_t layers, TetMesh& mesh) {
  const auto points = static_cast<std::uint32_t>(disc.x.size());
  for (std::uint32_t k = 0; k <= layers; ++k) {
    const std::uint32_t first = k * points;
    mesh.vertex_sets["axis"].push_back(first);
    for (std::uint32_t p = disc.wall_begin; p < points; ++p) mesh.vertex_sets["wall"].push_back(first + p);
  }
  for (std::uint32_t p = 0; p < points; ++p) {
    mesh.vertex_sets["bottom"].push_back(p);
    mesh.vertex_sets["top"].push_back(layers * points + p);
  }
}

}  // namespace

Fault CylinderOptions::check() const {
  const double prisms = 6.0 * radial_cells * radial_cells * axial_cells;
  if (prisms <= kMaxPrisms) return {};
  return {"6 radial_cells² axial_cells = " + detail::show(prisms) + " prisms are too many; allowed: at most 2e8",
          "radial_cells"};
}

TetMesh cylinder_mesh(const CylinderOptions& options) {
  detail::require_fields("cylinder", options);
  const Disc disc = make_disc(options);
  const auto points = static_cast<std::uint32_t>(disc.x.size());
  const auto layers = static_cast<std::uint32_t>(options.axial_cells);
  TetMesh mesh;
  mesh.vertices.reserve(std::size_t{points} * (layers + 1));
  mesh.tets.reserve(3 * disc.triangles.size() * layers);
  for (std::uint32_t k = 0; k <= layers; ++k) {
    const double z = options.height * k / layers;
    for (std::uint32_t p = 0; p < points; ++p) mesh.vertices.push_back({disc.x[p], disc.y[p], z});
  }
  for (std::uint32_t k = 0; k < layers; ++k) {
    for (const Triangle& triangle : disc.triangles) add_prism(triangle, k * points, (k + 1) * points, mesh);
  }
  add_sets(disc, layers, mesh);
  return mesh;
}

}  // namespace glisson

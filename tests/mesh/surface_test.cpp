#include <gtest/gtest.h>

#include <map>

#include "glisson/mesh.h"

namespace glisson {
namespace {

/// ∫ x·n dA / 3 over the triangles [m³].
double enclosed_volume(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
  double six = 0.0;
  for (const Triangle& t : triangles) {
    six += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return six / 6.0;
}

// Gauss: the outward boundary encloses the volume of the tets, for boxes of both splits and cylinders.
TEST(BoundaryTriangles, EncloseTheVolume) {
  BoxOptions alternating;
  alternating.split = BoxSplit::alternating;
  alternating.origin = {0.3, -0.2, 0.1};
  for (const TetMesh& mesh : {box_mesh({}), box_mesh(alternating), cylinder_mesh({})}) {
    EXPECT_NEAR(enclosed_volume(mesh, boundary_triangles(mesh)), volume(mesh), 1e-13 * volume(mesh) + 1e-17);
  }
}

// The boundary is closed: every directed edge meets its opposite exactly once.
TEST(BoundaryTriangles, AreClosed) {
  for (const TetMesh& mesh : {box_mesh({}), cylinder_mesh({})}) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : boundary_triangles(mesh)) {
      for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << edge.first << "–" << edge.second;
      ASSERT_TRUE(edges.contains({edge.second, edge.first})) << edge.first << "–" << edge.second;
    }
  }
}

// Each boundary triangle of a single tet looks away from the vertex it does not hold.
TEST(BoundaryTriangles, PointOutward) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}, {}, {}};
  const Vec3d middle{0.25, 0.25, 0.25};
  const auto triangles = boundary_triangles(mesh);
  ASSERT_EQ(triangles.size(), 4u);
  for (const Triangle& t : triangles) {
    const Vec3d normal = cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_GT(dot(normal, mesh.vertices[t[0]] - middle), 0.0);
  }
}

}  // namespace
}  // namespace glisson

// The surfaces of random bodies are in their meshes: of those between layers two edges thick, 95 % are within 0.1 edge of an interface.
//
// The other direction, interfaces from surfaces, is in region_mesh_test.cpp. Layers that are thinner may be lost; how thick one is is
// measured along the normal, up to the next change of region.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "glisson/region_mesh.h"
#include "mesh_checks.h"
#include "mesher/implicit/surface_tree.h"
#include "random_body.h"

namespace glisson {
namespace {

using test::Face;
using test::RandomShapes;

constexpr double kSurfaceEdge = 0.15;

/// The first region at a point; none in a hole or outside.
std::optional<std::size_t> region_at(const std::vector<BodyRegion>& regions, const Vec3d& p) {
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (regions[k].distance(p) < 0.0) return regions[k].hole ? std::nullopt : std::optional(k);
  }
  return std::nullopt;
}

Vec3d slope_at(const BodyRegion& region, const Vec3d& p) {
  constexpr double kStep = 1e-4;
  Vec3d g;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d h{};
    h[i] = kStep;
    g[i] = (region.distance(p + h) - region.distance(p - h)) / (2.0 * kStep);
  }
  return g;
}

/// A point of a region's surface near another one; none where there is none.
std::optional<Vec3d> drawn_to(const BodyRegion& region, Vec3d p) {
  double value = region.distance(p);
  if (std::abs(value) > 0.02) return {};
  for (int i = 0; i < 6 && std::abs(value) > 1e-6; ++i) {
    const Vec3d g = slope_at(region, p);
    if (dot(g, g) < 1e-6) return {};
    p -= g * (value / dot(g, g));
    value = region.distance(p);
  }
  return std::abs(value) < 1e-4 ? std::optional(p) : std::nullopt;
}

/// Whether different regions lie on both sides of a point, each for two edges along the normal.
bool between_thick_layers(const std::vector<BodyRegion>& regions, const Vec3d& p, const Vec3d& normal) {
  const auto at = [&](double edges) { return region_at(regions, p + normal * (edges * kSurfaceEdge)); };
  if (at(-0.03) == at(0.03)) return false;
  for (const double side : {-1.0, 1.0}) {
    for (double q = 0.06; q < 2.0; q += 0.06) {
      if (at(side * q) != at(side * 0.03)) return false;
    }
  }
  return true;
}

/// Distances of such points from the mesh's interfaces [edges], ascending.
std::vector<double> surface_distances(const TetMesh& mesh, const std::vector<BodyRegion>& regions, unsigned seed) {
  std::vector<detail::Corners> faces;
  for (const Face& f : test::faces_of(mesh)) {
    if (f.regions.size() == 2 && f.regions[0] == f.regions[1]) continue;
    faces.push_back({mesh.vertices[f.corners[0]], mesh.vertices[f.corners[1]], mesh.vertices[f.corners[2]]});
  }
  const detail::SurfaceTree interfaces(std::move(faces));
  RandomShapes random(1000 + seed);
  std::vector<double> distances;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const Vec3d low = regions[k].bounds.min, size = regions[k].bounds.max - low;
    const int tries = 1 + static_cast<int>(2000.0 * size.x * size.y * size.z);
    for (int i = 0; i < tries; ++i) {
      const double x = random.between(0, size.x), y = random.between(0, size.y), z = random.between(0, size.z);
      const std::optional<Vec3d> p = drawn_to(regions[k], low + Vec3d{x, y, z});
      if (!p) continue;
      const bool hidden = std::any_of(regions.begin(), regions.begin() + static_cast<std::ptrdiff_t>(k),
                                      [&](const BodyRegion& earlier) { return earlier.distance(*p) < 0.0; });
      if (hidden || !between_thick_layers(regions, *p, unit(slope_at(regions[k], *p)))) continue;
      distances.push_back(std::abs(interfaces.distance(*p)) / kSurfaceEdge);
    }
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

class RandomSurfaces : public testing::TestWithParam<unsigned> {};

// 0.099 edge was measured in body 294, 0.084 at most in the others.
TEST_P(RandomSurfaces, AreInTheirMeshes) {
  for (unsigned seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    const std::vector<BodyRegion> regions = RandomShapes(seed).body();
    RegionMesh made;
    try {
      made = mesh_regions(regions, {kSurfaceEdge});
    } catch (const std::invalid_argument&) {  // a region that others cover
      continue;
    }
    const std::vector<double> distances = surface_distances(made.mesh, regions, seed);
    ASSERT_GT(distances.size(), 100u) << "seed " << seed;
    const double p95 = distances[distances.size() * 95 / 100];
    RecordProperty("p95_" + std::to_string(seed), std::to_string(p95));
    EXPECT_LT(p95, 0.1) << "seed " << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(First, RandomSurfaces, testing::Range(0u, 1u));  // long
INSTANTIATE_TEST_SUITE_P(All, RandomSurfaces, testing::Range(1u, 30u));   // verify

}  // namespace
}  // namespace glisson

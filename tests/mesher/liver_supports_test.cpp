// The liver's gallbladder has the size of one and lies in its bed, and what holds the liver is where anatomy has it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "glisson/liver.h"

namespace glisson {
namespace {

RegionMesh liver_with_gallbladder() { return liver_mesh({.edge = 0.01, .gallbladder = true}); }

/// Extent of vertices along a direction [m].
double extent(const TetMesh& mesh, const std::set<std::uint32_t>& vertices, const Vec3d& along) {
  double low = 1e9, high = -1e9;
  for (const std::uint32_t v : vertices) {
    low = std::min(low, dot(mesh.vertices[v], along)), high = std::max(high, dot(mesh.vertices[v], along));
  }
  return high - low;
}

double lowest(const TetMesh& mesh, const std::set<std::uint32_t>& vertices, std::size_t axis) {
  double low = 1e9;
  for (const std::uint32_t v : vertices) low = std::min(low, mesh.vertices[v][axis]);
  return low;
}

/// Faces that tets of the gallbladder and of other regions share [m²].
double attached_area(const TetMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, int> sides;  // bit 0: gallbladder, bit 1: another region
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int side = mesh.region_names.at(mesh.regions[t]) == "gallbladder" ? 1 : 2;
    for (std::size_t out = 0; out < 4; ++out) {
      std::array<std::uint32_t, 3> face{};
      for (std::size_t k = 0, at = 0; k < 4; ++k) {
        if (k != out) face[at++] = mesh.tets[t][k];
      }
      std::sort(face.begin(), face.end());
      sides[face] |= side;
    }
  }
  double area = 0.0;
  for (const auto& [f, side] : sides) {
    const auto& x = mesh.vertices;
    if (side == 3) area += 0.5 * norm(cross(x[f[1]] - x[f[0]], x[f[2]] - x[f[0]]));
  }
  return area;
}

// [Gray1918]: 7 to 10 cm long, 2.5 cm wide, 30 to 35 mL; its upper surface grows to the liver, its fundus stands out in front.
TEST(LiverGallbladder, HasItsSizeAndLiesInItsBed) {
  const RegionMesh made = liver_with_gallbladder();
  const auto region = std::find_if(made.report.regions.begin(), made.report.regions.end(),
                                   [](const RegionVolume& r) { return r.name == "gallbladder"; });
  ASSERT_NE(region, made.report.regions.end());
  EXPECT_GT(region->volume, 30e-6);
  EXPECT_LT(region->volume, 35e-6);
  std::set<std::uint32_t> own, other;
  for (std::size_t t = 0; t < made.mesh.tets.size(); ++t) {
    (made.mesh.regions[t] == region->number ? own : other).insert(made.mesh.tets[t].begin(), made.mesh.tets[t].end());
  }
  const Vec3d axis = unit(Vec3d{16, 54, 28}), across = unit(cross(axis, Vec3d{0, 0, 1}));
  EXPECT_NEAR(extent(made.mesh, own, axis), 0.083, 0.006);
  EXPECT_NEAR(extent(made.mesh, own, across), 0.028, 0.006);
  EXPECT_LT(lowest(made.mesh, own, 1), lowest(made.mesh, other, 1) - 0.005) << "the fundus stands out in front";
  EXPECT_GT(attached_area(made.mesh), 10e-4) << "[m²]";
  EXPECT_EQ(inspect(made.mesh).pieces, 1u) << "grown to the liver";
  EXPECT_TRUE(made.report.poor_tets.empty());
  for (const std::uint32_t v : made.mesh.vertex_sets.at("gallbladder")) EXPECT_FALSE(other.contains(v)) << v;
}

// Without it the liver is what it was, and it is not a size's region.
TEST(LiverGallbladder, IsThereOnlyWhereItIsAskedFor) {
  const RegionMesh made = liver_mesh({.edge = 0.014});
  EXPECT_FALSE(made.mesh.vertex_sets.contains("gallbladder"));
  for (const RegionVolume& r : made.report.regions) EXPECT_NE(r.name, "gallbladder");
  LiverOptions options;
  options.sizes = {{.edge = 0.004, .near = "gallbladder"}};
  EXPECT_THROW(liver_body(options), std::invalid_argument);
  options.gallbladder = true;
  EXPECT_NO_THROW(liver_body(options));
}

/// Sets that may all be held at once.
constexpr std::array kDisjoint{"bare_area", "coronary_ligament", "right_triangular_ligament",
                               "left_triangular_ligament", "falciform_ligament"};

// Every set has vertices of the surface on each mesh, and none but the groove of the vena cava shares a vertex with the bare area.
TEST(LiverSets, AreThereOnCoarseAndScaledMeshes) {
  for (const LiverOptions& options : {LiverOptions{.edge = 0.015}, LiverOptions{.edge = 0.01, .gallbladder = true},
                                      LiverOptions{.edge = 0.005, .scale = 0.5}}) {
    const TetMesh mesh = liver_mesh(options).mesh;
    std::set<std::uint32_t> outside;
    for (const Triangle& t : boundary_triangles(mesh)) outside.insert(t.begin(), t.end());
    for (const auto& [name, set] : mesh.vertex_sets) {
      EXPECT_GE(set.size(), 8u) << name;
      EXPECT_TRUE(std::is_sorted(set.begin(), set.end())) << name;
      for (const std::uint32_t v : set) EXPECT_TRUE(outside.contains(v)) << name;
    }
    std::set<std::uint32_t> held;
    std::size_t members = 0;
    for (const char* name : kDisjoint) {
      const auto& set = mesh.vertex_sets.at(name);
      held.insert(set.begin(), set.end()), members += set.size();
    }
    EXPECT_EQ(held.size(), members) << "sets share vertices";
  }
}

// The ligaments end where they should: x to the left, y to the back, z to the head.
TEST(LiverSets, AreWhereAnatomyHasThem) {
  const TetMesh mesh = liver_with_gallbladder().mesh;
  const auto all = [&](const char* name, auto condition) {
    for (const std::uint32_t v : mesh.vertex_sets.at(name)) {
      const Vec3d p = mesh.vertices[v] * 1e3;
      EXPECT_TRUE(condition(p)) << name << " " << p.x << " " << p.y << " " << p.z;
    }
  };
  all("right_triangular_ligament", [](const Vec3d& p) { return p.x < -60 && p.y > 0; });
  all("left_triangular_ligament", [](const Vec3d& p) { return p.x > 40 && p.z > 0; });
  all("coronary_ligament", [](const Vec3d& p) { return p.x > -60 && p.x < 40 && p.y > 0; });
  all("vena_cava", [](const Vec3d& p) { return std::abs(p.x) < 16 && p.y > 30; });
  // From the umbilical notch in front to the top, within a width of 6 mm on both sides of its line.
  std::set<std::uint32_t> falciform(mesh.vertex_sets.at("falciform_ligament").begin(),
                                    mesh.vertex_sets.at("falciform_ligament").end());
  EXPECT_GT(extent(mesh, falciform, {0, 1, 0}), 0.04);
  EXPECT_GT(extent(mesh, falciform, {0, 0, 1}), 0.05);
  EXPECT_LT(extent(mesh, falciform, {1, 0, 0}), 0.03);
}

}  // namespace
}  // namespace glisson

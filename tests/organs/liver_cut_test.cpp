// A real organ mesh, cut through by planes: the parts that the plane makes, with the volume and mass of the whole.
#include <filesystem>

#include "cutting/cut_body.h"
#include "glisson/io.h"
#include "support/places.h"

namespace glisson::test {
namespace {

/// Pieces in which a plane parts the vertices of a mesh: those on one side that edges connect on that side.
std::ptrdiff_t parts_by(const TetMesh& mesh, const CutPlane& plane) {
  std::vector<std::uint32_t> first(mesh.vertices.size());
  std::iota(first.begin(), first.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (first[v] != v) v = first[v];
    return v;
  };
  const auto above = [&](std::uint32_t v) { return dot(plane.normal(), mesh.vertices[v] - plane.point) > 0.0; };
  for (const Tet& t : mesh.tets) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) {
        if (above(a) == above(b)) first[std::max(root(a), root(b))] = std::min(root(a), root(b));
      }
    }
  }
  std::ptrdiff_t parts = 0;
  for (std::uint32_t v = 0; v < first.size(); ++v) parts += first[v] == v ? 1 : 0;
  return parts;
}

TEST(LiverCut, PartsItAsThePlaneDoes) {
  const std::filesystem::path file = test::shipped("../shared/data/meshes/liver.vtu");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the liver mesh is not here: " << file;
  const TetMesh mesh = read_mesh(file.string()).mesh;
  Vec3d low{1e9, 1e9, 1e9}, high = -low;
  for (const Vec3d& x : mesh.vertices) {
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], x[a]), high[a] = std::max(high[a], x[a]);
  }
  const double size = norm(high - low), whole = volume(mesh);
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    Simulation body(mesh, {{mesh.region_of(0), law_tissue()}}, {});
    Cutter cutter(body);
    const CutPlane plane = random_plane((low + high) * 0.5 + random_field(1, 0.1 * size, random)[0], random);
    const CutReport report = cut_along(cutter, plane, size, size, 20);
    const TetMesh cut = body.present_mesh();
    const std::vector<std::size_t> pieces = piece_sizes(cut);
    ASSERT_GE(pieces.size(), 2U) << seed;
    // where a lobe hangs on by less than a tet beside the plane, all of whose corners go onto the cut, it may come off too
    EXPECT_LE(std::ssize(pieces), parts_by(mesh, plane) + 3) << seed;
    EXPECT_NEAR(volume(cut), whole, 1e-12 * whole) << seed;
    EXPECT_NEAR(mass(body), law_tissue().density * whole, 1e-12 * law_tissue().density * whole) << seed;
    EXPECT_GE(worst_quality(cut), std::min(CutOptions{}.least_quality, worst_quality(mesh))) << seed;
    EXPECT_NEAR(report.faces_area, report.area, 0.2 * report.area) << seed;
    for (int i = 0; i < 20; ++i) ASSERT_LE(body.step().status, StepStatus::inverted) << seed;
  }
}

}  // namespace
}  // namespace glisson::test

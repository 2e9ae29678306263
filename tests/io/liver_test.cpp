#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "io/raw_mesh.h"
#include "support/places.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The folder of the liver's files; empty if this checkout comes without them.
std::filesystem::path mesh_folder() {
  const std::filesystem::path folder = test::shipped("../shared/data/meshes");
  return std::filesystem::exists(folder / "liver.vtu") ? folder : std::filesystem::path();
}

#define REQUIRE_LIVER()      \
  if (mesh_folder().empty()) \
  GTEST_SKIP() << "the liver's mesh files are not beside this checkout (../shared/data/meshes)"

std::string bytes_of(const char* file) {
  std::ifstream stream(mesh_folder() / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// One liver in VTU, legacy VTK 5.1, Gmsh 2.2 and Gmsh 4.1 is one mesh: every coordinate to the last bit.
TEST(Liver, IsTheSameInEveryFormat) {
  REQUIRE_LIVER();
  const ImportedMesh first = read_mesh(mesh_folder() / "liver.vtu");
  EXPECT_EQ(first.mesh.vertices.size(), 1523u);
  EXPECT_EQ(first.mesh.tets.size(), 7828u);
  for (const char* file : {"liver.vtk", "liver.msh", "liver_v41.msh"}) {
    EXPECT_TRUE(read_mesh(mesh_folder() / file).mesh == first.mesh) << file;
  }
}

// The liver is sound: one manifold piece of 1.75 litres, no warning.
TEST(Liver, IsReported) {
  REQUIRE_LIVER();
  const MeshReport report = read_mesh(mesh_folder() / "liver.vtu").report;
  EXPECT_EQ(report.boundary_triangles, 762u);
  EXPECT_EQ(report.pieces, 1u);
  EXPECT_NEAR(report.volume, 1.7531e-3, 5e-8);
  EXPECT_NEAR(report.box_max.x - report.box_min.x, 0.22168, 5e-6);
  EXPECT_NEAR(report.worst_mean_ratio, 0.148, 5e-4);
  EXPECT_NEAR(report.median_mean_ratio, 0.808, 5e-4);
  EXPECT_THAT(report.warnings, IsEmpty());
}

// A liver in millimetres is 220 m large when read as metres: said, with the scale that cures it.
TEST(Liver, InMillimetresIsSuspected) {
  REQUIRE_LIVER();
  const ImportedMesh metres = read_mesh(mesh_folder() / "liver.msh");
  const ImportedMesh large = read_mesh(mesh_folder() / "liver.msh", 1000.0);
  EXPECT_THAT(large.report.warnings, ElementsAre(AllOf(HasSubstr("221.7 m"), HasSubstr("scale = 0.001"))));
  EXPECT_NEAR(large.report.volume, 1e9 * metres.report.volume, 1e-3);
}

// A tet of the file with two vertices exchanged is turned back and said.
TEST(Liver, InvertedTetIsTurnedAndSaid) {
  REQUIRE_LIVER();
  std::string text = bytes_of("liver.msh");
  const std::size_t begin = text.find("\n1 4 ", text.find("$Elements")) + 1, end = text.find('\n', begin);
  std::istringstream line(text.substr(begin, end - begin));
  std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
  std::swap(words[words.size() - 1], words[words.size() - 2]);
  std::string turned;
  for (const std::string& word : words) turned += (turned.empty() ? "" : " ") + word;
  text.replace(begin, end - begin, turned);
  const ImportedMesh imported = detail::read_mesh_bytes(text, "liver.msh");
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("1 tet (0) was inverted (negative volume): turned")));
  EXPECT_TRUE(imported.mesh == read_mesh(mesh_folder() / "liver.msh").mesh);
}

}  // namespace
}  // namespace glisson

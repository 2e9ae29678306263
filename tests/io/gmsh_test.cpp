#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/raw_mesh.h"
#include "io/sample_meshes.h"

namespace glisson {
namespace {

using detail::read_mesh_bytes;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Version 2.2 in text and in binary of either byte order are the same mesh: sparse node numbers are mapped,
// physical volumes are regions with names, physical surfaces and points are vertex sets.
TEST(Gmsh22, TextAndBinaryAreTheSameMesh) {
  const TetMesh expected = testing::two_tets();
  for (const std::string& bytes : {testing::gmsh22_text(), testing::gmsh22_binary(), testing::gmsh22_binary(true)}) {
    const ImportedMesh imported = read_mesh_bytes(bytes, "two.msh");
    EXPECT_EQ(imported.mesh, expected);
    EXPECT_THAT(imported.report.warnings, IsEmpty());
  }
}

// The same for version 4.1, where groups belong to entities and nodes come in blocks.
TEST(Gmsh41, TextAndBinaryAreTheSameMesh) {
  const TetMesh expected = testing::two_tets_last_first();
  for (const std::string& bytes : {testing::gmsh41_text(), testing::gmsh41_binary(), testing::gmsh41_binary(true)}) {
    const ImportedMesh imported = read_mesh_bytes(bytes, "two.msh");
    EXPECT_EQ(imported.mesh, expected);
    EXPECT_THAT(imported.report.warnings, IsEmpty());
  }
}

// Lines that end in CR LF, empty lines between sections and sections that are not read change nothing.
TEST(Gmsh22, ForgivesLineEndsAndUnknownSections) {
  std::string text = testing::with(testing::gmsh22_text(), "$Nodes", "\n$Comments\nany $text\n$EndComments\n\n$Nodes");
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_mesh_bytes(text, "two.msh").mesh, testing::two_tets());
  EXPECT_EQ(read_mesh_bytes(windows, "two.msh").mesh, testing::two_tets());
}

// Groups without a name keep their number in the set's name; tets without a group are in region 0.
TEST(Gmsh22, GroupsWithoutNames) {
  std::string text = testing::with(testing::gmsh22_text(), testing::kNames, "");
  text = testing::with(text, "4 4 2 9 1 5 2", "4 4 2 0 1 5 2");
  const TetMesh mesh = read_mesh_bytes(text, "two.msh").mesh;
  EXPECT_THAT(mesh.regions, ElementsAre(7, 0));
  EXPECT_THAT(mesh.region_names, IsEmpty());
  EXPECT_THAT(mesh.vertex_sets.at("surface_4"), ElementsAre(0u, 1u, 2u));
  EXPECT_THAT(mesh.vertex_sets.at("point_3"), ElementsAre(4u));
}

// Cells that are neither linear tets nor in a named group are skipped, counted and said.
TEST(Gmsh22, SaysWhatItSkips) {
  std::string text = testing::with(testing::gmsh22_text(), "2 2 2 4 1 10 5 700", "2 2 2 0 1 10 5 700");
  const ImportedMesh imported = read_mesh_bytes(text, "two.msh");
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("skipped: 1 triangles")));
}

// A tet in two physical volumes belongs to the first, and the report says so.
TEST(Gmsh41, SaysWhichTetsAreInSeveralGroups) {
  const std::string text = testing::with(testing::gmsh41_text(), "2 0 0 0 1 1 1 1 9 0", "2 0 0 0 1 1 1 2 9 7 0");
  const ImportedMesh imported = read_mesh_bytes(text, "two.msh");
  EXPECT_THAT(imported.mesh.regions, ElementsAre(7, 9));
  EXPECT_THAT(imported.report.warnings, Contains(HasSubstr("1 tet is in more than one physical volume")));
}

}  // namespace
}  // namespace glisson

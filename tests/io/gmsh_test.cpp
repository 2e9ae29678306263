#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/raw_mesh.h"
#include "io/sample_meshes.h"

namespace glisson {
namespace {

using detail::read_mesh_bytes;
using ::testing::AllOf;
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

// A tet in two physical volumes has the first as its region and is in the vertex sets of both; the report says so.
TEST(Gmsh41, TetsInSeveralVolumesAreInTheSetsOfAll) {
  const std::string text = testing::with(testing::gmsh41_text(), "2 0 0 0 1 1 1 1 9 0", "2 0 0 0 1 1 1 2 9 7 0");
  const ImportedMesh imported = read_mesh_bytes(text, "two.msh");
  EXPECT_THAT(imported.mesh.regions, ElementsAre(7, 9));
  EXPECT_EQ(imported.mesh.vertex_sets.at("liver").size(), 5u) << "the vertices of both tets";
  EXPECT_EQ(imported.mesh.vertex_sets.at("a tumour").size(), 4u);
  EXPECT_THAT(imported.report.warnings, ElementsAre(AllOf(HasSubstr("1 tet is in more than one physical volume"),
                                                          HasSubstr("\"liver\", \"a tumour\""))));
}

// Version 2.2 writes a tet in two physical volumes twice: it is one tet, with the mass and stiffness of one, its region is the first
// volume, and both are vertex sets. Copies in one volume stay what they are, a fault that is named.
TEST(Gmsh22, ATetInSeveralVolumesIsOneTet) {
  const std::string twice = testing::with(testing::with(testing::gmsh22_text(), "$Elements\n4", "$Elements\n5"),
                                          "4 4 2 9 1 5 2 700 31\n", "4 4 2 9 1 5 2 700 31\n5 4 2 7 1 5 2 31 700\n");
  const ImportedMesh imported = read_mesh_bytes(twice, "two.msh");
  EXPECT_EQ(imported.mesh.tets, testing::two_tets().tets);
  EXPECT_THAT(imported.mesh.regions, ElementsAre(7, 9));
  EXPECT_NEAR(imported.report.volume, volume(testing::two_tets()), 1e-18);
  EXPECT_EQ(imported.mesh.vertex_sets.at("liver").size(), 5u);
  EXPECT_EQ(imported.mesh.vertex_sets.at("a tumour").size(), 4u);
  EXPECT_THAT(imported.report.duplicate_tets, IsEmpty());
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("1 tet is in more than one physical volume")));
  const ImportedMesh faulty = read_mesh_bytes(testing::with(twice, "5 4 2 7 1 5", "5 4 2 9 1 5"), "two.msh");
  EXPECT_THAT(faulty.report.duplicate_tets, ElementsAre(2u));
}

// A volume that shares tets with another does not add its vertices to the surface of the same name.
TEST(Gmsh22, ASharedVolumeKeepsApartFromASurfaceOfItsName) {
  std::string text = testing::with(testing::gmsh22_text(), "\"base\"", "\"liver\"");
  text = testing::with(testing::with(text, "$Elements\n4", "$Elements\n5"), "4 4 2 9 1 5 2 700 31\n",
                       "4 4 2 9 1 5 2 700 31\n5 4 2 7 1 5 2 31 700\n");
  const TetMesh mesh = read_mesh_bytes(text, "two.msh").mesh;
  EXPECT_THAT(mesh.vertex_sets.at("liver"), ElementsAre(0u, 1u, 2u));
  EXPECT_EQ(mesh.vertex_sets.at("volume_7").size(), 5u);
}

// A partitioned file is the mesh that was partitioned: elements belong to parts of entities, whose groups are their own or, where
// they have none, those of the entity they are part of.
TEST(Gmsh41, PartitionsKeepTheirGroups) {
  for (const std::string own : {"1 9 0", "0 0"}) {
    std::string text = testing::with(testing::gmsh41_text(), "$Nodes",
                                     "$PartitionedEntities\n2\n1\n8 1\n1 0 1 2\n4 0 1 1 1 .1 .1 .1 1 3\n"
                                     "5 2 1 2 1 2 0 0 0 1 1 1 1 4 2 1 -1\n6 3 1 1 1 0 0 0 1 1 1 1 7 0\n"
                                     "7 3 2 1 2 0 0 0 1 1 1 " +
                                         own + "\n$EndPartitionedEntities\n$Nodes");
    text = testing::with(testing::with(text, "\n0 1 15 1\n", "\n0 4 15 1\n"), "\n2 1 2 1\n", "\n2 5 2 1\n");
    text = testing::with(testing::with(text, "\n3 1 4 1\n", "\n3 6 4 1\n"), "\n3 2 4 1\n", "\n3 7 4 1\n");
    const ImportedMesh imported = read_mesh_bytes(text, "parts.msh");
    EXPECT_EQ(imported.mesh, testing::two_tets_last_first()) << own;
    EXPECT_THAT(imported.report.warnings, IsEmpty());
  }
}

// Nodes of version 2.2 with the entity they lie on and their parameters there are the same nodes.
TEST(Gmsh22, NodesWithParametersAreTheSameMesh) {
  std::string text =
      testing::with(testing::gmsh22_text(), "$Nodes\n5\n10 0 0 0\n5 0.1 0 0\n700 0 0.1 0\n31 0.01 0.02 0.1\n",
                    "$ParametricNodes\n5\n10 0 0 0 0 1\n5 0.1 0 0 1 2 .5\n700 0 0.1 0 2 1 .25 1e-3\n"
                    "31 0.01 0.02 0.1 3 1\n");
  text = testing::with(testing::with(text, "+0.1\n$End", "+0.1 2 4 0 1\n$End"), "$EndNodes", "$EndParametricNodes");
  const ImportedMesh imported = read_mesh_bytes(text, "two.msh");
  EXPECT_EQ(imported.mesh, testing::two_tets());
  EXPECT_THAT(imported.report.warnings, IsEmpty());

  testing::Bytes nodes;
  const TetMesh mesh = testing::two_tets();
  for (std::size_t v = 0; v < 5; ++v) {
    const int dimension = static_cast<int>(v) % 4;
    nodes.i(testing::kTags[v]).d(mesh.vertices[v].x).d(mesh.vertices[v].y).d(mesh.vertices[v].z).i(dimension).i(1);
    for (int p = 0; p < dimension % 3; ++p) nodes.d(0.5);
  }
  const std::string binary = testing::gmsh22_binary(), head = "$Nodes\n5\n", end = "\n$EndNodes";
  const std::size_t from = binary.find(head), to = binary.find(end);
  const std::string parametric = binary.substr(0, from) + "$ParametricNodes\n5\n" + nodes.str() +
                                 "\n$EndParametricNodes" + binary.substr(to + end.size());
  EXPECT_EQ(read_mesh_bytes(parametric, "two.msh").mesh, mesh);
}

}  // namespace
}  // namespace glisson

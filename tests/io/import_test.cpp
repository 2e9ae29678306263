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
using ::testing::SizeIs;

struct Suspicious {
  const char* file;
  std::string bytes;
  const char* sentence;
};

// Import never fails silently: whatever is odd about the mesh in a file, the report says it in one sentence.
TEST(Import, SaysWhatIsOdd) {
  using namespace glisson::testing;
  const Suspicious table[] = {
      {"a.msh", with(gmsh22_text(), "1 5 2 700 31", "1 2 5 700 31"), "1 tet (1) was inverted"},
      {"a.vtu", with(vtu_text(), "1 4 2 3", "1 2 4 3"), "1 tet (1) was inverted"},
      {"a.vtk", with(vtk_text(), "4 1 4 2 3", "4 4 1 2 3"), "1 tet (1) was inverted"},
      {"a.msh", with(gmsh41_text(), "4 5 2 700 31", "4 31 10 5 700"), "1 tet (1) has the same four vertices"},
      {"a.vtk", with(vtk_text(), "4 1 4 2 3", "4 1 0 2 3"), "1 vertex (4) is in no tet"},
      {"a.vtu", with(vtu_text(), "1 4 2 3", "1 1 2 3"), "1 tet (1) is degenerate"},
      {"a.vtk", with(vtk_text(), "0.1 0.1 0.1 0.1", "0.1 0.05 0.05 1e-20"), "1 tet (1) is degenerate"},
      {"a.msh", with(gmsh22_text(), "2 .1 1e-1 +0.1", "2 100 1e-1 +0.1"), "more than any organ"},
  };
  for (const Suspicious& s : table) {
    const ImportedMesh imported = read_mesh_bytes(s.bytes, s.file);
    EXPECT_THAT(imported.report.warnings, ::testing::Contains(HasSubstr(s.sentence))) << s.file;
  }
}

// Two bodies in one file are two pieces.
TEST(Import, SaysHowManyPieces) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 .1 0 0\n3 0 .1 0\n4 0 0 .1\n5 1 0 0\n6 1.1 0 0\n"
      "7 1 .1 0\n8 1 0 .1\n$EndNodes\n$Elements\n2\n1 4 0 1 2 3 4\n2 4 0 5 6 7 8\n$EndElements\n";
  const ImportedMesh imported = read_mesh_bytes(text, "a.msh");
  EXPECT_EQ(imported.report.pieces, 2u);
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("2 pieces that share no face")));
}

// VTU and both layouts of legacy VTK give the mesh of the Gmsh files, region numbers included.
TEST(Import, ReadsTheTextFormsOfVtk) {
  TetMesh expected = testing::two_tets();
  expected.region_names.clear();
  expected.vertex_sets.clear();
  EXPECT_EQ(read_mesh_bytes(testing::vtu_text(), "a.vtu").mesh, expected);
  EXPECT_EQ(read_mesh_bytes(testing::vtk_text(), "a.vtk").mesh, expected);
  EXPECT_EQ(read_mesh_bytes(testing::vtk5_text(), "A.VTK").mesh, expected);
}

// A legacy VTK file in binary, big-endian as all of them, is the same mesh.
TEST(Import, ReadsBinaryLegacyVtk) {
  TetMesh expected = testing::two_tets();
  expected.region_names.clear();
  expected.vertex_sets.clear();
  testing::Bytes b(true);
  b.text("# vtk DataFile Version 3.0\ntwo tets\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n");
  for (const Vec3d& x : expected.vertices) b.d(x.x).d(x.y).d(x.z);
  b.text("\nCELLS 2 10\n").i(4).i(0).i(1).i(2).i(3).i(4).i(1).i(4).i(2).i(3).text("\nCELL_TYPES 2\n").i(10).i(10);
  b.text("\nCELL_DATA 2\nSCALARS region int 1\nLOOKUP_TABLE default\n").i(7).i(9).text("\n");
  EXPECT_EQ(read_mesh_bytes(b.str(), "a.vtk").mesh, expected);
}

// Metadata, strings and attributes that are not ours, as VTK writes them, are passed over; names are decoded.
TEST(Import, ReadsLegacyVtkWithMetadata) {
  const std::string text =
      "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 3\n"
      "region:a%20tumour 1 1 int\n9 \nMETADATA\nINFORMATION 0\n\nauthor 1 2 string\nA%20B\n\nregion:liver 1 1 int\n7 \n"
      "POINTS 5 float\n0 0 0 0.5 0 0 0 0.5 0 \n0.125 0.25 0.5 0.5 0.5 0.5\nMETADATA\nINFORMATION 1\n"
      "NAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 0.173205 \n\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8 \n"
      "CONNECTIVITY vtktypeint64\n0 1 2 3 1 4 2 3 \nCELL_TYPES 2\n10\n10\n\nCELL_DATA 2\nVECTORS v float\n1 2 3 4 5 6\n"
      "FIELD FieldData 1\nregion 1 2 int\n7 9 \nMETADATA\nINFORMATION 0\n\nPOINT_DATA 5\nFIELD FieldData 2\n"
      "set:base 1 5 unsigned_char\n1 1 1 0 0 \nset:tip 1 5 unsigned_char\n0 0 0 0 1 \n";
  TetMesh expected = testing::two_tets();
  expected.vertices = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0.125, 0.25, 0.5}, {0.5, 0.5, 0.5}};
  EXPECT_EQ(read_mesh_bytes(text, "a.vtk").mesh, expected);
}

// A cell array of three components called after fibres gives each tet its direction, past cells that are no tets; one
// that is not finite is left out and said.
TEST(Import, ReadsDirectionsOfFibres) {
  using testing::with;
  std::string text = with(testing::vtk_text(), "CELLS 2 10\n", "CELLS 3 14\n3 0 1 2\n");
  text = with(text, "CELL_TYPES 2\n10 10\nCELL_DATA 2", "CELL_TYPES 3\n5 10 10\nCELL_DATA 3");
  text = with(text, "default\n7 9", "default\n1 7 9\nVECTORS fibres double\n9 9 9 0 0.5 1 0 0 0");
  const std::vector<Vec3d> expected{{0.0, 0.5, 1.0}, {}};
  EXPECT_EQ(read_mesh_bytes(text, "a.vtk").mesh.fibres, expected);
  const ImportedMesh bad = read_mesh_bytes(with(text, "9 9 9 0", "9 9 9 nan"), "a.vtk");
  EXPECT_TRUE(bad.mesh.fibres.empty());
  EXPECT_THAT(bad.report.warnings, ::testing::Contains(::testing::HasSubstr("direction of fibres")));
}

// Triangles among the cells are skipped, counted and said, and the regions stay with their tets.
TEST(Import, SkipsCellsThatAreNotTets) {
  using testing::with;
  std::string text = with(testing::vtk_text(), "CELLS 2 10\n", "CELLS 3 14\n3 0 1 2\n");
  text = with(text, "CELL_TYPES 2\n10 10\nCELL_DATA 2", "CELL_TYPES 3\n5 10 10\nCELL_DATA 3");
  text = with(text, "default\n7 9", "default\n1 7 9");
  const ImportedMesh imported = read_mesh_bytes(text, "a.vtk");
  EXPECT_THAT(imported.mesh.regions, ElementsAre(7, 9));
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("skipped: 1 triangles")));
}

// A region array with fractions is not taken for region numbers, and the report says so.
TEST(Import, SaysWhenRegionsAreNoNumbers) {
  const std::string text = testing::with(testing::vtk_text(), "region int 1\nLOOKUP_TABLE default\n7 9",
                                         "region double 1\nLOOKUP_TABLE default\n7.5 9");
  const ImportedMesh imported = read_mesh_bytes(text, "a.vtk");
  EXPECT_THAT(imported.mesh.regions, IsEmpty());
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("\"region\" does not hold whole numbers")));
}

// The scale multiplies every coordinate: millimetres become metres.
TEST(Import, ScalesCoordinates) {
  const TetMesh mesh = read_mesh_bytes(testing::vtk_text(), "a.vtk", 0.001).mesh;
  const TetMesh metres = testing::two_tets();
  for (std::size_t v = 0; v < 5; ++v) EXPECT_EQ(mesh.vertices[v], metres.vertices[v] * 0.001);
}

// The printed report names counts, box, volume in litres or millilitres, regions, sets and warnings.
TEST(FormatReport, SaysAllThatMatters) {
  const ImportedMesh imported = read_mesh_bytes(testing::gmsh22_text(), "two.msh");
  EXPECT_EQ(format_report("two.msh", imported.report, &imported.mesh),
            "two.msh\n"
            "  vertices          5\n"
            "  tetrahedra        2\n"
            "  surface           6 triangles\n"
            "  pieces            1\n"
            "  bounding box      (0, 0, 0) to (100, 100, 100) mm\n"
            "  extent            100 × 100 × 100 mm\n"
            "  volume            0.00045 m³ (450 ml)\n"
            "  shape             mean ratio: median 0.983, worst 0.884 in tet 0 (1 is best)\n"
            "  region 7          \"liver\", 1 tet, 0.00016667 m³ (166.67 ml)\n"
            "  region 9          \"a tumour\", 1 tet, 0.00028333 m³ (283.33 ml)\n"
            "  vertex set        \"base\", 3 vertices\n"
            "  vertex set        \"tip\", 1 vertex\n"
            "\nDihedral angles:\n"
            "   50°– 60°          2 ################\n"
            "   60°– 70°          3 ########################\n"
            "   70°– 80°          5 ########################################\n"
            "   80°– 90°          1 ########\n"
            "   90°–100°          1 ########\n"
            "\nNothing suspicious.\n");
  TetMesh spoilt = imported.mesh;
  spoilt.vertices.push_back({0, 0, 0});
  EXPECT_THAT(format_report("two.msh", inspect(spoilt)),
              AllOf(HasSubstr("Please note:\n  - 1 vertex (5) is in no tet"), ::testing::Not(HasSubstr("region"))));
}

}  // namespace
}  // namespace glisson

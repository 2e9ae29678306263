// abaqus_test.cpp — .inp files of Abaqus: tets, sets and regions, as its own programs and others write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/raw_mesh.h"
#include "io/sample_meshes.h"
#include "support/places.h"

namespace glisson {
namespace abaqus_test {

using detail::read_mesh_bytes;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The mesh of two tets (sample_meshes.h), as Abaqus/CAE writes one.
const std::string kTwoTets = R"(*Heading
** Job name: two  Model name: two
*Preprint, echo=NO
*Part, name=organ
*Node
      10,           0.,           0.,           0.
       5,          0.1,           0.,           0.
     700,           0.,          0.1,           0.
      31,         0.01,         0.02,          0.1
       2,         0.1D0,        +1.E-1,       1e-01
*Element, type=S3
 1, 10, 5, 700
*Element, type=C3D4
 7,  10,   5, 700,  31
 9,   5,   2, 700,
  31
*Nset, nset=base
 10, 5, 700
*Nset, nset=tip
 2,
*Nset, nset=_PickedSet2, internal, generate
   2,  700,    1
*ELSET, ELSET=liver, generate
 7, 7, 1
*Elset, elset="a tumour"
 9
** Section: Section-1
*Solid Section, elset=liver, material=soft
,
*End Part
*Assembly, name=Assembly
*Instance, name=organ-1, part=organ
*End Instance
*Node
      1,           0.,           0.,           9.
*Nset, nset=_PickedSet9, internal
 1,
*Nset, nset=reference
 1,
*Nset, nset=rim, instance=organ-1
 5, 2
*End Assembly
*Material, name=soft
*Elastic
 3000., 0.45
)";

TetMesh two_tets() {
  TetMesh mesh = testing::two_tets();
  mesh.regions = {1, 2};
  mesh.region_names = {{1, "liver"}, {2, "a tumour"}};
  mesh.vertex_sets["rim"] = {1, 4};
  return mesh;
}

// Nodes keep their order, whatever their numbers; named sets are kept, those of the program itself and points of reference are not; a line that goes
// on is one element.
TEST(Abaqus, IsTheMeshThatItSays) {
  const ImportedMesh imported = read_mesh_bytes(kTwoTets, "two.inp");
  EXPECT_EQ(imported.mesh, two_tets());
  EXPECT_THAT(imported.report.warnings, ElementsAre(HasSubstr("skipped: 1 elements of type S3")));
  std::string windows = kTwoTets;
  for (std::size_t i = 0; (i = windows.find('\n', i)) != std::string::npos; i += 2) windows.replace(i, 1, "\r\n");
  EXPECT_EQ(read_mesh_bytes(windows, "TWO.INP").mesh, two_tets());
}

// Where element sets share tets, the smaller one has them, whatever their order in the file; the larger is a vertex set too, and that is said.
TEST(Abaqus, GivesSharedTetsToTheSmallerSet) {
  const std::string text = testing::with(kTwoTets, "generate\n 7, 7, 1", "generate\n 1, 9, 2");
  const ImportedMesh imported = read_mesh_bytes(text, "two.inp");
  EXPECT_THAT(imported.mesh.regions, ElementsAre(2, 1));
  EXPECT_EQ(imported.mesh.region_names.at(1), "a tumour");
  EXPECT_EQ(imported.mesh.region_names.at(2), "liver");
  EXPECT_THAT(imported.mesh.vertex_sets.at("liver"), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(imported.report.warnings, Contains(HasSubstr("\"liver\" shares tets with smaller ones")));
}

// The shared liver in Abaqus' format is that in VTK's: every vertex and tet.
TEST(Abaqus, ReadsTheLiver) {
  const std::filesystem::path folder = test::shipped("../shared/data/meshes");
  if (!std::filesystem::exists(folder / "liver.inp")) GTEST_SKIP() << "the liver is not here: " << folder;
  const ImportedMesh inp = read_mesh(folder / "liver.inp");
  const TetMesh vtu = read_mesh(folder / "liver.vtu").mesh;
  EXPECT_EQ(inp.mesh.vertices, vtu.vertices);
  EXPECT_EQ(inp.mesh.tets, vtu.tets);
  EXPECT_EQ(inp.mesh.region_names.at(inp.mesh.region_of(0)), "Perfu");
  EXPECT_THAT(inp.mesh.vertex_sets.at("FixT"), ::testing::SizeIs(63));
}

// What is not read or not right is refused with its line.
TEST(Abaqus, ExplainsWhatItRefuses) {
  const auto fault = [](const std::string& from, const std::string& to) -> std::string {
    try {
      read_mesh_bytes(testing::with(kTwoTets, from, to), "two.inp");
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(fault("*Heading", "Heading"), HasSubstr("two.inp:1: an Abaqus file begins with a keyword"));
  EXPECT_THAT(fault("*End Part", "*Part, name=b\n*Node\n 1, 0, 0, 0\n*End Part"), HasSubstr("nodes of a second part"));
  EXPECT_THAT(fault("*Preprint, echo=NO", "*Include, input=mesh.inp"), HasSubstr("two.inp:3: *include is not read"));
  EXPECT_THAT(fault(" 7,  10,", " 7,  11,"), HasSubstr("two.inp:14: element 7 refers to node 11"));
  EXPECT_THAT(fault("           0.,          0.1,           0.\n      31",
                    "           0.,          inf,           0.\n      31"),
              HasSubstr("two.inp:8: expected y, a finite number"));
  EXPECT_THAT(fault("       5,", "      10,"), HasSubstr("node 10 is given twice"));
  EXPECT_THAT(fault("  31\n*Nset, nset=base", "*Nset, nset=base"), HasSubstr("has 3 nodes of 4"));
  EXPECT_THAT(fault("type=C3D4", "type=C3D8"),
              HasSubstr("no tetrahedra in the file (it has 2 elements of type C3D8, 1 elements of type S3)"));
}

// ── tets of ten nodes ────────────────────────────────────────────────────────────────────────────────────────────────────────────────

/// A tet whose edge from (1, 0, 0) to (0, 1, 0) bulges outward by 0.05 along x and y each. Its volume is 1/6 more by
/// ∫ over the quadratic map: 11/60 (exact: the tet of python's sympy, 0.18333…).
constexpr const char* kPoints[10] = {"0 0 0",       "1 0 0",   "0 1 0",   "0 0 1",     "0.5 0 0",
                                     "0.55 0.55 0", "0 0.5 0", "0 0 0.5", "0.5 0 0.5", "0 0.5 0.5"};

std::string with_commas(std::string text) {
  std::replace(text.begin(), text.end(), ' ', ',');
  return text;
}

std::string abaqus_curved() {
  std::string text = "*NODE, NSET=all\n";
  for (int i = 0; i < 10; ++i) text += std::to_string(i + 1) + "," + with_commas(kPoints[i]) + "\n";
  return text + "*ELEMENT, TYPE=C3D10M, ELSET=organ\n1, 1, 2, 3, 4, 5, 6, 7,\n 8, 9, 10\n";
}

/// Of Gmsh the last two nodes stand the other way round.
std::string gmsh_curved() {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n";
  for (int i = 0; i < 10; ++i) text += std::to_string(i + 1) + " " + kPoints[i] + "\n";
  return text + "$EndNodes\n$Elements\n1\n1 11 2 1 1 1 2 3 4 5 6 7 8 10 9\n$EndElements\n";
}

std::string vtk_curved() {
  std::string text = "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n";
  for (const char* point : kPoints) text += std::string(point) + "\n";
  return text + "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n";
}

std::string vtu_curved() {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"10\" NumberOfCells=\"1\">\n<Points>\n"
      "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const char* point : kPoints) text += std::string(point) + "\n";
  return text +
         "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n"
         "0 1 2 3 4 5 6 7 8 9\n</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" "
         "format=\"ascii\">\n10\n</DataArray>\n"
         "<DataArray type=\"UInt8\" Name=\"types\" "
         "format=\"ascii\">\n24\n</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

// A tet of ten nodes is taken by its corners in every format, without its middle nodes, and what its bulge has of the volume is said: 1/6 of 11/60
// is lost to 1/60, 9.1 %.
TEST(CurvedTets, AreTakenByTheirCornersInEveryFormat) {
  for (const auto& [name, bytes] : {std::pair("a.inp", abaqus_curved()), std::pair("a.msh", gmsh_curved()),
                                    std::pair("a.vtk", vtk_curved()), std::pair("a.vtu", vtu_curved())}) {
    const ImportedMesh imported = read_mesh_bytes(bytes, name);
    EXPECT_EQ(imported.mesh.vertices.size(), 4U) << name;
    EXPECT_THAT(imported.mesh.tets, ElementsAre(Tet{0, 1, 2, 3})) << name;
    EXPECT_THAT(imported.report.warnings,
                Contains(HasSubstr("1 tet of 10 nodes was taken by the corners: straight edges lose 1.67e+04 ml of the "
                                   "body's 1.833e+05 ml (9.1 %)")))
        << name;
  }
  EXPECT_THAT(read_mesh_bytes(abaqus_curved(), "a.inp").mesh.vertex_sets.at("all"), ElementsAre(0, 1, 2, 3));
}

// Middle nodes on straight edges lose nothing; two tets that share them are one mesh.
TEST(CurvedTets, LoseNothingByStraightEdges) {
  std::string straight = abaqus_curved();
  straight = testing::with(straight, "0.55,0.55,0", "0.5,0.5,0");
  EXPECT_THAT(read_mesh_bytes(straight, "a.inp").report.warnings, Contains(HasSubstr("lose 0 ml")));
}

// ── units ────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────

// Without a scale a body larger than any organ is taken to be in millimetres, and that is said; one in metres is as it is.
TEST(ReadMesh, FindsMillimetres) {
  const ImportedMesh metres = read_mesh_bytes(kTwoTets, "two.inp", std::nullopt);
  EXPECT_EQ(metres.mesh.vertices, two_tets().vertices);
  std::string large = kTwoTets;
  for (const auto& [from, to] : {std::pair("0.1,           0.,           0.", "100.,           0.,           0."),
                                 std::pair("0.,          0.1,           0.", "0.,          100.,           0."),
                                 std::pair("0.01,         0.02,          0.1", "10,         20,          100"),
                                 std::pair("0.1D0,        +1.E-1,       1e-01", "100,        100,       100")}) {
    large = testing::with(large, from, to);
  }
  const ImportedMesh millimetres = read_mesh_bytes(large, "two.inp", std::nullopt);
  for (std::size_t v = 0; v < 5; ++v)
    EXPECT_NEAR(norm(millimetres.mesh.vertices[v] - two_tets().vertices[v]), 0.0, 1e-16);
  EXPECT_THAT(millimetres.report.warnings, Contains(HasSubstr("it was read as millimetres. Give scale = 1")));
}

}  // namespace abaqus_test
}  // namespace glisson

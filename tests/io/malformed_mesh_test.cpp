#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/raw_mesh.h"
#include "io/sample_meshes.h"
#include "support/folder.h"

namespace glisson {
namespace {

using namespace glisson::testing;

struct Malformed {
  const char* title;
  const char* file;
  std::string bytes;
  const char* message;  ///< what the user must read; every message also begins with the file's name
};

void PrintTo(const Malformed& m, std::ostream* out) { *out << m.title; }

class MalformedMesh : public ::testing::TestWithParam<Malformed> {};

// A mesh file that cannot be used is refused with the file, the place in it, the value and what is wrong.
TEST_P(MalformedMesh, IsRefusedWithItsReason) {
  const Malformed& m = GetParam();
  try {
    detail::read_mesh_bytes(m.bytes, m.file);
    FAIL() << m.title << ": accepted";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith(m.file));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(m.message)) << m.title;
  }
}

std::string cut(const std::string& bytes, const std::string& at, std::size_t after = 0) {
  return bytes.substr(0, bytes.find(at) + after);
}

const std::vector<Malformed> kGmshText = {
    {"not Gmsh at all", "a.msh", "hello\nworld\n", "a.msh:1: expected a section such as $Nodes, found \"hello\""},
    {"version 1", "a.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "begins with $MeshFormat"},
    {"version 4.0", "a.msh", with(gmsh41_text(), "4.1 0 8", "4 0 8"),
     "a.msh:2, $MeshFormat, format: Gmsh format 4 is not read"},
    {"file type", "a.msh", with(gmsh22_text(), "2.2 0 8", "2.2 3 8"), "file type 3; it must be 0 (text) or 1 (binary)"},
    {"data size", "a.msh", with(gmsh22_text(), "2.2 0 8", "2.2 0 16"), "data size 16"},
    {"unquoted name", "a.msh", with(gmsh22_text(), "\"base\"", "base"),
     "a.msh:7, $PhysicalNames, name 2: expected the name in double quotes"},
    {"group dimension", "a.msh", with(gmsh22_text(), "0 3 \"tip\"", "5 3 \"tip\""), "dimension 5 of a physical group"},
    {"absurd node count", "a.msh", with(gmsh22_text(), "$Nodes\n5", "$Nodes\n99999999999"),
     "the file says 99999999999 nodes, but only"},
    {"negative count", "a.msh", with(gmsh22_text(), "$Nodes\n5", "$Nodes\n-5"),
     "expected the number of nodes, an integer from 0, found \"-5\""},
    {"too few nodes", "a.msh", with(gmsh22_text(), "$Nodes\n5", "$Nodes\n6"),
     "node 6: expected the node number, an integer, found \"$EndNodes\""},
    {"too many nodes", "a.msh", with(gmsh22_text(), "$Nodes\n5", "$Nodes\n4"),
     "expected $EndNodes, found \"2 .1 1e-1 +0.1\": more entries than the count says"},
    {"duplicate node number", "a.msh", with(gmsh22_text(), "\n5 0.1", "\n10 0.1"), "node 10 is given twice"},
    {"missing coordinate", "a.msh", with(gmsh22_text(), "700 0 0.1 0", "700 0 0.1"),
     "a.msh:15, $Nodes, node 3: expected z, found the end of the line"},
    {"word for a coordinate", "a.msh", with(gmsh22_text(), "700 0 0.1", "700 0 0,1"),
     "a.msh:15, $Nodes, node 3: expected y, a number, found \"0,1\""},
    {"nan coordinate", "a.msh", with(gmsh22_text(), "700 0 0.1", "700 nan 0.1"),
     "a.msh:15, $Nodes, node 3: the coordinates are not finite"},
    {"inf coordinate", "a.msh", with(gmsh22_text(), "700 0 0.1", "700 0 -inf"), "not finite"},
    {"unknown node", "a.msh", with(gmsh22_text(), "1 5 2 700 31", "1 5 3 700 31"),
     "a.msh:24, $Elements, element 4: refers to node 3, which $Nodes does not hold"},
    {"unknown element type", "a.msh", with(gmsh22_text(), "2 2 2 4 1", "2 77 2 4 1"),
     "a.msh:22, $Elements, element 2: unknown element type 77"},
    {"tet with three nodes", "a.msh", with(gmsh22_text(), "10 5 700 31", "10 5 700"),
     "element 3: expected a node number, found the end of the line"},
    {"absurd element count", "a.msh", with(gmsh22_text(), "$Elements\n4", "$Elements\n1000000"),
     "the file says 1000000 elements"},
    {"absurd tag count", "a.msh", with(gmsh22_text(), "4 4 2 9", "4 4 -2 9"), "-2 tags of element"},
    {"elements before nodes", "a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Elements\n0\n$EndElements\n",
     "$Elements stands before $Nodes"},
    {"no tets", "a.msh",
     with(with(gmsh22_text(), "3 4 2 7 1 10 5 700 31", "3 3 2 0 1 10 5 700 31"), "4 4 2 9 1 5 2", "4 3 2 0 1 5 2"),
     "no tetrahedra in the file (it has 2 quadrangles)"},
    {"no nodes section", "a.msh", cut(gmsh22_text(), "$Nodes"),
     "the file ends without a $Nodes section: it is cut off"},
    {"no elements section", "a.msh", cut(gmsh22_text(), "$Elements"), "the file ends without an $Elements section"},
    {"cut in the nodes", "a.msh", cut(gmsh22_text(), "\n2 .1", 5),
     "a.msh:17, $Nodes, node 5: expected y, found the end of the file"},
    {"cut before the end", "a.msh", cut(gmsh22_text(), "$EndElements"),
     "the file ends before $EndElements: it is cut off"},
    {"two node sections", "a.msh", with(gmsh22_text(), "$Elements", "$Nodes\n0\n$EndNodes\n$Elements"),
     "a second $Nodes section"},
    {"4.1: sum of blocks", "a.msh", with(gmsh41_text(), "2 5 2 700", "2 6 2 700"),
     "the header says 6 nodes, the blocks hold 5"},
    {"4.1: sum of elements", "a.msh", with(gmsh41_text(), "4 4 1 4", "4 5 1 4"),
     "the header says 5 elements, the blocks hold 4"},
    {"4.1: absurd block", "a.msh", with(gmsh41_text(), "3 1 0 4", "3 1 0 18446744073709551615"),
     "the file says 18446744073709551615 nodes"},
    {"4.1: parametric flag", "a.msh", with(gmsh41_text(), "3 1 0 4", "3 1 7 4"), "parametric flag 7; 0 or 1"},
    {"4.1: unknown node", "a.msh", with(gmsh41_text(), "4 5 2 700 31", "4 5 2 701 31"),
     "element 4: refers to node 701"},
    {"parameters on nothing", "a.msh",
     with(with(with(gmsh22_text(), "$Nodes\n5\n10 0 0 0", "$ParametricNodes\n5\n10 0 0 0 4 1"), "$EndNodes",
               "$EndParametricNodes"),
          "+0.1", "+0.1 3 1"),
     "a.msh:13, $ParametricNodes, node 1: entity dimension 4; from 0 to 3"},
    {"parameters missing", "a.msh",
     with(with(gmsh22_text(), "$Nodes\n5\n10 0 0 0", "$ParametricNodes\n5\n10 0 0 0 2 1 0.5"), "$EndNodes",
          "$EndParametricNodes"),
     "a.msh:13, $ParametricNodes, node 1: expected a parametric coordinate, found the end of the line"},
    {"4.1: absurd ghosts", "a.msh",
     with(gmsh41_text(), "$Nodes", "$PartitionedEntities\n2\n100000\n$EndPartitionedEntities\n$Nodes"),
     "$PartitionedEntities, number of ghost entities: the file says 100000 ghost entities"},
    {"4.1: partitions cut", "a.msh", with(gmsh41_text(), "$Nodes", "$PartitionedEntities\n2\n0\n0 0 0 1\n3 3\n"),
     "$PartitionedEntities, volume 1: expected the parent's tag"},
    {"4.1: absurd groups", "a.msh", with(gmsh41_text(), "1 1 1 1 7", "1 1 1 99999 7"),
     "$Entities, volume 1: the file says 99999 physical tags"},
};

const std::vector<Malformed> kGmshBinary = {
    {"byte order mark", "b.msh", with(gmsh22_binary(), std::string("\1\0\0\0", 4), std::string("\2\0\0\0", 4)),
     "the byte order mark is 2 instead of 1"},
    {"cut in the nodes", "b.msh", cut(gmsh22_binary(), "$Nodes", 6 + 3 + 28 * 3 + 10),
     "bytes are left: the count is wrong or the file is cut off"},
    {"cut in the elements", "b.msh", cut(gmsh22_binary(), "$Elements", 9 + 3 + 50),
     "$Elements, element 2: the file ends before a tag: it is cut off"},
    {"block larger than the count", "b.msh", with(gmsh22_binary(), "$Elements\n4", "$Elements\n3"),
     "a block of 2 elements where 1 are left of the count"},
    {"not finite", "b.msh", with(gmsh22_binary(), Bytes().d(0.02).str(), Bytes().d(INFINITY).str()),
     "$Nodes, node 4: the coordinates are not finite"},
    {"unknown type", "b.msh", with(gmsh22_binary(), Bytes().i(4).i(2).i(2).str(), Bytes().i(400).i(2).i(2).str()),
     "$Elements, element 3: unknown element type 400"},
    {"4.1: cut", "b.msh", cut(gmsh41_binary(), "$Elements", 80), "the file says 4 blocks, but only"},
    {"4.1: absurd entities", "b.msh",
     with(gmsh41_binary(), Bytes().n(1).n(1).n(1).n(2).str(), Bytes().n(1).n(1).n(1).n(1ull << 60).str()),
     "the file says 1152921504606846976 entities"},
    {"4.1: unknown node", "b.msh", with(gmsh41_binary(), Bytes().n(4).n(5).n(2).str(), Bytes().n(4).n(5).n(3).str()),
     "$Elements, element 4: refers to node 3"},
};

const std::vector<Malformed> kVtk = {
    {"other kind of VTK file", "c.vtu", with(vtu_text(), "\"UnstructuredGrid\"", "\"PolyData\""),
     "c.vtu: a VTK file of type \"PolyData\"; tetrahedra come in files of type UnstructuredGrid"},
    {"not XML", "c.vtu", "points and tets", "it is no XML that VTK can read: Error parsing XML in stream at line 1"},
    {"broken XML", "c.vtu", with(vtu_text(), "</Points>", "</Point>"), "line 9"},
    {"cut off", "c.vtu", cut(vtu_text(), "10 10"), "at line 18, column 0, byte index 541: no element found"},
    {"absurd number of points", "c.vtu", with(vtu_text(), "NumberOfPoints=\"5\"", "NumberOfPoints=\"5000000000\""),
     "c.vtu:4, Piece: NumberOfPoints = 5000000000 is more than the file has room for"},
    {"number of points that is none", "c.vtu", with(vtu_text(), "NumberOfPoints=\"5\"", "NumberOfPoints=\"five\""),
     "c.vtu:4, Piece: NumberOfPoints = \"five\"; it must be an integer from 0"},
    {"fewer points than said", "c.vtu", with(vtu_text(), "0 0 0 0.1", "0 0.1"),
     "c.vtu:6, array \"Points\": it must have 15 values, but only 13 can be read"},
    {"vertex out of range", "c.vtu", with(vtu_text(), "1 4 2 3", "1 5 2 3"),
     "c.vtu, cell 1: refers to vertex 5, but the file has 5 vertices, numbered from 0"},
    {"negative vertex", "c.vtu", with(vtu_text(), "1 4 2 3", "1 -4 2 3"), "refers to vertex -4"},
    {"offsets that fall", "c.vtu", with(vtu_text(), "4 8", "8 4"),
     "c.vtu:14, array \"offsets\": the offsets of the cells must rise from 0"},
    {"tet with three vertices", "c.vtu", with(vtu_text(), "4 8", "5 8"),
     "c.vtu, cell 0: type 10 (tetrahedra) takes 4 vertices; it has 5"},
    {"nan coordinate", "c.vtu", with(vtu_text(), "0.01 0.02", "nan 0.02"),
     "vertex 3 is at (nan, 0.02, 0.1); coordinates must be finite"},
    {"no tets", "c.vtu", with(vtu_text(), "10 10", "9 9"), "no tetrahedra in the file (it has 2 quadrangles)"},
    {"more points than said", "c.vtu", with(vtu_text(), "0 0 0 0.1", "0 0 0 0 0.1"),
     "array \"Points\": it must have 15 values, but has more"},
    {"more cells than offsets", "c.vtu", with(vtu_text(), "NumberOfCells=\"2\"", "NumberOfCells=\"4\""),
     "array \"offsets\": it must have 4 values, but only 2 can be read"},
    {"points of two components", "c.vtu", with(vtu_text(), "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
     "points must have 3 components"},
    {"array of no known type", "c.vtu", with(vtu_text(), "\"Int64\"", "\"Int46\""),
     "array \"connectivity\": type \"Int46\" is not one of numbers"},
    {"connectivity of fractions", "c.vtu", with(vtu_text(), "\"Int64\"", "\"Float64\""),
     "array \"connectivity\": it must hold integers, not Float64"},
    {"no types", "c.vtu", with(vtu_text(), "\"types\"", "\"kinds\""),
     "a piece without the array \"types\" of its cells"},
    {"unknown compressor", "c.vtu", with(vtu_text(), "byte_order", "compressor=\"Zstd\" byte_order"),
     "compressor \"Zstd\" is not known"},
    {"appended data that are not there", "c.vtu",
     with(vtu_text(), "format=\"ascii\"", "format=\"appended\" offset=\"700\""), "array \"Points\": "},
    {"binary block larger than the file", "c.vtu",
     with(with(vtu_text(), "\"UInt8\" Name=\"types\" format=\"ascii\"", "\"UInt8\" Name=\"types\" format=\"binary\""),
          "10 10", "////fw=="),
     "array \"types\": its data claim 1 blocks of 2147483647 bytes"},
    {"not VTK", "d.vtk", "hello\n", "d.vtk:1: a legacy VTK file begins with"},
    {"data set", "d.vtk", with(vtk_text(), "UNSTRUCTURED_GRID", "POLYDATA"),
     "d.vtk:4: a data set of type \"polydata\""},
    {"encoding", "d.vtk", with(vtk_text(), "ASCII", "UTF8"), "expected ASCII or BINARY, found \"utf8\""},
    {"absurd number of points", "d.vtk", with(vtk_text(), "POINTS 5", "POINTS 5000000000"),
     "d.vtk:5, POINTS: 5000000000 as the number of points is more than the file has room for"},
    {"fewer points than said", "d.vtk", with(vtk_text(), "0 0 0 0.1 ", ""),
     "d.vtk:8, POINTS: expected number 12 of 15, found \"CELLS\""},
    {"word for a coordinate", "d.vtk", with(vtk_text(), "0.01 0.02", "0.01 left"),
     "d.vtk:7, POINTS: expected number 11 of 15, found \"left\""},
    {"nan coordinate", "d.vtk", with(vtk_text(), "0.01 0.02", "nan 0.02"),
     "vertex 3 is at (nan, 0.02, 0.1); coordinates must be finite"},
    {"vertex out of range", "d.vtk", with(vtk_text(), "4 1 4 2 3", "4 1 5 2 3"),
     "d.vtk, cell 1: refers to vertex 5, but the file has 5 vertices, numbered from 0"},
    {"cell longer than the list", "d.vtk", with(vtk_text(), "4 1 4 2 3", "6 1 4 2 3"),
     "d.vtk:10, CELLS: cell 1 says 6 vertices where the list has 4 numbers left"},
    {"cells and types differ", "d.vtk", with(vtk_text(), "CELL_TYPES 2", "CELL_TYPES 3"),
     "CELL_TYPES: 3 cell types for 2 cells"},
    {"cell data of another size", "d.vtk", with(vtk_text(), "CELL_DATA 2", "CELL_DATA 3"),
     "3 items where the mesh has 2"},
    {"type of another size", "d.vtk", with(vtk_text(), "10 10", "10 1"),
     "cell 1: type 1 (vertices) takes 1 vertices; it has 4"},
    {"cell type", "d.vtk", with(vtk_text(), "10 10", "10 300"),
     "CELL_TYPES: cell 1 has type 300; it must be from 0 to 255"},
    {"offsets that fall", "d.vtk", with(vtk5_text(), "0 4 8", "0 8 4"),
     "the offsets must rise from 0 to the length of the connectivity, 8"},
    {"unknown keyword", "d.vtk", vtk_text() + "SHAPES 2\n", "SHAPES: unknown keyword"},
    {"cut off", "d.vtk", cut(vtk_text(), "CELL_TYPES"), "the file ends without CELL_TYPES: it is cut off"},
    {"no known ending", "e.bdf", "solid", "unknown ending \".bdf\"; meshes are read from .vtu"},
    {"no ending", "e", "solid", "the name has no ending"},
};

INSTANTIATE_TEST_SUITE_P(GmshText, MalformedMesh, ::testing::ValuesIn(kGmshText));
INSTANTIATE_TEST_SUITE_P(GmshBinary, MalformedMesh, ::testing::ValuesIn(kGmshBinary));
INSTANTIATE_TEST_SUITE_P(Vtk, MalformedMesh, ::testing::ValuesIn(kVtk));

// No prefix of a good file is accepted as another mesh, and none does worse than a FileError.
TEST(MalformedMeshPrefix, IsNeverAnotherMesh) {
  const std::pair<const char*, std::string> files[] = {
      {"a.msh", gmsh22_text()}, {"a.msh", gmsh41_text()}, {"a.msh", gmsh22_binary()}, {"a.msh", gmsh41_binary()},
      {"a.vtu", vtu_text()},    {"a.vtk", vtk_text()},    {"a.vtk", vtk5_text()}};
  for (const auto& [name, bytes] : files) {
    const TetMesh whole = detail::read_mesh_bytes(bytes, name).mesh;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      try {
        TetMesh part = detail::read_mesh_bytes(bytes.substr(0, size), name).mesh;
        part.regions = whole.regions;  // a legacy VTK file may end before its cell data
        EXPECT_TRUE(part == whole) << name << " cut after " << size << " bytes";
      } catch (const FileError&) {
      }
    }
  }
}

// A scale that is not a positive number is refused by name.
TEST(MalformedMeshScale, IsRefused) {
  for (const double scale : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
    try {
      detail::read_mesh_bytes(gmsh22_text(), "a.msh", scale);
      FAIL() << "accepted scale " << scale;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("scale = "));
    }
  }
}

// A file that is missing, a folder or empty is refused as what it is.
TEST(MalformedMeshFile, IsRefused) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      read_mesh(file);
    } catch (const FileError& error) {
      return error.what();
    }
    return "accepted";
  };
  const test::Folder own;
  const std::filesystem::path folder = own.path() / "folder.msh";
  std::filesystem::create_directories(folder);
  EXPECT_THAT(message("no/such/mesh.vtu"), ::testing::HasSubstr("no/such/mesh.vtu: there is no such file"));
  EXPECT_THAT(message(folder), ::testing::HasSubstr("is a folder; name a mesh file"));
  EXPECT_THAT(
      message("organ.bdf"),
      ::testing::AllOf(::testing::HasSubstr("unknown ending \".bdf\""),
                       ::testing::HasSubstr("convert others in Python: glisson.convert(\"organ.bdf\", \"mesh.vtu\")")));
}

}  // namespace
}  // namespace glisson

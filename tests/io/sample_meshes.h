// sample_meshes.h — one small mesh with everything a file can carry, and its bytes in each variety of Gmsh.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "glisson/io.h"

namespace glisson::testing {

/// Two tets that share a face, in two named regions; the surface group "base" and the point group "tip".
inline TetMesh two_tets() {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.01, 0.02, 0.1}, {0.1, 0.1, 0.1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 4, 2, 3}};
  mesh.regions = {7, 9};
  mesh.region_names = {{7, "liver"}, {9, "a tumour"}};
  mesh.vertex_sets = {{"base", {0, 1, 2}}, {"tip", {4}}};
  return mesh;
}

/// Node numbers in the Gmsh files of two_tets: with gaps and not in order.
inline constexpr int kTags[5] = {10, 5, 700, 31, 2};

inline constexpr const char* kNames =
    "$PhysicalNames\n4\n0 3 \"tip\"\n2 4 \"base\"\n3 7 \"liver\"\n3 9 \"a tumour\"\n$EndPhysicalNames\n";

/// Bytes of numbers, in this machine's order or the other one.
class Bytes {
 public:
  explicit Bytes(bool swapped = false) : swapped_(swapped) {}
  Bytes& text(const std::string& s) { return out_ += s, *this; }
  Bytes& i(int value) { return number(value); }
  Bytes& n(std::uint64_t value) { return number(value); }
  Bytes& d(double value) { return number(value); }
  const std::string& str() const { return out_; }

 private:
  template <class T>
  Bytes& number(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (swapped_) std::reverse(raw, raw + sizeof(T));
    out_.append(raw, sizeof(T));
    return *this;
  }
  std::string out_;
  bool swapped_;
};

inline std::string gmsh22_text() {
  return std::string("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n") + kNames +
         "$Nodes\n5\n10 0 0 0\n5 0.1 0 0\n700 0 0.1 0\n31 0.01 0.02 0.1\n2 .1 1e-1 +0.1\n$EndNodes\n"
         "$Elements\n4\n1 15 2 3 1 2\n2 2 2 4 1 10 5 700\n3 4 2 7 1 10 5 700 31\n4 4 2 9 1 5 2 700 31\n$EndElements\n";
}

inline std::string gmsh41_text() {
  return std::string("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n") + kNames +
         "$Entities\n1 1 1 2\n1 .1 .1 .1 1 3\n1 0 0 0 1 1 1 0 2 1 -1\n1 0 0 0 1 1 1 1 4 1 1\n"
         "1 0 0 0 1 1 1 1 7 1 1\n2 0 0 0 1 1 1 1 9 0\n$EndEntities\n"
         "$Nodes\n2 5 2 700\n0 1 0 1\n2\n.1 .1 .1\n3 1 0 4\n10\n5\n700\n31\n0 0 0\n0.1 0 0\n0 0.1 0\n0.01 0.02 0.1\n"
         "$EndNodes\n$Elements\n4 4 1 4\n0 1 15 1\n1 2\n2 1 2 1\n2 10 5 700\n3 1 4 1\n3 10 5 700 31\n"
         "3 2 4 1\n4 5 2 700 31\n$EndElements\n";
}

inline std::string gmsh22_binary(bool swapped = false) {
  const TetMesh mesh = two_tets();
  Bytes b(swapped);
  b.text("$MeshFormat\n2.2 1 8\n").i(1).text("\n$EndMeshFormat\n").text(kNames).text("$Nodes\n5\n");
  for (std::size_t v = 0; v < 5; ++v) {
    b.i(kTags[v]).d(mesh.vertices[v].x).d(mesh.vertices[v].y).d(mesh.vertices[v].z);
  }
  b.text("\n$EndNodes\n$Elements\n4\n");
  b.i(15).i(1).i(2).i(1).i(3).i(1).i(2);
  b.i(2).i(1).i(2).i(2).i(4).i(1).i(10).i(5).i(700);
  b.i(4).i(2).i(2).i(3).i(7).i(1).i(10).i(5).i(700).i(31).i(4).i(9).i(1).i(5).i(2).i(700).i(31);
  return b.text("\n$EndElements\n").str();
}

/// Vertex 4 comes first in this file, in a block of its own with parametric coordinates.
inline std::string gmsh41_binary(bool swapped = false) {
  const TetMesh mesh = two_tets();
  Bytes b(swapped);
  b.text("$MeshFormat\n4.1 1 8\n").i(1).text("\n$EndMeshFormat\n").text(kNames).text("$Entities\n");
  b.n(1).n(1).n(1).n(2);
  b.i(1).d(.1).d(.1).d(.1).n(1).i(3);
  b.i(1).d(0).d(0).d(0).d(1).d(1).d(1).n(0).n(2).i(1).i(-1);
  b.i(1).d(0).d(0).d(0).d(1).d(1).d(1).n(1).i(4).n(1).i(1);
  b.i(1).d(0).d(0).d(0).d(1).d(1).d(1).n(1).i(7).n(1).i(1);
  b.i(2).d(0).d(0).d(0).d(1).d(1).d(1).n(1).i(9).n(0);
  b.text("\n$EndEntities\n$Nodes\n").n(2).n(5).n(2).n(700);
  b.i(1).i(1).i(1).n(1).n(2).d(.1).d(.1).d(.1).d(0.5);
  b.i(3).i(1).i(0).n(4).n(10).n(5).n(700).n(31);
  for (std::size_t v = 0; v < 4; ++v) b.d(mesh.vertices[v].x).d(mesh.vertices[v].y).d(mesh.vertices[v].z);
  b.text("\n$EndNodes\n$Elements\n").n(4).n(4).n(1).n(4);
  b.i(0).i(1).i(15).n(1).n(1).n(2);
  b.i(2).i(1).i(2).n(1).n(2).n(10).n(5).n(700);
  b.i(3).i(1).i(4).n(1).n(3).n(10).n(5).n(700).n(31);
  b.i(3).i(2).i(4).n(1).n(4).n(5).n(2).n(700).n(31);
  return b.text("\n$EndElements\n").str();
}

/// two_tets with the vertices in the order of the 4.1 files, which hold vertex 4 first.
inline TetMesh two_tets_last_first() {
  TetMesh mesh = two_tets();
  std::rotate(mesh.vertices.begin(), mesh.vertices.begin() + 4, mesh.vertices.end());
  for (Tet& tet : mesh.tets) {
    for (std::uint32_t& v : tet) v = (v + 1) % 5;
  }
  mesh.vertex_sets = {{"base", {1, 2, 3}}, {"tip", {0}}};
  return mesh;
}

inline std::string vtu_text() {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
         "<UnstructuredGrid>\n<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<Points>\n"
         "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n"
         "0 0 0 0.1 0 0 0 0.1 0 0.01 0.02 0.1 0.1 0.1 0.1\n</DataArray>\n</Points>\n<Cells>\n"
         "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n0 1 2 3 1 4 2 3\n</DataArray>\n"
         "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n4 8\n</DataArray>\n"
         "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n10 10\n</DataArray>\n</Cells>\n"
         "<CellData>\n<DataArray type=\"Int32\" Name=\"region\" format=\"ascii\">\n7 9\n</DataArray>\n</CellData>\n"
         "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

inline std::string vtk_text() {
  return "# vtk DataFile Version 3.0\ntwo tets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
         "0 0 0 0.1 0 0 0 0.1 0\n0.01 0.02 0.1 0.1 0.1 0.1\nCELLS 2 10\n4 0 1 2 3\n4 1 4 2 3\nCELL_TYPES 2\n10 10\n"
         "CELL_DATA 2\nSCALARS region int 1\nLOOKUP_TABLE default\n7 9\n";
}

inline std::string vtk5_text() {
  return "# vtk DataFile Version 5.1\ntwo tets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
         "0 0 0 0.1 0 0 0 0.1 0\n0.01 0.02 0.1 0.1 0.1 0.1\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\n"
         "CONNECTIVITY vtktypeint64\n0 1 2 3 1 4 2 3\nCELL_TYPES 2\n10\n10\n"
         "CELL_DATA 2\nFIELD FieldData 1\nregion 1 2 int\n7 9\n";
}

/// The first occurrence of `from` replaced; the test that asks for it fails loudly if there is none.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("test input holds no \"" + from + "\"");
  return text.replace(at, from.size(), to);
}

}  // namespace glisson::testing

// read_mesh.cpp — from a file's ending to its reader, and the checks that are the same for every format.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/input_file.h"
#include "base/text.h"
#include "io/curved_tets.h"
#include "io/raw_mesh.h"
#include "mesh/inspect/warnings.h"

namespace glisson {
namespace detail {
namespace {

struct Format {
  const char* ending;
  RawMesh (*read)(std::string_view, const std::string&);
};

constexpr Format kFormats[] = {
    {".vtu", read_vtu}, {".vtk", read_legacy_vtk}, {".msh", read_gmsh}, {".inp", read_abaqus}};

std::string ending_of(const std::string& name) {
  std::string ending = std::filesystem::path(name).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

const Format& format_of(const std::string& name) {
  const std::string ending = ending_of(name), file = std::filesystem::path(name).filename().string();
  for (const Format& format : kFormats) {
    if (ending == format.ending) return format;
  }
  if (ending == ".stl" || ending == ".obj" || ending == ".ply")
    fail(name, "is a surface; fill it with tetrahedra first: glisson mesh " + file + " --edge-mm E --out mesh.vtu");
  fail(name, (ending.empty() ? "the name has no ending" : "unknown ending \"" + ending + "\"") +
                 "; meshes are read from .vtu (VTK XML), .vtk (legacy VTK), .msh (Gmsh 2.2 and 4.1) and .inp (Abaqus); "
                 "convert others in Python: glisson.convert(\"" +
                 file + "\", \"mesh.vtu\")");
}

std::string skipped_text(const RawMesh& raw) {
  std::string text;
  for (const auto& [kind, count] : raw.skipped) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  }
  return text;
}

void scale_vertices(TetMesh& mesh, const std::string& name, double scale) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Vec3d& x = mesh.vertices[v];
    x *= scale;
    if (std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z)) continue;
    fail(name, "vertex " + std::to_string(v) + " is at (" + number_text(x.x) + ", " + number_text(x.y) + ", " +
                   number_text(x.z) + "); coordinates must be finite numbers");
  }
}

void check_tets(const TetMesh& mesh, const std::string& name) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) {
      if (v < mesh.vertices.size()) continue;
      fail(name, "tet " + std::to_string(t) + " refers to vertex " + std::to_string(v) + ", but the file has " +
                     count_text(mesh.vertices.size(), "vertex", "vertices") + ", numbered from 0");
    }
  }
}

void sort_sets(TetMesh& mesh) {
  for (auto& [name, set] : mesh.vertex_sets) {
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
}

}  // namespace

void fail(const std::string& name, const std::string& what) { throw FileError(name + ": " + what); }

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) fail(file.string(), "there is no such file");
  InputFile input = read_input(file, kMeshInput);
  if (!input.problem.empty()) throw FileError(input.problem);
  if (input.bytes.empty()) fail(file.string(), "the file is empty");
  return std::move(input.bytes);
}

/// The factor on coordinates: where none is given, that of millimetres for a body larger than any organ.
double scale_of(RawMesh& raw, const std::optional<double>& given) {
  if (given) return *given;
  const auto [low, high] = box_of(raw.mesh);
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!(extent > kLargestOrgan)) return 1.0;
  raw.notes.push_back("The mesh is " + number_text(extent, 4) +
                      " across its longest side, in metres more than any organ: it was read as millimetres. Give scale "
                      "= 1 if it is in metres.");
  return 0.001;
}

ImportedMesh finish_import(RawMesh raw, const std::string& name, std::optional<double> given) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (raw.mesh.tets.empty()) {
    fail(name, "no tetrahedra in the file" +
                   (raw.skipped.empty() ? std::string() : " (it has " + skipped_text(raw) + ")") +
                   "; mesh the volume with tetrahedra of 4 or 10 nodes");
  }
  if (raw.mesh.vertices.size() > kMost || raw.mesh.tets.size() > kMost) {
    fail(name, "more than " + std::to_string(kMost) + " vertices or tets cannot be numbered");
  }
  check_tets(raw.mesh, name);
  scale_vertices(raw.mesh, name, scale_of(raw, given));
  take_corners(raw);
  sort_sets(raw.mesh);
  ImportedMesh imported{std::move(raw.mesh), {}};
  imported.report = orient_and_inspect(imported.mesh);
  if (!raw.skipped.empty()) {
    raw.notes.push_back("Cells that are not tetrahedra of 4 or 10 nodes were skipped: " + skipped_text(raw) + ".");
  }
  auto& warnings = imported.report.warnings;
  warnings.insert(warnings.begin(), raw.notes.begin(), raw.notes.end());
  return imported;
}

ImportedMesh read_mesh_bytes(std::string_view bytes, const std::string& name, std::optional<double> scale) {
  if (scale && !(std::isfinite(*scale) && *scale > 0.0)) {
    fail(name, "scale = " + number_text(*scale) +
                   " is out of range: it must be greater than 0 (0.001 for a file in millimetres)");
  }
  return finish_import(format_of(name).read(bytes, name), name, scale);
}

}  // namespace detail

ImportedMesh read_mesh(const std::filesystem::path& file, std::optional<double> scale) {
  detail::format_of(file.string());
  return detail::read_mesh_bytes(detail::read_bytes(file), file.string(), scale);
}

}  // namespace glisson

// mesh_fuzz.cpp — any bytes as a mesh file: a valid mesh or a FileError, nothing else.
//
// The first byte picks the format ('3': Abaqus; else modulo 3: Gmsh, VTU, legacy VTK), the rest is the file. The entry point
// serves libFuzzer and, through replay_main.cpp, the replay of the corpus in every test run.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "io/raw_mesh.h"

namespace {

/// Stops the fuzzer unless the mesh keeps what read_mesh promises. (Degenerate tets stay, and are reported.)
void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "read_mesh broke its promise: %s\n", promise);
  std::abort();
}

void require_promises(const glisson::ImportedMesh& imported) {
  const glisson::TetMesh& mesh = imported.mesh;
  require(!mesh.tets.empty(), "there are tets");
  require(mesh.regions.empty() || mesh.regions.size() == mesh.tets.size(), "a region for each tet or none");
  for (const glisson::Vec3d& x : mesh.vertices) {
    require(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z), "coordinates are finite");
  }
  for (const glisson::Tet& tet : mesh.tets) {
    for (const std::uint32_t v : tet) require(v < mesh.vertices.size(), "tets refer to vertices");
  }
  for (const auto& [name, set] : mesh.vertex_sets) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      require(set[i] < mesh.vertices.size(), "sets refer to vertices");
      require(i == 0 || set[i] > set[i - 1], "sets are sorted and hold no vertex twice");
    }
  }
  const glisson::MeshReport again = glisson::inspect(mesh);
  require(again.reoriented_tets.empty(), "no tet is inverted");
  require(again.tets == imported.report.tets && again.vertices == imported.report.vertices, "the report fits");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const char* names[] = {"fuzz.msh", "fuzz.vtu", "fuzz.vtk", "fuzz.inp"};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const glisson::ImportedMesh imported =
        glisson::detail::read_mesh_bytes(bytes, names[data[0] == '3' ? 3 : data[0] % 3]);
    require_promises(imported);
    require(!glisson::format_report("fuzz", imported.report, &imported.mesh).empty(), "there is a report");
  } catch (const glisson::FileError&) {
    // What a reader may throw; anything else ends the fuzzer.
  }
  return 0;
}

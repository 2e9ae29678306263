// require_valid.cpp — refuses a mesh that a simulation cannot use, naming the first fault.
#include "mesh/topology/require_valid.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/text.h"

namespace glisson {
namespace {

[[noreturn]] void refuse_mesh(const std::string& fault) { throw std::invalid_argument("mesh: " + fault); }

std::string tet_text(const TetMesh& mesh, std::size_t tet) {
  return "tet " + std::to_string(tet) + " (vertices " + detail::index_list(mesh.tets[tet]) + ")";
}

void require_positions(const TetMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3d& x = mesh.vertices[v];
    if (std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z)) continue;
    refuse_mesh("vertex " + std::to_string(v) + " is at (" + detail::number_text(x.x) + ", " +
                detail::number_text(x.y) + ", " + detail::number_text(x.z) + "); coordinates must be finite [m]");
  }
}

void require_orientation(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double six_volume = six_rest_volume(mesh, t);
    if (six_volume > 0.0) continue;
    const bool inverted = six_volume < 0.0;
    refuse_mesh(tet_text(mesh, t) + (inverted ? " is inverted" : " has no volume") + ": its volume is " +
                detail::number_text(six_volume / 6.0) + " m³ and must be greater than 0; " +
                (inverted ? "orient_and_inspect() turns it" : "remove or repair it in the mesh generator"));
  }
}

void require_sets(const TetMesh& mesh) {
  for (const auto& [name, set] : mesh.vertex_sets) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (set[i] >= mesh.vertices.size()) {
        refuse_mesh("vertex set \"" + name + "\" holds vertex " + std::to_string(set[i]) + ", but the mesh has " +
                    detail::count_text(mesh.vertices.size(), "vertex", "vertices"));
      }
      if (i > 0 && set[i] <= set[i - 1]) {
        refuse_mesh("vertex set \"" + name + "\" is not sorted: " + std::to_string(set[i]) + " follows " +
                    std::to_string(set[i - 1]) + "; sort it and leave each vertex in it once");
      }
    }
  }
}

void require_fibres(const TetMesh& mesh) {
  if (mesh.fibres.empty()) return;
  if (mesh.fibres.size() != mesh.tets.size()) {
    refuse_mesh("fibres has " + detail::count_text(mesh.fibres.size(), "entry", "entries") + " for " +
                detail::count_text(mesh.tets.size(), "tet", "tets") + "; give one direction per tet, or none");
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (std::isfinite(norm(mesh.fibres[t]))) continue;
    refuse_mesh("the fibre direction of " + tet_text(mesh, t) + " is not finite");
  }
}

}  // namespace

namespace detail {

void require_indices(const TetMesh& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (mesh.vertices.size() > kMost || mesh.tets.size() > kMost) {
    refuse_mesh("more than " + std::to_string(kMost) + " vertices or tets; vertex and tet numbers are 32-bit");
  }
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.tets.size()) {
    refuse_mesh("regions has " + count_text(mesh.regions.size(), "entry", "entries") + " for " +
                count_text(mesh.tets.size(), "tet", "tets") + "; give one region number per tet, or none");
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) {
      if (v < mesh.vertices.size()) continue;
      refuse_mesh(tet_text(mesh, t) + " refers to vertex " + std::to_string(v) + ", but the mesh has " +
                  count_text(mesh.vertices.size(), "vertex", "vertices") + ", numbered from 0");
    }
  }
}

}  // namespace detail

void require_valid(const TetMesh& mesh) {
  if (mesh.tets.empty()) refuse_mesh("it has no tetrahedra");
  detail::require_indices(mesh);
  require_positions(mesh);
  require_orientation(mesh);
  require_sets(mesh);
  require_fibres(mesh);
}

}  // namespace glisson

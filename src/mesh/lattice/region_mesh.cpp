// region_mesh.cpp — the mesher from end to end: lattice, cuts, improvement, figures.
#include "glisson/region_mesh.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "base/text.h"
#include "mesh/lattice/body_lattice.h"
#include "mesh/lattice/cleave.h"
#include "mesh/lattice/improve.h"

namespace glisson {
namespace {

using namespace lattice;

constexpr double kAim = 0.26;  ///< quality that is worked for; 15° and 158°

/// Tets and the vertices they use, numbered anew in their order.
TetMesh compact(const TetComplex& c, const std::vector<BodyRegion>& regions) {
  TetMesh mesh;
  std::vector<std::uint32_t> number(c.points.size(), ~0u);
  for (std::uint32_t v = 0; v < c.points.size(); ++v) {
    if (c.stars[v].empty()) continue;
    number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(c.points[v]);
  }
  for (std::uint32_t t = 0; t < c.tets.size(); ++t) {
    if (!c.alive(t)) continue;
    Tet tet = c.tets[t];
    for (std::uint32_t& v : tet) v = number[v];
    mesh.tets.push_back(tet);
    mesh.regions.push_back(c.labels[t] + 1);
  }
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].hole) mesh.region_names[static_cast<int>(k) + 1] = regions[k].name;
  }
  return mesh;
}

}  // namespace

std::array<double, 6> dihedral_angles(const TetMesh& mesh, std::size_t tet) {
  const Tet& t = mesh.tets[tet];
  std::array<double, 6> angles{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const auto& others = kOthers[i][j];
      const Vec3d &p = mesh.vertices[t[i]], axis = mesh.vertices[t[j]] - p;
      const Vec3d a = cross(axis, mesh.vertices[t[others[0]]] - p), b = cross(axis, mesh.vertices[t[others[1]]] - p);
      angles[n++] = std::atan2(norm(cross(a, b)), dot(a, b)) * 180.0 / std::numbers::pi;
    }
  }
  return angles;
}

std::vector<std::size_t> dihedral_histogram(const TetMesh& mesh, double bin_deg) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(std::ceil(180.0 / bin_deg - 1e-9)), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const double angle : dihedral_angles(mesh, t)) {
      ++counts[std::min(counts.size() - 1, static_cast<std::size_t>(angle / bin_deg))];
    }
  }
  return counts;
}

RegionMesh mesh_regions(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto go_on = [&](double part) {
    if (options.progress && !options.progress(part)) throw std::runtime_error("the mesher was stopped");
    return true;
  };
  const RegionFields fields(regions, options.edge);
  TetComplex complex;
  fill_lattice(fields, options.max_tets, complex);
  go_on(0.1);
  cleave(fields, complex);
  go_on(0.3);
  Workspace w{complex, fields};
  improve(w, kAim, [&](double part) { return go_on(0.3 + 0.7 * part); });
  RegionMesh out;
  out.mesh = compact(complex, regions);
  RegionMeshReport& r = out.report;
  r.min_dihedral_deg = 180.0;
  for (std::uint32_t t = 0; t < out.mesh.tets.size(); ++t) {
    const auto angles = dihedral_angles(out.mesh, t);
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    r.min_dihedral_deg = std::min(r.min_dihedral_deg, *low);
    r.max_dihedral_deg = std::max(r.max_dihedral_deg, *high);
    if (*low < 10.0 || *high > 165.0) r.poor_tets.push_back(t);
  }
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (regions[k].hole) continue;
    r.regions.push_back({regions[k].name, static_cast<int>(k) + 1, 0, 0.0});
  }
  for (std::size_t t = 0; t < out.mesh.tets.size(); ++t) {
    for (RegionVolume& v : r.regions) {
      if (v.number != out.mesh.regions[t]) continue;
      ++v.tets;
      v.volume += six_rest_volume(out.mesh, t) / 6.0;
    }
  }
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace glisson

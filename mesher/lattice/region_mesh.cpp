// region_mesh.cpp — the mesher from end to end: lattice, cuts, improvement, figures.
#include "glisson/region_mesh.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "base/text.h"
#include "mesher/lattice/body_lattice.h"
#include "mesher/lattice/cleave.h"
#include "mesher/lattice/graded_lattice.h"
#include "mesher/lattice/improve.h"
#include "mesher/lattice/operations.h"

namespace glisson {
namespace {

using namespace lattice;

constexpr double kAim = 0.26;                                ///< quality that is worked for; 15° and 158°
constexpr double kFloor = 0.2;                               ///< that the last step leaves; 11.5° and 163.4°
constexpr std::size_t kMostRegions = 60;                     ///< labels are bits of a mask
constexpr double kLeastAngle = 10.0, kLargestAngle = 165.0;  ///< [degrees]

Vec3d size_of(const Bounds& b) { return b.max - b.min; }

void require_regions(const std::vector<BodyRegion>& regions) {
  const bool any = std::any_of(regions.begin(), regions.end(), [](const BodyRegion& r) { return !r.hole; });
  if (!any) throw std::invalid_argument("the body has no region to fill; give at least one that is no hole");
  if (regions.size() > kMostRegions) {
    throw std::invalid_argument(std::to_string(regions.size()) + " regions; at most " + std::to_string(kMostRegions) +
                                " are allowed: join some of them");
  }
  for (const BodyRegion& r : regions) {
    const Vec3d size = size_of(r.bounds);
    const double least = std::min({size.x, size.y, size.z}), sum = size.x + size.y + size.z;
    if (least > 0.0 && std::isfinite(sum)) continue;
    throw std::invalid_argument("region \"" + r.name +
                                "\" has an empty or infinite box: its shapes leave nothing, or "
                                "are not bounded; see whether they overlap as they should");
  }
}

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

void measure_angles(const TetMesh& mesh, RegionMeshReport& report) {
  report.min_dihedral_deg = 180.0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const auto angles = dihedral_angles(mesh, t);
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    report.min_dihedral_deg = std::min(report.min_dihedral_deg, *low);
    report.max_dihedral_deg = std::max(report.max_dihedral_deg, *high);
    if (*low < kLeastAngle || *high > kLargestAngle) report.poor_tets.push_back(t);
  }
  if (report.poor_tets.empty()) return;
  report.warnings.push_back(detail::count_text(report.poor_tets.size(), "tet has", "tets have") +
                            " an angle below 10° or above 165° (" + detail::index_list(report.poor_tets) +
                            "): surfaces meet at a sharp angle there; blend them, or change the edge");
}

void measure_regions(const TetMesh& mesh, const std::vector<BodyRegion>& regions, RegionMeshReport& report) {
  std::vector<RegionVolume> all;
  for (std::size_t k = 0; k < regions.size(); ++k) all.push_back({regions[k].name, static_cast<int>(k) + 1, 0, 0.0});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    RegionVolume& v = all[static_cast<std::size_t>(mesh.regions[t]) - 1];
    ++v.tets;
    v.volume += six_rest_volume(mesh, t) / 6.0;
  }
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].hole) report.regions.push_back(all[k]);
  }
}

/// Points of a grid in a region's box that are inside it, and those of them that no earlier region has.
struct PointsInside {
  std::size_t all = 0, own = 0;
};
PointsInside points_inside(const RegionFields& fields, std::size_t k) {
  constexpr int kAcross = 40;
  const Bounds& box = fields.region(k).bounds;
  const Vec3d step = size_of(box) * (1.0 / kAcross);
  PointsInside inside;
  for (int n = 0; n < kAcross * kAcross * kAcross; ++n) {
    const int i = n % kAcross, j = n / kAcross % kAcross, k_up = n / (kAcross * kAcross);
    const Vec3d p = box.min + Vec3d{(i + 0.5) * step.x, (j + 0.5) * step.y, (k_up + 0.5) * step.z};
    if (fields.value(k, p) >= 0.0) continue;
    ++inside.all;
    inside.own += fields.label(p) == k;
  }
  return inside;
}

void require_tets_in_each(const RegionFields& fields, const RegionMeshReport& report) {
  for (const RegionVolume& v : report.regions) {
    if (v.tets > 0) continue;
    const auto k = static_cast<std::size_t>(v.number) - 1;
    const Vec3d size = size_of(fields.region(k).bounds) * 1e3;
    const PointsInside inside = points_inside(fields, k);
    const std::string box = "its box of " + detail::number_text(size.x, 3) + " × " + detail::number_text(size.y, 3) +
                            " × " + detail::number_text(size.z, 3) + " mm";
    std::string why = "it is thinner than two edges of " + detail::number_text(1e3 * fields.edge(), 3) + " mm in " +
                      box + ", or earlier regions cover it; give a smaller edge or another order";
    if (inside.all == 0) why = "its shapes leave nothing in " + box + "; see whether they overlap as they should";
    if (inside.all > 0 && inside.own == 0) why = "earlier regions cover it; name it before them";
    throw RegionLost(v.name, "region \"" + v.name + "\" is left without a tet: " + why);
  }
}

}  // namespace

std::vector<double> edges_asked(const TetMesh& mesh, const std::vector<BodyRegion>& regions,
                                const RegionMeshOptions& options) {
  const SizeField sizes(regions, options);
  std::vector<double> edges;
  edges.reserve(mesh.tets.size());
  for (const Tet& t : mesh.tets) {
    Vec3d centre{};
    for (const std::uint32_t v : t) centre += mesh.vertices[v] * 0.25;
    edges.push_back(sizes.at(centre));
  }
  return edges;
}

RegionMesh mesh_regions(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  double done = 0.0;
  const auto go_on = [&](double part) {
    done = part;
    if (options.progress && !options.progress(part)) throw MeshingStopped();
    return true;
  };
  require_regions(regions);
  SizeField sizes(regions, options);
  const RegionFields fields(regions, sizes, [&] { go_on(done); });
  sizes.find_finest(fields, options.max_tets);
  TetComplex complex;
  if (sizes.uniform()) {
    fill_lattice(fields, options.max_tets, complex);
  } else {
    fill_graded_lattice(fields, sizes, options.max_tets, complex);
  }
  go_on(0.1);
  cleave(fields, complex);
  go_on(0.3);
  Workspace w{complex, fields};
  improve(w, kAim, [&](double part) { return go_on(0.3 + 0.7 * part); });
  keep_volume(w, kFloor);
  RegionMesh out;
  out.mesh = compact(complex, regions);
  measure_angles(out.mesh, out.report);
  measure_regions(out.mesh, regions, out.report);
  require_tets_in_each(fields, out.report);
  out.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace glisson

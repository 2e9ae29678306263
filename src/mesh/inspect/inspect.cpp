// inspect.cpp — what a mesh holds and what is wrong with it, in time linear in its size (but for short sorts).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "mesh/inspect/warnings.h"
#include "mesh/topology/faces.h"
#include "mesh/topology/repeated_tets.h"
#include "mesh/topology/require_valid.h"

namespace glisson {
namespace {

/// |6V| below this part of the longest edge's cube is rounding, not volume.
constexpr double kNoVolume = 1e-12;

bool has_repeated_vertex(const Tet& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

bool is_degenerate(const TetMesh& mesh, std::size_t tet, double six_volume) {
  const Tet& t = mesh.tets[tet];
  if (has_repeated_vertex(t)) return true;
  double longest_squared = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const Vec3d edge = mesh.vertices[t[b]] - mesh.vertices[t[a]];
      longest_squared = std::max(longest_squared, dot(edge, edge));
    }
  }
  return !(std::abs(six_volume) > kNoVolume * longest_squared * std::sqrt(longest_squared));
}

void find_degenerate_and_inverted(const TetMesh& mesh, MeshReport& report) {
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const double six_volume = six_rest_volume(mesh, t);
    if (is_degenerate(mesh, t, six_volume)) {
      report.degenerate_tets.push_back(t);
    } else if (six_volume < 0.0) {
      report.reoriented_tets.push_back(t);
    }
  }
}

void find_duplicates(const TetMesh& mesh, MeshReport& report) {
  detail::for_each_repeated_tet(mesh.tets, mesh.vertices.size(),
                                [&](std::uint32_t, std::uint32_t again) { report.duplicate_tets.push_back(again); });
  std::sort(report.duplicate_tets.begin(), report.duplicate_tets.end());
}

/// Bounding box of the vertices in use (of all, if none is), and the list of the others.
void find_extent(const TetMesh& mesh, MeshReport& report) {
  std::vector<bool> used(mesh.vertices.size(), mesh.tets.empty());
  for (const Tet& tet : mesh.tets) {
    for (const std::uint32_t v : tet) used[v] = true;
  }
  if (mesh.vertices.empty()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  report.box_min = {kInfinity, kInfinity, kInfinity};
  report.box_max = -report.box_min;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!used[v] || mesh.tets.empty()) report.unused_vertices.push_back(v);
    if (!used[v]) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      report.box_min[a] = std::min(report.box_min[a], mesh.vertices[v][a]);
      report.box_max[a] = std::max(report.box_max[a], mesh.vertices[v][a]);
    }
  }
}

/// Disjoint sets of tets, joined face by face.
class TetPieces {
 public:
  explicit TetPieces(std::size_t tets) : parent_(tets) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t tet) {
    while (parent_[tet] != tet) tet = parent_[tet] = parent_[parent_[tet]];
    return tet;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The box around each piece.
void find_boxes(const TetMesh& mesh, const std::vector<bool>& skipped, TetPieces& pieces, detail::Findings& findings) {
  for (const std::uint32_t t : findings.piece_starts) {
    const Vec3d first = mesh.vertices[mesh.tets[t][0]];
    findings.boxes.push_back({first, first});
  }
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (skipped[t]) continue;
    const auto piece = std::ranges::lower_bound(findings.piece_starts, pieces.root(t)) - findings.piece_starts.begin();
    auto& [low, high] = findings.boxes[static_cast<std::size_t>(piece)];
    for (const std::uint32_t v : mesh.tets[t]) {
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], mesh.vertices[v][a]);
        high[a] = std::max(high[a], mesh.vertices[v][a]);
      }
    }
  }
}

/// Boundary, non-manifold faces and pieces. Duplicate tets and tets with a vertex twice would only repeat
/// their own fault here, so they are left out.
void find_faces(const TetMesh& mesh, MeshReport& report, detail::Findings& findings) {
  std::vector<bool> skipped(mesh.tets.size(), false);
  for (const std::uint32_t t : report.duplicate_tets) skipped[t] = true;
  for (const std::uint32_t t : report.degenerate_tets) skipped[t] = skipped[t] || has_repeated_vertex(mesh.tets[t]);
  TetPieces pieces(mesh.tets.size());
  detail::for_each_face(mesh, skipped, [&](std::span<const detail::FaceSide> sides) {
    if (sides.size() == 1) ++report.boundary_triangles;
    if (sides.size() > 2) ++report.non_manifold_faces;
    for (std::size_t i = 1; i < sides.size(); ++i) pieces.join(sides[0].tet, sides[i].tet);
  });
  std::vector<std::uint32_t> sizes(mesh.tets.size(), 0);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) sizes[pieces.root(t)] += !skipped[t];
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (sizes[t] == 0) continue;
    findings.piece_starts.push_back(t);
    findings.piece_sizes.push_back(sizes[t]);
  }
  report.pieces = findings.piece_sizes.size();
  if (report.pieces > 1) find_boxes(mesh, skipped, pieces, findings);
}

/// Worst and median shape, and the tets that are badly shaped without being degenerate or inverted.
void measure_shape(const TetMesh& mesh, MeshReport& report, detail::Findings& findings) {
  if (mesh.tets.empty()) return;
  std::vector<std::uint32_t> bad;
  std::vector<double> ratios(mesh.tets.size());
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    ratios[t] = regular_mean_ratio(mesh, t);
    if (ratios[t] > 0.0 && ratios[t] < detail::kBadMeanRatio) bad.push_back(t);
  }
  std::set_difference(bad.begin(), bad.end(), report.degenerate_tets.begin(), report.degenerate_tets.end(),
                      std::back_inserter(findings.bad_tets));
  const auto worst = std::min_element(ratios.begin(), ratios.end());
  report.worst_mean_ratio = *worst;
  report.worst_tet = static_cast<std::size_t>(worst - ratios.begin());
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  report.median_mean_ratio = *middle;
}

/// Everything but the orientation, which `report` already holds.
void complete(const TetMesh& mesh, MeshReport& report, bool turned) {
  detail::Findings findings;
  findings.turned = turned;
  report.vertices = mesh.vertices.size();
  report.tets = mesh.tets.size();
  report.volume = volume(mesh);
  find_duplicates(mesh, report);
  find_extent(mesh, report);
  find_faces(mesh, report, findings);
  measure_shape(mesh, report, findings);
  report.warnings = detail::report_warnings(report, findings);
}

}  // namespace

MeshReport inspect(const TetMesh& mesh) {
  detail::require_indices(mesh);
  MeshReport report;
  find_degenerate_and_inverted(mesh, report);
  complete(mesh, report, false);
  return report;
}

MeshReport orient_and_inspect(TetMesh& mesh) {
  detail::require_indices(mesh);
  MeshReport report;
  find_degenerate_and_inverted(mesh, report);
  for (const std::uint32_t t : report.reoriented_tets) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  complete(mesh, report, true);
  return report;
}

}  // namespace glisson

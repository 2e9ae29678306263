#include "mesh/inspect/warnings.h"

#include <algorithm>

#include "base/text.h"

namespace glisson::detail {
namespace {

constexpr double kSmallestOrgan = 0.001;  // [m]

std::string tets_text(std::span<const std::uint32_t> tets) {
  return count_text(tets.size(), "tet", "tets") + " (" + index_list(tets) + ")";
}

std::string is_or_are(std::size_t count) { return count == 1 ? " is " : " are "; }

std::string inverted_warning(std::span<const std::uint32_t> tets, bool turned) {
  if (turned) {
    return tets_text(tets) + (tets.size() == 1 ? " was" : " were") +
           " inverted (negative volume): turned by exchanging the last two vertices.";
  }
  return tets_text(tets) + is_or_are(tets.size()) + "inverted (negative volume): turn with orient_and_inspect().";
}

std::string unit_warning(double extent) {
  const std::string size = "The mesh is " + number_text(extent, 4) + " m across its longest side, ";
  if (extent > kLargestOrgan) {
    return size + "more than any organ: it is probably in millimetres; import it with scale = 0.001.";
  }
  return size + "less than 1 mm: it has probably been scaled down once too often; import it without a scale, or with " +
         "scale = 1000.";
}

/// Distance of two boxes [m]; 0 where they overlap.
double gap_of(const std::array<Vec3d, 2>& a, const std::array<Vec3d, 2>& b) {
  Vec3d gap{};
  for (std::size_t i = 0; i < 3; ++i) gap[i] = std::max({0.0, a[0][i] - b[1][i], b[0][i] - a[1][i]});
  return norm(gap);
}

/// That pieces do not feel each other, and which two are near enough to meet; of many pieces only the first are looked at.
std::string meeting_text(const MeshReport& r, const Findings& findings) {
  constexpr std::size_t kMost = 500;
  constexpr double kNear = 0.25;  // of the mesh's diagonal: what a deep press bridges
  std::size_t one = 0, other = 0;
  double least = kNear * norm(r.box_max - r.box_min);
  for (std::size_t i = 0; i < std::min(kMost, findings.boxes.size()); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double gap = gap_of(findings.boxes[i], findings.boxes[k]);
      if (gap < least) one = k, other = i, least = gap;
    }
  }
  std::string text =
      "Pieces do not touch each other: no contact between them is computed, they pass through one another.";
  if (other == 0) return text;
  return text + " The boxes of those from tet " + std::to_string(findings.piece_starts[one]) + " and tet " +
         std::to_string(findings.piece_starts[other]) +
         (least > 0.0 ? " are " + number_text(1e3 * least, 3) + " mm apart" : std::string(" overlap")) +
         ": WHERE THEY MEET, THE RESULT IS WRONG; join them by common faces, or keep them apart.";
}

std::string pieces_warning(const MeshReport& r, const Findings& findings) {
  constexpr std::size_t kShown = 4;
  const std::size_t pieces = findings.piece_sizes.size();
  std::string text = "The mesh is in " + std::to_string(pieces) + " pieces that share no face (";
  for (std::size_t i = 0; i < std::min(pieces, kShown); ++i) {
    text += (i > 0 ? ", " : "") + count_text(findings.piece_sizes[i], "tet", "tets") + " from tet " +
            std::to_string(findings.piece_starts[i]);
  }
  if (pieces > kShown) text += ", and " + std::to_string(pieces - kShown) + " more";
  return text + "): a piece without support falls; hold each, remove the small ones, or merge double vertices. " +
         meeting_text(r, findings);
}

std::string shape_warning(const MeshReport& r, std::span<const std::uint32_t> bad_tets) {
  return tets_text(bad_tets) + (bad_tets.size() == 1 ? " has" : " have") + " a mean ratio below " +
         number_text(kBadMeanRatio) + " (worst of all " + number_text(r.worst_mean_ratio, 3) + " in tet " +
         std::to_string(r.worst_tet) + "): flat tets make the stable step small; improve or remesh.";
}

}  // namespace

std::vector<std::string> report_warnings(const MeshReport& r, const Findings& findings) {
  std::vector<std::string> w;
  if (r.tets == 0) w.push_back("The mesh has no tetrahedra: nothing to simulate.");
  if (!r.reoriented_tets.empty()) w.push_back(inverted_warning(r.reoriented_tets, findings.turned));
  if (const auto& d = r.degenerate_tets; !d.empty()) {
    w.push_back(tets_text(d) + is_or_are(d.size()) +
                "degenerate (no volume, or a vertex twice): a simulation refuses the mesh; remove or remesh them.");
  }
  if (const auto& d = r.duplicate_tets; !d.empty()) {
    w.push_back(tets_text(d) + (d.size() == 1 ? " has" : " have") +
                " the same four vertices as an earlier tet: mass and stiffness count twice there; remove them.");
  }
  if (const auto& u = r.unused_vertices; !u.empty()) {
    w.push_back(count_text(u.size(), "vertex", "vertices") + " (" + index_list(u) + ")" + is_or_are(u.size()) +
                "in no tet: without mass or force, they stay where they are; remove them, or look for missing tets.");
  }
  if (r.pieces > 1) w.push_back(pieces_warning(r, findings));
  if (r.non_manifold_faces > 0) {
    w.push_back(count_text(r.non_manifold_faces, "face", "faces") + (r.non_manifold_faces == 1 ? " is" : " are") +
                " shared by more than two tets: tets overlap there; remesh.");
  }
  if (!findings.bad_tets.empty()) w.push_back(shape_warning(r, findings.bad_tets));
  const Vec3d extent = r.box_max - r.box_min;
  const double largest = std::max({extent.x, extent.y, extent.z});
  if (r.tets > 0 && (largest > kLargestOrgan || largest < kSmallestOrgan)) w.push_back(unit_warning(largest));
  return w;
}

}  // namespace glisson::detail

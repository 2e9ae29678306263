// warnings.h — what is suspicious about a mesh, as sentences with element numbers and the way out.
#pragma once

#include "glisson/mesh.h"

namespace glisson::detail {

/// Tets below this mean ratio are called badly shaped; the step h* shrinks with the flattest tet.
inline constexpr double kBadMeanRatio = 0.05;
/// A body that is longer is probably in millimetres [m].
inline constexpr double kLargestOrgan = 2.0;

/// What the sentences need beside the report.
struct Findings {
  bool turned = false;                      ///< inverted tets have been turned
  std::vector<std::uint32_t> bad_tets;      ///< mean ratio in (0, kBadMeanRatio), not degenerate
  std::vector<std::uint32_t> piece_starts;  ///< lowest tet of each piece
  std::vector<std::size_t> piece_sizes;     ///< tets of each piece
  std::vector<std::array<Vec3d, 2>> boxes;  ///< lowest and highest corner of each piece [m]
};

/// @param report  filled but for `warnings`
std::vector<std::string> report_warnings(const MeshReport& report, const Findings& findings);

}  // namespace glisson::detail

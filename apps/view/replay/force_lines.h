// force_lines.h — the tables of forces of a run, side by side and thinned, so that a long one stays small.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "view/state/snapshot.h"

namespace glisson::view {

/// Depth and force along its direction of every tool at a time [s], [m], [N].
struct ForceLine {
  double time = 0.0;
  std::array<double, kMostTools> depth{}, force{};
};

/// Lines kept of a run.
inline constexpr std::size_t kMostLines = 100'000;

/// Reads forces.csv, then the further tables, line by line; a line that one of them lacks, or has by half, ends it.
/// Where there are more than `most`, of each two the one with the larger force is kept, as often as it takes; the last one always.
/// @param files  one a tool @throws std::runtime_error where a table lacks a column
std::vector<ForceLine> read_forces(std::span<const std::filesystem::path> files, std::size_t most = kMostLines);

/// Of each run of lines the one with the largest force, and the last: `most` or fewer.
std::vector<ForceLine> thinned(std::vector<ForceLine> lines, std::size_t most);

/// Between two lines, linearly; at the ends the end. @param lines  one or more
ForceLine forces_at(std::span<const ForceLine> lines, double time);

}  // namespace glisson::view

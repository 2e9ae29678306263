// added_levels.h — stiffness per vertex of what acts beside the tissue, for the mass that bears it under variable mass scaling.
//
// With stiffness K ≤ diag(d) beside that of the tissue, masses ¼ h² d beside those that bear the tissue leave the step as it is:
//   h² (K_t + K) ≤ 4 M + h² diag(d) = 4 (M + ¼ h² diag(d)).
// A level runs ahead of the present stiffness by two steps as stiff as the last one has made it, comes down slowly, and has room, so
// that masses change seldom.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/archive.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

class AddedLevels {
 public:
  /// Takes in the present stiffness. @return whether all are below their levels
  bool meet(std::span<const VertexStiffness> now);
  /// Lets levels follow what lately was, with room.
  void settle();
  /// Adds to masses of all vertices what the levels ask for. @param per_stiffness  [kg m/N]
  void add_masses(double per_stiffness, std::span<double> masses) const;
  void clear() { levels_.clear(); }
  void archive(Archive& ar, std::size_t vertex_count);

 private:
  struct Level {
    std::uint32_t vertex = 0;
    double before = 0.0, lately = 0.0, level = 0.0;  ///< [N/m]
    void archive(Archive& ar) { ar(vertex, before, lately, level); }
  };
  bool follow(std::span<const VertexStiffness> now);

  std::vector<Level> levels_;  ///< in the order of what was met last
};

}  // namespace glisson

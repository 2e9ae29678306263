// tool_yield.h — a tool that a force moves, within a long step: where it ends is found together with the rows.
//
//   end of the tool = end found with `force` + compliance · (force at the end − `force`)
#pragma once

#include "glisson/math.h"

namespace glisson {

struct ToolYield {
  Mat3d compliance{};  ///< displacement of the tool's end by the force on it [m/N]
  Vec3d force{};       ///< on the tool, with which the pose that its rows are declared for was found [N]
  Vec3d held_back{};   ///< of that pose from where the tool would end without the tissue [m]
  Vec3d found{};       ///< by the solver: force of the rows on the tool [N] …
  Vec3d shift{};       ///< … and where it takes the tool from that pose [m]

  void begin() { found = {}; }
  void end() { shift = compliance * (found - force); }
  /// Whether the rows were declared for another pose. @param share  of what the tissue holds the tool back, by which that may be wrong
  bool moves_on(double share) const { return norm(shift) > share * norm(held_back + shift) + kLeast; }

 private:
  static constexpr double kLeast = 1e-12;  ///< [m]
};

}  // namespace glisson

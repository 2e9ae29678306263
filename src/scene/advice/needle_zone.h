// needle_zone.h — how coarse a mesh is around a needle.
#pragma once

#include <optional>

#include "glisson/scene/scene.h"

namespace glisson::advice {

/// Edges of the tets around a needle's line against its zone (docs/needles.md).
struct ZoneEdges {
  double edge = 0.0;  ///< of a regular tet of their mean volume [m]
  double zone = 0.0;  ///< [m]
  static constexpr double kResolved = 0.6;
  double share() const { return edge / zone; }
};

/// Nothing for other instruments, and where the line misses the body.
std::optional<ZoneEdges> edges_in_zone(const TetMesh& mesh, const InstrumentSpec& instrument);

}  // namespace glisson::advice

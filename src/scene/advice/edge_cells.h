// edge_cells.h — how coarse a surface is under the sharp edge of an instrument.
#pragma once

#include <optional>

#include "glisson/scene/scene.h"

namespace glisson::advice {

/// Cells of the surface against the edge that a punch or a block would press into it, straight ahead from its start.
struct EdgeCells {
  double across = 0.0;  ///< extent of a cell across the edge, the median along the edge [m]
  double size = 0.0;    ///< of the instrument: radius of a punch, half the shorter side of a block's face [m]
  double share() const { return across / size; }
};

/// Nothing for other instruments, for a rounded edge as wide as a cell, and where the body lies within the edge.
std::optional<EdgeCells> cells_under_edge(const TetMesh& mesh, const InstrumentSpec& instrument);

}  // namespace glisson::advice

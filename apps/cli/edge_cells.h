// edge_cells.h — how coarse a surface is under an instrument or pad, under the sharp edge of one, and around a needle.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "glisson/scene/scene.h"

namespace glisson::app {

/// Cells of the surface against the edge that a punch or a block would press into it, straight ahead from its start.
struct EdgeCells {
  double across = 0.0;  ///< extent of a cell across the edge, the median along the edge [m]
  double size = 0.0;    ///< of the instrument: radius of a punch, half the shorter side of a block's face [m]
  double share() const { return across / size; }
};

/// Nothing for other instruments, for a rounded edge as wide as a cell, and where the body lies within the edge.
std::optional<EdgeCells> cells_under_edge(const TetMesh& mesh, const InstrumentSpec& instrument);

/// Faces of the surface that a pad holds, or an instrument would press straight ahead from its start.
struct PressedFaces {
  std::size_t count = 0;
  double edge = 0.0;  ///< mean of their edges [m]
  double size = 0.0;  ///< of pad or instrument: diameter, shorter side, of a pad that of a disc of its area [m]

  static constexpr std::size_t kFew = 16;     ///< fewer do not resolve how the pressure is spread …
  static constexpr double kCoarse = 1.0 / 3;  ///< … and so do edges beyond this share of the size
  bool coarse() const { return count < kFew || edge > kCoarse * size; }
  /// How many times as fine the mesh should be.
  double finer() const;
};

PressedFaces faces_of_pad(const TetMesh& mesh, const std::string& set);
/// Nothing for instruments that pierce or cut, and for those without a size or off the body.
std::optional<PressedFaces> faces_under(const TetMesh& mesh, const InstrumentSpec& instrument);

/// Edges of the tets around a needle's line against its zone (docs/needles.md).
struct ZoneEdges {
  double edge = 0.0;  ///< of a regular tet of their mean volume [m]
  double zone = 0.0;  ///< [m]
  static constexpr double kResolved = 0.6;
  double share() const { return edge / zone; }
};

/// Nothing for other instruments, and where the line misses the body.
std::optional<ZoneEdges> edges_in_zone(const TetMesh& mesh, const InstrumentSpec& instrument);

}  // namespace glisson::app

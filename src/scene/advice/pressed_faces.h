// pressed_faces.h — how coarse a surface is under an instrument or pad.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "glisson/scene/scene.h"

namespace glisson::advice {

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

}  // namespace glisson::advice

// tool_surface.h — an instrument as triangles where it is at present, for the .vtp files beside frames.
#pragma once

#include <vector>

#include "glisson/instruments/instrument.h"
#include "glisson/mesh.h"

namespace glisson {

struct SurfaceMesh {
  std::vector<Vec3d> points;  ///< [m]
  std::vector<Triangle> triangles;
};

/// The solid of Instrument::form() at its pose; a needle as a tube about its centre line, as it is bent. Empty where it has none.
/// Round parts have 32 sides; a bevelled tip is drawn as a cone.
/// @param extent  how large a plate, a wall or a blade is drawn, which have no end [m]
SurfaceMesh tool_surface(const Instrument& instrument, double extent);

}  // namespace glisson

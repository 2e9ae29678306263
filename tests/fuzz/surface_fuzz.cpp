// surface_fuzz.cpp — any bytes as a surface file: triangles of finite points, a body within where they are closed, or a message that names
// the file.
//
// The first byte picks the format (modulo 3: .stl, .obj, .ply), the rest is the file.
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "glisson/surface_region.h"
#include "glisson/surface_repair.h"
#include "scene/surface/surface_source.h"
#include "support.h"

using glisson::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const char* names[] = {"fuzz.stl", "fuzz.obj", "fuzz.ply"};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  glisson::TriangleSurface surface;
  try {
    surface = glisson::surface_file::parse(bytes, names[data[0] % 3], 0.5);
  } catch (const std::invalid_argument& error) {
    require(std::string_view(error.what()).substr(0, 5) == "fuzz.", "a message begins with the file");
    return 0;
  }
  require(!surface.triangles.empty(), "there are triangles");
  for (const glisson::Vec3d& x : surface.points)
    require(std::isfinite(x.x + x.y + x.z) || std::abs(x.x) > 1e300 || std::abs(x.y) > 1e300 || std::abs(x.z) > 1e300,
            "coordinates are finite");
  for (const glisson::Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) require(v < surface.points.size(), "triangles refer to points");
  }
  try {
    const glisson::SurfaceRepair closed = glisson::repair_surface(surface.points, surface.triangles);
    require(closed.any() == !closed.text().empty(), "what was done is said");
    const glisson::Solid solid = glisson::surface_solid(closed.points, closed.triangles);
    require(!std::isnan(solid.distance(surface.points.front() + glisson::Vec3d{0.25, 0.5, 0.125})),
            "a distance is a number");
  } catch (const std::invalid_argument&) {
    // It bounds no body.
  }
  return 0;
}

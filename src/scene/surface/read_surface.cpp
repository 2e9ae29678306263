// read_surface.cpp — from a file's ending to its reader, and the checks that are the same for every format.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/input_file.h"
#include "base/text.h"
#include "glisson/surface_region.h"
#include "glisson/surface_repair.h"
#include "scene/surface/surface_source.h"

namespace glisson {
namespace surface_file {
namespace {

struct Format {
  const char* ending;
  TriangleSurface (*read)(Source&);
};
constexpr Format kFormats[] = {{".stl", read_stl}, {".obj", read_obj}, {".ply", read_ply}};

const Format* format_of(const std::filesystem::path& file) {
  const std::string ending = detail::lower_case(file.extension().string());
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& f) { return ending == f.ending; });
  return found == std::end(kFormats) ? nullptr : found;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw std::invalid_argument(file.string() + ": " + what);
}

}  // namespace

TriangleSurface parse(std::string_view bytes, const std::filesystem::path& name, double scale) {
  const Format* format = format_of(name);
  if (format == nullptr)
    refuse(name, "surfaces are read from .stl, .obj and .ply; convert others, for instance with meshio");
  if (!(std::isfinite(scale) && scale > 0.0))
    refuse(name, "scale = " + detail::show(scale) + " is out of range; allowed: > 0 (0.001 for a file in millimetres)");
  if (bytes.empty()) refuse(name, "the file is empty");
  if (bytes.size() / 3 > std::numeric_limits<std::uint32_t>::max()) refuse(name, "is too large; coarsen the surface");
  Source source(bytes, name.string());
  TriangleSurface surface = format->read(source);
  if (surface.triangles.empty()) refuse(name, "has no triangles; write a closed surface of triangles");
  for (Vec3d& x : surface.points) x *= scale;
  return surface;
}

}  // namespace surface_file

bool is_surface_file(const std::filesystem::path& file) { return surface_file::format_of(file) != nullptr; }

TriangleSurface read_surface(const std::filesystem::path& file, double scale) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) surface_file::refuse(file, "there is no such file");
  if (surface_file::format_of(file) == nullptr) return surface_file::parse({}, file, scale);  // says which there are
  const detail::InputFile input = detail::read_input(file, detail::kSurfaceInput);
  if (!input.problem.empty()) throw std::invalid_argument(input.problem);
  return surface_file::parse(input.bytes, file, scale);
}

SurfaceShape load_surface(const std::filesystem::path& file, double scale) {
  const TriangleSurface surface = read_surface(file, scale);
  try {
    const SurfaceRepair closed = repair_surface(surface.points, surface.triangles);
    std::string repaired = closed.text();
    if (!repaired.empty()) repaired = file.string() + ": " + repaired;
    return {file, scale, surface_solid(closed.points, closed.triangles), std::move(repaired)};
  } catch (const std::invalid_argument& error) {
    surface_file::refuse(file, std::string("the surface ") + error.what());
  }
}

}  // namespace glisson

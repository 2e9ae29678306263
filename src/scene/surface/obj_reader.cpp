// obj_reader.cpp — Wavefront .obj: lines `v x y z` and `f a b c …`; polygons become fans, everything else is passed over.
#include <charconv>

#include "base/text.h"
#include "scene/surface/surface_source.h"

namespace glisson::surface_file {
namespace {

/// The point of `7`, `7/2`, `7//3` or `-1`; negative numbers count back from the last point.
std::uint32_t point_of(const Source& source, std::string_view corner, std::size_t points) {
  const std::string_view number = corner.substr(0, corner.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (error != std::errc() || end != number.data() + number.size())
    source.fail("expected the number of a vertex, found " + shown(corner));
  const auto count = static_cast<std::int64_t>(points);
  if (index == 0 || index > count || index < -count)
    source.fail("refers to vertex " + std::to_string(index) + "; " + detail::count_text(points, "vertex", "vertices") +
                " came before, counted from 1");
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : index + count);
}

void read_polygon(const Source& source, std::string_view line, TriangleSurface& surface) {
  std::uint32_t first = 0, last = 0;
  std::size_t corners = 0;
  for (std::string_view word = first_word(line); !word.empty(); word = first_word(line)) {
    const std::uint32_t point = point_of(source, word, surface.points.size());
    if (corners == 0) first = point;
    if (corners >= 2) surface.triangles.push_back({first, last, point});
    last = point;
    ++corners;
  }
  if (corners < 3) source.fail("a face of " + detail::count_text(corners, "vertex", "vertices") + "; it needs three");
}

}  // namespace

TriangleSurface read_obj(Source& source) {
  TriangleSurface surface;
  std::string_view line;
  while (source.line(line)) {
    const std::string_view keyword = first_word(line);
    if (keyword != "v" && keyword != "f") continue;
    if (line.ends_with('\\')) source.fail("goes on in the next line, which is not read; write it in one line");
    if (keyword == "f") {
      read_polygon(source, line, surface);
      continue;
    }
    Vec3d p;
    const char* what[] = {"x of a vertex", "y of a vertex", "z of a vertex"};
    for (std::size_t i = 0; i < 3; ++i) p[i] = real_in(source, first_word(line), what[i]);
    surface.points.push_back(p);
  }
  return surface;
}

}  // namespace glisson::surface_file

// stl_reader.cpp — .stl: three points for each triangle, as text or as 50 bytes a triangle behind a head of 84.
//
// A binary file may begin with "solid" too: its size tells, and bytes that no text has.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scene/surface/surface_source.h"

namespace glisson::surface_file {
namespace {

constexpr std::size_t kTitle = 80, kHead = 84, kRecord = 50;  // bytes

bool looks_like_text(std::string_view bytes) {
  std::string_view rest = bytes;
  if (detail::lower_case(first_word(rest)) != "solid") return false;
  const std::string_view start = bytes.substr(0, 512);
  return std::none_of(start.begin(), start.end(), [](char c) { return c == '\0'; });
}

void read_facet(Source& source, TriangleSurface& surface) {
  source.expect("normal", "a facet");
  for (int i = 0; i < 3; ++i) source.word();  // recomputed from the corners; some programs write nan
  source.expect("outer", "a facet");
  source.expect("loop", "a facet");
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  for (int i = 0; i < 3; ++i) {
    source.expect("vertex", "a facet");
    const double x = source.real("x of a vertex"), y = source.real("y of a vertex"), z = source.real("z of a vertex");
    surface.points.push_back({x, y, z});
  }
  source.expect("endloop", "a facet");
  source.expect("endfacet", "a facet");
  surface.triangles.push_back({first, first + 1, first + 2});
}

TriangleSurface read_text(Source& source) {
  TriangleSurface surface;
  bool in_solid = false;
  std::string_view rest;
  while (true) {
    const std::string_view word = source.word();
    const std::string keyword = detail::lower_case(word);
    if (word.empty()) break;
    if (keyword == "facet" && in_solid) {
      read_facet(source, surface);
    } else if (keyword == (in_solid ? "endsolid" : "solid")) {
      in_solid = !in_solid;
      source.line(rest);  // its name
    } else {
      source.fail(std::string("expected ") + (in_solid ? "\"facet\" or \"endsolid\"" : "\"solid\"") + ", found " +
                  shown(word));
    }
  }
  if (in_solid) source.fail("the file ends before \"endsolid\": it is cut off; write it again");
  return surface;
}

TriangleSurface read_binary(Source& source) {
  source.set_binary(std::endian::little);
  source.skip(kTitle, "the head of a binary .stl");
  const std::uint64_t count = source.number<std::uint32_t>("the number of triangles");
  if (count * kRecord > source.left()) {
    source.fail("the head announces " + detail::count_text(count, "triangle", "triangles") + ", " +
                std::to_string(count * kRecord) + " bytes, and " + std::to_string(source.left()) +
                " bytes follow: the file is cut off or is no .stl; write it again");
  }
  TriangleSurface surface;
  for (std::uint64_t t = 0; t < count; ++t) {
    const std::string what = "triangle " + std::to_string(t);
    source.skip(12, what);  // its normal
    for (int i = 0; i < 3; ++i) {
      const Vec3d p{source.number<float>(what), source.number<float>(what), source.number<float>(what)};
      if (!std::isfinite(p.x + p.y + p.z)) source.fail(what + " has a corner that is not finite; repair the file");
      surface.points.push_back(p);
    }
    source.skip(2, what);  // its attributes
    const auto first = static_cast<std::uint32_t>(3 * t);
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

}  // namespace

TriangleSurface read_stl(Source& source) {
  return looks_like_text(source.bytes()) ? read_text(source) : read_binary(source);
}

}  // namespace glisson::surface_file

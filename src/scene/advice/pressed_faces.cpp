#include "scene/advice/pressed_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "scene/advice/seen_surface.h"

namespace glisson::advice {
namespace {

double mean_edge(const Corners& t) { return (norm(t[1] - t[0]) + norm(t[2] - t[1]) + norm(t[0] - t[2])) / 3.0; }

/// Half the extent of an instrument's footprint along its own x and y; 0: it has none.
struct Footprint {
  double x = 0.0, y = 0.0;
  bool round = true;
};
Footprint footprint_of(const FlatPunch& s) { return {s.radius, s.radius}; }
Footprint footprint_of(const Ball& s) { return {s.radius, s.radius}; }
Footprint footprint_of(const NeedleShape& s) { return {0.5 * s.diameter, 0.5 * s.diameter}; }
Footprint footprint_of(const Block& s) { return {0.5 * s.size.x, 0.5 * s.size.y, false}; }
template <class Other>
Footprint footprint_of(const Other&) {
  return {};
}

void add(PressedFaces& faces, const Corners& t) { ++faces.count, faces.edge += mean_edge(t); }

/// Nine points a side are more than kFew faces.
PressedFaces faces_in(const Footprint& print, const std::vector<Corners>& surface) {
  constexpr int kSide = 9;
  std::set<const Corners*> met;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double a = 2.0 * (i + 0.5) / kSide - 1.0, b = 2.0 * (j + 0.5) / kSide - 1.0;
      if (print.round && a * a + b * b > 1.0) continue;
      if (const Corners* t = met_by(Vec3d{a * print.x, b * print.y, 0.0}, surface)) met.insert(t);
    }
  }
  PressedFaces faces{.size = 2.0 * std::min(print.x, print.y)};
  for (const Corners* t : met) add(faces, *t);
  if (faces.count > 0) faces.edge /= static_cast<double>(faces.count);
  return faces;
}

}  // namespace

double PressedFaces::finer() const {
  const double by_count = std::sqrt(static_cast<double>(kFew) / static_cast<double>(std::max<std::size_t>(count, 1)));
  return std::max(by_count, size > 0.0 ? edge / (kCoarse * size) : 1.0);
}

PressedFaces faces_of_pad(const TetMesh& mesh, const std::string& set) {
  const auto found = mesh.vertex_sets.find(set);
  PressedFaces faces;
  if (found == mesh.vertex_sets.end()) return faces;
  const auto held = [&](std::uint32_t v) { return std::binary_search(found->second.begin(), found->second.end(), v); };
  double area = 0.0;
  for (const Triangle& t : boundary_triangles(mesh)) {
    if (!std::all_of(t.begin(), t.end(), held)) continue;
    const Corners corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    add(faces, corners);
    area += 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
  }
  if (faces.count > 0) faces.edge /= static_cast<double>(faces.count);
  faces.size = std::sqrt(4.0 * area / std::numbers::pi);
  return faces;
}

std::optional<PressedFaces> faces_under(const TetMesh& mesh, const InstrumentSpec& instrument) {
  const auto* contact = std::get_if<ContactOptions>(&instrument.what);
  if (!contact) return {};
  const Footprint print = std::visit([](const auto& shape) { return footprint_of(shape); }, contact->shape);
  if (print.x == 0.0) return {};
  const PressedFaces faces = faces_in(print, seen_from(start_pose(instrument, mesh), mesh));
  if (faces.count == 0) return {};
  return faces;
}

}  // namespace glisson::advice

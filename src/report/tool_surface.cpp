// tool_surface.cpp — see tool_surface.h.
#include "report/tool_surface.h"
#include "base/two_across.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glisson {
namespace {

constexpr std::uint32_t kSides = 32;

/// A ring of points about a centre: kSides points at `radius`.
void add_ring(SurfaceMesh& mesh, const Vec3d& centre, const Vec3d& x, const Vec3d& y, double radius) {
  for (std::uint32_t k = 0; k < kSides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSides;
    mesh.points.push_back(centre + x * (radius * std::cos(angle)) + y * (radius * std::sin(angle)));
  }
}

/// Triangles between rings that follow one another; none where a ring of radius 0 leaves them without area.
void join_rings(SurfaceMesh& mesh) {
  const auto rings = static_cast<std::uint32_t>(mesh.points.size()) / kSides;
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& x = mesh.points;
    if (x[a] != x[b] && x[b] != x[c] && x[c] != x[a]) mesh.triangles.push_back({a, b, c});
  };
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = r * kSides + k, b = r * kSides + (k + 1) % kSides;
      add(a, b, b + kSides);
      add(a, b + kSides, a + kSides);
    }
  }
}

/// A solid of revolution about z: rings of radius r at height z, closed where the first or last radius is 0.
SurfaceMesh revolved(const std::vector<std::array<double, 2>>& profile) {
  SurfaceMesh mesh;
  for (const auto& [r, z] : profile) add_ring(mesh, {0.0, 0.0, z}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, r);
  join_rings(mesh);
  return mesh;
}

SurfaceMesh ball(double radius) {
  std::vector<std::array<double, 2>> profile;
  for (std::uint32_t k = 0; k <= kSides / 2; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSides;
    profile.push_back({radius * std::sin(angle), radius * (1.0 - std::cos(angle))});
  }
  return revolved(profile);
}

SurfaceMesh box(const Vec3d& size) {
  SurfaceMesh mesh;
  for (std::uint32_t k = 0; k < 8; ++k) {
    mesh.points.push_back({(k & 1U) != 0 ? 0.5 * size.x : -0.5 * size.x, (k & 2U) != 0 ? 0.5 * size.y : -0.5 * size.y,
                           (k & 4U) != 0 ? size.z : 0.0});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

SurfaceMesh quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
}

/// In the instrument's own axes.
SurfaceMesh solid_of(const InstrumentForm& form, double extent) {
  const double r = form.radius, s = 0.5 * extent;
  switch (form.kind) {
    case InstrumentForm::Kind::punch:
      return revolved({{0.0, 0.0}, {r, 0.0}, {r, form.length}, {0.0, form.length}});
    case InstrumentForm::Kind::ball:
      return ball(r);
    case InstrumentForm::Kind::probe:
      return revolved({{0.0, 0.0}, {r, form.tip}, {r, form.length}, {0.0, form.length}});
    case InstrumentForm::Kind::plate:
      return quad({-s, -s, 0.0}, {s, -s, 0.0}, {s, s, 0.0}, {-s, s, 0.0});
    case InstrumentForm::Kind::wall:
      return revolved({{r, 0.0}, {r, extent}});
    case InstrumentForm::Kind::block:
      return box(form.size);
    case InstrumentForm::Kind::blade:
      return quad(form.from, form.to, form.to + Vec3d{0.0, 0.0, s}, form.from + Vec3d{0.0, 0.0, s});
    case InstrumentForm::Kind::none:
    case InstrumentForm::Kind::point:
    case InstrumentForm::Kind::needle:
      break;
  }
  return {};
}

/// A tube about a line, closed at its end.
SurfaceMesh tube(const std::vector<Vec3d>& line, double radius) {
  SurfaceMesh mesh;
  if (line.size() < 2) return mesh;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3d way = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    if (!(norm(way) > 0.0)) continue;
    const auto [x, y] = two_across(unit(way));
    add_ring(mesh, line[i], x, y, radius);
  }
  join_rings(mesh);
  if (mesh.points.empty()) return mesh;
  const auto last = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back(line.back());
  for (std::uint32_t k = 0; k < kSides; ++k) {
    mesh.triangles.push_back({last - kSides + k, last - kSides + (k + 1) % kSides, last});
  }
  return mesh;
}

}  // namespace

SurfaceMesh tool_surface(const Instrument& instrument, double extent) {
  const InstrumentForm form = instrument.form();
  if (form.kind == InstrumentForm::Kind::needle) return tube(instrument.centre_line(), form.radius);
  SurfaceMesh mesh = solid_of(form, extent);
  const Pose pose = instrument.pose();
  for (Vec3d& x : mesh.points) x = pose.position + pose.axes * x;
  return mesh;
}

}  // namespace glisson

// palpation.cpp — see palpation.h.
#include "scene/build/palpation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>
#include <stdexcept>

#include "mesh/inspect/tet_locator.h"

namespace glisson::scene {
namespace {

constexpr int kPieces = 10;             // of each edge of a triangle that is sampled
constexpr double kTouching = 1e-7;      // distance that counts as touch [m]
constexpr double kOutOfReach = 1000.0;  // [m]; a tool beyond it has passed the body
constexpr int kMostSteps = 500;

/// How far the tool moves before its distance from a point is `close`; `most` where it does not before that. The distance is never
/// more than the true one, so it can be moved by as much without passing the point.
double march(const Shape& shape, const Vec3d& point, const Vec3d& direction, double close, double most) {
  double moved = 0.0;
  for (int n = 0; n < kMostSteps && moved < most; ++n) {
    const double gap = distance_to(shape, point - direction * moved).distance - close;
    if (gap <= kTouching) return moved;
    moved += gap;
  }
  return most;
}

/// The same for the nearest point of a triangle, sampled.
double march_to_triangle(const Shape& shape, const std::array<Vec3d, 3>& corners, const Vec3d& direction, double most) {
  const Vec3d centre = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
  double radius = 0.0;
  for (const Vec3d& x : corners) radius = std::max(radius, norm(x - centre));
  if (march(shape, centre, direction, radius, most) >= most) return most;
  for (int i = 0; i <= kPieces; ++i) {
    for (int j = 0; i + j <= kPieces; ++j) {
      const double a = static_cast<double>(i) / kPieces, b = static_cast<double>(j) / kPieces;
      const Vec3d point = corners[0] + (corners[1] - corners[0]) * a + (corners[2] - corners[0]) * b;
      most = std::min(most, march(shape, point, direction, 0.0, most));
    }
  }
  return most;
}

std::optional<double> touch_of(const Shape& shape, const Pose& start, const Vec3d& direction, const TetMesh& mesh,
                               std::span<const Triangle> surface) {
  const Vec3d own = transposed(start.axes) * direction;
  double first = kOutOfReach;
  for (const Triangle& t : surface) {
    std::array<Vec3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = start.to_own(mesh.vertices[t[i]]);
    first = march_to_triangle(shape, corners, own, first);
  }
  if (first >= kOutOfReach) return {};
  return first;
}

/// A move that takes a given time whatever its length: its speed rises to the middle and falls from there.
Stroke timed(const Vec3d& from, const Vec3d& to, double time, double rest = 0.0) {
  const double length = norm(to - from);
  if (length < 1e-12) return {.to = from, .rest = time + rest};
  return {.to = to, .velocity = 2.0 * length / time, .ramp = 0.5 * time, .rest = rest};
}

}  // namespace

std::optional<double> first_touch(const Shape& shape, const Pose& start, const Vec3d& direction, const TetMesh& mesh) {
  return touch_of(shape, start, direction, mesh, boundary_triangles(mesh));
}

std::vector<Vec3d> palpation_points(const PalpationSpec& p, const Pose& start) {
  std::vector<Vec3d> points;
  for (int row = 0; row < p.rows; ++row) {
    for (int i = 0; i < p.columns; ++i) {
      const int column = row % 2 == 0 ? i : p.columns - 1 - i;
      const Vec3d own{p.spacing * (column - 0.5 * (p.columns - 1)), p.spacing * (row - 0.5 * (p.rows - 1)), 0.0};
      points.push_back(start.axes * own);
    }
  }
  return points;
}

StrokeMotion palpation_strokes(const PalpationSpec& p, const Pose& start, const Vec3d& direction,
                               const std::vector<double>& touch) {
  const std::vector<Vec3d> points = palpation_points(p, start);
  const double down = (p.clearance + p.indentation) / p.velocity;
  StrokeMotion motion{.start = p.start, .strokes = {}};
  Vec3d at{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d above = points[i] + direction * (touch.at(i) - p.clearance),
                below = points[i] + direction * (touch[i] + p.indentation);
    motion.strokes.push_back(timed(at, above, p.move));
    motion.strokes.push_back({.to = below, .velocity = norm(below - above) / down, .rest = p.hold});
    motion.strokes.push_back({.to = above, .velocity = norm(below - above) / down});
    at = above;
  }
  return motion;
}

std::vector<double> palpation_touches(const InstrumentSpec& x, const Pose& start, const Vec3d& direction,
                                      const TetMesh& mesh) {
  const auto* contact = std::get_if<ContactOptions>(&x.what);
  if (!contact)
    throw std::invalid_argument(
        "a palpation needs an instrument that presses in contact: punch, ball, probe, plate or block");
  const std::vector<Triangle> surface = boundary_triangles(mesh);
  const detail::TetLocator body(mesh, {});
  std::vector<double> touches;
  for (const Vec3d& aside : palpation_points(std::get<PalpationSpec>(x.motion.how), start)) {
    Pose at = start;
    at.position += aside;
    const std::optional<double> touch = touch_of(contact->shape, at, direction, mesh, surface);
    const bool inside = body.locate(at.position).has_value() || (touch && *touch <= 0.0);
    if (touch && !inside) {
      touches.push_back(*touch);
      continue;
    }
    std::ostringstream text;
    text << "the point of the palpation at (" << at.position.x << ", " << at.position.y << ", " << at.position.z
         << ") m "
         << (inside ? "is inside the body at the start; move `tip_m` away from it against the direction"
                    : "misses the body along the direction; move `tip_m`, or give fewer `columns` and `rows` or less "
                      "`spacing_mm`");
    throw std::invalid_argument(text.str());
  }
  return touches;
}

}  // namespace glisson::scene

// body_places.cpp — see glisson/scene/body_places.h.
#include "glisson/scene/body_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/text.h"
#include "glisson/mesh.h"
#include "mesh/inspect/nearest_point.h"
#include "scene/build/build_instruments.h"
#include "scene/build/palpation.h"
#include "scene/build/select.h"

namespace glisson {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kOnEdge =
    1e-9;  // of a triangle's area: a line through an edge meets one of its two triangles, whatever rounding does
constexpr int kLooks = 200;                // at a path
constexpr std::size_t kMostTimes = 2000;   // of a path with its corners
constexpr std::size_t kMostFollowed = 20;  // moves, each in some 0.1 s
constexpr int kEdgePoints = 9;             // of an instrument that has an edge

std::string millimetres(double metres) { return detail::number_text(1e3 * metres, 4) + " mm"; }

/// Where the line x + s d crosses a triangle; infinite: nowhere. [MollerTrumbore1997]
double crossing(const Vec3d& x, const Vec3d& d, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d along = b - a, aside = c - a, across = cross(d, aside);
  const double area = dot(along, across);
  if (area == 0.0) return kInfinite;
  const Vec3d from = x - a, turned = cross(from, along);
  const double u = dot(from, across) / area, v = dot(d, turned) / area;
  if (u < -kOnEdge || v < -kOnEdge || u + v > 1.0 + kOnEdge) return kInfinite;
  return dot(aside, turned) / area;
}

/// The surface of a body, for questions about lines.
struct Skin {
  explicit Skin(const TetMesh& body) : mesh(body), faces(boundary_triangles(body)) {}

  /// The first place from x on where the line x + s d crosses the surface; infinite: nowhere.
  double first_crossing(const Vec3d& x, const Vec3d& d) const {
    double first = kInfinite;
    for (const Triangle& t : faces) {
      const double s = crossing(x, d, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      if (s >= 0.0) first = std::min(first, s);
    }
    return first;
  }
  double distance(const Vec3d& x) const {
    double least = kInfinite;
    for (const Triangle& t : faces) {
      const Vec3d near = detail::nearest_on_triangle(x, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      least = std::min(least, norm(near - x));
    }
    return least;
  }

  const TetMesh& mesh;
  std::vector<Triangle> faces;
};

/// A distance from which a point of the line is outside of the body, whatever the direction [m].
double far_from(const TetMesh& mesh, const Vec3d& point) {
  const auto [low, high] = box_of(mesh);
  return 2.0 * norm(high - low) + norm(point - (low + high) * 0.5);
}

std::string bracketed(const Vec3d& x) {
  return "[" + detail::number_text(x.x) + ", " + detail::number_text(x.y) + ", " + detail::number_text(x.z) + "]";
}

std::string line_text(const Vec3d& point, const Vec3d& direction) {
  return "the line through " + bracketed(point) + " m along " + bracketed(direction);
}

[[noreturn]] void refuse_miss(const TetMesh& mesh, const Vec3d& point, const Vec3d& direction) {
  throw std::invalid_argument(line_text(point, direction) + " misses the body, which spans " +
                              scene::extent_text(mesh) +
                              "; give another `direction`, or a `region` or `point_m` of the body");
}

/// How far an instrument moves along its direction until it meets the surface: with its tip, or as the shape that it has.
std::optional<double> touch_from(const InstrumentSpec& x, const Pose& start, const Vec3d& direction,
                                 const TetMesh& mesh) {
  if (const auto* contact = std::get_if<ContactOptions>(&x.what)) {
    return scene::first_touch(contact->shape, start, direction, mesh);
  }
  const double touch = Skin(mesh).first_crossing(start.position, direction);
  return std::isfinite(touch) ? std::optional(touch) : std::nullopt;
}

/// A straight part of a path, without a turn.
struct Move {
  Pose from;
  Vec3d to;
};

/// A path as straight moves, looked at now and then and at its corners; a turn is a move of its own at each look.
std::vector<Move> moves_of(ToolDriver& driver, double until) {
  std::vector<double> times;
  for (int i = 1; i <= kLooks; ++i) times.push_back(until * i / kLooks);
  for (double t = driver.corners().after(0.0); t < until && times.size() < kMostTimes; t = driver.corners().after(t)) {
    times.push_back(t);
  }
  std::sort(times.begin(), times.end());
  std::vector<Move> moves{{driver.start(), driver.start().position}};
  for (const double time : times) {
    const Pose now = driver.advance(time, 0.0, {});
    Move& last = moves.back();
    const Vec3d done = last.to - last.from.position, next = now.position - last.to;
    const bool turned = !(now.axes == last.from.axes);
    const bool bent = norm(cross(done, next)) > 1e-9 * norm(done) * norm(next) || dot(done, next) < 0.0;
    if (turned || bent) {
      moves.push_back({{last.to, now.axes}, now.position});
    } else {
      last.to = now.position;
    }
  }
  return moves;
}

/// Whether a shape may touch the body on a move: its distance from a triangle is at least that from the middle less what reaches beyond it.
bool may_touch(const glisson::Shape& shape, const Pose& pose, double moved, const Skin& skin) {
  return std::ranges::any_of(skin.faces, [&](const Triangle& t) {
    const Vec3d &a = skin.mesh.vertices[t[0]], &b = skin.mesh.vertices[t[1]], &c = skin.mesh.vertices[t[2]];
    const Vec3d middle = (a + b + c) * (1.0 / 3.0);
    const double reach = std::max({norm(a - middle), norm(b - middle), norm(c - middle)});
    return distance_to(shape, pose.to_own(middle)).distance <= reach + moved;
  });
}

/// @param form   of an instrument without a shape: its tip and edge count
/// @param exact  whether a shape that may touch is followed to where it does
bool move_meets(const InstrumentSpec& x, const InstrumentForm& form, const Move& move, const Skin& skin, bool exact) {
  const Vec3d way = move.to - move.from.position;
  const double length = norm(way);
  const Vec3d direction = length > 0.0 ? way * (1.0 / length) : unit(x.direction);
  if (const auto* contact = std::get_if<ContactOptions>(&x.what)) {
    const bool may = may_touch(contact->shape, move.from, length, skin);
    if (!may || !exact) return may;
    const std::optional<double> touch = scene::first_touch(contact->shape, move.from, direction, skin.mesh);
    return touch && *touch <= length;
  }
  std::vector<Vec3d> points{move.from.position};
  for (int i = 0; i < kEdgePoints; ++i) {
    const double share = static_cast<double>(i) / (kEdgePoints - 1);
    points.push_back(move.from.to_space(form.from + (form.to - form.from) * share));
  }
  return std::ranges::any_of(points, [&](const Vec3d& p) { return skin.first_crossing(p, direction) <= length; });
}

}  // namespace

Vec3d body_point(const TetMesh& mesh, const BodyPoint& at) {
  if (at.point) return *at.point;
  const int region = at.region.empty() ? 0 : scene::region_number(mesh, at.region);
  Vec3d sum{};
  double weight = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!at.region.empty() && mesh.region_of(t) != region) continue;
    const double volume = six_rest_volume(mesh, t);
    for (const std::uint32_t v : mesh.tets[t]) sum += mesh.vertices[v] * (0.25 * volume);
    weight += volume;
  }
  if (!(weight > 0.0)) {
    throw std::invalid_argument(
        "the mesh has no region \"" + at.region +
        "\" with tets in it; `glisson info` lists the regions of a file, `glisson check` those of a scene");
  }
  return sum * (1.0 / weight);
}

Vec3d facing_point(const TetMesh& mesh, const BodyPoint& at, const Vec3d& direction) {
  const Vec3d point = body_point(mesh, at), d = unit(direction), far = point - d * far_from(mesh, point);
  const double touch = Skin(mesh).first_crossing(far, d);
  if (!std::isfinite(touch)) refuse_miss(mesh, point, direction);
  return far + d * touch;
}

Vec3d aimed_tip(const InstrumentSpec& x, const Pose& pose, const TetMesh& mesh) {
  const Vec3d point = body_point(mesh, x.aim->at), d = unit(x.direction);
  const double away = far_from(mesh, point);
  Pose far = pose;
  far.position = point - d * away;
  const std::optional<double> touch = touch_from(x, far, d, mesh);
  if (!touch) refuse_miss(mesh, point, x.direction);
  if (!x.aim->distance) return far.position + d * (*touch - x.aim->clearance);
  if (away - *x.aim->distance > *touch) {
    throw std::invalid_argument("aim: with `distance_mm` = " + detail::number_text(1e3 * *x.aim->distance) + " \"" +
                                x.name + "\" would start inside the body: " + line_text(point, x.direction) +
                                " meets the surface " + millimetres(away - *touch) +
                                " before that point; give more, or `clearance_mm` in its place");
  }
  return point - d * *x.aim->distance;
}

std::optional<PathMeeting> meets_body(const InstrumentSpec& x, const TetMesh& mesh, double until) {
  if (std::holds_alternative<OwnInstrument>(x.what)) return {};
  const InstrumentForm form = scene::make_instrument(x, mesh)->form();
  const std::shared_ptr<ToolDriver> driver = make_driver(x, mesh);
  until = std::min(until, driver->end().value_or(kInfinite));
  if (driver->yields() || !std::isfinite(until)) return {};
  const Skin skin(mesh);
  const std::vector<Move> moves = moves_of(*driver, until);
  const bool exact = moves.size() <= kMostFollowed;
  if (std::ranges::any_of(moves, [&](const Move& move) { return move_meets(x, form, move, skin, exact); })) {
    return PathMeeting{.meets = true};
  }
  constexpr int kPlaces = 20;  // of each move
  PathMeeting beside{.meets = false, .beside = skin.distance(moves.front().from.position)};
  const int places = std::max(1, kPlaces / static_cast<int>(moves.size()));
  for (const Move& move : moves) {
    for (int i = 1; i <= places; ++i) {
      const Vec3d place = move.from.position + (move.to - move.from.position) * (static_cast<double>(i) / places);
      beside.beside = std::min(beside.beside, skin.distance(place));
    }
  }
  return beside;
}

}  // namespace glisson

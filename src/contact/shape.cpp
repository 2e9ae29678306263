// shape.cpp — signed distances of the tools' shapes.
//
// Solids of revolution are convex polygons in the half-plane (ρ, z), grown by the radius of their edges:
//
//   z ▲ 3────2        punch: rectangle          Outside, the distance is that to the nearest point of the polygon;
//     │ │    │        cone:  1 runs up a slant   inside, that to the nearest of its lines. Both are exact.
//     │ 0────1  ▶ ρ   blunt: a line on the axis, grown by the needle's radius
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "contact/shape_traits.h"

namespace glisson {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kRim = 1e-10;  // of the length: so near to a rim, either side of it is meant

struct Point {
  double rho, z;
};
using Profile = std::array<Point, 4>;  ///< anticlockwise; the last and the first are on the axis

/// Distance and normal in the half-plane.
struct FlatDistance {
  double distance = -kInfinite;
  Point normal{0.0, -1.0};
};

/// Of the line that is nearest from inside, or most exceeded from outside; at a rim, of the one nearer to the tip.
FlatDistance to_lines(const Profile& p, const Point& x) {
  FlatDistance best;
  const double even = kRim * p[2].z;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double er = p[i + 1].rho - p[i].rho, ez = p[i + 1].z - p[i].z, length = std::sqrt(er * er + ez * ez);
    if (!(length > 0.0)) continue;
    const Point n{ez / length, -er / length};
    const double d = n.rho * (x.rho - p[i].rho) + n.z * (x.z - p[i].z);
    if (d > best.distance + even) best = {d, n};
  }
  return best;
}

FlatDistance to_nearest(const Profile& p, const Point& x, const Point& line_normal) {
  double squared = kInfinite;
  Point way{};
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double er = p[i + 1].rho - p[i].rho, ez = p[i + 1].z - p[i].z, ee = er * er + ez * ez;
    const double dr = x.rho - p[i].rho, dz = x.z - p[i].z;
    const double t = ee > 0.0 ? std::clamp((er * dr + ez * dz) / ee, 0.0, 1.0) : 0.0;
    const Point w{dr - t * er, dz - t * ez};
    const double s = w.rho * w.rho + w.z * w.z;
    if (s < squared) squared = s, way = w;
  }
  const double d = std::sqrt(squared);
  if (!(d > kRim * p[2].z)) return {d, line_normal};
  return {d, {way.rho / d, way.z / d}};
}

ShapeDistance revolved(const Profile& p, double rounding, const Vec3d& x) {
  const double rho = std::sqrt(x.x * x.x + x.y * x.y);
  FlatDistance f = to_lines(p, {rho, x.z});
  if (f.distance >= 0.0) f = to_nearest(p, {rho, x.z}, f.normal);
  ShapeDistance d{f.distance - rounding, {0.0, 0.0, f.normal.z}};
  if (rho > 0.0) {
    d.normal.x = f.normal.rho * x.x / rho, d.normal.y = f.normal.rho * x.y / rho;
  } else if (std::abs(f.normal.z) > 1e-3) {
    d.normal.z = std::copysign(1.0, f.normal.z);  // on the axis all ways to the side are as near: along it
  } else {
    d.normal = {1.0, 0.0, 0.0};
  }
  return d;
}

Profile cylinder(double radius, double length, double rounding) {
  const double r = radius - rounding, bottom = rounding, top = length - rounding;
  return {{{0.0, bottom}, {r, bottom}, {r, top}, {0.0, top}}};
}

ShapeDistance distance(const FlatPunch& s, const Vec3d& x) {
  return revolved(cylinder(s.radius, s.length, s.edge_radius), s.edge_radius, x);
}

ShapeDistance distance(const Ball& s, const Vec3d& x) {
  const Vec3d d{x.x, x.y, x.z - s.radius};
  const double r = norm(d);
  return {r - s.radius, r > 0.0 ? d * (1.0 / r) : Vec3d{0.0, 0.0, -1.0}};
}

ShapeDistance distance(const NeedleShape& s, const Vec3d& x) {
  const double radius = 0.5 * s.diameter;
  if (s.tip == TipForm::blunt) return revolved(cylinder(radius, s.length, radius), radius, x);
  if (s.tip == TipForm::conical) {
    const double height = radius / std::tan(0.5 * s.tip_angle);
    return revolved({{{0.0, 0.0}, {radius, height}, {radius, s.length}, {0.0, s.length}}}, 0.0, x);
  }
  const ShapeDistance shaft = revolved(cylinder(radius, s.length, 0.0), 0.0, x);
  const double sine = std::sin(s.tip_angle), cosine = std::cos(s.tip_angle);
  const double plane = (radius - x.x) * cosine - x.z * sine;
  return plane > shaft.distance ? ShapeDistance{plane, {-cosine, 0.0, -sine}} : shaft;
}

ShapeDistance distance(const Plate&, const Vec3d& x) { return {-x.z, {0.0, 0.0, -1.0}}; }

ShapeDistance distance(const CylinderWall& s, const Vec3d& x) {
  const double rho = std::sqrt(x.x * x.x + x.y * x.y);
  return {s.radius - rho, rho > 0.0 ? Vec3d{-x.x / rho, -x.y / rho, 0.0} : Vec3d{-1.0, 0.0, 0.0}};
}

ShapeDistance distance(const Block& s, const Vec3d& x) {
  const Vec3d y{x.x, x.y, x.z - 0.5 * s.size.z};
  Vec3d over, sign;
  std::size_t most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    over[i] = std::abs(y[i]) - (0.5 * s.size[i] - s.edge_radius);
    sign[i] = y[i] < 0.0 || (i == 2 && y[i] == 0.0) ? -1.0 : 1.0;
    if (over[i] > over[most]) most = i;
  }
  ShapeDistance d;
  d.normal[most] = sign[most];
  d.distance = over[most] - s.edge_radius;
  if (!(over[most] > 0.0)) return d;
  const Vec3d out{std::max(over.x, 0.0), std::max(over.y, 0.0), std::max(over.z, 0.0)};
  const double away = norm(out);
  return {away - s.edge_radius, {sign.x * out.x / away, sign.y * out.y / away, sign.z * out.z / away}};
}

ShapeTraits traits(const FlatPunch& s) { return {.thickness = std::min(2.0 * s.radius, s.length)}; }
ShapeTraits traits(const Ball& s) { return {.thickness = 2.0 * s.radius}; }
ShapeTraits traits(const NeedleShape& s) { return {.thickness = s.diameter}; }
ShapeTraits traits(const Plate&) { return {.thickness = kInfinite, .presses_between = false, .flat = true}; }
ShapeTraits traits(const CylinderWall&) { return {.thickness = kInfinite, .presses_between = false, .hollow = true}; }
ShapeTraits traits(const Block& s) { return {.thickness = std::min({s.size.x, s.size.y, s.size.z})}; }

}  // namespace

ShapeDistance distance_to(const Shape& shape, const Vec3d& x) {
  return std::visit([&](const auto& s) { return distance(s, x); }, shape);
}

Fault FlatPunch::check() const {
  const double most = std::min(radius, 0.5 * length);
  if (edge_radius <= most) return {};
  return {detail::number_text(1e3 * edge_radius) + " mm is above " + detail::number_text(1e3 * most) +
              " mm, the radius or half the length; give a smaller one",
          "edge_radius"};
}

double NeedleShape::tip_length() const {
  return tip == TipForm::conical    ? 0.5 * diameter / std::tan(0.5 * tip_angle)
         : tip == TipForm::bevelled ? diameter / std::tan(tip_angle)
                                    : 0.5 * diameter;
}

Fault NeedleShape::check() const {
  constexpr double kMostBevel = 1.55;
  if (tip == TipForm::bevelled && tip_angle > kMostBevel) {
    return {detail::number_text(tip_angle) + " rad is above " + detail::number_text(kMostBevel) +
                " rad, the most of a bevelled tip",
            "tip_angle"};
  }
  const double least = tip == TipForm::blunt ? diameter : tip_length();  // a blunt one has its hemisphere and a shaft
  if (length > least) return {};
  return {detail::number_text(1e3 * length) + " mm is not more than the " + detail::number_text(1e3 * least) +
              " mm of its tip; make it longer or the tip blunter",
          "length"};
}

Fault Block::check() const {
  const double most = 0.5 * std::min({size.x, size.y, size.z});
  if (edge_radius <= most) return {};
  return {detail::number_text(1e3 * edge_radius) + " mm is above " + detail::number_text(1e3 * most) +
              " mm, half its smallest size; give a smaller one",
          "edge_radius"};
}

ShapeTraits traits_of(const Shape& shape) {
  return std::visit([](const auto& s) { return traits(s); }, shape);
}

}  // namespace glisson

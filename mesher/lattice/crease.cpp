// crease.cpp — planes on both sides of a crease.
#include "mesher/lattice/crease.h"

#include <algorithm>
#include <cmath>

namespace glisson::lattice {
namespace {

constexpr double kInto = 0.1;  ///< of the edge: how far into a side its function is asked

Vec3d unit_or(const Vec3d& v, const Vec3d& otherwise) {
  const double length = norm(v);
  return length > 1e-9 ? v * (1.0 / length) : otherwise;
}

}  // namespace

CreasePlanes crease_planes(const RegionFields& fields, std::size_t k, const Vec3d& p, double edge,
                           const CreaseSides& sides) {
  const double into = kInto * edge;
  CreasePlanes planes;
  const auto plane = [&](const Vec3d& side, Vec3d& normal, double& value) {
    const Vec3d at = p + side * into;
    const Vec3d g = fields.gradient(k, at, edge);
    const double slope = std::max(norm(g), 1e-3);
    normal = g * (1.0 / slope);
    value = fields.value(k, at) / slope - dot(normal, side) * into;
  };
  plane(sides.a, planes.normal_a, planes.value_a);
  plane(sides.b, planes.normal_b, planes.value_b);
  return planes;
}

double project_to_crease(const RegionFields& fields, std::size_t k, Vec3d& p, double edge, CreaseSides& sides) {
  double left = 0.0;
  for (int i = 0; i < 5; ++i) {
    const CreasePlanes planes = crease_planes(fields, k, p, edge, sides);
    left = std::max(std::abs(planes.value_a), std::abs(planes.value_b));
    const double c = dot(planes.normal_a, planes.normal_b), det = 1.0 - c * c;
    if (det < 0.02) return 1e300;  // the sides have become one
    const Vec3d line = unit_or(cross(planes.normal_a, planes.normal_b), Vec3d{1.0, 0.0, 0.0});
    const auto turned = [&](const Vec3d& side, const Vec3d& normal) {
      return unit_or(side - line * dot(line, side) - normal * dot(normal, side), side);
    };
    sides = {turned(sides.a, planes.normal_a), turned(sides.b, planes.normal_b)};
    if (left < 1e-4 * edge) break;
    const double wa = (-planes.value_a + c * planes.value_b) / det, wb = (-planes.value_b + c * planes.value_a) / det;
    Vec3d step = planes.normal_a * wa + planes.normal_b * wb;
    if (const double length = norm(step); length > 0.5 * edge) step *= 0.5 * edge / length;
    p += step;
  }
  return left;
}

}  // namespace glisson::lattice

// tet_quality.h — one number for the shape of a tetrahedron: what the mesher improves.
//
// The sine of the worst dihedral angle, those beyond 90° counted as 0.7 of it, so that 10° and 165° weigh about the same,
// and the least altitude over the edge that was asked for, which bounds the stable step:
//   q = min( min_θ≤90° sin θ, 0.7 min_θ>90° sin θ, 0.755 min altitude / edge )              [KlingnerShewchuk2008, §2]
// q ≥ kGood means every angle in [10.6°, 164.7°] and no altitude below 0.3 of that of a regular tetrahedron.
#pragma once

#include <algorithm>
#include <cmath>

#include "glisson/math.h"

namespace glisson::lattice {

inline constexpr double kGood = 0.185;
inline constexpr double kAltitudeWeight = 0.755;

/// @param edge  length asked for [m]
/// @return q, or a number ≤ 0 for a tet without volume or turned inside out
inline double tet_quality(const Vec3d& p0, const Vec3d& p1, const Vec3d& p2, const Vec3d& p3, double edge) {
  const Vec3d e1 = p1 - p0, e2 = p2 - p0, e3 = p3 - p0, e12 = p2 - p1, e13 = p3 - p1, e23 = p3 - p2;
  const Vec3d n3 = cross(e2, e1), n2 = cross(e1, e3), n1 = cross(e3, e2),
              n0 = -(n1 + n2 + n3);  // outward, twice the area
  const double six = -dot(n3, e3);
  if (!(six > 0.0)) return six / (edge * edge * edge);
  const double a0 = dot(n0, n0), a1 = dot(n1, n1), a2 = dot(n2, n2), a3 = dot(n3, n3);
  const auto at_edge = [](const Vec3d& e, const Vec3d& m, const Vec3d& n, double am, double an) {
    return dot(e, e) * (dot(m, n) > 0.0 ? 0.49 : 1.0) / (am * an);  // sin²θ = (6V)² l² / (|m|² |n|²)
  };
  const double sines =
      std::min({at_edge(e1, n2, n3, a2, a3), at_edge(e2, n1, n3, a1, a3), at_edge(e3, n1, n2, a1, a2),
                at_edge(e12, n0, n3, a0, a3), at_edge(e13, n0, n2, a0, a2), at_edge(e23, n0, n1, a0, a1)});
  const double weight = kAltitudeWeight / edge;
  const double altitude = weight * weight / std::max({a0, a1, a2, a3});
  return six * std::sqrt(std::min(sines, altitude));
}

}  // namespace glisson::lattice

// point_laws.h — the laws of a point that a solid holds out, one at a time: pressing, friction, bonds.
//
// Rows are moved by a class with
//   h()            length of the step [s]
//   end(row)       where the point ends with the present velocities, in the frame of the solid [m]
//   velocity(row)  of the point [m/s]
//   own(row, J)    velocity that an impulse J on the point gives it [m/s]
//   push(row, J)   gives it an impulse [N s]
// in a short step vertices alone (point_rows.cpp), in a long one all points that move one another (coupled_rows.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/two_across.h"
#include "contact/point_rows.h"

namespace glisson::point_laws {

inline constexpr int kMostCorrections = 8;
inline constexpr double kSticks = 1.0 - 1e-9;  ///< of its limit: friction below it holds a point

/// φ with the allowance of the row taken off.
inline ShapeDistance distance_of(const ContactRow& row, const Vec3d& y) {
  ShapeDistance d = distance_to(*row.solid->shape, y);
  d.distance += row.allowance;
  return d;
}

inline double phi(const ContactRow& row, const Vec3d& y) { return distance_of(row, y).distance; }

inline Vec3d scaled(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Impulse along the normal that the point needs if it is to end at `level`, and no less than none.
/// @param base  where it ends without that impulse @param way  by how much a unit impulse moves it
inline double needed(const ContactRow& row, const Vec3d& base, const Vec3d& way, double per_impulse) {
  const double close = row.solid->tolerance();
  const double flat = (dot(row.n, row.face - base) + row.level) / per_impulse;
  if (row.solid->holds) return flat;
  if (flat <= 0.0 && !row.solid->traits.hollow) return 0.0;
  double s = std::max(0.0, flat), d = phi(row, base + way * s) - row.level;
  for (int k = 0; k < kMostCorrections && d < -close; ++k) {  // hollow: the wall rises beyond its tangent plane
    const double next = s - d / per_impulse, further = phi(row, base + way * next) - row.level;
    if (!(further > d)) return s;
    s = next, d = further;
  }
  const double speed = norm(way);
  for (int k = 0; k < kMostCorrections && s > 0.0 && d > close; ++k) {  // down from the tangent plane to the solid
    s -= d / speed;
    if (s <= 0.0) return row.fast ? std::max(0.0, flat) : 0.0;
    d = phi(row, base + way * s) - row.level;
  }
  return s;
}

/// The impulse across the normal that would stop the point against the solid.
inline Vec3d sticking(const ContactRow& row, const Vec3d& slip) {
  const Vec3d &w = row.response, &n = row.normal;
  if (w.x == w.y && w.y == w.z) return slip * (-1.0 / w.x);
  const auto [s, t] = two_across(n);
  double ss = dot(s, scaled(w, s)), tt = dot(t, scaled(w, t));
  const double st = dot(s, scaled(w, t)), floor = 1e-9 * std::max({w.x, w.y, w.z});
  // a way that supports hold altogether: friction acts there up to its limit, where it has one
  ss += floor, tt += floor;
  const double det = ss * tt - st * st, a = -dot(slip, s), b = -dot(slip, t);
  Vec3d r = s * ((tt * a - st * b) / det) + t * ((ss * b - st * a) / det);
  if (std::isinf(row.solid->friction)) {
    for (std::size_t i = 0; i < 3; ++i) r[i] = w[i] > 0.0 ? r[i] : 0.0;
  }
  return r;
}

/// @return by how much the point was moved [m]
template <class Moves>
double rub(ContactRow& row, Moves& moves) {
  const double limit = row.pressing > 0.0 ? row.solid->friction * row.pressing : 0.0;
  if (limit == 0.0 && row.rubbing == Vec3d{}) return 0.0;
  const Vec3d drift = row.solid->after.axes * (moves.end(row) - row.start) * (1.0 / moves.h());
  const Vec3d undone = drift - scaled(row.response, row.rubbing);
  Vec3d wanted = sticking(row, undone - row.normal * dot(undone, row.normal));
  if (row.softness > 0.0) wanted *= 1.0 / (1.0 + row.softness);
  const double size = norm(wanted);
  if (size > limit) wanted *= limit / size;
  const Vec3d change = wanted - row.rubbing;
  row.rubbing = wanted;
  moves.push(row, change);
  return norm(scaled(row.response, change)) * moves.h();
}

/// @return the same
template <class Moves>
double press(ContactRow& row, Moves& moves) {
  const Vec3d way = transposed(row.solid->after.axes) * moves.own(row, row.normal) * moves.h();
  const double per_impulse = row.along * moves.h();
  double wanted = needed(row, moves.end(row) - way * row.pressing, way, per_impulse);
  if (row.softness > 0.0) wanted /= 1.0 + row.softness;
  if (row.most) {
    const double speed_off = dot(row.normal, moves.velocity(row) - row.carried);
    wanted = std::min(wanted, std::max(0.0, row.pressing + (*row.most - speed_off) / row.along));
  }
  const double change = wanted - row.pressing;
  row.pressing = wanted;
  if (change != 0.0) moves.push(row, row.normal * change);
  return std::abs(change) * per_impulse;
}

/// Takes a bonded point to where it is held. @return by how much it was moved [m]
template <class Moves>
double hold(ContactRow& row, Moves& moves) {
  const Vec3d off = row.solid->after.axes * (row.face - moves.end(row)) * (1.0 / moves.h()), &w = row.response;
  const Vec3d change{w.x > 0.0 ? off.x / w.x : 0.0, w.y > 0.0 ? off.y / w.y : 0.0, w.z > 0.0 ? off.z / w.z : 0.0};
  row.take(row.impulse() + change);
  moves.push(row, change);
  return norm(scaled(w, change)) * moves.h();
}

/// Whether friction holds the point with something to spare.
inline bool sticks(const ContactRow& row) {
  return row.pressing > 0.0 && row.solid->friction > 0.0 &&
         norm(row.rubbing) < kSticks * row.solid->friction * row.pressing;
}

/// How much farther out the row would have its point, or, of a bond, elsewhere [m]. Of one that is held back by what it may give, nothing.
template <class Moves>
double missed(const ContactRow& row, const Moves& moves) {
  if (row.most) return 0.0;
  const Vec3d end = moves.end(row);
  if (row.bonded) return norm(row.face - end);
  const Vec3d way = transposed(row.solid->after.axes) * moves.own(row, row.normal) * moves.h();
  const double per_impulse = row.along * moves.h(),
               more = (needed(row, end - way * row.pressing, way, per_impulse) - row.pressing) * per_impulse;
  return row.solid->holds ? std::abs(more) : std::max(0.0, more);
}

/// Takes off what the row exerts. @return by how much the point was moved [m]
template <class Moves>
double release(ContactRow& row, Moves& moves) {
  const Vec3d impulse = row.impulse();
  if (impulse == Vec3d{}) return 0.0;
  moves.push(row, -impulse);
  row.pressing = 0.0, row.rubbing = {};
  return norm(scaled(row.response, impulse)) * moves.h();
}

}  // namespace glisson::point_laws

// shape_node.h — a node of the tree of shapes: its distance, its box, and a cheap bound of its distance from above.
//
// A union, difference or intersection leaves out parts that cannot change its value: one side by the box of a part, which its distance
// is never less than, the other by surely_below(). In a vein, `intersection of tree and whole` is the distance of the tree as long as
// p is further inside the whole, which balls within its lobes tell for a tenth of the cost. What is left out changes no bit.
#pragma once

#include <algorithm>
#include <limits>

#include "glisson/implicit.h"

namespace glisson::detail {

inline Vec3d lesser(const Vec3d& a, const Vec3d& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3d greater(const Vec3d& a, const Vec3d& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline Vec3d all(double x) { return {x, x, x}; }
inline Bounds grown(const Bounds& b, double by) { return {b.min - all(by), b.max + all(by)}; }
inline Bounds joined(const Bounds& a, const Bounds& b) { return {lesser(a.min, b.min), greater(a.max, b.max)}; }
inline bool is_finite(const Bounds& b) {
  const auto finite = [](const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  return finite(b.min) && finite(b.max);
}
/// From a point to a box [m]; 0 inside.
inline double box_distance(const Bounds& b, const Vec3d& p) {
  return norm(greater(greater(b.min - p, p - b.max), Vec3d{}));
}
/// Whether p is outside a box and further from it than `reach`: what the box holds is then further, too.
inline bool is_beyond(const Bounds& b, const Vec3d& p, double reach) {
  const double distance = box_distance(b, p);
  return distance > 0.0 && distance >= reach;
}
inline const Bounds kEverywhere{all(-std::numeric_limits<double>::infinity()),
                                all(std::numeric_limits<double>::infinity())};

}  // namespace glisson::detail

namespace glisson {

class Solid::Node {
 public:
  explicit Node(const Bounds& box) : bounds(box) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// At least the distance to the box, so that leaving out what lies in a far box changes no bit.
  double distance(const Vec3d& p) const {
    const double value = formula(p);
    return value > 0.0 ? std::max(value, detail::box_distance(bounds, p)) : value;
  }

  /// Whether distance(p) ≤ bound, as far as that can be told for much less than the distance costs; false: it is not known.
  bool surely_below(const Vec3d& p, double bound) const {
    if (bound >= 0.0 && detail::box_distance(bounds, p) > 0.0) return false;
    return below(p, bound);
  }
  /// The same for distance(p) ≥ bound.
  bool surely_above(const Vec3d& p, double bound) const {
    return detail::is_beyond(bounds, p, bound) || (cheap() && distance(p) >= bound);
  }
  /// Whether distance() costs no more than such a test.
  virtual bool cheap() const { return false; }

  const Bounds bounds;

 protected:
  virtual double formula(const Vec3d& p) const = 0;
  virtual bool below(const Vec3d& p, double bound) const { return cheap() && distance(p) <= bound; }
};

}  // namespace glisson

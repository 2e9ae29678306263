// simple_shapes.cpp — ball, ellipsoid, box, cylinder, torus, half space, any function.
#include <cmath>

#include "base/require_fields.h"
#include "base/text.h"
#include "mesher/implicit/shape_node.h"

namespace glisson {
namespace {

using namespace detail;

/// A function of a point as a node.
template <class Function>
class Formula final : public Solid::Node {
 public:
  Formula(const Bounds& box, Function function, bool cheap)
      : Node(box), function_(std::move(function)), cheap_(cheap) {}
  double formula(const Vec3d& p) const override { return function_(p); }
  bool cheap() const override { return cheap_; }

 private:
  Function function_;
  bool cheap_;
};
template <class Function>
std::shared_ptr<const Solid::Node> formula(const Bounds& box, Function function, bool cheap = true) {
  return std::make_shared<Formula<Function>>(box, std::move(function), cheap);
}

template <class S>
const S& checked(const S& shape) {
  require_fields(std::string(S::kName), shape);
  return shape;
}

/// From a point to a rectangle, or in three dimensions a box, about the origin, given |p| − half.
double outside_and_inside(const Vec3d& q) {
  return norm(greater(q, Vec3d{})) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

std::shared_ptr<const Solid::Node> ball_node(const BallShape& s) {
  return formula({s.center - all(s.radius), s.center + all(s.radius)},
                 [=](const Vec3d& p) { return norm(p - s.center) - s.radius; });
}

double power(double x, double n) { return n == 2.0 ? x * x : std::pow(x, n); }
double root(double x, double n) { return n == 2.0 ? std::sqrt(x) : std::pow(x, 1.0 / n); }

/// With ρ the norm whose unit ball the body is: d = (ρ − 1)/|∇ρ|, the distance to the plane that touches the body where the
/// ray from its centre leaves it. The body is convex, so that d is no more than the distance outside.
double ellipsoid_distance(const EllipsoidShape& s, const Vec3d& p) {
  const double m = s.exponent_xy, n = s.exponent_z;
  const Vec3d q = p - s.center;
  const Vec3d u{std::abs(q.x) / s.semi_axes.x, std::abs(q.y) / s.semi_axes.y, std::abs(q.z) / s.semi_axes.z};
  const double flat = root(power(u.x, m) + power(u.y, m), m);
  const double rho = root(power(flat, n) + power(u.z, n), n);
  if (!(rho > 1e-12)) return -std::min({s.semi_axes.x, s.semi_axes.y, s.semi_axes.z});
  const double of_flat = power(flat / rho, n - 1.0);
  const double sx = flat > 0.0 ? power(u.x / flat, m - 1.0) : 0.0, sy = flat > 0.0 ? power(u.y / flat, m - 1.0) : 0.0;
  const Vec3d gradient{of_flat * sx / s.semi_axes.x, of_flat * sy / s.semi_axes.y,
                       power(u.z / rho, n - 1.0) / s.semi_axes.z};
  return (rho - 1.0) / norm(gradient);
}

/// Ten powers a distance: the tree asks below() first.
class Superellipsoid final : public Solid::Node {
 public:
  explicit Superellipsoid(const EllipsoidShape& s)
      : Node({s.center - s.semi_axes, s.center + s.semi_axes}), shape_(s),
        least_axis_(std::min({s.semi_axes.x, s.semi_axes.y, s.semi_axes.z})) {}

  double formula(const Vec3d& p) const override { return ellipsoid_distance(shape_, p); }

 private:
  /// With exponents of 2 or more ρ is at most the Euclidean norm |u|, so that its gradient in u is no longer than 1 and
  /// (ρ − 1)/|∇ρ| ≤ (|u| − 1) · the shortest semi-axis inside.
  bool below(const Vec3d& p, double bound) const override {
    constexpr double kRounding = 1e-9;
    const Vec3d q = p - shape_.center;
    const Vec3d u{q.x / shape_.semi_axes.x, q.y / shape_.semi_axes.y, q.z / shape_.semi_axes.z};
    const double norm2 = dot(u, u);
    return norm2 < 1.0 && (std::sqrt(norm2) - 1.0 + kRounding) * least_axis_ <= bound;
  }

  EllipsoidShape shape_;
  double least_axis_;  ///< [m]
};

std::shared_ptr<const Solid::Node> ellipsoid_node(const EllipsoidShape& s) {
  if (s.exponent_xy != 2.0 || s.exponent_z != 2.0) return std::make_shared<Superellipsoid>(s);
  return formula({s.center - s.semi_axes, s.center + s.semi_axes},
                 [s](const Vec3d& p) { return ellipsoid_distance(s, p); });
}

std::shared_ptr<const Solid::Node> box_node(const BoxShape& s) {
  const Vec3d half = s.size * 0.5, core = half - all(s.rounding);
  return formula({s.center - half, s.center + half}, [=](const Vec3d& p) {
    const Vec3d q = p - s.center;
    return outside_and_inside(Vec3d{std::abs(q.x), std::abs(q.y), std::abs(q.z)} - core) - s.rounding;
  });
}

/// Half the extent along x, y, z of a disc of radius r across a unit axis.
Vec3d disc_extent(const Vec3d& axis, double r) {
  const auto one = [&](double a) { return r * std::sqrt(std::max(0.0, 1.0 - a * a)); };
  return {one(axis.x), one(axis.y), one(axis.z)};
}

std::shared_ptr<const Solid::Node> cylinder_node(const CylinderShape& s) {
  const Vec3d middle = (s.from + s.to) * 0.5, axis = unit(s.to - s.from);
  const double half = 0.5 * norm(s.to - s.from), radius = s.radius, r = s.rounding;
  const Vec3d extent = disc_extent(axis, radius);
  const Bounds box{lesser(s.from, s.to) - extent, greater(s.from, s.to) + extent};
  return formula(box, [=](const Vec3d& p) {
    const Vec3d q = p - middle;
    const double along = dot(q, axis), across = norm(q - axis * along);
    return outside_and_inside({across - radius + r, std::abs(along) - half + r, -1e300}) - r;
  });
}

std::shared_ptr<const Solid::Node> torus_node(const TorusShape& s) {
  const Vec3d axis = unit(s.axis);
  const Vec3d extent = disc_extent(axis, s.radius) + all(s.tube_radius);
  return formula({s.center - extent, s.center + extent}, [=](const Vec3d& p) {
    const Vec3d q = p - s.center;
    const double along = dot(q, axis), across = norm(q - axis * along);
    return std::hypot(across - s.radius, along) - s.tube_radius;
  });
}

}  // namespace

Fault BoxShape::check() const {
  const double most = 0.5 * std::min({size.x, size.y, size.z});
  if (rounding <= most) return {};
  return {"rounds more than half the shortest side; give " + show(most * 1e3) + " mm or less", "rounding"};
}

Fault CylinderShape::check() const {
  const double height = norm(to - from);
  if (!(height > 0.0)) return {"is the same point as `from`; give the centre of the other end", "to"};
  const double most = std::min(radius, 0.5 * height);
  if (rounding <= most) return {};
  return {"rounds more than the radius or half the height; give " + show(most * 1e3) + " mm or less", "rounding"};
}

Solid::Solid(const BallShape& shape) : node_(ball_node(checked(shape))) {}
Solid::Solid(const EllipsoidShape& shape) : node_(ellipsoid_node(checked(shape))) {}
Solid::Solid(const BoxShape& shape) : node_(box_node(checked(shape))) {}
Solid::Solid(const CylinderShape& shape) : node_(cylinder_node(checked(shape))) {}
Solid::Solid(const TorusShape& shape) : node_(torus_node(checked(shape))) {}

Solid::Solid(const HalfSpaceShape& shape)
    : node_(formula(kEverywhere, [point = checked(shape).point, normal = unit(shape.normal)](const Vec3d& p) {
        return dot(p - point, normal);
      })) {}

Solid::Solid(std::function<double(const Vec3d&)> distance, const Bounds& bounds)
    : node_(formula(bounds, std::move(distance), false)) {}

double Solid::distance(const Vec3d& point) const { return node_->distance(point); }
const Bounds& Solid::bounds() const { return node_->bounds; }

}  // namespace glisson

#include "instruments/contact_rows.h"

#include <algorithm>
#include <cmath>

namespace glisson {
namespace {

constexpr int kMostSweeps = 40;
constexpr double kSettling = 5e-3;  // tissue found inside a tool leaves by its depth over this time [s]
constexpr double kFast = 0.25;      // of the thickness
constexpr double kNear = 0.1;       // of its way: a point that ends so near takes part

double phi(const ContactRow& row, const Vec3d& y) { return distance_to(*row.solid->shape, y).distance; }

/// First place on the way from a to b that is not outside. @return share of the way; above 1: none
double first_touch(const ContactRow& row, const Vec3d& a, const Vec3d& b) {
  const double length = norm(b - a), close = row.solid->tolerance();
  double way = 0.0;
  for (int k = 0; k < 64 && way <= length; ++k) {
    const double d = phi(row, a + (b - a) * (way / length));
    if (d <= close) return way / length;
    way += d;  // φ is never more than the distance: nothing is passed over
  }
  return way <= length ? way / length : 2.0;
}

/// Velocity per impulse of a point that is a mean of vertices.
Vec3d response_of(const ContactRow& row, const InteractionStep& step) {
  Vec3d sum;
  for (std::uint32_t i = 0; i < row.count; ++i) {
    sum += step.mobility[row.places[i]] * (row.weights[i] * row.weights[i]);
  }
  return sum;
}

Vec3d scaled(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

void push(ContactRow& row, const InteractionStep& step, const Vec3d& impulse) {
  for (std::uint32_t i = 0; i < row.count; ++i) step.push(row.places[i], impulse * row.weights[i]);
}

bool meets(ContactRow& row, const Vec3d& end, const ShapeDistance& at_start) {
  const double close = row.solid->tolerance(), way = norm(end - row.start);
  row.fast = way > kFast * row.solid->traits.thickness;
  const ShapeDistance at_end = distance_to(*row.solid->shape, end);
  const bool touches = at_start.distance <= close;
  if (at_end.distance > kNear * way + close && !row.fast && !(touches && row.solid->holds)) return false;
  if (touches) {
    row.n = at_start.normal;
    row.face = row.start - row.n * at_start.distance;
    return true;
  }
  const double share = first_touch(row, row.start, end);
  if (share <= 1.0) {
    row.face = row.start + (end - row.start) * share;
    row.n = distance_to(*row.solid->shape, row.face).normal;
    return true;
  }
  row.n = at_end.normal;
  row.face = end - row.n * at_end.distance;
  return at_end.distance <= kNear * way + close;
}

/// Impulse along the normal that the point needs if it is to end at `level`, and no less than none.
/// @param base  where it ends without that impulse @param way  by how much a unit impulse moves that
double needed(const ContactRow& row, const Vec3d& base, const Vec3d& way, double per_impulse) {
  const double close = row.solid->tolerance();
  const double flat = (dot(row.n, row.face - base) + row.level) / per_impulse;
  if (row.solid->holds) return flat;
  double s = std::max(0.0, flat);
  double d = phi(row, base + way * s) - row.level;
  for (int k = 0; k < 12 && d < -close; ++k) {  // hollow: the wall rises beyond the tangent plane
    const double slope = dot(distance_to(*row.solid->shape, base + way * s).normal, way);
    if (!(slope > 0.1 * per_impulse)) return s;
    s -= d / slope;
    d = phi(row, base + way * s) - row.level;
  }
  const double speed = norm(way);
  for (int k = 0; k < 24 && s > 0.0 && d > close; ++k) {  // down from the tangent plane to the solid
    s -= d / speed;
    if (s <= 0.0) return row.fast ? std::max(0.0, flat) : 0.0;
    d = phi(row, base + way * s) - row.level;
  }
  return s;
}

/// The impulse across the normal that would stop the point against the solid.
Vec3d sticking(const ContactRow& row, const Vec3d& slip) {
  const Vec3d &w = row.response, &n = row.normal;
  if (w.x == w.y && w.y == w.z) return slip * (-1.0 / w.x);
  const Vec3d helper = std::abs(n.x) < 0.6 ? Vec3d{1.0, 0.0, 0.0} : Vec3d{0.0, 1.0, 0.0};
  const Vec3d c = cross(n, helper), s = c * (1.0 / norm(c)), t = cross(n, s);
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
double rub(ContactRow& row, const InteractionStep& step) {
  const double limit = row.pressing > 0.0 ? row.solid->friction * row.pressing : 0.0;
  if (limit == 0.0 && row.rubbing == Vec3d{}) return 0.0;
  const Vec3d drift = row.solid->after.axes * (end_of(row, step) - row.start) * (1.0 / step.h);
  const Vec3d undone = drift - scaled(row.response, row.rubbing);
  Vec3d wanted = sticking(row, undone - row.normal * dot(undone, row.normal));
  const double size = norm(wanted);
  if (size > limit) wanted *= limit / size;
  const Vec3d change = wanted - row.rubbing;
  row.rubbing = wanted;
  push(row, step, change);
  return norm(scaled(row.response, change)) * step.h;
}

double press(ContactRow& row, const InteractionStep& step) {
  const Vec3d way = direction_to_frame(row.solid->after, scaled(row.response, row.normal)) * step.h;
  const double per_impulse = row.along * step.h;
  const double wanted = needed(row, end_of(row, step) - way * row.pressing, way, per_impulse);
  const double change = wanted - row.pressing;
  row.pressing = wanted;
  if (change != 0.0) push(row, step, row.normal * change);
  return std::abs(change) * per_impulse;
}

}  // namespace

double ContactSolid::tolerance() const { return std::isfinite(traits.thickness) ? 1e-9 * traits.thickness : 1e-12; }

Vec3d end_of(const ContactRow& row, const InteractionStep& step) {
  Vec3d v;
  for (std::uint32_t i = 0; i < row.count; ++i) v += step.vertices[row.places[i]].velocity * row.weights[i];
  return to_frame(row.solid->after, row.origin + v * step.h);
}

bool prepare(ContactRow& row, const InteractionStep& step) {
  row.origin = {};
  for (std::uint32_t i = 0; i < row.count; ++i) row.origin += step.position(row.places[i]) * row.weights[i];
  row.start = to_frame(row.solid->before, row.origin);
  const ShapeDistance at_start = distance_to(*row.solid->shape, row.start);
  if (!meets(row, end_of(row, step), at_start)) return false;
  row.normal = row.solid->after.axes * row.n;
  row.response = response_of(row, step);
  row.along = dot(row.normal, scaled(row.response, row.normal));
  const double inside = std::max(0.0, -at_start.distance - row.solid->tolerance());
  row.level = -std::max(0.0, inside - step.h * std::min(row.solid->push_out_speed, inside / kSettling));
  return row.along > 1e-9 * std::max({row.response.x, row.response.y, row.response.z});
}

int solve(std::span<ContactRow> rows, const InteractionStep& step) {
  double enough = 0.0;
  for (const ContactRow& row : rows) enough = std::max(enough, row.solid->tolerance());
  for (int sweep = 1; sweep <= kMostSweeps; ++sweep) {
    double change = 0.0;
    for (ContactRow& row : rows) {
      change = std::max(change, press(row, step));
      change = std::max(change, rub(row, step));
    }
    if (change <= enough) return sweep;
  }
  return kMostSweeps;
}

std::array<double, 3> deepest(const Shape& shape, const std::array<Vec3d, 3>& corners,
                              const std::array<double, 3>& at_corners, double& depth) {
  const auto first =
      static_cast<std::size_t>(std::min_element(at_corners.begin(), at_corners.end()) - at_corners.begin());
  std::array<double, 3> best{};
  best[first] = 1.0;
  depth = at_corners[first];
  const std::array<double, 3> third{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  const auto at = [&](const std::array<double, 3>& w) {
    return corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
  };
  ShapeDistance d = distance_to(shape, at(third));
  if (d.distance < depth) best = third, depth = d.distance;
  d = distance_to(shape, at(best));
  double step = 0.5;  // of the way that the slope asks for along the edges
  for (int k = 0; k < 14; ++k) {
    // slopes of φ along the weights, the mean taken off so that they add up to none
    std::array<double, 3> slope{dot(d.normal, corners[0]), dot(d.normal, corners[1]), dot(d.normal, corners[2])};
    const double mean = (slope[0] + slope[1] + slope[2]) / 3.0;
    double largest = 0.0;
    for (double& s : slope) s -= mean, largest = std::max(largest, std::abs(s));
    if (!(largest > 0.0)) break;
    std::array<double, 3> w = best;
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) w[i] = std::max(0.0, w[i] - step * slope[i] / largest), sum += w[i];
    for (double& x : w) x /= sum;
    const ShapeDistance next = distance_to(shape, at(w));
    if (next.distance < depth) {
      best = w, depth = next.distance, d = next;
    } else {
      step *= 0.5;
    }
  }
  return best;
}

}  // namespace glisson

#include "contact/point_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/two_across.h"
#include "contact/point_laws.h"

namespace glisson {
namespace {

constexpr int kMostSweeps = 60;
constexpr int kMostSweepsBetween = 45;  // with triangles, whose points are looked for up to three times
constexpr double kAtEdge = 1e-3;        // a weight below it: the point is on an edge of its triangle
constexpr double kAlike = 0.8;  // cosine between normals of solid and triangle that are one but for the triangle's size
constexpr double kAway = -0.2;  // … below which they do not face each other
constexpr int kMostProbes = 24;     // of a triangle
constexpr double kSettling = 5e-3;  // tissue found inside a tool leaves by its depth over this time [s]
constexpr double kFast = 0.25;      // of the thickness
constexpr double kHeld = 2000.0;    // tolerances: a point that ends so near is where its row wants it
constexpr double kNear = 0.1;       // of its way: a point that ends so near takes part

using Corners = std::array<Vec3d, 3>;
using point_laws::distance_of, point_laws::phi, point_laws::scaled;

/// Where the vertices of a row are in the frame of the solid.
Corners at_start(const ContactRow& row) {
  const Pose& p = row.solid->before;
  return {p.to_own(row.origins[0]), p.to_own(row.origins[1]), p.to_own(row.origins[2])};
}
Corners at_end(const ContactRow& row, const InteractionStep& step) {
  Corners c{};
  for (std::uint32_t i = 0; i < row.count; ++i) {
    c[i] = row.solid->after.to_own(row.origins[i] + step.vertices[row.places[i]].velocity * step.h);
  }
  return c;
}

Vec3d mean(const ContactRow& row, const Corners& c) {
  if (row.count == 1) return c[0];
  return c[0] * row.weights[0] + c[1] * row.weights[1] + c[2] * row.weights[2];
}

/// Share of the way at which a point is not outside any more; above 1: never. φ is never more than the distance, so that
/// nothing is passed over.
double first_touch(const ContactRow& row, const Vec3d& a, const Vec3d& b) {
  const double close = row.solid->tolerance(), length = norm(b - a);
  double way = 0.0;
  for (int k = 0; k < 64 && way <= length; ++k) {
    const double d = phi(row, a + (b - a) * (way / length));
    if (d <= close) return way / length;
    way += d;
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

/// Where the point of a row is held: where it starts, if it touches there, or where it enters.
bool meets(ContactRow& row, const Vec3d& end) {
  const double way = norm(end - row.start), close = row.solid->tolerance(), reach = kNear * way + close;
  const ShapeDistance before = distance_of(row, row.start);
  row.fast = way > kFast * row.solid->traits.thickness;
  row.inside = std::max(0.0, -before.distance - close);
  if (before.distance <= close + (row.solid->holds ? row.solid->grip : 0.0)) {
    row.n = before.normal, row.face = row.start - row.n * before.distance;
    return row.fast || row.solid->holds || phi(row, end) <= reach;
  }
  const double share = std::min(1.0, first_touch(row, row.start, end));
  const Vec3d y = row.start + (end - row.start) * share;
  const ShapeDistance d = distance_of(row, y);
  row.n = d.normal, row.face = y - row.n * d.distance;
  return d.distance <= reach;
}

/// The point of a triangle nearest to the centre of a ball: by the regions of corners, edges and face.
std::array<double, 3> nearest_to(const Ball& ball, const Corners& c, double& depth) {
  const Vec3d p{0.0, 0.0, ball.radius}, ab = c[1] - c[0], ac = c[2] - c[0], ap = p - c[0], bp = p - c[1], cp = p - c[2];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  std::array<double, 3> w{};
  if (d1 <= 0.0 && d2 <= 0.0) {
    w = {1.0, 0.0, 0.0};
  } else if (d3 >= 0.0 && d4 <= d3) {
    w = {0.0, 1.0, 0.0};
  } else if (d6 >= 0.0 && d5 <= d6) {
    w = {0.0, 0.0, 1.0};
  } else if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    w = {1.0 - t, t, 0.0};
  } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    w = {1.0 - t, 0.0, t};
  } else if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    w = {0.0, 1.0 - t, t};
  } else {
    const double sum = va + vb + vc;
    w = {va / sum, vb / sum, vc / sum};
  }
  depth = norm(c[0] * w[0] + c[1] * w[1] + c[2] * w[2] - p) - ball.radius;
  return w;
}

/// Inside a triangle, and at a sharp rim of the solid, contact is normal to the triangle.
void turn_to_triangle(ContactRow& row, const Corners& at) {
  const Vec3d outward = cross(at[1] - at[0], at[2] - at[0]);
  const double area = norm(outward);
  if (!(area > 0.0)) return;
  const Vec3d inward = outward * (-1.0 / area);
  const double cosine = dot(row.n, inward);
  const bool inside = std::min({row.weights[0], row.weights[1], row.weights[2]}) > kAtEdge;
  if (cosine > kAway && (inside || cosine < kAlike)) row.n = inward;
}

}  // namespace

void push(const ContactRow& row, const InteractionStep& step, const Vec3d& impulse) {
  for (std::uint32_t i = 0; i < row.count; ++i) step.push(row.places[i], impulse * row.weights[i]);
}

void list_held(const ContactRow& row, const InteractionStep& step, HeldRows& held) {
  if (row.pressing == 0.0) return;
  const double close = kHeld * row.solid->tolerance();
  const Vec3d end = end_of(row, step);
  if (std::abs(phi(row, end) - row.level) > close) return;
  std::array<VertexWeight, 3> corners;
  for (std::uint32_t i = 0; i < row.count; ++i) {
    corners[i] = {step.vertices[row.places[i]].vertex, row.weights[i]};
  }
  const std::uint32_t point = held.add_mean(std::span(corners).first(row.count));
  held.add_row(point, row.normal);
  if (!point_laws::sticks(row)) return;
  const Vec3d way = end - row.start;
  if (norm(way - row.n * dot(way, row.n)) > close) return;
  for (const Vec3d& e : two_across(row.normal)) held.add_row(point, e);
}

double ContactSolid::tolerance() const { return std::isfinite(traits.thickness) ? 1e-9 * traits.thickness : 1e-12; }

ToolVelocity ContactSolid::velocity_at(const Vec3d& x, double h) const {
  ToolVelocity velocity;
  const Vec3d own = before.to_own(x);
  if (last_h > 0.0) velocity.before = (x - earlier.to_space(own)) * (1.0 / last_h);
  velocity.after = (after.to_space(own) - x) * (1.0 / h);
  return velocity;
}

Vec3d end_of(const ContactRow& row, const InteractionStep& step) { return mean(row, at_end(row, step)); }

bool prepare(ContactRow& row, const InteractionStep& step) {
  for (std::uint32_t i = 0; i < row.count; ++i) row.origins[i] = step.position(row.places[i]);
  const Corners start = at_start(row), end = at_end(row, step);
  row.start = mean(row, start);
  row.origin = mean(row, row.origins);
  if (!meets(row, mean(row, end))) return false;
  if (row.count == 3) turn_to_triangle(row, start);
  row.normal = row.solid->after.axes * row.n;
  row.response = response_of(row, step);
  row.along = dot(row.normal, scaled(row.response, row.normal));
  row.level = -std::max(0.0, row.inside - step.h * std::min(row.solid->push_out_speed, row.inside / kSettling));
  // in a long step other points of a triangle come to be its deepest: pushed out, they would bring energy in
  if (step.is_long && row.count == 3) row.level = -row.inside;
  const ContactSolid& solid = *row.solid;
  row.carried = (solid.after.to_space(row.start) - row.origin) * (1.0 / step.h);
  row.carried_before = row.carried;
  if (solid.last_h > 0.0) row.carried_before = (row.origin - solid.earlier.to_space(row.start)) * (1.0 / solid.last_h);
  if (row.comes_out) {
    const Vec3d growth = row.normal * ((row.inside + row.level) / step.h);
    row.carried += growth, row.carried_before += growth;
  }
  return row.along > 1e-9 * std::max({row.response.x, row.response.y, row.response.z});
}

void prepare_bond(ContactRow& row, const Vec3d& anchor, const InteractionStep& step) {
  row.bonded = true;
  row.origin = row.origins[0] = step.position(row.places[0]);
  row.start = row.solid->before.to_own(row.origin);
  row.face = anchor, row.n = distance_to(*row.solid->shape, anchor).normal;
  row.normal = row.solid->after.axes * row.n;
  row.response = response_of(row, step);
}

int most_sweeps(std::span<ContactRow* const> rows) {
  const bool between = !rows.empty() && rows.back()->count == 3;  // triangles come last
  return between ? kMostSweepsBetween : kMostSweeps;
}

namespace {

/// Rows of a short step: a vertex is moved by what pushes it alone.
struct ShortMoves {
  const InteractionStep& step;

  double h() const { return step.h; }
  Vec3d end(const ContactRow& row) const { return end_of(row, step); }
  Vec3d velocity(const ContactRow& row) const {
    Vec3d v;
    for (std::uint32_t i = 0; i < row.count; ++i) v += step.vertices[row.places[i]].velocity * row.weights[i];
    return v;
  }
  static Vec3d own(const ContactRow& row, const Vec3d& impulse) { return scaled(row.response, impulse); }
  void push(const ContactRow& row, const Vec3d& impulse) const { glisson::push(row, step, impulse); }
};

}  // namespace

Swept sweep(std::span<ContactRow* const> rows, const InteractionStep& step, PushClock& clock, int most) {
  double enough = 0.0;
  for (const ContactRow* row : rows) enough = std::max(enough, kSolvedWithin * row->solid->tolerance());
  const ShortMoves moves{step};
  Swept done;
  while (done.sweeps < most) {
    double change = 0.0;
    for (ContactRow* at : rows) {
      ContactRow& row = *at;
      if (clock.latest(places_of(row)) <= row.solved_at) continue;
      const bool alone = row.response.x == row.response.y && row.response.y == row.response.z;
      if (row.bonded) {
        change = std::max(change, point_laws::hold(row, moves));
        continue;
      }
      const double pressed = point_laws::press(row, moves), rubbed = point_laws::rub(row, moves);
      change = std::max({change, pressed, rubbed});
      if (pressed > 0.0 || rubbed > 0.0) clock.push(places_of(row));
      // rubbing moves a point along a curved solid, and off it where supports hold some of its ways: once more then
      if (rubbed <= kSolvedWithin * row.solid->tolerance() || (alone && row.solid->traits.flat))
        row.solved_at = clock.now();
    }
    ++done.sweeps, done.change = change;
    if (change <= enough) break;
  }
  return done;
}

double most_missed(std::span<ContactRow* const> rows, const InteractionStep& step) {
  double most = 0.0;
  for (const ContactRow* row : rows) most = std::max(most, point_laws::missed(*row, ShortMoves{step}));
  return most;
}

std::array<double, 3> deepest(const Shape& shape, const std::array<Vec3d, 3>& corners, double& depth) {
  if (const Ball* ball = std::get_if<Ball>(&shape)) return nearest_to(*ball, corners, depth);
  std::array<ShapeDistance, 3> at_corners;
  for (std::size_t i = 0; i < 3; ++i) at_corners[i] = distance_to(shape, corners[i]);
  std::size_t first = 0;
  for (std::size_t i = 1; i < 3; ++i) first = at_corners[i].distance < at_corners[first].distance ? i : first;
  std::array<double, 3> best{};
  best[first] = 1.0;
  depth = at_corners[first].distance;
  const auto at = [&](const std::array<double, 3>& w) {
    return corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
  };
  ShapeDistance d = at_corners[first];
  const std::array<double, 3> third{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  const ShapeDistance middle = distance_to(shape, at(third));
  if (middle.distance < depth) best = third, depth = middle.distance, d = middle;
  double step = 0.5;
  for (int k = 0; k < kMostProbes && step > 1e-4; ++k) {
    // slopes of φ along the weights, the mean taken off so that they add up to none
    std::array<double, 3> slope{dot(d.normal, corners[0]), dot(d.normal, corners[1]), dot(d.normal, corners[2])};
    const double middle_slope = (slope[0] + slope[1] + slope[2]) / 3.0;
    double largest = 0.0;
    for (double& s : slope) s -= middle_slope, largest = std::max(largest, std::abs(s));
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

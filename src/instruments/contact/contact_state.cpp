// contact_state.cpp — the rows of a step: vertices that meet the tool, triangles that it meets between their corners.
#include "instruments/contact/contact_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {
namespace {

constexpr double kTouch = 1e-6;       // of the body's size: tissue so near to a tool that bonds touches
constexpr double kAllowance = 0.01;   // of its longest edge: a triangle may be so deep inside between its corners …
constexpr double kMostAllowed = 0.1;  // … and so much of the thickness
constexpr double kStride = 0.25;      // of the thickness: a fast triangle is looked at so often on its way
constexpr int kMostStrides = 200;

Triangle corners_of(const ContactRow& row, const InteractionStep& step) {
  return {step.vertices[row.places[0]].vertex, step.vertices[row.places[1]].vertex,
          step.vertices[row.places[2]].vertex};
}

}  // namespace

void ContactTool::State::measure(std::size_t i, const InteractionStep& step) {
  const std::uint32_t place = step.place_of[reach.vertices()[i]];
  const Vec3d x = step.position(place);
  starts[i] = to_frame(solid.before, x);
  ends[i] = to_frame(solid.after, x + step.vertices[place].velocity * step.h);
  at_ends[i] = distance_to(options.shape, ends[i]).distance;
}

void ContactTool::State::add_vertices(const InteractionStep& step) {
  const std::span<const std::uint32_t> mine = reach.vertices();
  starts.resize(mine.size()), ends.resize(mine.size()), at_ends.resize(mine.size());
  pressed.assign(mine.size(), 0.0), exerted.assign(mine.size(), Vec3d{});
  touched.clear();
  for (std::uint32_t i = 0; i < mine.size(); ++i) {
    measure(i, step);
    if (at_ends[i] > norm(ends[i] - starts[i]) + solid.tolerance()) continue;  // nowhere on its way inside
    if (bonds.count(mine[i]) != 0) continue;
    ContactRow row;
    row.places[0] = step.place_of[mine[i]];
    row.solid = &solid;
    found_inside.mark(row, mine[i], 0, starts[i], begun);
    if (prepare(row, step)) rows.push_back(row), touched.push_back(i);
    found_inside.settle(row, mine[i], 0);
  }
  begun = true;
}

void ContactTool::State::add_triangles(const InteractionStep& step) {
  for (const std::uint32_t i : touched) measure(i, step);
  for (const Triangle& t : reach.triangles()) {
    double longest = 0.0, farthest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d edge = ends[t[(i + 1) % 3]] - ends[t[i]], way = ends[t[i]] - starts[t[i]];
      longest = std::max(longest, dot(edge, edge)), farthest = std::max(farthest, dot(way, way));
    }
    const double apart = std::max({at_ends[t[0]], at_ends[t[1]], at_ends[t[2]]});
    // no point of it is farther from a corner than the longest edge; (a + b)² ≤ 2 a² + 2 b²
    if (apart > 0.0 && apart * apart > 2.0 * (longest + farthest)) continue;
    const double allowance = std::min(kAllowance * std::sqrt(longest), kMostAllowed * solid.traits.thickness);
    const double strides = std::ceil(std::sqrt(farthest) / (kStride * solid.traits.thickness));
    if (strides <= 1.0 && least_of({ends[t[0]], ends[t[1]], ends[t[2]]}) > -allowance) continue;
    add_triangle(static_cast<std::uint32_t>(std::clamp(strides, 1.0, double(kMostStrides))), t, allowance, step);
  }
}

/// A bound of φ over a triangle from below: φ is convex, so that it is nowhere below its tangent at the middle.
double ContactTool::State::least_of(const std::array<Vec3d, 3>& x) const {
  const Vec3d middle = (x[0] + x[1] + x[2]) * (1.0 / 3.0);
  const ShapeDistance d = distance_to(options.shape, middle);
  return d.distance +
         std::min({dot(d.normal, x[0] - middle), dot(d.normal, x[1] - middle), dot(d.normal, x[2] - middle)});
}

/// Holds a triangle out that comes to be inside between its corners; a fast one is held where it first enters.
void ContactTool::State::add_triangle(std::uint32_t strides, const Triangle& t, double allowance,
                                      const InteractionStep& step) {
  for (std::uint32_t k = 1; k <= strides; ++k) {
    const double share = static_cast<double>(k) / strides;
    std::array<Vec3d, 3> at{};
    double corner = std::numeric_limits<double>::infinity(), depth = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = starts[t[i]] + (ends[t[i]] - starts[t[i]]) * share;
      corner = std::min(corner, k == strides ? at_ends[t[i]] : distance_to(options.shape, at[i]).distance);
    }
    deepest(options.shape, at, depth);
    if (depth > -allowance || depth > corner - solid.tolerance()) continue;
    ContactRow row;
    for (std::size_t i = 0; i < 3; ++i) row.places[i] = step.place_of[reach.vertices()[t[i]]];
    row.count = 3, row.solid = &solid, row.allowance = allowance;
    if (prepare(row, step, share)) rows.push_back(row);
    return;
  }
}

/// Begins with the forces of the last step: when all rows have been found, as they look at where the free way ends.
void ContactTool::State::begin_triangles(const InteractionStep& step) {
  for (ContactRow& row : rows) {
    if (row.count != 3) continue;
    const auto last = last_pressing.find(corners_of(row, step));
    if (last == last_pressing.end()) continue;
    row.pressing = last->second * step.h;
    push(row, step, row.normal * row.pressing);
  }
}

/// Keeps vertices that have touched where they touched, and takes in those that touch now.
/// Bonds what touches at the start: what follows would only find tissue that comes nearer.
void ContactTool::State::bond_first(const BodyView& body, const Pose& pose) {
  double size = 0.0;  // of the body, at most twice too large
  for (const Vec3d& x : body.mesh.vertices) size = std::max(size, norm(x - body.mesh.vertices.front()));
  for (const std::uint32_t v : reach.surface().vertices()) {
    const Vec3d place = to_frame(pose, body.mesh.vertices[v] + body.displacement[v]);
    if (std::abs(distance_to(options.shape, place).distance) <= kTouch * size) bonds[v] = place;
  }
}

void ContactTool::State::bond(const InteractionStep& step, ToolForces& forces) {
  for (const auto& [vertex, anchor] : bonds) {
    const std::uint32_t place = step.place_of[vertex];
    if (place == InteractionStep::kNowhere) continue;
    const Vec3d x = step.position(place);
    const Vec3d wanted = (to_space(solid.after, anchor) - x) * (1.0 / step.h);
    const Vec3d impulse = stopping(step, place, wanted);
    step.push(place, impulse);
    bond_impulses.emplace_back(place, impulse);
    const Vec3d n = solid.after.axes * distance_to(options.shape, anchor).normal;
    const Vec3d across = n * dot(impulse, n);
    forces.normal += across * (1.0 / step.h), forces.friction += (impulse - across) * (1.0 / step.h);
    forces.torque += cross(x - solid.before.position, impulse) * (1.0 / step.h);
    bear(vertex, dot(impulse, n), impulse);
  }
  for (const ContactRow& row : rows) {
    if (row.count == 1 && row.pressing > 0.0) bonds[step.vertices[row.places[0]].vertex] = end_of(row, step);
  }
}

void ContactTool::State::bear(std::uint32_t vertex, double pressing, const Vec3d& impulse) {
  const std::span<const std::uint32_t> mine = reach.vertices();
  const auto at = std::lower_bound(mine.begin(), mine.end(), vertex);
  if (at == mine.end() || *at != vertex) return;
  const auto place = static_cast<std::size_t>(at - mine.begin());
  pressed[place] += pressing, exerted[place] += impulse;
}

void ContactTool::State::collect(const InteractionStep& step, ToolForces& forces) {
  const double rate = 1.0 / step.h;
  last_pressing.clear();
  for (const ContactRow& row : rows) {
    if (row.count == 3 && row.pressing > 0.0) last_pressing[corners_of(row, step)] = row.pressing * rate;
    if (row.pressing == 0.0 && row.rubbing == Vec3d{}) continue;
    forces.normal += row.normal * (row.pressing * rate);
    forces.friction += row.rubbing * rate;
    forces.torque += cross(row.origin - solid.before.position, row.impulse()) * rate;
    for (std::uint32_t i = 0; i < row.count; ++i) {
      bear(step.vertices[row.places[i]].vertex, row.pressing * row.weights[i], row.impulse() * row.weights[i]);
    }
  }
}

/// Pressures over the present area of the vertices that bear.
void ContactTool::State::weigh(const InteractionStep& step) {
  bearing_vertices.clear(), pressures.clear(), bearing_normal.clear(), bearing_forces.clear();
  area = 0.0;
  const auto position = [&](std::uint32_t v) {
    const std::uint32_t place = step.place_of[v];
    return place == InteractionStep::kNowhere ? step.rest[v] : step.position(place);
  };
  for (std::size_t i = 0; i < pressed.size(); ++i) {
    if (pressed[i] == 0.0 && exerted[i] == Vec3d{}) continue;
    const std::uint32_t vertex = reach.vertices()[i];
    double share = 0.0;
    for (const std::uint32_t k : reach.surface().triangles_at(vertex)) {
      const Triangle& t = reach.surface().triangles()[k];
      const Vec3d a = position(t[0]);
      share += norm(cross(position(t[1]) - a, position(t[2]) - a)) / 6.0;
    }
    bearing_vertices.push_back(vertex);
    bearing_normal.push_back(pressed[i] / step.h), bearing_forces.push_back(exerted[i] * (1.0 / step.h));
    pressures.push_back(share > 0.0 ? pressed[i] / (step.h * share) : 0.0);
    area += share;
  }
}

}  // namespace glisson

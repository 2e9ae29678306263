// contact_state.cpp — the rows of a step: vertices that meet the tool, triangles that it meets between their corners.
#include "instruments/contact/contact_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/text.h"
#include "glisson/simulation/integrator.h"

namespace glisson {
namespace {

constexpr double kTouch = 1e-6;       // of the body's size: tissue so near to a tool that bonds touches
constexpr double kAllowance = 0.01;   // of its longest edge: a triangle may be so deep inside between its corners …
constexpr double kMostAllowed = 0.1;  // … and so much of the thickness
constexpr int kMostRounds = 12;       // of looking for points that come inside in a long step
constexpr double kStride = 0.25;      // of the thickness: a fast triangle is looked at so often on its way
constexpr int kMostStrides = 200;

/// What a row is known by from one step or iteration to the next: the corners of its triangle, or three times its vertex.
Triangle key_of(const ContactRow& row, const InteractionStep& step) {
  const auto vertex = [&](std::size_t i) { return step.vertices[row.places[row.count == 3 ? i : 0]].vertex; };
  return {vertex(0), vertex(1), vertex(2)};
}

}  // namespace

void ContactTool::State::measure(std::size_t i, const InteractionStep& step) {
  const std::uint32_t place = step.place_of[reach.vertices()[i]];
  const Vec3d x = step.position(place);
  starts[i] = solid.before.to_own(x);
  ends[i] = solid.after.to_own(x + step.vertices[place].velocity * step.h);
  at_ends[i] = distance_to(options.shape, ends[i]).distance;
}

void ContactTool::State::begin_vertices(const InteractionStep&) {
  const std::size_t count = reach.vertices().size();
  starts.resize(count), ends.resize(count), at_ends.resize(count);
  pressed.assign(count, 0.0), exerted.assign(count, Vec3d{}), has_row.assign(count, 0);
  touched.clear();
}

/// Finds the vertices that meet the tool and have no row yet. @return how many
std::size_t ContactTool::State::add_vertices(const InteractionStep& step) {
  const std::span<const std::uint32_t> mine = reach.vertices();
  const std::size_t before = rows.size();
  for (std::uint32_t i = 0; i < mine.size(); ++i) {
    measure(i, step);
    if (has_row[i] != 0) continue;
    if (at_ends[i] > norm(ends[i] - starts[i]) + solid.tolerance()) continue;  // nowhere on its way inside
    if (bonds.count(mine[i]) != 0) continue;
    ContactRow row;
    row.places[0] = step.place_of[mine[i]];
    row.solid = &solid;
    found_inside.mark(row, mine[i], 0, starts[i], begun);
    if (prepare(row, step)) rows.push_back(row), touched.push_back(i), has_row[i] = 1;
    found_inside.settle(row, mine[i], 0);
  }
  begun = true;
  return rows.size() - before;
}

void ContactTool::State::solve_short(const InteractionStep& step) {
  begin_vertices(step);
  add_vertices(step);
  effort.vertices = rows.size();
  if (!rows.empty()) effort.sweeps = books.solve(rows, step);
  if (solid.traits.presses_between) add_triangles(step);
  effort.triangles = rows.size() - effort.vertices;
  begin_triangles(step);
  if (effort.triangles > 0) effort.sweeps += books.solve(rows, step);
  effort.corrected = books.corrected();
  books.close(rows, step);
}

/// Rows of what is bonded: they move and are moved by all others in a long step.
void ContactTool::State::add_bonds(const InteractionStep& step) {
  for (const auto& [vertex, anchor] : bonds) {
    if (step.place_of[vertex] == InteractionStep::kNowhere) continue;
    ContactRow row;
    row.places[0] = step.place_of[vertex];
    row.solid = &solid;
    prepare_bond(row, anchor, step);
    rows.push_back(row);
  }
}

/// Begins with what the row had in the last iteration, or with the force of the last step.
void ContactTool::State::begin_row(ContactRow& row, const InteractionStep& step) const {
  const Triangle key = key_of(row, step);
  if (!trial.empty()) {
    if (const auto at = trial.find(key); at != trial.end())
      row.pressing = at->second.first, row.rubbing = at->second.second;
  } else if (const auto at = last_pressing.find(key); at != last_pressing.end()) {
    row.pressing = at->second * step.h;
  } else if (const auto bond = last_bonds.find(key[0]); row.bonded && bond != last_bonds.end()) {
    row.take(bond->second * step.h);
  }
  if (row.pressing > 0.0 || row.bonded) push(row, step, row.impulse());
}

/// All rows of a long step. Points move one another, so that those that come inside by it are looked for until there are
/// none: vertices first, as in a short step. @return sweeps
int ContactTool::State::solve_long(const InteractionStep& step) {
  begin_vertices(step);
  triangle_has_row.assign(reach.triangles().size(), 0);
  int sweeps = 0;
  add_bonds(step);
  add_vertices(step);
  std::size_t fresh = rows.size();
  effort.vertices = fresh;
  for (int round = 0; round < kMostRounds && (fresh > 0 || round == 0); ++round) {
    for (std::size_t k = rows.size() - fresh; k < rows.size(); ++k) begin_row(rows[k], step);
    if (!rows.empty()) sweeps += glisson::solve(rows, step);
    step.compliance->settle(step.vertices);
    fresh = add_vertices(step);
    effort.vertices += fresh;
    if (fresh > 0 || !solid.traits.presses_between) continue;
    const std::size_t before = rows.size();
    add_triangles(step);
    fresh = rows.size() - before;
    effort.triangles += fresh;
  }
  trial.clear();
  for (const ContactRow& row : rows) trial[key_of(row, step)] = {row.pressing, row.rubbing};
  return sweeps;
}

/// @throws std::invalid_argument naming how deep the tool is inside the body
void ContactTool::State::require_outside(const BodyView& body, const Pose& pose, const Vec3d& direction) const {
  double size = 0.0, deepest_phi = 0.0;
  for (const std::uint32_t v : reach.surface().vertices()) {
    const Vec3d x = body.mesh.vertices[v] + body.displacement[v];
    size = std::max(size, norm(x - body.mesh.vertices[reach.surface().vertices().front()]));
    deepest_phi = std::min(deepest_phi, distance_to(options.shape, pose.to_own(x)).distance);
  }
  if (deepest_phi >= -kTouch * size) return;
  const Vec3d back = direction * deepest_phi + Vec3d{};  // no −0
  throw std::invalid_argument(
      "contact tool \"" + options.name + "\": it starts inside the body, " + detail::number_text(-1e3 * deepest_phi) +
      " mm deep, which long steps do not push out. Ways out: start it farther back, by (" +
      detail::number_text(1e3 * back.x) + ", " + detail::number_text(1e3 * back.y) + ", " +
      detail::number_text(1e3 * back.z) + ") mm or more, or take integrator = " + supporting_integrators());
}

void ContactTool::State::add_triangles(const InteractionStep& step) {
  const bool is_long = step.compliance != nullptr;
  if (!is_long) {  // in a long step all have just been measured
    for (const std::uint32_t i : touched) measure(i, step);
  }
  for (std::size_t k = 0; k < reach.triangles().size(); ++k) {
    const Triangle& t = reach.triangles()[k];
    if (is_long && (triangle_has_row[k] != 0 || is_bonded_at(t))) continue;
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
    const bool added =
        add_triangle(static_cast<std::uint32_t>(std::clamp(strides, 1.0, double(kMostStrides))), t, allowance, step);
    if (is_long) triangle_has_row[k] = added ? 1 : 0;
  }
}

/// Whether a corner is bonded. In a long step all rows hold at once: such a triangle would widen the tool by its free corners, which in a
/// short step the bonds undo for the most part.
bool ContactTool::State::is_bonded_at(const Triangle& corners) const {
  return std::any_of(corners.begin(), corners.end(),
                     [&](std::uint32_t i) { return bonds.count(reach.vertices()[i]) != 0; });
}

/// A bound of φ over a triangle from below: φ is convex, so that it is nowhere below its tangent at the middle.
double ContactTool::State::least_of(const std::array<Vec3d, 3>& x) const {
  const Vec3d middle = (x[0] + x[1] + x[2]) * (1.0 / 3.0);
  const ShapeDistance d = distance_to(options.shape, middle);
  return d.distance +
         std::min({dot(d.normal, x[0] - middle), dot(d.normal, x[1] - middle), dot(d.normal, x[2] - middle)});
}

/// Holds a triangle out that comes to be inside between its corners; a fast one is held where it first enters.
/// @return whether there is a row of it
bool ContactTool::State::add_triangle(std::uint32_t strides, const Triangle& t, double allowance,
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
    if (!prepare(row, step, share)) return false;
    rows.push_back(row);
    return true;
  }
  return false;
}

/// Begins with the forces of the last step: when all rows have been found, as they look at where the free way ends.
void ContactTool::State::begin_triangles(const InteractionStep& step) {
  for (ContactRow& row : rows) {
    if (row.count != 3) continue;
    const auto last = last_pressing.find(key_of(row, step));
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
    const Vec3d place = pose.to_own(body.mesh.vertices[v] + body.displacement[v]);
    if (std::abs(distance_to(options.shape, place).distance) <= kTouch * size) bonds[v] = place;
  }
}

void ContactTool::State::bond(const InteractionStep& step, ToolForces& forces) {
  for (const auto& [vertex, anchor] : bonds) {
    const std::uint32_t place = step.place_of[vertex];
    if (place == InteractionStep::kNowhere || step.compliance != nullptr) continue;
    const Vec3d x = step.position(place);
    const Vec3d wanted = (solid.after.to_space(anchor) - x) * (1.0 / step.h);
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
    if (row.count == 1 && row.pressing > 0.0 && !row.bonded) {
      bonds[step.vertices[row.places[0]].vertex] = end_of(row, step);
    }
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
  const bool is_long = step.compliance != nullptr;
  last_pressing.clear(), last_bonds.clear();
  for (const ContactRow& row : rows) {
    if (row.bonded) {
      last_bonds[step.vertices[row.places[0]].vertex] = row.impulse() * rate;
    } else if ((row.count == 3 || is_long) && row.pressing > 0.0) {
      last_pressing[key_of(row, step)] = row.pressing * rate;
    }
    if (row.pressing == 0.0 && row.rubbing == Vec3d{}) continue;
    forces.normal += row.normal * (row.pressing * rate);
    forces.friction += row.rubbing * rate;
    const Vec3d arm =
        is_long ? solid.after.to_space(end_of(row, step)) - solid.after.position : row.origin - solid.before.position;
    forces.torque += cross(arm, row.impulse()) * rate;
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

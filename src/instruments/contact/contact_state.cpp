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
constexpr double kDeeper = 0.02;      // of that: a point so much deeper than those held is held, too …
constexpr double kLongDeeper = 0.05;  // … in a long step, where points that are close give each other their load …
constexpr std::uint32_t kMostPoints = 3;  // … up to so many of a triangle
constexpr int kMostLooks = 3;             // for points of triangles, in a short step
constexpr double kStride = 0.25;          // of the thickness: a fast triangle is looked at so often on its way
constexpr int kMostStrides = 200;

/// What a row is known by from one step or iteration to the next: the corners of its triangle, or three times its vertex.
Triangle key_of(const ContactRow& row, const InteractionStep& step) {
  const auto vertex = [&](std::size_t i) { return step.vertices[row.places[row.count == 3 ? i : 0]].vertex; };
  return {vertex(0), vertex(1), vertex(2)};
}

/// The point of these weights; null where there is none.
template <class Points>
auto* find(Points& points, const std::array<double, 3>& weights) {
  const auto at = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.weights == weights; });
  return at != points.end() ? &*at : nullptr;
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
  effort = {};
  const std::size_t count = reach.vertices().size();
  starts.resize(count), ends.resize(count), at_ends.resize(count);
  pressed.assign(count, 0.0), exerted.assign(count, Vec3d{}), has_row.assign(count, 0), moves.assign(count, 0);
  touched.clear();
  held.assign(reach.triangles().size(), {});
}

void ContactTool::State::bear_nothing() {
  pressed.clear(), exerted.clear();
  effort = {};
}

/// Finds the vertices that meet the tool and have no row yet. @return how many
std::size_t ContactTool::State::add_vertices(const InteractionStep& step, RowGroup& rows) {
  const std::span<const std::uint32_t> mine = reach.vertices();
  const std::size_t before = rows.points.size();
  for (std::uint32_t i = 0; i < mine.size(); ++i) {
    measure(i, step);
    if (has_row[i] != 0) continue;
    if (at_ends[i] > norm(ends[i] - starts[i]) + solid.tolerance()) continue;  // nowhere on its way inside
    if (bonds.count(mine[i]) != 0) continue;
    ContactRow row;
    row.places[0] = step.place_of[mine[i]];
    row.solid = &solid;
    found_inside.mark(row, mine[i], 0, starts[i], begun);
    if (prepare(row, step)) rows.points.push_back(row), touch(i), has_row[i] = 1;
    found_inside.settle(row, mine[i], 0);
  }
  begun = true;
  return rows.points.size() - before;
}

/// A row moves the vertex.
void ContactTool::State::touch(std::uint32_t i) {
  if (moves[i] == 0) touched.push_back(i), moves[i] = 1;
}

/// Vertices first, then triangles that are inside between them, then other points of these: held at one point alone a triangle under an edge
/// would tilt, and be held at the next point only in the next step.
void ContactTool::State::declare_short(const InteractionStep& step, RowGroup& rows, int round) {
  if (round == 0) {
    begin_vertices(step);
    looks = 0;
    rows.account = &account;
    for (const auto& [vertex, anchor] : bonds) {
      const std::uint32_t place = step.place_of[vertex];
      if (place == InteractionStep::kNowhere) continue;
      const Vec3d x = step.position(place);
      rows.holds.push_back({.place = place,
                            .velocity = (solid.after.to_space(anchor) - x) * (1.0 / step.h),
                            .tool = solid.velocity_at(x, step.h)});
    }
  }
  const std::size_t fresh = round == 0 || rows.others_act ? add_vertices(step, rows) : 0;
  effort.vertices += fresh;
  if (fresh > 0 || !solid.traits.presses_between || looks == kMostLooks) return;
  const std::size_t before = rows.points.size();
  effort.triangles += add_triangles(looks > 0 && !rows.others_act, step, rows);
  ++looks;
  begin_rows(before, step, rows);
}

/// Rows of what is bonded: they move and are moved by all others in a long step.
void ContactTool::State::add_bonds(const InteractionStep& step, RowGroup& rows) {
  for (const auto& [vertex, anchor] : bonds) {
    if (step.place_of[vertex] == InteractionStep::kNowhere) continue;
    ContactRow row;
    row.places[0] = step.place_of[vertex];
    row.solid = &solid;
    prepare_bond(row, anchor, step);
    rows.points.push_back(row);
  }
}

/// Rows begin with what they had in the last iteration; in the first with the force of the last step, a triangle's all at its first point.
void ContactTool::State::begin_rows(std::size_t first, const InteractionStep& step, RowGroup& rows) const {
  for (ContactRow& row : std::span(rows.points).subspan(first)) {
    const Triangle key = key_of(row, step);
    if (!trial.empty()) {
      const auto known = trial.find(key);
      const BearingPoint* point = known != trial.end() ? find(known->second, row.weights) : nullptr;
      if (point != nullptr) row.pressing = point->pressing, row.rubbing = point->rubbing;
    } else if (row.bonded) {
      if (const auto bond = last_bonds.find(key[0]); bond != last_bonds.end()) row.take(bond->second * step.h);
    } else if (const auto last = last_pressing.find(key); last != last_pressing.end() && !row.again) {
      row.pressing = last->second * step.h;
    }
  }
}

/// Points of triangles that earlier iterations of this step have found: were they found anew in each, their rows would come and go, and
/// iterations not end.
void ContactTool::State::hold_again(const InteractionStep& step, RowGroup& rows) {
  const std::span<const std::uint32_t> mine = reach.vertices();
  for (std::size_t k = 0; k < reach.triangles().size() && !trial.empty(); ++k) {
    const Triangle& t = reach.triangles()[k];
    const auto known = trial.find({mine[t[0]], mine[t[1]], mine[t[2]]});
    if (known == trial.end() || is_bonded_at(t)) continue;
    const double allowance = allowance_of(longest_of(t));
    for (const BearingPoint& point : known->second) hold(k, point.weights, allowance, step, rows);
  }
}

/// Holds a point of a triangle where the tool meets it.
void ContactTool::State::hold(std::size_t triangle, const std::array<double, 3>& weights, double allowance,
                              const InteractionStep& step, RowGroup& rows) {
  const Triangle& t = reach.triangles()[triangle];
  HeldTriangle& h = held[triangle];
  ContactRow row;
  for (std::size_t i = 0; i < 3; ++i) row.places[i] = step.place_of[reach.vertices()[t[i]]];
  row.count = 3, row.solid = &solid, row.allowance = allowance, row.weights = weights, row.again = h.points > 0;
  if (!prepare(row, step)) return;
  rows.points.push_back(row);
  ++h.points, h.level = std::min(h.level, row.level);
  for (const std::uint32_t i : t) touch(i);
}

/// All rows of a long step. Points move one another, so that those that come inside by it are looked for until there are
/// none: vertices first, as in a short step.
void ContactTool::State::declare_long(const InteractionStep& step, RowGroup& rows, int round) {
  std::size_t before = rows.points.size();
  if (round == 0) {
    begin_vertices(step);
    add_bonds(step, rows);
  }
  const std::size_t fresh = add_vertices(step, rows);
  effort.vertices = round == 0 ? rows.points.size() : effort.vertices + fresh;
  if (round == 0) {
    if (solid.traits.presses_between) hold_again(step, rows);
    effort.triangles = rows.points.size() - effort.vertices;
    if (rows.points.empty() && solid.traits.presses_between) effort.triangles += add_triangles(false, step, rows);
  } else if (fresh == 0 && solid.traits.presses_between) {
    effort.triangles += add_triangles(false, step, rows);
  }
  begin_rows(before, step, rows);
}

/// What solving a step took, and what it leaves for the next iteration of a long one.
void ContactTool::State::found(const InteractionStep& step, const RowGroup& rows) {
  effort.sweeps = rows.sweeps, effort.corrected = rows.corrected;
  if (step.is_long) remember(step, rows);
}

/// Keeps what the rows of an iteration had for the next. Points that were not met this time stay.
void ContactTool::State::remember(const InteractionStep& step, const RowGroup& rows) {
  for (auto& [key, points] : trial) {
    for (BearingPoint& point : points) point.pressing = 0.0, point.rubbing = {};
  }
  for (const ContactRow& row : rows.points) {
    std::vector<BearingPoint>& points = trial[key_of(row, step)];
    BearingPoint* point = find(points, row.weights);
    if (point == nullptr) point = &points.emplace_back(BearingPoint{.weights = row.weights});
    point->pressing = row.pressing, point->rubbing = row.rubbing;
  }
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

/// Looks for triangles that the tool enters between their corners, deeper than where they are held already.
/// @param moved  only among those that rows move @return how many points it adds
std::size_t ContactTool::State::add_triangles(bool moved, const InteractionStep& step, RowGroup& rows) {
  const bool is_long = step.is_long;
  const std::size_t before = rows.points.size();
  if (!is_long && !rows.others_act) {  // otherwise all have just been measured
    for (const std::uint32_t i : touched) measure(i, step);
  }
  for (std::size_t k = 0; k < reach.triangles().size(); ++k) {
    const Triangle& t = reach.triangles()[k];
    if (moved && (moves[t[0]] | moves[t[1]] | moves[t[2]]) == 0) continue;
    if (held[k].points >= kMostPoints || is_bonded_at(t)) continue;
    const double longest = longest_of(t);
    double farthest = 0.0;
    for (const std::uint32_t i : t) {
      const Vec3d way = ends[i] - starts[i];
      farthest = std::max(farthest, dot(way, way));
    }
    const double apart = std::max({at_ends[t[0]], at_ends[t[1]], at_ends[t[2]]});
    // no point of it is farther from a corner than the longest edge; (a + b)² ≤ 2 a² + 2 b²
    if (apart > 0.0 && apart * apart > 2.0 * (longest + farthest)) continue;
    const double allowance = allowance_of(longest);
    const double strides = std::ceil(std::sqrt(farthest) / (kStride * solid.traits.thickness));
    if (strides <= 1.0 && least_of({ends[t[0]], ends[t[1]], ends[t[2]]}) > -allowance) continue;
    add_triangle(k, static_cast<int>(std::clamp(strides, 1.0, double(kMostStrides))), allowance, step, rows);
  }
  return rows.points.size() - before;
}

/// The longest edge of a triangle at the end of the step, squared [m²].
double ContactTool::State::longest_of(const Triangle& t) const {
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d edge = ends[t[(i + 1) % 3]] - ends[t[i]];
    longest = std::max(longest, dot(edge, edge));
  }
  return longest;
}

/// How deep a triangle may be inside between its corners [m]. @param longest  of its edges, squared
double ContactTool::State::allowance_of(double longest) const {
  return std::min(kAllowance * std::sqrt(longest), kMostAllowed * solid.traits.thickness);
}

/// Whether a corner is bonded. All rows hold at once: such a triangle would widen the tool by its free corners.
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

/// Holds a triangle out that comes to be inside between its corners, at its deepest point; a fast one where it first enters.
void ContactTool::State::add_triangle(std::size_t triangle, int strides, double allowance, const InteractionStep& step,
                                      RowGroup& rows) {
  const Triangle& t = reach.triangles()[triangle];
  const double deeper = step.is_long ? kLongDeeper : kDeeper;
  const double let = held[triangle].points > 0 ? (1.0 + deeper) * allowance - held[triangle].level : allowance;
  for (int k = 1; k <= strides; ++k) {
    const double share = static_cast<double>(k) / strides;
    std::array<Vec3d, 3> at{};
    double corner = std::numeric_limits<double>::infinity(), depth = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = k == strides ? ends[t[i]] : starts[t[i]] + (ends[t[i]] - starts[t[i]]) * share;
      corner = std::min(corner, k == strides ? at_ends[t[i]] : distance_to(options.shape, at[i]).distance);
    }
    const std::array<double, 3> weights = deepest(options.shape, at, depth);
    if (depth > -let || depth > corner - solid.tolerance()) continue;
    hold(triangle, weights, allowance, step, rows);
    return;
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

void ContactTool::State::bond(const InteractionStep& step, const RowGroup& rows, ToolForces& forces) {
  auto held_row = rows.holds.begin();
  for (const auto& [vertex, anchor] : bonds) {
    const std::uint32_t place = step.place_of[vertex];
    if (place == InteractionStep::kNowhere || step.is_long) continue;
    const Vec3d impulse = (held_row++)->impulse, n = solid.after.axes * distance_to(options.shape, anchor).normal;
    const Vec3d across = n * dot(impulse, n);
    forces.normal += across * (1.0 / step.h), forces.friction += (impulse - across) * (1.0 / step.h);
    forces.torque += cross(step.position(place) - solid.before.position, impulse) * (1.0 / step.h);
    bear(vertex, dot(impulse, n), impulse);
  }
  for (const ContactRow& row : rows.points) {
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

void ContactTool::State::collect(const InteractionStep& step, const RowGroup& rows, ToolForces& forces) {
  const double rate = 1.0 / step.h;
  const bool is_long = step.is_long;
  last_pressing.clear(), last_bonds.clear();
  for (const ContactRow& row : rows.points) {
    if (row.bonded) {
      last_bonds[step.vertices[row.places[0]].vertex] = row.impulse() * rate;
    } else if ((row.count == 3 || is_long) && row.pressing > 0.0) {
      last_pressing[key_of(row, step)] += row.pressing * rate;
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

#include "glisson/instruments/capsule.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_fields.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"
#include "instruments/capsule/capsule_state.h"

namespace glisson {
namespace {

constexpr double kMostRise = 2.0;  ///< how much faster than in the last step its stiffness is taken to rise at most

/// Hole of a radius about a point of the rest surface, in the plane of the triangle it is in.
struct Hole {
  Vec3d middle, x, y, normal;
  double radius;
  static constexpr double kReach = 2.0;  ///< how far off its plane a triangle may be, in radii

  Hole(const std::array<Vec3d, 3>& corner, const std::array<double, 3>& weights, double r)
      : middle(corner[0] * weights[0] + corner[1] * weights[1] + corner[2] * weights[2]), radius(r) {
    const Vec3d d1 = corner[1] - corner[0], n = cross(d1, corner[2] - corner[0]);
    x = unit(d1);
    normal = unit(n);
    y = cross(normal, x);
  }

  /// Share of a triangle it takes, seen along its own normal [-].
  double share_of(const std::array<Vec3d, 3>& corner) const {
    if (squared_distance_of_box(corner, middle) > (1.0 + kReach * kReach) * radius * radius) return 0.0;
    std::array<std::array<double, 2>, 3> flat{};
    double height = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d d = corner[i] - middle;
      flat[i] = {dot(d, x), dot(d, y)};
      height = std::min(height, std::abs(dot(d, normal)));
    }
    const double twice =
        (flat[1][0] - flat[0][0]) * (flat[2][1] - flat[0][1]) - (flat[1][1] - flat[0][1]) * (flat[2][0] - flat[0][0]);
    if (!(twice > 0.0) || height > kReach * radius) return 0.0;  // another side of the body
    return std::min(1.0, overlap_with_disc(flat, radius) / (0.5 * twice));
  }
};

}  // namespace

Capsule::Capsule(const CapsuleOptions& options) {
  detail::require_fields("capsule \"" + options.name + "\"", options);
  state_ = std::make_unique<State>(options);
}

Capsule::~Capsule() = default;

const CapsuleOptions& Capsule::options() const { return state_->options; }
std::span<const Triangle> Capsule::triangles() const { return state_->triangles; }
std::span<const double> Capsule::tension() const { return state_->tensions(); }
std::span<const double> Capsule::open_share() const { return state_->open; }
double Capsule::released_energy() const { return state_->released; }
const std::vector<CapsuleEvent>& Capsule::events() const { return state_->events; }
double Capsule::energy() const { return state_->membrane.energy(state_->now); }

double Capsule::largest_tension() const {
  const std::vector<double>& t = state_->tensions();
  return t.empty() ? 0.0 : *std::max_element(t.begin(), t.end());
}

bool Capsule::is_torn(std::size_t triangle) const {
  return state_->open.at(triangle) >= 1.0 || state_->is_gone[triangle] != 0;
}

double Capsule::open_area() const {
  double sum = 0.0;
  for (std::size_t t = 0; t < state_->open.size(); ++t) sum += state_->open[t] * state_->membrane.rest_area(t);
  return sum;
}

double Capsule::tension_at(const Vec3d& place) const {
  const PointOnTriangle at = state_->nearest_to(place);
  return std::isfinite(at.distance) ? state_->mean_tension(at.triangle) : 0.0;
}

void Capsule::tear(std::size_t triangle) {
  State& s = *state_;
  if (triangle >= s.triangles.size()) {
    throw std::invalid_argument(s.options.name + ": tear of triangle " + std::to_string(triangle) +
                                "; it has the triangles 0 to " + std::to_string(s.triangles.size()) +
                                " without the last");
  }
  if (s.counts[triangle] == 0) return;
  s.events.push_back({s.time, CapsuleEvent::What::opening, s.centre(triangle),
                      s.membrane.rest_area(triangle) * (1.0 - s.open[triangle])});
  s.open_to(triangle, 1.0);
}

double Capsule::open_at(const Vec3d& place, double radius) {
  State& s = *state_;
  if (!(radius > 0.0 && std::isfinite(radius))) {
    throw std::invalid_argument(s.options.name + ": open_at with the radius " + std::to_string(radius) +
                                " m, which has to be > 0 and finite; a needle's is half its diameter");
  }
  const PointOnTriangle at = s.nearest_to(place);
  if (!std::isfinite(at.distance)) return 0.0;
  const auto corners = [&](std::size_t t) {
    return std::array<Vec3d, 3>{s.rest[s.local[t][0]], s.rest[s.local[t][1]], s.rest[s.local[t][2]]};
  };
  const Hole hole(corners(at.triangle), at.weights, radius);
  double area = 0.0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.counts[t] == 0) continue;
    const double share = hole.share_of(corners(t));
    if (!(share > 0.0)) continue;
    const double before = s.open[t];
    s.open_to(t, before + share);
    area += (s.open[t] - before) * s.membrane.rest_area(t);
  }
  s.events.push_back({s.time, CapsuleEvent::What::opening, place, area});
  return area;
}

void Capsule::attached(const BodyView& body, double time) {
  State fresh(state_->options);
  fresh.is_long = state_->is_long;
  fresh.faces = capsule_faces(fresh.options, body);
  for (const TetFace& f : fresh.faces) fresh.triangles.push_back(corners_of(body.mesh, f));
  fresh.is_gone.assign(fresh.faces.size(), 0);
  fresh.open.assign(fresh.faces.size(), 0.0);
  fresh.time = time;
  fresh.lay_out(body, true);
  *state_ = std::move(fresh);
}

void Capsule::body_changed(const BodyView& body, std::span<const std::uint32_t>) {
  State& s = *state_;
  for (std::size_t t = 0; t < s.faces.size(); ++t) {
    if (s.is_gone[t] != 0) continue;
    if (body.is_removed(s.faces[t].tet)) {
      s.is_gone[t] = 1;
      s.released += s.membrane.kept(t) * s.membrane.energy(s.now, t);
    } else {
      s.triangles[t] = corners_of(body.mesh, s.faces[t]);
    }
  }
  s.lay_out(body, false);
}

std::span<const std::uint32_t> Capsule::reach(double, double) {
  if (state_->is_named || state_->is_long) return {};
  state_->is_named = true;
  return state_->vertices;
}

int Capsule::most_drag_stages() const { return kMostDragStages; }

void Capsule::add_forces(const InteractionStep& step) {
  State& s = *state_;
  if (s.is_long) return;
  s.time = step.time;
  for (std::size_t k = 0; k < s.vertices.size(); ++k) s.now[k] = step.position(step.place_of[s.vertices[k]]);
  s.evaluate();
  for (std::size_t k = 0; k < s.vertices.size(); ++k)
    step.vertices[step.place_of[s.vertices[k]]].elastic += s.forces[k];
  s.tear_where_due();
}

void Capsule::set_long_steps(bool are_long) { state_->is_long = are_long; }

void Capsule::add_forces_at(std::span<const Vec3d> displacement, std::span<Vec3d> force) {
  State& s = *state_;
  for (std::size_t k = 0; k < s.vertices.size(); ++k) s.now[k] = s.rest[k] + displacement[s.vertices[k]];
  s.evaluate();
  for (std::size_t k = 0; k < s.vertices.size(); ++k) force[s.vertices[k]] += s.forces[k];
}

void Capsule::add_stiffness(std::vector<TriangleStiffness>& all) const {
  const State& s = *state_;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.counts[t] != 0) all.push_back({s.triangles[t], s.membrane.stiffness(s.now, t)});
  }
}

/// The sheet was evaluated last where the step has ended.
bool Capsule::overshoots(const InteractionStep&) { return state_->due_to_tear() < state_->triangles.size(); }

void Capsule::moved(const InteractionStep& step) {
  if (!state_->is_long) return;
  state_->time = step.time + step.h;
  state_->tear_where_due();
}

/// Of the last forces, ahead by two steps as stiff as the last one has made it.
double Capsule::squared_frequency() const {
  const State& s = *state_;
  if (!(s.frequency > s.frequency_before && s.frequency_before > 0.0)) return s.frequency;
  const double rise = std::min(s.frequency / s.frequency_before, kMostRise);
  return s.frequency * rise * rise;
}

bool Capsule::add_stiffness_bound(std::vector<VertexStiffness>& all) const {
  const State& s = *state_;
  std::vector<double> bound(s.vertices.size(), 0.0);
  s.membrane.add_stiffness_bound(bound);
  for (std::size_t k = 0; k < bound.size(); ++k) all.push_back({s.vertices[k], bound[k]});
  return true;
}

void Capsule::state_set(std::span<const Vec3d> displacement) {
  State& s = *state_;
  for (std::size_t k = 0; k < s.vertices.size(); ++k) s.now[k] = s.rest[k] + displacement[s.vertices[k]];
  s.evaluate();
  s.frequency_before = s.frequency;
}

void archive(Archive& ar, CapsuleEvent& event) { ar(event.time, event.place, event.area, event.what); }

void Capsule::archive(Archive& ar) {
  State& s = *state_;
  std::vector<char> gone = s.is_gone;
  ar(gone);
  ar.check(gone == s.is_gone);
  ar.same_size(s.open);
  ar.check(std::all_of(s.open.begin(), s.open.end(), [](double share) { return share >= 0.0 && share <= 1.0; }));
  ar.same_size(s.now);
  if (ar.reads()) s.show_openings(), s.evaluate();
  ar(s.frequency, s.frequency_before, s.released, s.time, s.events);
}

/// Its sheet goes with it: made anew for another body it would have another bound of its frequency.
std::shared_ptr<const void> Capsule::save_state() const { return std::make_shared<const State>(*state_); }

void Capsule::load_state(const std::shared_ptr<const void>& state, const BodyView*) {
  *state_ = *std::static_pointer_cast<const State>(state);
}

}  // namespace glisson

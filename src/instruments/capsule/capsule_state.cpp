#include "instruments/capsule/capsule_state.h"

#include <algorithm>
#include <cmath>

namespace glisson {

Fault CapsuleOptions::check() const {
  return {vertices.empty() || triangles.empty() ? ""
                                                : "both vertices and triangles are given; choose the surface by one"};
}

/// Numbers the vertices, makes the sheet anew over them and looks at the present state.
void Capsule::State::lay_out(const BodyView& body, bool sharply) {
  vertices.clear();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_gone[t] == 0) vertices.insert(vertices.end(), triangles[t].begin(), triangles[t].end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  rest.clear(), now.clear();
  std::vector<double> masses;
  for (const std::uint32_t v : vertices) {
    rest.push_back(body.mesh.vertices[v]);
    now.push_back(rest.back() + body.displacement[v]);
    masses.push_back(body.masses[v]);
  }
  local.assign(triangles.size(), Triangle{});
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3 && is_gone[t] == 0; ++i) {
      const auto at = std::lower_bound(vertices.begin(), vertices.end(), triangles[t][i]) - vertices.begin();
      local[t][i] = static_cast<std::uint32_t>(at);
    }
  }
  const CapsuleOptions& o = options;
  membrane = Membrane(local, rest, {o.youngs_modulus * o.thickness, o.poisson_ratio, o.stiffening, o.prestretch});
  membrane.set_masses(masses);
  if (sharply) membrane.sharpen(rest);
  show_openings();
  near = {};
  is_named = false;
  evaluate();
  frequency_before = frequency;
}

/// Lets the sheet have what is open of it.
void Capsule::State::show_openings() {
  counts.assign(triangles.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    membrane.keep(t, kept_share(open[t]));
    counts[t] = is_gone[t] == 0 && open[t] < 1.0 && membrane.rest_area(t) > 0.0;
  }
}

/// Forces and the frequency at the present positions.
void Capsule::State::evaluate() {
  forces.assign(vertices.size(), Vec3d{});
  membrane.add_forces(now, forces);
  tension_is_current = false;
  frequency_before = frequency;
  frequency = membrane.squared_frequency();
}

const std::vector<double>& Capsule::State::tensions() {
  if (tension_is_current) return tension;
  tension.assign(triangles.size(), 0.0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (counts[t] != 0) tension[t] = membrane.tension(t);
  }
  tension_is_current = true;
  return tension;
}

PointOnTriangle Capsule::State::nearest_to(const Vec3d& place) {
  const PointOnTriangle point = nearest_point(local, now, counts, place, nearest);
  nearest = point.triangle;
  return point;
}

Vec3d Capsule::State::centre(std::size_t triangle) const {
  const Triangle& t = local[triangle];
  return (now[t[0]] + now[t[1]] + now[t[2]]) * (1.0 / 3.0);
}

/// Raises the open share of a triangle; what it stored goes in proportion.
void Capsule::State::open_to(std::size_t triangle, double share) {
  share = std::clamp(share, open[triangle], 1.0);
  if (share > 1.0 - 1e-9) share = 1.0;
  const double kept = kept_share(share);
  released += (membrane.kept(triangle) - kept) * membrane.energy(now, triangle);
  membrane.keep(triangle, kept);
  open[triangle] = share;
  if (share == 1.0) counts[triangle] = 0, tension_is_current = false;
}

/// Tension over the disc about a triangle, of what is whole [N/m].
double Capsule::State::mean_tension(std::size_t triangle) {
  if (near.first.empty()) near = find_neighbours(local, rest, 0.5 * options.averaging_length);
  double sum = 0.0, area = 0.0;
  for (std::uint32_t k = near.first[triangle]; k < near.first[triangle + 1]; ++k) {
    const std::uint32_t t = near.list[k];
    if (counts[t] == 0) continue;
    const double share = membrane.kept(t) * membrane.rest_area(t);
    sum += share * membrane.tension(t);
    area += share;
  }
  return area > 0.0 ? sum / area : 0.0;
}

/// The triangle with the largest mean tension above the strength; their number: none has.
std::size_t Capsule::State::due_to_tear() {
  if (!options.strength || membrane.largest_tension() < *options.strength) return triangles.size();
  std::size_t worst = triangles.size();
  double most = *options.strength;
  const std::vector<double>& of = tensions();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (counts[t] == 0 || of[t] < *options.strength) continue;
    const double mean = mean_tension(t);
    if (mean >= most && (mean > most || worst == triangles.size())) most = mean, worst = t;
  }
  return worst;
}

/// Opens that triangle: one a step, so that a tear runs from neighbour to neighbour and a sheet under even tension does not vanish at
/// once.
void Capsule::State::tear_where_due() {
  const std::size_t worst = due_to_tear();
  if (worst == triangles.size()) return;
  events.push_back({time, CapsuleEvent::What::tear, centre(worst), membrane.rest_area(worst) * (1.0 - open[worst])});
  open_to(worst, 1.0);
}

}  // namespace glisson

#include "element/body_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace glisson {
namespace {

ElementRest rest_of(const Body& body, std::uint32_t e) {
  const Tet& t = body.elements[e];
  const std::vector<Vec3d>& x = body.rest_positions;
  return element_rest({x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
}

}  // namespace

std::array<double, 4> weights_at(const Body& body, std::uint32_t element, const Vec3d& point) {
  const Vec3d d = point - body.rest_positions[body.elements[element][0]];
  const auto& s = body.rest[element].s;
  const double b = dot(s[0], d), c = dot(s[1], d), e = dot(s[2], d);
  return {1.0 - b - c - e, b, c, e};
}

Located locate(const Body& body, std::span<const std::uint32_t> elements, const Vec3d& point) {
  Located best;
  double depth = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t e : elements) {
    const std::array<double, 4> w = weights_at(body, e, point);
    const double least = *std::min_element(w.begin(), w.end());
    if (least <= depth) continue;
    depth = least;
    best = {e, w};
  }
  return best;
}

BodyChanger::BodyChanger(Body& body)
    : body_(body), stars_(body.elements, body.vertex_count), element_of_(body.elements.size()) {
  for (std::uint32_t e = 0; e < element_of_.size(); ++e) element_of_[body.mesh_tet[e]] = e;
  quarter_masses_.resize(body.elements.size());
  masses_changed();
  for (std::uint32_t e = 0; e < element_of_.size(); ++e) {
    if (body.rest[e].volume == 0.0) stars_.remove(e, body.elements[e]);
  }
}

void BodyChanger::masses_changed() {
  for (const TissueBlock& block : body_.blocks) {
    for (std::size_t e = block.begin; e < block.end; ++e) quarter_masses_[e] = body_.quarter_mass(block, e);
  }
}

/// Sums the masses of these vertices anew, in the order of build_body, and sorts them.
void BodyChanger::weigh(std::vector<std::uint32_t>& vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t v : vertices) {
    double mass = 0.0;
    for (const std::uint32_t e : stars_.tets_at(v)) mass += quarter_masses_[e];
    body_.masses[v] = mass;
  }
}

std::vector<std::uint32_t> BodyChanger::living_elements(std::span<const std::uint32_t> mesh_tets) const {
  std::vector<std::uint32_t> elements;
  for (const std::uint32_t t : mesh_tets) {
    if (t >= element_of_.size()) {
      throw std::invalid_argument("remove_tets: tet " + std::to_string(t) + " is outside the mesh, 0 to " +
                                  std::to_string(element_of_.size() - 1));
    }
    if (!is_removed(t)) elements.push_back(element_of_[t]);
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

BodyChange BodyChanger::remove(std::span<const std::uint32_t> elements) {
  BodyChange change;
  change.removed.assign(elements.begin(), elements.end());
  for (const std::uint32_t e : change.removed) {
    quarter_masses_[e] = 0.0;
    body_.rest[e] = {};
    stars_.remove(e, body_.elements[e]);
    change.touched.insert(change.touched.end(), body_.elements[e].begin(), body_.elements[e].end());
  }
  weigh(change.touched);
  return change;
}

std::vector<std::uint32_t> BodyChanger::elements_around(std::span<const VertexMove> moves) const {
  std::vector<std::uint32_t> elements;
  for (const VertexMove& m : moves) {
    if (m.vertex >= body_.vertex_count) continue;
    const auto star = stars_.tets_at(m.vertex);
    elements.insert(elements.end(), star.begin(), star.end());
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

/// Tries the moves in their order, and takes them all back.
void BodyChanger::require_moves(std::span<const VertexMove> moves) {
  std::vector<VertexMove> back;
  const auto refuse = [&](const VertexMove& m, const std::string& fault) {
    for (auto at = back.rbegin(); at != back.rend(); ++at) body_.rest_positions[at->vertex] = at->rest;
    throw std::invalid_argument("move at rest: vertex " + std::to_string(m.vertex) + " " + fault);
  };
  for (const VertexMove& m : moves) {
    if (m.vertex >= body_.vertex_count) {
      refuse(m, "is outside the mesh, 0 to " + std::to_string(body_.vertex_count - 1));
    }
    if (!std::isfinite(norm(m.rest))) refuse(m, "goes to a place that is not finite");
    back.push_back({m.vertex, body_.rest_positions[m.vertex]});
    body_.rest_positions[m.vertex] = m.rest;
    for (const std::uint32_t e : stars_.tets_at(m.vertex)) {
      if (rest_of(body_, e).volume > 0.0) continue;
      refuse(m, "would turn tet " + std::to_string(body_.mesh_tet[e]) + " over; move it less far");
    }
  }
  for (auto at = back.rbegin(); at != back.rend(); ++at) body_.rest_positions[at->vertex] = at->rest;
}

/// Takes a vertex to its place and measures the elements around it anew.
void BodyChanger::place(const VertexMove& m) {
  body_.rest_positions[m.vertex] = m.rest;
  for (const std::uint32_t e : stars_.tets_at(m.vertex)) {
    body_.rest[e] = rest_of(body_, e);
    quarter_masses_[e] = body_.quarter_mass(body_.block_of(e), e);
  }
}

void BodyChanger::move(std::span<const VertexMove> moves, const StateOf& state, BodyChange& change) {
  std::map<std::uint32_t, std::pair<Vec3d, Vec3d>> now;
  for (const VertexMove& m : moves) {
    const auto star = stars_.tets_at(m.vertex);
    if (star.empty()) {
      place(m);
      continue;
    }
    const Located at = locate(body_, star, m.rest);
    std::pair<Vec3d, Vec3d> here;
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t v = body_.elements[at.element][a];
      const auto known = now.find(v);
      const auto& [u, velocity] = known != now.end() ? known->second : now.emplace(v, state(v)).first->second;
      here.first += u * at.weights[a];
      here.second += velocity * at.weights[a];
    }
    now[m.vertex] = here;
    place(m);
  }
  change.reshaped = elements_around(moves);
  for (const VertexMove& m : moves) {
    const bool told = std::any_of(change.moved.begin(), change.moved.end(),
                                  [&](const MovedVertex& other) { return other.vertex == m.vertex; });
    if (const auto at = now.find(m.vertex); at != now.end() && !told) {
      change.moved.push_back({m.vertex, at->second.first, at->second.second});
    }
  }
  for (const std::uint32_t e : change.reshaped) {
    change.touched.insert(change.touched.end(), body_.elements[e].begin(), body_.elements[e].end());
  }
}

void BodyChanger::archive(Archive& ar) {
  ar(closed_);
  for (const Triangle& t : closed_) ar.check(std::max({t[0], t[1], t[2]}) < body_.vertex_count);
}

BodyChange BodyChanger::cut(std::span<const Triangle> faces, std::span<const VertexMove> moves, const StateOf& state) {
  require_moves(moves);
  const auto first_new = static_cast<std::uint32_t>(body_.vertex_count);
  detail::SplitPlan plan = detail::plan_split(body_.elements, stars_, faces, first_new, closed_);
  BodyChange change;
  if (!moves.empty()) move(moves, state, change);
  detail::apply_split(plan, body_.elements, stars_);
  change.corners = std::move(plan.corners);
  change.origins = std::move(plan.origins);
  closed_ = std::move(plan.closed);
  for (const std::uint32_t origin : change.origins) {
    change.touched.push_back(origin);
    change.touched.push_back(static_cast<std::uint32_t>(body_.vertex_count++));
    body_.rest_positions.push_back(Vec3d(body_.rest_positions[origin]));
    body_.masses.push_back(0.0);
  }
  weigh(change.touched);
  return change;
}

}  // namespace glisson

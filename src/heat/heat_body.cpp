#include "heat/heat_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

namespace glisson::heat {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Gradients of the four linear functions times 6 V, and 6 V.
std::pair<std::array<Vec3d, 4>, double> gradients(const TetMesh& mesh, const Tet& t) {
  const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]], &d = mesh.vertices[t[3]];
  std::array<Vec3d, 4> g;
  g[1] = cross(c - a, d - a), g[2] = cross(d - a, b - a), g[3] = cross(b - a, c - a);
  g[0] = (g[1] + g[2] + g[3]) * -1.0;
  return {g, dot(b - a, g[1])};
}

}  // namespace

HeatBody::HeatBody(const TetMesh& mesh, const std::map<int, ThermalTissue>& tissues) {
  for (const auto& [region, tissue] : tissues) {
    numbers_[region] = static_cast<std::uint32_t>(tissues_.size());
    tissues_.push_back(tissue);
  }
  std::vector<std::tuple<std::uint32_t, std::uint32_t, double>> volumes;
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    const Tet& t = mesh.tets[k];
    const auto number = numbers_.find(mesh.region_of(k));
    if (number == numbers_.end()) {
      throw std::invalid_argument("heat: region " + std::to_string(mesh.region_of(k)) +
                                  " of the mesh has no thermal tissue");
    }
    const auto [g, six_volume] = gradients(mesh, t);
    for (const std::uint32_t v : t) volumes.emplace_back(v, number->second, six_volume / 24.0);
    for (const auto& [a, b] : kEdges) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      conductances_.push_back(
          {std::min(t[i], t[j]), std::max(t[i], t[j]), number->second, -dot(g[i], g[j]) / (6.0 * six_volume)});
    }
  }
  const auto by_vertices = [](const Conductance& c) { return std::tuple(c.i, c.j, c.tissue); };
  std::stable_sort(conductances_.begin(), conductances_.end(),
                   [&](const auto& a, const auto& b) { return by_vertices(a) < by_vertices(b); });
  std::size_t last = 0;
  for (std::size_t k = 1; k < conductances_.size(); ++k) {
    if (by_vertices(conductances_[k]) == by_vertices(conductances_[last])) {
      conductances_[last].w += conductances_[k].w;
    } else {
      conductances_[++last] = conductances_[k];
    }
  }
  if (!conductances_.empty()) conductances_.resize(last + 1);
  std::stable_sort(volumes.begin(), volumes.end(), [](const auto& a, const auto& b) {
    return std::tie(std::get<0>(a), std::get<1>(a)) < std::tie(std::get<0>(b), std::get<1>(b));
  });
  begin_.assign(mesh.vertices.size() + 1, 0);
  std::uint32_t of = 0;
  for (const auto& [vertex, number, part] : volumes) {
    if (parts_.empty() || of != vertex || parts_.back().tissue != number)
      parts_.push_back({number, 0.0}), ++begin_[vertex + 1];
    parts_.back().volume += part;
    of = vertex;
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) begin_[v + 1] += begin_[v];
}

double HeatBody::volume(std::size_t vertex) const {
  double sum = 0.0;
  for (const Part& p : parts(vertex)) sum += p.volume;
  return sum;
}

VertexState HeatBody::state(std::size_t vertex, double temperature) const {
  VertexState sum;
  double volume = 0.0;
  for (const Part& p : parts(vertex)) {
    const ThermalState s = thermal_state(tissues_[p.tissue], temperature);
    sum.heat += p.volume * s.heat, sum.capacity += p.volume * s.capacity, sum.conductivity += p.volume * s.conductivity;
    volume += p.volume;
  }
  if (volume > 0.0) sum.conductivity /= volume;
  return sum;
}

// Heat is piecewise linear in temperature, with two corners a tissue: from corner to corner until it is met.
double HeatBody::temperature_of(std::size_t vertex, double heat, double near) const {
  double t = near;
  const VertexState here = state(vertex, t);
  double left = heat - here.heat;
  if (!std::isfinite(left)) return left;
  const double way = left < 0.0 ? -1.0 : 1.0;
  while (true) {
    double corner = way * INFINITY;
    for (const Part& p : parts(vertex)) {
      for (const double c : {tissues_[p.tissue].freezing_begins, tissues_[p.tissue].freezing_ends}) {
        if (way * (c - t) > 0.0 && way * (c - corner) < 0.0) corner = c;
      }
    }
    const double capacity = state(vertex, std::isfinite(corner) ? 0.5 * (t + corner) : t + way).capacity;
    const double next = t + left / capacity;
    if (way * (next - corner) <= 0.0) return next;
    left -= capacity * (corner - t), t = corner;
  }
}

}  // namespace glisson::heat

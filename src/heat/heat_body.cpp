#include "heat/heat_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

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
  std::map<int, std::uint32_t> numbers;
  for (const auto& [region, tissue] : tissues) {
    numbers[region] = static_cast<std::uint32_t>(curves_.size());
    curves_.emplace_back(tissue), regions_.push_back(region);
  }
  std::vector<std::uint32_t> tissue_of(mesh.tets.size());
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    const auto number = numbers.find(mesh.region_of(k));
    if (number == numbers.end()) {
      const auto name = mesh.region_names.find(mesh.region_of(k));
      throw std::invalid_argument("heat: region " + std::to_string(mesh.region_of(k)) +
                                  (name == mesh.region_names.end() ? "" : " (" + name->second + ")") +
                                  " of the mesh has no thermal tissue; give it one");
    }
    tissue_of[k] = number->second;
  }
  find_parts(mesh, tissue_of);
  find_links(mesh, tissue_of);
  find_spreads(mesh);
}

void HeatBody::find_spreads(const TetMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  std::vector<double> edge(n, 0.0), slope(n, 0.0);  // longest, steepest
  for (const Tet& t : mesh.tets) {
    const auto [g, six_volume] = gradients(mesh, t);
    for (std::size_t c = 0; c < 4; ++c) slope[t[c]] = std::max(slope[t[c]], norm(g[c]) / six_volume);
    for (const auto& [i, j] : kEdges) {
      const std::uint32_t a = t[static_cast<std::size_t>(i)], b = t[static_cast<std::size_t>(j)];
      const double length = norm(mesh.vertices[a] - mesh.vertices[b]);
      edge[a] = std::max(edge[a], length), edge[b] = std::max(edge[b], length);
    }
  }
  for (std::size_t i = 0; i < n; ++i) spread_.push_back(edge[i] * slope[i]);
}

void HeatBody::find_parts(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of) {
  const std::size_t n = mesh.vertices.size();
  std::vector<std::vector<Part>> parts(n);
  volume_.assign(n, 0.0);
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    const double share = gradients(mesh, mesh.tets[k]).second / 24.0;
    for (const std::uint32_t v : mesh.tets[k]) {
      auto at = std::find_if(parts[v].begin(), parts[v].end(), [&](const Part& p) { return p.tissue == tissue_of[k]; });
      if (at == parts[v].end()) at = parts[v].insert(at, {tissue_of[k], 0.0});
      at->volume += share, volume_[v] += share;
    }
  }
  begin_.push_back(0);
  for (std::vector<Part>& of : parts) {
    if (of.empty()) of.push_back({});
    std::sort(of.begin(), of.end(), [](const Part& a, const Part& b) { return a.tissue < b.tissue; });
    vertex_of_.insert(vertex_of_.end(), of.size(), static_cast<std::uint32_t>(begin_.size() - 1));
    parts_.insert(parts_.end(), of.begin(), of.end());
    begin_.push_back(parts_.size());
  }
}

std::uint32_t HeatBody::part_of(std::uint32_t vertex, std::uint32_t tissue) const {
  std::size_t p = begin_[vertex];
  while (parts_[p].tissue != tissue) ++p;
  return static_cast<std::uint32_t>(p);
}

void HeatBody::find_links(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of) {
  // pairs of parts by the lower one, with the sum of their tets' w
  std::vector<std::vector<std::pair<std::uint32_t, double>>> pairs(parts_.size());
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    const Tet& t = mesh.tets[k];
    const auto [g, six_volume] = gradients(mesh, t);
    std::array<std::uint32_t, 4> part;
    for (std::size_t c = 0; c < 4; ++c) part[c] = part_of(t[c], tissue_of[k]);
    for (const auto& [i, j] : kEdges) {
      const double w = -dot(g[static_cast<std::size_t>(i)], g[static_cast<std::size_t>(j)]) / (6.0 * six_volume);
      const auto [low, high] = std::minmax(part[static_cast<std::size_t>(i)], part[static_cast<std::size_t>(j)]);
      const auto at =
          std::find_if(pairs[low].begin(), pairs[low].end(), [to = high](const auto& x) { return x.first == to; });
      if (at == pairs[low].end())
        pairs[low].emplace_back(high, w);
      else
        at->second += w;
    }
  }
  const std::size_t n = parts_.size();
  std::vector<std::uint32_t> next(n, 0), next_negative(n, 0);
  for (std::uint32_t p = 0; p < n; ++p) {
    std::sort(pairs[p].begin(), pairs[p].end());
    for (const auto& [q, w] : pairs[p]) {
      for (const std::uint32_t end : {p, q}) ++(w < 0.0 ? next_negative : next)[end];
    }
  }
  links_.begin.push_back(0);
  for (std::size_t p = 0; p < n; ++p) {
    links_.negative.push_back(links_.begin[p] + next[p]);
    links_.begin.push_back(links_.negative[p] + next_negative[p]);
    next[p] = links_.begin[p], next_negative[p] = links_.negative[p];
  }
  links_.to.resize(links_.begin[n]), links_.w.resize(links_.begin[n]);
  for (std::uint32_t p = 0; p < n; ++p) {
    for (const auto& [q, w] : pairs[p]) {
      const std::uint32_t pq = (w < 0.0 ? next_negative : next)[p]++, qp = (w < 0.0 ? next_negative : next)[q]++;
      links_.to[pq] = q, links_.to[qp] = p;
      links_.w[pq] = links_.w[qp] = w;
      if (w < 0.0) negative_.push_back({p, q, pq, qp});
    }
  }
}

VertexState HeatBody::state(std::size_t vertex, double temperature) const {
  VertexState sum;
  double volume = 0.0;
  for (const Part& p : parts(vertex)) {
    const ThermalState s = curves_[p.tissue].at(temperature);
    sum.heat += p.volume * s.heat, sum.capacity += p.volume * s.capacity, sum.conductivity += p.volume * s.conductivity;
    volume += p.volume;
  }
  if (volume > 0.0) sum.conductivity /= volume;
  return sum;
}

// Heat is piecewise linear in temperature, with two corners a tissue: from corner to corner until it is met.
double HeatBody::temperature_of(std::size_t vertex, double heat, double near) const {
  if (parts(vertex).size() == 1) {
    const Part& only = parts(vertex).front();
    return curves_[only.tissue].temperature_of(heat / only.volume);
  }
  double t = near;
  const VertexState here = state(vertex, t);
  double left = heat - here.heat;
  if (!std::isfinite(left)) return left;
  const double way = left < 0.0 ? -1.0 : 1.0;
  while (true) {
    double corner = way * INFINITY;
    for (const Part& p : parts(vertex)) {
      for (const double c : {curves_[p.tissue].begins, curves_[p.tissue].ends}) {
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

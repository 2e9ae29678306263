#include "heat/heat_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "heat/tet_links.h"

namespace glisson::heat {
namespace {

constexpr std::uint32_t kHollow = std::numeric_limits<std::uint32_t>::max();  // in place of a tissue
constexpr double kLeastVolume = 0.05;  // of the volume at rest, below which a tet conducts as at rest

}  // namespace

HeatBody::HeatBody(const TetMesh& mesh, const std::map<int, ThermalTissue>& tissues, std::span<const int> hollow,
                   std::span<const Vec3d> positions) {
  std::map<int, std::uint32_t> numbers;
  for (const auto& [region, tissue] : tissues) {
    numbers[region] = static_cast<std::uint32_t>(curves_.size());
    curves_.emplace_back(tissue), regions_.push_back(region);
  }
  std::vector<std::uint32_t> tissue_of(mesh.tets.size());
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    if (std::find(hollow.begin(), hollow.end(), mesh.region_of(k)) != hollow.end()) {
      tissue_of[k] = kHollow;
      continue;
    }
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
  find_links(mesh, tissue_of, positions);
  find_spreads(mesh, tissue_of, positions);
}

/// Of a tet where the body is now.
TetLinks HeatBody::present_links(const TetMesh& mesh, const Tet& t, std::span<const Vec3d> positions) {
  const TetLinks rest = links_of(mesh.vertices, t);
  if (positions.empty()) return rest;
  const TetLinks moved = links_of(positions, t);
  return moved.six_volume > kLeastVolume * rest.six_volume ? moved : rest;
}

void HeatBody::find_spreads(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of,
                            std::span<const Vec3d> positions) {
  const std::size_t n = mesh.vertices.size();
  const std::span<const Vec3d> at = positions.empty() ? std::span<const Vec3d>(mesh.vertices) : positions;
  std::vector<double> edge(n, 0.0), slope(n, 0.0);  // longest, steepest
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    if (tissue_of[k] == kHollow) continue;
    const Tet& t = mesh.tets[k];
    const TetLinks x = present_links(mesh, t, positions);
    for (std::size_t c = 0; c < 4; ++c) slope[t[c]] = std::max(slope[t[c]], norm(x.slopes[c]) / x.six_volume);
    for (const auto& [i, j] : kEdges) {
      const double length = norm(at[t[i]] - at[t[j]]);
      edge[t[i]] = std::max(edge[t[i]], length), edge[t[j]] = std::max(edge[t[j]], length);
    }
  }
  for (std::size_t i = 0; i < n; ++i) spread_.push_back(edge[i] * slope[i]);
}

void HeatBody::find_parts(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of) {
  const std::size_t n = mesh.vertices.size();
  std::vector<std::vector<Part>> parts(n);
  volume_.assign(n, 0.0);
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    if (tissue_of[k] == kHollow) continue;
    const double share = six_rest_volume(mesh, k) / 24.0;
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

void HeatBody::find_links(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of,
                          std::span<const Vec3d> positions) {
  // pairs of parts by the lower one, with the sum of their tets' w
  std::vector<std::vector<std::pair<std::uint32_t, double>>> pairs(parts_.size());
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    if (tissue_of[k] == kHollow) continue;
    const Tet& t = mesh.tets[k];
    const TetLinks x = present_links(mesh, t, positions);
    std::array<std::uint32_t, 4> part;
    for (std::size_t c = 0; c < 4; ++c) part[c] = part_of(t[c], tissue_of[k]);
    for (std::size_t e = 0; e < 6; ++e) {
      const double w = x.w[e];
      const auto [low, high] = std::minmax(part[kEdges[e][0]], part[kEdges[e][1]]);
      const auto at = std::find_if(pairs[low].begin(), pairs[low].end(),
                                   [to = high](const auto& pair) { return pair.first == to; });
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

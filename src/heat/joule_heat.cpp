#include "heat/joule_heat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/text.h"
#include "heat/tet_links.h"
#include "mesh/inspect/tet_locator.h"

namespace glisson {
namespace heat {
namespace {

constexpr int kMostPotentialIterations = 2000;
constexpr double kExactPotential = 1e-8;  // of the residual, relative, weighted by 1/diagonal

}  // namespace

JouleHeat::JouleHeat(const TetMesh& mesh, std::vector<const ThermalTissue*> tissue_of, RadioFrequency radio)
    : tissue_of_(std::move(tissue_of)), radio_(std::move(radio)), tets_(mesh.tets), conductivity_(mesh.tets.size()),
      diagonal_(mesh.vertices.size()), held_(mesh.vertices.size(), 0), heat_(mesh.vertices.size(), 0.0) {
  if (static_cast<bool>(radio_.voltage) == static_cast<bool>(radio_.power))
    throw std::invalid_argument("heat: radio frequency needs either a voltage or a power");
  for (const auto& [vertices, name] :
       {std::pair(&radio_.electrode, "electrode"), std::pair(&radio_.ground, "ground")}) {
    if (vertices->empty())
      throw std::invalid_argument(std::string("heat: radio frequency: the ") + name + " has no vertices");
    for (const std::uint32_t v : *vertices) {
      if (v >= held_.size()) throw std::invalid_argument("heat: there is no vertex " + std::to_string(v));
    }
  }
  for (const std::uint32_t v : radio_.electrode) held_[v] = 1;
  for (const std::uint32_t v : radio_.ground) {
    if (held_[v] == 1)
      throw std::invalid_argument("heat: radio frequency: electrode and ground share vertex " + std::to_string(v) +
                                  "; move one of them");
    held_[v] = 2;
  }
  find_edges(mesh);
}

void JouleHeat::find_edges(const TetMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> beside(n);  // higher vertex, edge
  std::uint32_t count = 0;
  for (const Tet& t : mesh.tets) {
    const TetLinks links = links_of(mesh.vertices, t);
    TetEdges x;
    x.w = links.w;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [low, high] = std::minmax(t[kEdges[e][0]], t[kEdges[e][1]]);
      auto at =
          std::find_if(beside[low].begin(), beside[low].end(), [h = high](const auto& b) { return b.first == h; });
      if (at == beside[low].end()) at = beside[low].insert(at, {high, count++});
      x.edge[e] = at->second;
    }
    of_tet_.push_back(x);
  }
  conductance_.assign(count, 0.0);
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> rows(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    for (const auto& [high, edge] : beside[v]) rows[v].emplace_back(high, edge), rows[high].emplace_back(v, edge);
  }
  for (std::vector<std::pair<std::uint32_t, std::uint32_t>>& row : rows) {
    std::sort(row.begin(), row.end());
    begin_.push_back(static_cast<std::uint32_t>(to_.size()));
    for (const auto& [other, edge] : row) to_.push_back(other), edge_.push_back(edge);
  }
  begin_.push_back(static_cast<std::uint32_t>(to_.size()));
}

void JouleHeat::assemble(std::span<const double> temperature) {
  std::fill(conductance_.begin(), conductance_.end(), 0.0);
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    double sum = 0.0;
    if (tissue_of_[t] != nullptr) {
      for (const std::uint32_t v : tets_[t]) sum += electric_conductivity(*tissue_of_[t], temperature[v]);
    }
    conductivity_[t] = 0.25 * sum;
    for (std::size_t e = 0; e < 6; ++e) conductance_[of_tet_[t].edge[e]] += conductivity_[t] * of_tet_[t].w[e];
  }
  for (std::size_t v = 0; v < diagonal_.size(); ++v) {
    diagonal_[v] = 0.0;
    for (std::uint32_t k = begin_[v]; k < begin_[v + 1]; ++k) diagonal_[v] += conductance_[edge_[k]];
  }
}

// Of vertices that are held, or that no current reaches, rows are 0.
void JouleHeat::multiply(Blocks& blocks, const std::vector<double>& x, std::vector<double>& y) const {
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      double sum = 0.0;
      for (std::uint32_t k = begin_[v]; k < begin_[v + 1]; ++k) sum += conductance_[edge_[k]] * (x[v] - x[to_[k]]);
      y[v] = held_[v] != 0 || diagonal_[v] <= 0.0 ? 0.0 : sum;
    }
  });
}

void JouleHeat::iterate(Blocks& blocks, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (auto* of : {&r_, &p_, &q_}) of->resize(n);
  multiply(blocks, x, r_);
  const auto scaled = [&](std::size_t v) { return diagonal_[v] > 0.0 ? r_[v] / diagonal_[v] : 0.0; };
  const auto size = [&] {
    return blocks.sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
      double sum = 0.0;
      for (std::size_t v = begin; v < end; ++v) sum += r_[v] * scaled(v);
      return {sum};
    })[0];
  };
  for (std::size_t v = 0; v < n; ++v) r_[v] = -r_[v], p_[v] = scaled(v);
  // a potential of 1 over all of the electrode
  double whole = 0.0;
  for (const std::uint32_t v : radio_.electrode) whole += diagonal_[v];
  double before = size();
  for (int k = 0; k < kMostPotentialIterations && before > kExactPotential * kExactPotential * whole; ++k) {
    multiply(blocks, p_, q_);
    const double along = blocks.sums<1>([&](std::size_t begin, std::size_t end) -> std::array<double, 1> {
      double sum = 0.0;
      for (std::size_t v = begin; v < end; ++v) sum += p_[v] * q_[v];
      return {sum};
    })[0];
    if (!(along > 0.0)) break;
    const double a = before / along;
    for (std::size_t v = 0; v < n; ++v) x[v] += a * p_[v], r_[v] -= a * q_[v];
    const double now = size(), b = now / before;
    for (std::size_t v = 0; v < n; ++v) p_[v] = scaled(v) + b * p_[v];
    before = now;
  }
}

double JouleHeat::find_heat(const std::vector<double>& potential) {
  std::fill(heat_.begin(), heat_.end(), 0.0);
  double sum = 0.0;
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    double here = 0.0;
    for (std::size_t e = 0; e < 6; ++e) {
      const double falls = potential[tets_[t][kEdges[e][0]]] - potential[tets_[t][kEdges[e][1]]];
      here += of_tet_[t].w[e] * falls * falls;
    }
    here *= conductivity_[t], sum += here;
    for (const std::uint32_t v : tets_[t]) heat_[v] += 0.25 * here;
  }
  return sum;
}

double JouleHeat::solve(std::span<const double> temperature, Blocks& blocks, std::vector<double>& potential) {
  assemble(temperature);
  if (potential.empty()) potential.assign(temperature.size(), 0.0);
  for (const std::uint32_t v : radio_.electrode) potential[v] = 1.0;
  for (const std::uint32_t v : radio_.ground) potential[v] = 0.0;
  iterate(blocks, potential);
  return find_heat(potential);
}

double JouleHeat::voltage_at(double time, double conductance) const {
  const bool by_power = static_cast<bool>(radio_.power);
  const double value = by_power ? radio_.power(time) : radio_.voltage(time);
  if (!std::isfinite(value) || (by_power && value < 0.0)) {
    throw std::invalid_argument(std::string("heat: the ") + (by_power ? "power" : "voltage") +
                                " of radio frequency at " + detail::show(time) + " s is " + detail::show(value) +
                                (by_power ? " W; allowed: ≥ 0" : " V"));
  }
  if (!by_power || value == 0.0) return value;
  if (!(conductance > 0.0)) {
    throw std::invalid_argument(
        "heat: radio frequency: no current goes from the electrode to the ground; give the tissues between them an "
        "electric_conductivity");
  }
  return std::sqrt(value / conductance);
}

}  // namespace heat

std::vector<std::uint32_t> needle_vertices(const TetMesh& mesh, const Vec3d& from, const Vec3d& to, double radius) {
  const Vec3d way = to - from;
  const double length = norm(way);
  if (!(length > 0.0)) throw std::invalid_argument("heat: a needle has no length");
  if (!(radius >= 0.0) || !std::isfinite(radius))
    throw std::invalid_argument("heat: a needle has a radius of " + detail::show(radius) + " m; allowed: ≥ 0");
  const detail::TetLocator locator(mesh, {});
  constexpr double kSamplesPerTet = 4.0;
  const double tet = std::cbrt(6.0 * volume(mesh) / static_cast<double>(mesh.tets.size()));
  const int n = std::max(1, static_cast<int>(std::ceil(kSamplesPerTet * length / tet)));
  std::vector<char> in(mesh.vertices.size(), 0);
  for (int k = 0; k <= n; ++k) {
    const Vec3d x = from + way * (static_cast<double>(k) / n);
    const auto at = locator.locate(x);
    if (!at) {
      throw std::invalid_argument("heat: a needle leaves the body at (" + detail::number_text(1e3 * x.x) + ", " +
                                  detail::number_text(1e3 * x.y) + ", " + detail::number_text(1e3 * x.z) + ") mm");
    }
    constexpr double kOf = 1e-9;  // a corner of the face or edge that the axis lies in, not one beside it
    for (std::size_t c = 0; c < 4; ++c) {
      if (at->weights[c] > kOf) in[mesh.tets[at->tet][c]] = 1;
    }
  }
  for (std::size_t v = 0; v < in.size(); ++v) {
    const Vec3d off = mesh.vertices[v] - from;
    const double along = std::clamp(dot(off, way) / (length * length), 0.0, 1.0);
    if (norm(off - way * along) <= radius * (1.0 + 1e-9)) in[v] = 1;
  }
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < in.size(); ++v) {
    if (in[v] != 0) vertices.push_back(v);
  }
  return vertices;
}

}  // namespace glisson

// refined.cpp — every tet into eight.
//
// Four of the eight keep a corner; the octahedron between them is cut along one of its three diagonals, that which leaves the
// best shapes. The cubes of a generated box, six tets each, become eight such cubes by this rule.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "glisson/mesh_refinement.h"
#include "mesh/topology/faces.h"
#include "mesh/topology/require_valid.h"

namespace glisson {
namespace {

/// An edge by its corners in a tet.
constexpr std::array<std::array<std::uint8_t, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// Number in kTetEdges of the edge between two corners.
constexpr std::array<std::array<std::uint8_t, 4>, 4> kEdgeOf{{{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}}};

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge_between(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// All edges, ascending; edge i gets vertex `first` + i at its middle.
class MiddleVertices {
 public:
  explicit MiddleVertices(const TetMesh& mesh) : first_(static_cast<std::uint32_t>(mesh.vertices.size())) {
    edges_.reserve(6 * mesh.tets.size());
    for (const Tet& t : mesh.tets) {
      for (const auto& [a, b] : kTetEdges) edges_.push_back(edge_between(t[a], t[b]));
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }
  const std::vector<Edge>& edges() const { return edges_; }
  std::uint32_t at(std::uint32_t a, std::uint32_t b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge_between(a, b));
    return first_ + static_cast<std::uint32_t>(found - edges_.begin());
  }
  std::uint32_t of(std::size_t edge) const { return first_ + static_cast<std::uint32_t>(edge); }

 private:
  std::uint32_t first_;
  std::vector<Edge> edges_;
};

/// The octahedron's four tets around one of its diagonals, positively oriented; the worst of their shapes.
///
/// A diagonal joins the middles of two opposite edges. The other four middles lie around it in a ring; two neighbours of the ring
/// and the diagonal's ends make a tet.
double add_octahedron(const std::array<std::uint32_t, 6>& middle, std::size_t diagonal, TetMesh& fine) {
  constexpr std::array<std::array<std::uint8_t, 2>, 3> kEnds{{{0, 5}, {1, 4}, {2, 3}}};
  constexpr std::array<std::array<std::uint8_t, 4>, 3> kRings{{{1, 2, 4, 3}, {0, 2, 5, 3}, {0, 1, 5, 4}}};
  double worst = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    fine.tets.push_back({middle[kEnds[diagonal][0]], middle[kEnds[diagonal][1]], middle[kRings[diagonal][k]],
                         middle[kRings[diagonal][(k + 1) % 4]]});
    Tet& t = fine.tets.back();
    if (six_rest_volume(fine, fine.tets.size() - 1) < 0.0) std::swap(t[2], t[3]);
    worst = std::min(worst, regular_mean_ratio(fine, fine.tets.size() - 1));
  }
  return worst;
}

/// Along the diagonal whose worst tet is best; of equal ones, but for rounding, the first.
void add_best_octahedron(const std::array<std::uint32_t, 6>& middle, TetMesh& fine) {
  const std::size_t first = fine.tets.size();
  std::size_t best = 0;
  double best_shape = 0.0;
  for (std::size_t d = 0; d < 3; ++d) {
    const double shape = add_octahedron(middle, d, fine);
    fine.tets.resize(first);
    if (shape > best_shape * (1.0 + 1e-9)) best = d, best_shape = shape;
  }
  add_octahedron(middle, best, fine);
}

void add_children(const Tet& t, const MiddleVertices& middles, TetMesh& fine) {
  std::array<std::uint32_t, 6> middle;
  for (std::size_t e = 0; e < 6; ++e) middle[e] = middles.at(t[kTetEdges[e][0]], t[kTetEdges[e][1]]);
  for (std::size_t a = 0; a < 4; ++a) {
    Tet corner{};
    for (std::size_t b = 0; b < 4; ++b) corner[b] = a == b ? t[a] : middle[kEdgeOf[a][b]];
    fine.tets.push_back(corner);
  }
  add_best_octahedron(middle, fine);
}

/// Of each edge, whether it lies on the surface.
std::vector<char> on_surface(const TetMesh& mesh, const MiddleVertices& middles) {
  std::vector<char> on(middles.edges().size(), 0);
  for (const Triangle& t : boundary_triangles(mesh)) {
    for (std::size_t a = 0; a < 3; ++a) on[middles.at(t[a], t[(a + 1) % 3]) - middles.of(0)] = 1;
  }
  return on;
}

/// A set with the middles of its edges.
std::vector<std::uint32_t> refined_set(const TetMesh& mesh, const std::vector<std::uint32_t>& set,
                                       const MiddleVertices& middles, const std::vector<char>& surface) {
  std::vector<char> in(mesh.vertices.size(), 0), outer(mesh.vertices.size(), 0);
  for (const std::uint32_t v : set) in[v] = 1;
  for (std::size_t e = 0; e < surface.size(); ++e) {
    if (surface[e] != 0) outer[middles.edges()[e].first] = outer[middles.edges()[e].second] = 1;
  }
  const bool on_surface = std::all_of(set.begin(), set.end(), [&](std::uint32_t v) { return outer[v] != 0; });
  std::vector<std::uint32_t> fine = set;
  for (std::size_t e = 0; e < surface.size(); ++e) {
    const auto& [a, b] = middles.edges()[e];
    if (in[a] != 0 && in[b] != 0 && (!on_surface || surface[e] != 0)) fine.push_back(middles.of(e));
  }
  return fine;
}

}  // namespace

TetMesh refined(const TetMesh& mesh) {
  require_valid(mesh);
  const MiddleVertices middles(mesh);
  TetMesh fine;
  fine.vertices = mesh.vertices;
  for (const auto& [a, b] : middles.edges()) fine.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) * 0.5);
  fine.tets.reserve(8 * mesh.tets.size());
  for (const Tet& t : mesh.tets) add_children(t, middles, fine);
  const auto eight_times = [](const auto& values) {
    std::remove_cvref_t<decltype(values)> all;
    for (const auto& value : values) all.insert(all.end(), 8, value);
    return all;
  };
  fine.regions = eight_times(mesh.regions);
  fine.fibres = eight_times(mesh.fibres);
  fine.region_names = mesh.region_names;
  const std::vector<char> surface = on_surface(mesh, middles);
  for (const auto& [name, set] : mesh.vertex_sets) fine.vertex_sets[name] = refined_set(mesh, set, middles, surface);
  return fine;
}

std::vector<Vec3d> refined(const TetMesh& mesh, std::span<const Vec3d> field) {
  require_valid(mesh);
  if (field.size() != mesh.vertices.size()) {
    throw std::invalid_argument("refined: a field of " + std::to_string(field.size()) + " given, the mesh has " +
                                std::to_string(mesh.vertices.size()) + " vertices");
  }
  std::vector<Vec3d> fine(field.begin(), field.end());
  const MiddleVertices middles(mesh);
  for (const auto& [a, b] : middles.edges()) fine.push_back((field[a] + field[b]) * 0.5);
  return fine;
}

}  // namespace glisson

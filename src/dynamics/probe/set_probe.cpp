// set_probe.cpp — a vertex set: where it is on the whole, and the resultant of the stress on it.
#include <algorithm>

#include "dynamics/probe/probe_reader.h"
#include "mesh/topology/faces.h"

namespace glisson {
namespace {

class SetReader : public ProbeReader {
 public:
  SetReader(const TetMesh& mesh, const std::vector<std::uint32_t>& set) {
    std::vector<char> in(mesh.vertices.size(), 0);
    for (const std::uint32_t v : set) in[v] = 1;
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
      for (std::uint8_t a = 0; a < 4; ++a) {
        if (in[mesh.tets[t][a]] != 0) corners_.push_back({t, a});
      }
    }
    detail::for_each_face(mesh, {}, [&](std::span<const detail::FaceSide> sides) {
      if (sides.size() > 1) return;
      const auto& corners = detail::kFaceCorners[sides[0].corner];
      const Tet& t = mesh.tets[sides[0].tet];
      if (in[t[corners[0]]] + in[t[corners[1]]] + in[t[corners[2]]] == 3)
        faces_.push_back({sides[0].tet, sides[0].corner});
    });
  }

  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    add_vector_columns(names, "displacement", "m");
    add_vector_columns(names, "velocity", "m_s");
    add_vector_columns(names, "force", "N");
    return names;
  }

  void follow(const Simulation& simulation) override {
    tets_.clear();
    std::erase_if(corners_, [&](const Corner& c) { return simulation.is_removed(c.tet); });
    for (const Corner& c : corners_) {
      if (tets_.empty() || tets_.back() != c.tet) tets_.push_back(c.tet);
    }
    weigh(simulation);
  }

  std::vector<double> read(const Simulation& simulation, const TetFields& fields, std::size_t first) const override {
    Vec3d u{}, v{}, force{};
    for (const auto& [vertex, weight] : weights_) {
      u += simulation.displacement()[vertex] * weight;
      v += simulation.velocity()[vertex] * weight;
    }
    std::size_t at = first;
    for (const Corner& c : corners_) {
      while (tets_[at - first] != c.tet) ++at;
      force += corner_force(simulation.mesh(), fields, at, c);
    }
    std::vector<double> row;
    for (const Vec3d& x : {u, v, force}) add_vector(row, x);
    return row;
  }

  std::optional<Vec3d> place(const Simulation& simulation) const override {
    Vec3d x{};
    for (const auto& [vertex, weight] : weights_) x += present_position(simulation, vertex) * weight;
    return x;
  }

 private:
  /// A third of each face's area to its vertices; without faces a quarter of each tet's volume to those of the set.
  void weigh(const Simulation& simulation) {
    const TetMesh& mesh = simulation.mesh();
    weights_.clear();
    for (const Corner& face : faces_) {
      if (simulation.is_removed(face.tet)) continue;
      const ElementRest rest = rest_of(mesh, face.tet);
      const double area = 3.0 * rest.volume * norm(shape_gradients(rest)[face.at]);  // |s_a| is 1 over the altitude
      for (const std::uint8_t a : detail::kFaceCorners[face.at])
        weights_.emplace_back(mesh.tets[face.tet][a], area / 3.0);
    }
    if (weights_.empty()) {
      for (const Corner& c : corners_)
        weights_.emplace_back(mesh.tets[c.tet][c.at], 0.25 * rest_of(mesh, c.tet).volume);
    }
    double sum = 0.0;
    for (const auto& [vertex, weight] : weights_) sum += weight;
    for (auto& [vertex, weight] : weights_) weight /= sum;
  }

  std::vector<Corner> corners_;                            ///< of all tets around the set, by tet
  std::vector<Corner> faces_;                              ///< of the surface at the start, by the corner opposite
  std::vector<std::pair<std::uint32_t, double>> weights_;  ///< of vertices, which may come several times
};

}  // namespace

std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbeSet& set) {
  const TetMesh& mesh = simulation.mesh();
  auto reader = std::make_unique<SetReader>(mesh, mesh.vertex_set(set.set));
  reader->follow(simulation);
  if (!reader->tets().empty()) return reader;
  throw std::invalid_argument("the vertex set \"" + set.set + "\" has no vertex of a tetrahedron; name a set that has");
}

}  // namespace glisson

// point_probe.cpp — a point of the material, by its barycentric coordinates in a tet.
#include <algorithm>
#include <stdexcept>

#include "base/text.h"
#include "dynamics/probe/probe_reader.h"
#include "mesh/inspect/nearest_point.h"
#include "mesh/inspect/tet_locator.h"

namespace glisson {
namespace {

class PointReader : public ProbeReader {
 public:
  explicit PointReader(const ProbePoint& point) : point_(point) {}

  std::vector<std::string> columns() const override {
    std::vector<std::string> names = material_columns();
    names.emplace_back("volume_ratio");
    return names;
  }

  void follow(const Simulation& simulation) override {
    const TetMesh& mesh = simulation.mesh();
    std::vector<char> removed(mesh.tets.size(), 0);
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) removed[t] = simulation.is_removed(t) ? 1 : 0;
    // Of several tets that hold the point the one it was in stays: a cut may have parted them.
    const bool stays = !tets_.empty() && removed[tets_[0]] == 0 && holds_point(mesh, tets_[0]);
    if (!stays) {
      tets_.clear();
      if (const auto found = detail::TetLocator(mesh, removed).locate(point_.position)) tets_ = {found->tet};
    }
    if (!tets_.empty()) weights_ = weights_in(mesh, tets_[0]);
  }

  std::vector<double> read(const Simulation& simulation, const TetFields& fields, std::size_t first) const override {
    const Tet& t = simulation.mesh().tets[tets_[0]];
    Vec3d u{}, v{};
    for (std::size_t a = 0; a < 4; ++a) {
      u += simulation.displacement()[t[a]] * weights_[a];
      v += simulation.velocity()[t[a]] * weights_[a];
    }
    std::vector<double> row;
    add_vector(row, u);
    add_vector(row, v);
    const double volume = 1.0;
    const std::vector<double> state = mean_state(simulation, fields, first, tets_, {&volume, 1});
    row.insert(row.end(), state.begin(), state.end());
    row.push_back(fields.jacobian[first]);
    return row;
  }

  std::optional<Vec3d> place(const Simulation& simulation) const override {
    Vec3d x{};
    for (std::size_t a = 0; a < 4; ++a)
      x += present_position(simulation, simulation.mesh().tets[tets_[0]][a]) * weights_[a];
    return x;
  }

 private:
  std::array<double, 4> weights_in(const TetMesh& mesh, std::uint32_t tet) const {
    const ElementRest rest = rest_of(mesh, tet);
    const Vec3d way = point_.position - mesh.vertices[mesh.tets[tet][0]];
    const double b = dot(rest.s[0], way), c = dot(rest.s[1], way), d = dot(rest.s[2], way);
    return {1.0 - b - c - d, b, c, d};
  }
  /// Whether the point still lies there: a cut may move vertices at rest.
  bool holds_point(const TetMesh& mesh, std::uint32_t tet) const {
    constexpr double kOutside = -1e-9;
    const std::array<double, 4> weights = weights_in(mesh, tet);
    return *std::min_element(weights.begin(), weights.end()) >= kOutside;
  }

  ProbePoint point_;
  std::array<double, 4> weights_{};
};

std::string point_text(const Vec3d& x) {
  return "[" + detail::show(x.x) + ", " + detail::show(x.y) + ", " + detail::show(x.z) + "]";
}

}  // namespace

std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbePoint& point) {
  auto reader = std::make_unique<PointReader>(point);
  reader->follow(simulation);
  if (!reader->tets().empty()) return reader;
  const TetMesh present = simulation.present_mesh();
  const auto [low, high] = box_of(present);
  throw std::invalid_argument("the point " + point_text(point.position) +
                              " m is outside of the body at rest, which spans " + point_text(low) + " to " +
                              point_text(high) + " m; its nearest point is " +
                              point_text(detail::nearest_point(present, point.position)) + " m");
}

}  // namespace glisson

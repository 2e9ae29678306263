// plane_probe.cpp — a section: the force and moment that one side of a plane exerts on the other.
//
//        in front   ·───·         F  of the corners in front, V P s_a: what the stress of the cut tets hands over,
//      ─ ─ ─ ─ ─ ─ /─\ ─/─ ─ n      the same sum of which the forces of these vertices are made
//        behind   ·───·           t  P n over the polygon that the plane cuts out of each tet
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/text.h"
#include "dynamics/probe/probe_reader.h"
#include "mesh/inspect/nearest_point.h"

namespace glisson {
namespace {

/// Area of the polygon that a plane cuts out of a tet. @param d  distances of the corners, > 0 in front, else ≤ 0
double section_area(const std::array<Vec3d, 4>& x, const std::array<double, 4>& d) {
  std::vector<std::size_t> front, behind;
  for (std::size_t a = 0; a < 4; ++a) (d[a] > 0.0 ? front : behind).push_back(a);
  std::vector<Vec3d> polygon;
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (std::size_t k = 0; k < behind.size(); ++k) {
      const std::size_t p = front[i], m = behind[i % 2 == 0 ? k : behind.size() - 1 - k];  // once around
      polygon.push_back(x[m] + (x[p] - x[m]) * (-d[m] / (d[p] - d[m])));
    }
  }
  Vec3d twice{};
  for (std::size_t i = 2; i < polygon.size(); ++i) twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * norm(twice);
}

class PlaneReader : public ProbeReader {
 public:
  explicit PlaneReader(const ProbePlane& plane) : point_(plane.point), normal_(unit(plane.normal)) {}

  std::vector<std::string> columns() const override {
    std::vector<std::string> names;
    add_vector_columns(names, "force", "N");
    add_vector_columns(names, "moment", "N_m");
    add_vector_columns(names, "traction", "Pa");
    names.emplace_back("area_m2");
    return names;
  }

  void follow(const Simulation& simulation) override {
    const TetMesh& mesh = simulation.mesh();
    const double on_plane = detail::place_tolerance(mesh);  // so near, a vertex lies on the plane
    tets_.clear(), front_.clear(), areas_.clear();
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
      std::array<double, 4> d;
      std::array<Vec3d, 4> x;
      std::array<bool, 4> front;
      for (std::size_t a = 0; a < 4; ++a) {
        x[a] = mesh.vertices[mesh.tets[t][a]];
        d[a] = dot(x[a] - point_, normal_);
        front[a] = d[a] > on_plane;
        if (!front[a]) d[a] = std::min(d[a], 0.0);
      }
      const auto count = std::count(front.begin(), front.end(), true);
      if (count == 0 || count == 4 || simulation.is_removed(t)) continue;
      tets_.push_back(t);
      front_.push_back(front);
      areas_.push_back(section_area(x, d));
    }
  }

  std::vector<double> read(const Simulation& simulation, const TetFields& fields, std::size_t first) const override {
    const TetMesh& mesh = simulation.mesh();
    Vec3d force{}, moment{}, traction{};
    double area = 0.0;
    for (std::size_t k = 0; k < tets_.size(); ++k) {
      for (std::uint8_t a = 0; a < 4; ++a) {
        if (!front_[k][a]) continue;
        const std::uint32_t v = mesh.tets[tets_[k]][a];
        const Vec3d f = corner_force(mesh, fields, first + k, {tets_[k], a});
        force += f;
        moment += cross(mesh.vertices[v] + simulation.displacement()[v] - point_, f);
      }
      const double* P = &fields.piola[9 * (first + k)];
      for (std::size_t i = 0; i < 3; ++i) {
        traction[i] += areas_[k] * (P[3 * i] * normal_.x + P[3 * i + 1] * normal_.y + P[3 * i + 2] * normal_.z);
      }
      area += areas_[k];
    }
    std::vector<double> row;
    for (const Vec3d& v : {force, moment, traction * (1.0 / area)}) add_vector(row, v);
    row.push_back(area);
    return row;
  }

 private:
  Vec3d point_, normal_;
  std::vector<std::array<bool, 4>> front_;  ///< per tet: its corners in front
  std::vector<double> areas_;               ///< of each tet's section [m²]
};

}  // namespace

std::unique_ptr<ProbeReader> make_reader(const Simulation& simulation, const ProbePlane& plane) {
  auto reader = std::make_unique<PlaneReader>(plane);
  reader->follow(simulation);
  if (!reader->tets().empty()) return reader;
  const TetMesh present = simulation.present_mesh();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Tet& t : present.tets) {
    for (const std::uint32_t v : t) {
      const double d = dot(present.vertices[v] - plane.point, unit(plane.normal));
      low = std::min(low, d), high = std::max(high, d);
    }
  }
  throw std::invalid_argument("the plane does not cut the body: along the normal, the body lies from " +
                              detail::number_text(low) + " to " + detail::number_text(high) +
                              " m away from the plane's point; move the point into it");
}

}  // namespace glisson

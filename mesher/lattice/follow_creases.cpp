// follow_creases.cpp — puts vertices and edges of the mesh on the creases of surfaces.
//
// Along an edge of an interface whose ends have normals far apart, the place where they part is found by halving; normals that
// still differ over a sixty-fourth of the edge part at a crease, others belong to a bend. As with the surfaces themselves, an
// end near that place is drawn to it, and the edge is cut there otherwise.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "mesher/lattice/crease.h"
#include "mesher/lattice/workspace.h"

namespace glisson::lattice {
namespace {

constexpr double kParted = 0.87;       ///< cosine of 30°: normals of the ends
constexpr double kStillParted = 0.90;  ///< and where they part
constexpr double kDrawShare = 0.38;    ///< of the edge
constexpr double kCornerReach = 0.8;   ///< of the edge
constexpr double kLeastDrawn = 0.03;

class Follower {
 public:
  Follower(Workspace& w, double floor) : w_(w), c_(w.complex), floor_(floor) {}

  void run() {
    w_.sides.resize(c_.points.size());
    find_normals();
    const auto edges = parted_edges();
    std::vector<Place> places;
    for (const auto& [u, v] : edges) {
      if (const auto place = crease_between(u, v)) places.push_back(*place);
    }
    draw(places);
    cut(places);
    draw_corners();
  }

 private:
  struct Place {
    std::uint32_t u, v;
    std::size_t k;
    Vec3d at;
    double t;  ///< from u
    CreaseSides sides;
  };

  /// The one surface of a vertex; none where it has none or several.
  std::optional<std::size_t> surface(std::uint32_t v) const {
    const Mask s = surfaces_of(c_.masks[v] & ~kMarks);
    if (std::popcount(s) != 1 || c_.stars[v].empty()) return {};
    return static_cast<std::size_t>(std::countr_zero(s));
  }

  Vec3d normal_at(std::size_t k, const Vec3d& p, double edge) const {
    const Vec3d g = w_.fields.gradient(k, p, edge);
    return g * (1.0 / std::max(norm(g), 1e-9));
  }

  void find_normals() {
    normals_.assign(c_.points.size(), Vec3d{});
    for (std::uint32_t v = 0; v < c_.points.size(); ++v) {
      if (const auto k = surface(v)) normals_[v] = normal_at(*k, c_.points[v], w_.edge(v));
    }
  }

  /// Whether an edge lies in an interface.
  bool in_interface(std::uint32_t u, std::uint32_t v) const {
    const EdgeRing ring = c_.edge_ring(u, v);
    if (ring.tets.empty()) return false;
    return !ring.closed || std::popcount(c_.labels_at_edge(u, v)) > 1;
  }

  std::vector<std::array<std::uint32_t, 2>> parted_edges() const {
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::uint32_t> around;
    for (std::uint32_t u = 0; u < c_.points.size(); ++u) {
      const auto k = surface(u);
      if (!k) continue;
      c_.neighbours(u, around);
      for (const std::uint32_t v : around) {
        if (v < u || surface(v) != k || dot(normals_[u], normals_[v]) > kParted) continue;
        if (in_interface(u, v)) edges.push_back({u, v});
      }
    }
    return edges;
  }

  std::optional<Place> crease_between(std::uint32_t u, std::uint32_t v) const {
    const std::size_t k = *surface(u);
    const Vec3d p = c_.points[u], q = c_.points[v];
    const double edge = c_.edge_between(u, v);
    double a = 0.0, b = 1.0;
    Vec3d na = normals_[u], nb = normals_[v];
    for (int i = 0; i < 6; ++i) {
      const double m = 0.5 * (a + b);
      Vec3d at = p + (q - p) * m;
      if (w_.fields.project(at, Mask{1} << k, edge) > kSlack * edge) return {};
      const Vec3d n = normal_at(k, at, edge);
      const bool nearer_a = dot(n, na) > dot(n, nb);
      (nearer_a ? a : b) = m;
      (nearer_a ? na : nb) = n;
    }
    if (dot(na, nb) > kStillParted) return {};
    const double t = 0.5 * (a + b);
    Vec3d at = p + (q - p) * t;
    if (w_.fields.project(at, Mask{1} << k, edge) > kSlack * edge) return {};
    const Vec3d line = cross(na, nb), along = line * (1.0 / std::max(norm(line), 1e-9));
    const auto side = [&](const Vec3d& to, const Vec3d& n) {
      const Vec3d s = to - at - along * dot(along, to - at);
      const Vec3d flat = s - n * dot(n, s);
      return flat * (1.0 / std::max(norm(flat), 1e-9));
    };
    Place place{u, v, k, at, t, {side(p, na), side(q, nb)}};
    const double left = project_to_crease(w_.fields, k, place.at, edge, place.sides);
    if (left > kSlack * edge || norm(place.at - at) > 0.3 * edge) return {};
    return place;
  }

  bool try_move(std::uint32_t v, const Vec3d& to) {
    const Vec3d from = c_.points[v];
    const double before = w_.star_quality(v);
    c_.points[v] = to;
    if (w_.star_quality(v) > std::min(before, std::max(floor_, kLeastDrawn))) return true;
    c_.points[v] = from;
    return false;
  }

  void mark(std::uint32_t v, const CreaseSides& sides) {
    c_.masks[v] |= kCrease;
    w_.sides.resize(c_.points.size());
    w_.sides[v] = sides;
  }
  bool marked(std::uint32_t v) const { return (c_.masks[v] & kCrease) != 0; }

  void draw(std::vector<Place>& places) {
    std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return std::min(a.t, 1.0 - a.t) < std::min(b.t, 1.0 - b.t);
    });
    for (const Place& x : places) {
      if (std::min(x.t, 1.0 - x.t) > kDrawShare || marked(x.u) || marked(x.v)) continue;
      const std::uint32_t near = x.t < 0.5 ? x.u : x.v;
      Vec3d at = c_.points[near];
      CreaseSides sides = x.sides;
      const double edge = w_.edge(near), left = project_to_crease(w_.fields, x.k, at, edge, sides);
      if (left < kSlack * edge && norm(at - c_.points[near]) < 0.45 * edge && try_move(near, at)) {
        mark(near, sides);
      } else if (try_move(near, x.at)) {
        mark(near, x.sides);
      }
    }
  }

  void cut(const std::vector<Place>& places) {
    for (const Place& x : places) {
      if (marked(x.u) || marked(x.v)) continue;
      const EdgeRing ring = c_.edge_ring(x.u, x.v);
      if (!ring.simple) continue;
      const Mask mask = c_.masks[x.u] & c_.masks[x.v] & ~kMarks;
      if (surfaces_of(mask) != Mask{1} << x.k)
        continue;  // one end is where another region meets: not that surface's alone
      c_.begin();
      const std::uint32_t m = c_.split_edge(x.u, x.v, x.at);
      c_.set_mask(m, mask);
      if (w_.star_quality(m) > floor_) {
        c_.keep();
        mark(m, x.sides);
      } else {
        c_.take_back();
      }
    }
  }

  /// Where creases of different direction are near each other, three planes meet: the nearest vertex goes there.
  void draw_corners() {
    std::vector<std::uint32_t> around, further, near;
    for (std::uint32_t u = 0; u < c_.points.size(); ++u) {
      if (!marked(u) || (c_.masks[u] & kCorner)) continue;
      c_.neighbours(u, around);
      near = around;
      for (const std::uint32_t n : around) {
        if (!surfaces_of(c_.masks[n])) continue;
        c_.neighbours(n, further);
        near.insert(near.end(), further.begin(), further.end());
      }
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      for (const std::uint32_t v : near) {
        if (v != u && surface(v) == surface(u) && draw_corner(u, v, near)) break;
      }
    }
  }

  /// The plane at v that is least like those of a crease; its normal and a point of it.
  std::pair<Vec3d, Vec3d> third_plane(std::size_t k, std::uint32_t v, const CreasePlanes& crease) const {
    const Vec3d& q = c_.points[v];
    if (!marked(v)) return {normal_at(k, q, w_.edge(v)), q};
    const CreasePlanes pv = crease_planes(w_.fields, k, q, w_.edge(v), w_.sides[v]);
    const bool is_a = likeness(pv.normal_a, crease) < likeness(pv.normal_b, crease);
    return is_a ? std::pair(pv.normal_a, q - pv.normal_a * pv.value_a)
                : std::pair(pv.normal_b, q - pv.normal_b * pv.value_b);
  }
  static double likeness(const Vec3d& n, const CreasePlanes& crease) {
    return std::max(dot(n, crease.normal_a), dot(n, crease.normal_b));
  }

  /// The corner of the crease at u and the plane at v, where that is on the surface. @param near  vertices that may go there
  bool draw_corner(std::uint32_t u, std::uint32_t v, const std::vector<std::uint32_t>& near) {
    const auto k = surface(u);
    if (!k || (c_.masks[v] & kCorner)) return false;
    const Vec3d& p = c_.points[u];
    const CreasePlanes pu = crease_planes(w_.fields, *k, p, w_.edge(u), w_.sides[u]);
    const auto [third, q] = third_plane(*k, v, pu);
    if (likeness(third, pu) > 0.8) return false;
    Mat3d rows;
    for (std::size_t j = 0; j < 3; ++j) rows(0, j) = pu.normal_a[j], rows(1, j) = pu.normal_b[j], rows(2, j) = third[j];
    if (std::abs(determinant(rows)) < 0.05) return false;
    const Vec3d corner =
        inverse(rows) * Vec3d{dot(pu.normal_a, p) - pu.value_a, dot(pu.normal_b, p) - pu.value_b, dot(third, q)};
    if (w_.fields.off(corner, Mask{1} << *k) > kSlack * w_.edge(u)) return false;
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const std::uint32_t x : near) {
      const double distance = norm(corner - c_.points[x]);
      if (surface(x) != k || distance > kCornerReach * w_.edge(x)) continue;
      if (c_.masks[x] & kCorner) return false;  // taken
      order.emplace_back(distance, x);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [distance, x] : order) {
      if (!try_move(x, corner)) continue;
      mark(x, w_.sides[u]);
      c_.masks[x] |= kCorner;
      return true;
    }
    return false;
  }

  Workspace& w_;
  TetComplex& c_;
  double floor_;
  std::vector<Vec3d> normals_;
};

}  // namespace

void follow_creases(Workspace& w, double floor) { Follower(w, floor).run(); }

}  // namespace glisson::lattice

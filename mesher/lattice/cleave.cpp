// cleave.cpp — drawing lattice vertices onto a region's surface, and cutting the edges that still cross it.
//
// A vertex close to the surface moves onto it, where the surface crosses an edge nearer to the vertex than a quarter of a
// long or 0.41 of a short edge [LabelleShewchuk2007, table 1]. The edges whose ends still lie on different sides are cut in
// two, one by one and the longest first; each cut halves the tets around the edge, so that the mesh conforms at any time, and
// in the end no tet has corners on both sides. A region is cut out of tets that no region with precedence took: its edges on
// earlier interfaces are cut in the tets of both sides, and vertices there move along the interface.
#include "mesher/lattice/cleave.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/lattice/tet_quality.h"

namespace glisson::lattice {
namespace {

constexpr double kLongShare = 0.25, kShortShare = 0.41;  ///< of an edge: a crossing nearer than that draws the vertex
constexpr double kLongEdge = 0.93;                       ///< of the cube's side
constexpr double kOnSurface = 0.02;                      ///< of the edge: near enough as it is
constexpr double kLeastQuality = 0.04;                   ///< of tets around a vertex that is drawn

class Cleaver {
 public:
  Cleaver(const RegionFields& fields, TetComplex& complex) : f_(fields), c_(complex) {}

  void cut_out(std::size_t region) {
    region_ = region;
    evaluate();
    find_crossings();
    draw_vertices();
    cut_edges();
    label_tets();
  }

 private:
  struct Crossing {
    std::uint32_t u, v;
    double t;  ///< from u
  };

  void evaluate() {
    value_.assign(c_.points.size(), std::numeric_limits<double>::quiet_NaN());
    const Bounds& b = f_.region(region_).bounds;
    const double margin = f_.edge();  // of the coarsest tets
    for (std::uint32_t t = 0; t < c_.tets.size(); ++t) {
      if (c_.labels[t] != kUndecided) continue;
      for (const std::uint32_t v : c_.tets[t]) {
        if (std::isnan(value_[v])) value_[v] = value_at(v, b, margin);
      }
    }
  }

  double value_at(std::uint32_t v, const Bounds& b, double margin) const {
    const Vec3d& p = c_.points[v];
    for (std::size_t d = 0; d < 3; ++d) {
      if (p[d] < b.min[d] - margin || p[d] > b.max[d] + margin) return margin;
    }
    const double value = f_.value(region_, p);
    return std::abs(value) < kOnSurface * c_.edges[v] ? 0.0 : value;
  }

  bool crosses(std::uint32_t u, std::uint32_t v) const { return value_[u] * value_[v] < 0.0; }

  /// Where the surface crosses an edge, from u: false position with halving, to a thousandth.
  double root(std::uint32_t u, std::uint32_t v) const {
    double a = 0.0, b = 1.0, fa = value_[u], fb = value_[v];
    double t = 0.5;
    const double close = 1e-3 * c_.edge_between(u, v);
    for (int i = 0; i < 12; ++i) {
      t = a + (b - a) * std::clamp(fa / (fa - fb), 0.05, 0.95);
      const double ft = f_.value(region_, c_.points[u] + (c_.points[v] - c_.points[u]) * t);
      if (std::abs(ft) < close) break;
      ((ft < 0.0) == (fa < 0.0) ? a : b) = t;
      ((ft < 0.0) == (fa < 0.0) ? fa : fb) = ft;
    }
    return t;
  }

  void find_crossings() {
    crossings_.clear();
    for (std::uint32_t t = 0; t < c_.tets.size(); ++t) {
      if (c_.labels[t] != kUndecided) continue;
      const Tet& tet = c_.tets[t];
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
          if (crosses(tet[i], tet[j])) crossings_.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j]), 0.0});
        }
      }
    }
    const auto before = [](const Crossing& a, const Crossing& b) { return a.u != b.u ? a.u < b.u : a.v < b.v; };
    const auto same = [](const Crossing& a, const Crossing& b) { return a.u == b.u && a.v == b.v; };
    std::sort(crossings_.begin(), crossings_.end(), before);
    crossings_.erase(std::unique(crossings_.begin(), crossings_.end(), same), crossings_.end());
    for (Crossing& x : crossings_) x.t = root(x.u, x.v);
  }

  double length(std::uint32_t u, std::uint32_t v) const { return norm(c_.points[v] - c_.points[u]); }

  void draw_vertices() {
    struct Draw {
      double share;  ///< of what is allowed
      std::uint32_t vertex, other;
      double t;
    };
    std::vector<Draw> draws;
    for (const Crossing& x : crossings_) {
      const bool is_long = length(x.u, x.v) > kLongEdge * c_.edge_between(x.u, x.v) / 0.9234;
      const double allowed = is_long ? kLongShare : kShortShare;
      if (x.t < allowed) draws.push_back({x.t / allowed, x.u, x.v, x.t});
      if (1.0 - x.t < allowed) draws.push_back({(1.0 - x.t) / allowed, x.v, x.u, 1.0 - x.t});
    }
    std::stable_sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) { return a.share < b.share; });
    for (const Draw& d : draws) {
      if (crosses(d.vertex, d.other))
        draw(d.vertex, c_.points[d.vertex] + (c_.points[d.other] - c_.points[d.vertex]) * d.t);
    }
  }

  /// Moves a vertex onto the surface, and along those it lies on; where that squeezes its tets, to the crossing.
  void draw(std::uint32_t v, const Vec3d& crossing) {
    const Vec3d from = c_.points[v];
    const double edge = c_.edges[v];
    const Mask earlier = surfaces_of(c_.labels_at(v));
    Vec3d nearest = from;
    const double left = f_.project(nearest, earlier | bit(static_cast<Label>(region_)), edge);
    const double far = 0.5 * edge;
    if (left < kOnSurface * edge && norm(nearest - from) < far) {
      c_.points[v] = nearest;
      if (star_quality(v) > kLeastQuality) {
        value_[v] = 0.0;
        return;
      }
    }
    c_.points[v] = from;
    if (earlier != 0) {
      // Two surfaces so close that they are one to this mesh: the vertex is of both as it is.
      if (std::abs(value_[v]) < 0.15 * edge) value_[v] = 0.0;
      return;
    }
    c_.points[v] = crossing;
    if (star_quality(v) > kLeastQuality) {
      value_[v] = 0.0;
    } else {
      c_.points[v] = from;
    }
  }

  double quality(std::uint32_t t) const {
    const Tet& x = c_.tets[t];
    return tet_quality(c_.points[x[0]], c_.points[x[1]], c_.points[x[2]], c_.points[x[3]], c_.edge_in(x));
  }
  double star_quality(std::uint32_t v) const {
    double least = 1.0;
    for (const std::uint32_t t : c_.stars[v]) least = std::min(least, quality(t));
    return least;
  }

  void cut_edges() {
    std::erase_if(crossings_, [&](const Crossing& x) { return !crosses(x.u, x.v); });
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < crossings_.size(); ++i)
      order.emplace_back(-length(crossings_[i].u, crossings_[i].v), i);
    std::sort(order.begin(), order.end());
    for (const auto& [minus_length, i] : order) cut(crossings_[i]);
  }

  void cut(const Crossing& x) {
    const Vec3d at = c_.points[x.u] + (c_.points[x.v] - c_.points[x.u]) * x.t;
    const Mask earlier = surfaces_of(c_.labels_at_edge(x.u, x.v));
    const std::uint32_t m = c_.split_edge(x.u, x.v, at);
    value_.push_back(0.0);
    if (earlier == 0) return;
    Vec3d nearest = at;
    const double edge = c_.edges[m];
    const double left = f_.project(nearest, earlier | bit(static_cast<Label>(region_)), edge);
    if (left > kOnSurface * edge || norm(nearest - at) > 0.3 * edge) return;
    const double before = star_quality(m);
    c_.points[m] = nearest;
    if (star_quality(m) < std::min(before, kLeastQuality)) c_.points[m] = at;
  }

  void label_tets() {
    for (std::uint32_t t = 0; t < c_.tets.size(); ++t) {
      if (c_.labels[t] != kUndecided) continue;
      double sum = 0.0;
      Vec3d centre{};
      for (const std::uint32_t v : c_.tets[t]) {
        sum += value_[v];
        centre += c_.points[v] * 0.25;
      }
      if (sum == 0.0) sum = f_.value(region_, centre);
      if (sum < 0.0) c_.labels[t] = static_cast<Label>(region_);
    }
  }

  const RegionFields& f_;
  TetComplex& c_;
  std::size_t region_ = 0;
  std::vector<double> value_;  ///< of the region at the vertices; NaN: not asked for
  std::vector<Crossing> crossings_;
};

}  // namespace

void cleave(const RegionFields& fields, TetComplex& complex) {
  Cleaver cleaver(fields, complex);
  for (std::size_t k = 0; k < fields.count(); ++k) cleaver.cut_out(k);
  for (Label& label : complex.labels) {
    if (label == kUndecided) label = fields.outside();
  }
  for (std::uint32_t v = 0; v < complex.points.size(); ++v) complex.masks[v] = complex.labels_at(v);
  for (std::uint32_t t = 0; t < complex.tets.size(); ++t) {
    const Label label = complex.labels[t];
    if (label == kNone) continue;
    if (label == fields.outside() || fields.region(label).hole) complex.remove_tet(t);
  }
}

}  // namespace glisson::lattice

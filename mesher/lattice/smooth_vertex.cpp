// smooth_vertex.cpp — moves one vertex to where the worst of its tets is best.
#include "mesher/lattice/operations.h"

#include <algorithm>
#include <bit>

namespace glisson::lattice {
namespace {

/// The face of a tet that the vertex sees, so that (vertex, a, b, c) has positive volume.
struct SeenFace {
  Vec3d a, b, c;
  double edge;  ///< asked for in the tet [m]
};

class Climb {
 public:
  Climb(Workspace& w, std::uint32_t vertex, double loose)
      : w_(w), vertex_(vertex), edge_(w.edge(vertex)), loose_(loose > 0.0),
        surfaces_(surfaces_of(w.complex.masks[vertex])) {
    const Mask mask = w.complex.masks[vertex];
    crease_ = (mask & kCrease) && surfaces_ && !loose_;
    fixed_ = (mask & kCorner) || (std::popcount(surfaces_) > 2 && !loose_);
    if (crease_) sides_ = w.sides[vertex];
    static constexpr std::uint8_t kSeen[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const auto& points = w.complex.points;
    for (const std::uint32_t t : w.complex.stars[vertex]) {
      const Tet& tet = w.complex.tets[t];
      const auto corner = static_cast<std::size_t>(std::find(tet.begin(), tet.end(), vertex) - tet.begin());
      const auto& s = kSeen[corner];
      faces_.push_back({points[tet[s[0]]], points[tet[s[1]]], points[tet[s[2]]], w.complex.edge_in(tet)});
    }
    quality_.resize(faces_.size());
    at_ = points[vertex];
    least_ = evaluate(at_, -1e300);
    if (surfaces_) slack_ = std::max(std::max(loose, kSlack) * edge_, w.fields.off(at_, surfaces_));
  }

  bool run() {
    if (fixed_ || faces_.empty()) return false;
    bool moved = false;
    for (int i = 0; i < 4; ++i) {
      if (!step(0.06) && !step(0.015)) break;
      moved = true;
    }
    if (moved) w_.complex.move(vertex_, at_);
    if (moved && crease_) w_.sides[vertex_] = sides_;
    return moved;
  }

 private:
  double quality(const SeenFace& f, const Vec3d& p) const { return tet_quality(p, f.a, f.b, f.c, f.edge); }

  /// Least quality with the vertex at p; gives up below `floor`.
  double evaluate(const Vec3d& p, double floor) {
    double least = 1.0;
    for (std::size_t i = 0; i < faces_.size() && least > floor; ++i) least = std::min(least, quality(faces_[i], p));
    return least;
  }

  /// Removes what a vector has across the surfaces.
  Vec3d along(Vec3d g) const {
    if (normals_ == 1) return g - normal_[0] * dot(normal_[0], g);
    if (normals_ < 2) return g;
    const Vec3d line = cross(normal_[0], normal_[1]);
    const double length2 = dot(line, line);
    return length2 < 1e-4 ? Vec3d{} : line * (dot(line, g) / length2);
  }

  Vec3d gradient(const SeenFace& f, double q) const {
    const double h = 1e-5 * edge_;
    const Vec3d g{quality(f, at_ + Vec3d{h, 0, 0}) - q, quality(f, at_ + Vec3d{0, h, 0}) - q,
                  quality(f, at_ + Vec3d{0, 0, h}) - q};
    return along(g * (1.0 / h));
  }

  /// Shortest vector in the convex hull of the gradients, by Frank and Wolfe's steps.
  static Vec3d shortest(const std::vector<Vec3d>& gradients) {
    Vec3d x = gradients.front();
    for (int i = 0; i < 30; ++i) {
      const auto least = std::min_element(gradients.begin(), gradients.end(),
                                          [&](const Vec3d& a, const Vec3d& b) { return dot(a, x) < dot(b, x); });
      const Vec3d to = *least - x;
      const double gain = -dot(x, to), length2 = dot(to, to);
      if (gain <= 1e-3 * dot(x, x) || length2 == 0.0) break;
      x += to * std::min(1.0, gain / length2);
    }
    return x;
  }

  bool step(double band) {
    for (std::size_t i = 0; i < faces_.size(); ++i) quality_[i] = quality(faces_[i], at_);
    find_normals();
    const auto worst = static_cast<std::size_t>(std::min_element(quality_.begin(), quality_.end()) - quality_.begin());
    gradients_.assign(1, gradient(faces_[worst], quality_[worst]));
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (i != worst && quality_[i] < least_ + band) gradients_.push_back(gradient(faces_[i], quality_[i]));
    }
    const Vec3d direction = shortest(gradients_);
    const double steepness = norm(direction);
    if (steepness * edge_ < 1e-3) return false;
    for (double s = 0.25 * edge_; s > 0.005 * edge_; s *= 0.5) {
      if (try_at(at_ + direction * (s / steepness))) return true;
    }
    return false;
  }

  void find_normals() {
    normals_ = 0;
    if (crease_) {
      const CreasePlanes planes = crease_planes(w_.fields, surface(), at_, edge_, sides_);
      normal_[0] = planes.normal_a;
      normal_[1] = planes.normal_b;
      normals_ = 2;
    } else if (surfaces_ && !loose_) {
      normals_ = w_.fields.normals(at_, surfaces_, edge_, normal_, 2);
    }
  }
  std::size_t surface() const { return static_cast<std::size_t>(std::countr_zero(surfaces_)); }

  bool try_at(Vec3d p) {
    CreaseSides sides = sides_;
    const double least_gain = 1e-4;
    if (crease_) {
      if (project_to_crease(w_.fields, surface(), p, edge_, sides) > kSlack * edge_) return false;
    } else if (surfaces_ && !loose_ && w_.fields.project(p, surfaces_, edge_) > slack_) {
      return false;
    }
    const double q = evaluate(p, least_ + least_gain);
    if (q <= least_ + least_gain) return false;
    if (loose_ && w_.fields.off(p, surfaces_) > slack_) return false;
    least_ = q;
    at_ = p;
    sides_ = sides;
    return true;
  }

  Workspace& w_;
  std::uint32_t vertex_;
  double edge_;  ///< asked for at the vertex [m]
  bool loose_;
  bool crease_ = false, fixed_ = false;
  CreaseSides sides_{};
  Mask surfaces_;
  double slack_ = 0.0;  ///< [m]
  std::vector<SeenFace> faces_;
  std::vector<double> quality_;
  std::vector<Vec3d> gradients_;
  Vec3d at_{};
  Vec3d normal_[2];
  std::size_t normals_ = 0;
  double least_ = 0.0;
};

}  // namespace

bool smooth_vertex(Workspace& w, std::uint32_t vertex, double loose) { return Climb(w, vertex, loose).run(); }

bool centre_vertex(Workspace& w, std::uint32_t vertex, double floor) {
  TetComplex& c = w.complex;
  const Mask mask = c.masks[vertex], surfaces = surfaces_of(mask);
  if (std::popcount(surfaces) > 2 || c.stars[vertex].empty() || (mask & kCorner)) return false;
  if (mask & kCrease) return false;  // moved by smooth_vertex alone
  thread_local std::vector<std::uint32_t> around;
  c.neighbours(vertex, around);
  Vec3d sum{};
  double count = 0.0;
  for (const std::uint32_t n : around) {
    if ((c.masks[n] & mask) != mask) continue;
    sum += c.points[n];
    count += 1.0;
  }
  if (count < (surfaces ? 2.0 : 4.0)) return false;
  const Vec3d from = c.points[vertex], aim = sum * (1.0 / count) - from;
  const double before = w.star_quality(vertex), edge = w.edge(vertex),
               slack = std::max(kSlack * edge, w.fields.off(from, surfaces));
  for (const double part : {1.0, 0.5}) {
    Vec3d p = from + aim * part;
    if (surfaces && w.fields.project(p, surfaces, edge) > slack) continue;
    c.points[vertex] = p;
    const bool good = w.star_quality(vertex) >= std::min(before, floor);
    c.points[vertex] = from;
    if (!good) continue;
    c.move(vertex, p);
    return true;
  }
  return false;
}

}  // namespace glisson::lattice

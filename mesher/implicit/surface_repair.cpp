// surface_repair.cpp — see surface_repair.h.
#include "glisson/surface_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "base/text.h"
#include "mesher/implicit/surface_edges.h"
#include "mesher/implicit/surface_tree.h"

namespace glisson {
namespace {

using namespace detail;

constexpr double kWeld = 0.01;      // of the median edge: how far apart points may be that are one
constexpr double kWeldOfOwn = 0.1;  // of the shortest edge at a point: below it a weld folds no triangle
constexpr std::size_t kLeastArea =
    400;  // edges around a hole up to which its lid of least area is searched, in some 0.1 s
constexpr std::size_t kShownPlaces = 3;

double area_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return 0.5 * norm(cross(b - a, c - a)); }

bool closes(const EdgeUses& edges) {
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second.sum == 0; });
}

// ── welding ──────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────

/// A point on an edge that does not close.
struct LoosePoint {
  std::uint32_t point = 0;
  std::size_t uses = 0;  ///< edges at it
  double reach = 0.0;    ///< within which it may become another [m]
};

/// Loose points, those that more triangles share first: a corner that is off by itself moves, not its neighbours.
std::vector<LoosePoint> loose_points(std::span<const Vec3d> points, const EdgeUses& edges) {
  std::vector<double> lengths;
  std::map<std::uint32_t, LoosePoint> at;
  for (const auto& [ends, use] : edges) {
    lengths.push_back(norm(points[ends[1]] - points[ends[0]]));
    if (use.sum == 0) continue;
    for (const std::uint32_t p : ends) at.try_emplace(p, LoosePoint{p, 0, std::numeric_limits<double>::infinity()});
  }
  std::size_t i = 0;
  for (const auto& [ends, use] : edges) {
    for (const std::uint32_t p : ends) {
      const auto found = at.find(p);
      if (found == at.end()) continue;
      ++found->second.uses;
      found->second.reach = std::min(found->second.reach, kWeldOfOwn * lengths[i]);
    }
    ++i;
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  std::vector<LoosePoint> loose;
  for (const auto& [point, x] : at) loose.push_back({point, x.uses, std::min(x.reach, kWeld * *middle)});
  std::stable_sort(loose.begin(), loose.end(), [](const auto& a, const auto& b) { return a.uses > b.uses; });
  return loose;
}

/// Points by cubes as wide as the largest reach, so that what is within it is in a cube nearby.
class NearbyPoints {
 public:
  NearbyPoints(std::span<const Vec3d> points, double reach) : points_(points), cell_(reach) {}

  void add(std::uint32_t point) { cells_[cell_of(points_[point])].push_back(point); }
  /// The nearest one within the reach.
  std::optional<std::uint32_t> nearest(const Vec3d& x, double reach) const {
    std::optional<std::uint32_t> best;
    const std::array<std::int64_t, 3> at = cell_of(x);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find({at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1});
      if (found == cells_.end()) continue;
      for (const std::uint32_t p : found->second) {
        const double off = norm(points_[p] - x);
        if (off <= reach) best = p, reach = off;
      }
    }
    return best;
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3d& x) const {
    std::array<std::int64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(std::floor(std::clamp(x[k] / cell_, -1e15, 1e15)));
    return cell;
  }

  std::span<const Vec3d> points_;
  double cell_;
  std::map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>> cells_;
};

void weld(SurfaceRepair& surface) {
  const std::vector<LoosePoint> loose = loose_points(surface.points, edge_uses(surface.triangles));
  double most = 0.0;
  for (const LoosePoint& x : loose) most = std::max(most, x.reach);
  if (!(most > 0.0)) return;
  NearbyPoints kept(surface.points, most);
  std::map<std::uint32_t, std::uint32_t> becomes;
  for (const LoosePoint& x : loose) {
    if (const auto other = kept.nearest(surface.points[x.point], x.reach)) {
      becomes[x.point] = *other;
      surface.welded.push_back(surface.points[x.point]);
      surface.farthest_weld = std::max(surface.farthest_weld, norm(surface.points[*other] - surface.points[x.point]));
    } else {
      kept.add(x.point);
    }
  }
  for (Triangle& t : surface.triangles) {
    for (std::uint32_t& corner : t) {
      if (const auto found = becomes.find(corner); found != becomes.end()) corner = found->second;
    }
  }
  std::erase_if(surface.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

// ── doubles ──────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────

/// Adds a triangle to the edges, or takes it off.
void count_triangle(EdgeUses& edges, const Triangle& t, int times) {
  for (std::size_t i = 0; i < 3; ++i)
    edges[edge_of(t[i], t[(i + 1) % 3])].sum += t[i] < t[(i + 1) % 3] ? times : -times;
}

/// How far the edges of a triangle are from closing.
int open_at(const EdgeUses& edges, const Triangle& t) {
  int open = 0;
  for (std::size_t i = 0; i < 3; ++i) open += std::abs(edges.at(edge_of(t[i], t[(i + 1) % 3])).sum);
  return open;
}

/// Of triangles on the same three points: the one with which their edges come nearest to closing, or none of two that face each other.
std::optional<Triangle> fitting(EdgeUses& edges, const std::vector<Triangle>& all) {
  for (const Triangle& t : all) count_triangle(edges, t, -1);
  std::optional<Triangle> best;
  int least = std::numeric_limits<int>::max();
  bool both_ways = false;
  for (const Triangle& t : all) {
    count_triangle(edges, t, 1);
    if (const int open = open_at(edges, t); open < least) {
      both_ways = best.has_value();
      least = open, best = t;
    } else if (open > least) {
      both_ways = true;
    }
    count_triangle(edges, t, -1);
  }
  if (both_ways && open_at(edges, all.front()) < least) best.reset();
  if (best) count_triangle(edges, *best, 1);
  return best;
}

void drop_doubles(SurfaceRepair& surface) {
  EdgeUses edges = edge_uses(surface.triangles);
  std::map<Triangle, std::vector<Triangle>> by_corners;
  for (const Triangle& t : surface.triangles) {
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    by_corners[sorted].push_back(t);
  }
  std::map<Triangle, std::optional<Triangle>> left;  // of corners that several have
  for (const auto& [corners, all] : by_corners) {
    if (all.size() > 1) left.emplace(corners, fitting(edges, all));
  }
  if (left.empty()) return;
  std::vector<Triangle> kept;
  for (const Triangle& t : surface.triangles) {
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    const auto found = left.find(sorted);
    if (found == left.end() || found->second == t) {
      kept.push_back(t);
      if (found != left.end()) found->second.reset();  // the first alone
    } else {
      surface.doubled.push_back(middle_of({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]}));
    }
  }
  surface.triangles = std::move(kept);
}

// ── holes ────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────────

using Loop = std::vector<std::uint32_t>;

/// The loops around the holes, in the direction of their lids: what the surface lacks goes in and out of every point as often.
std::vector<Loop> loops_of(const EdgeUses& edges) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;
  for (const auto& [ends, use] : edges) {
    if (use.sum > 0) next[ends[1]].push_back(ends[0]);
    if (use.sum < 0) next[ends[0]].push_back(ends[1]);
  }
  std::vector<Loop> loops;
  for (auto& [start, ways] : next) {
    while (!ways.empty()) {
      Loop path{start};
      while (!path.empty()) {
        std::vector<std::uint32_t>& on = next.at(path.back());
        if (on.empty()) break;  // the start, with no way left
        const std::uint32_t to = on.back();
        on.pop_back();
        const auto before = std::find(path.begin(), path.end(), to);
        if (before == path.end()) {
          path.push_back(to);
          continue;
        }
        loops.emplace_back(before, path.end());
        path.erase(before + 1, path.end());
      }
    }
  }
  return loops;
}

/// Triangles of least area on a loop, by the best third corner of every chord. [Liepa2003, §3]
std::vector<Triangle> least_lid(std::span<const Vec3d> points, const Loop& loop) {
  const std::size_t n = loop.size();
  std::vector<double> area(n * n, 0.0);
  std::vector<std::size_t> third(n * n, 0);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t m = i + 1; m < k; ++m) {
        const double sum =
            area[i * n + m] + area[m * n + k] + area_of(points[loop[i]], points[loop[m]], points[loop[k]]);
        if (sum < least) least = sum, third[i * n + k] = m;
      }
      area[i * n + k] = least;
    }
  }
  std::vector<Triangle> lid;
  std::vector<std::array<std::size_t, 2>> chords{{0, n - 1}};
  while (!chords.empty()) {
    const auto [i, k] = chords.back();
    chords.pop_back();
    if (k < i + 2) continue;
    const std::size_t m = third[i * n + k];
    lid.push_back({loop[i], loop[m], loop[k]});
    chords.push_back({i, m});
    chords.push_back({m, k});
  }
  return lid;
}

Vec3d middle_of_loop(std::span<const Vec3d> points, const Loop& loop) {
  Vec3d sum{};
  for (const std::uint32_t p : loop) sum += points[p];
  return sum * (1.0 / static_cast<double>(loop.size()));
}

/// The lid on a loop; of a long one a fan about its middle, which becomes a point of the surface.
std::vector<Triangle> lid_of(std::vector<Vec3d>& points, const Loop& loop) {
  if (loop.size() <= kLeastArea) return least_lid(points, loop);
  const auto middle = static_cast<std::uint32_t>(points.size());
  points.push_back(middle_of_loop(points, loop));
  std::vector<Triangle> fan;
  for (std::size_t i = 0; i < loop.size(); ++i) fan.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
  return fan;
}

double area_of(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  double sum = 0.0;
  for (const Triangle& t : triangles) sum += area_of(points[t[0]], points[t[1]], points[t[2]]);
  return sum;
}

std::string percent(double share) { return show(std::round(share * 1e5) / 1e3) + " %"; }

void close_holes(SurfaceRepair& surface) {
  const EdgeUses edges = edge_uses(surface.triangles);
  if (std::any_of(edges.begin(), edges.end(), [](const auto& e) { return e.second.sum != 0 && e.second.count > 1; })) {
    return;  // sheets and turned triangles are for surface_solid to refuse
  }
  const double whole = area_of(surface.points, surface.triangles);
  for (const Loop& loop : loops_of(edges)) {
    const Vec3d middle = middle_of_loop(surface.points, loop);
    const std::vector<Triangle> lid = lid_of(surface.points, loop);
    const double share = area_of(surface.points, lid) / whole;
    if (!(share <= kLargestHole)) {
      throw std::invalid_argument("has a hole of " + percent(share) + " of its area, " +
                                  count_text(loop.size(), "edge", "edges") + " around " + place_text(middle) +
                                  "; holes up to " + percent(kLargestHole) +
                                  " are closed: close it in the program that it is from");
    }
    surface.holes.push_back({middle, loop.size(), share});
    surface.triangles.insert(surface.triangles.end(), lid.begin(), lid.end());
  }
  std::stable_sort(surface.holes.begin(), surface.holes.end(),
                   [](const auto& a, const auto& b) { return a.share > b.share; });
}

/// ` at (…) m, (…) m and 23 more`.
template <class Things, class Place>
std::string places(const Things& things, Place place) {
  std::string text = " at ";
  for (std::size_t i = 0; i < std::min(things.size(), kShownPlaces); ++i)
    text += (i > 0 ? ", " : "") + place_text(place(things[i]));
  return text + (things.size() > kShownPlaces ? " and " + std::to_string(things.size() - kShownPlaces) + " more" : "");
}

}  // namespace

std::string SurfaceRepair::text() const {
  const auto itself = [](const Vec3d& x) { return x; };
  std::vector<std::string> parts;
  if (!welded.empty()) {
    parts.push_back(count_text(welded.size(), "point was", "points were") + " joined to others up to " +
                    show(std::round(1e9 * farthest_weld) / 1e6) + " mm away," + places(welded, itself));
  }
  if (!doubled.empty()) {
    parts.push_back(count_text(doubled.size(), "double triangle was", "double triangles were") + " left out," +
                    places(doubled, itself));
  }
  if (!holes.empty()) {
    parts.push_back(count_text(holes.size(), "hole was", "holes were") + " closed, the largest of " +
                    percent(holes.front().share) + " of the area," +
                    places(holes, [](const Hole& hole) { return hole.middle; }));
  }
  return std::accumulate(
      parts.begin(), parts.end(), std::string(),
      [](const std::string& all, const std::string& part) { return all + (all.empty() ? "" : "; ") + part; });
}

SurfaceRepair repair_surface(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  SurfaceRepair surface{.points = {points.begin(), points.end()},
                        .triangles = distinct_triangles(points, triangles),
                        .welded = {},
                        .doubled = {},
                        .holes = {}};
  if (closes(edge_uses(surface.triangles))) return surface;
  weld(surface);
  drop_doubles(surface);
  close_holes(surface);
  if (surface.triangles.empty()) throw std::invalid_argument("has no triangles; give a closed surface");
  return surface;
}

}  // namespace glisson

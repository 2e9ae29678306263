#include "glisson/heat/heat_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/text.h"
#include "heat/share_below.h"
#include "mesh/inspect/tet_locator.h"

namespace glisson {
namespace {

constexpr double kSamplesAnEdge = 8.0;
constexpr int kDirections = 360;  // half a degree apart

double mean_edge(const TetMesh& mesh) {
  return std::cbrt(6.0 * volume(mesh) / static_cast<double>(std::max<std::size_t>(1, mesh.tets.size())));
}

std::string in_mm(const Vec3d& x) {
  const auto text = [](double m) { return detail::number_text(1e3 * m); };
  return "(" + text(x.x) + ", " + text(x.y) + ", " + text(x.z) + ") mm";
}

/// The part of a line that lies in the box around the body, as shares of it; nothing: the second is not above the first.
std::pair<double, double> within_box(const TetMesh& mesh, const Vec3d& from, const Vec3d& to) {
  const auto [low, high] = box_of(mesh);
  double begin = 0.0, end = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = to[i] - from[i];
    if (way == 0.0) {
      if (from[i] < low[i] || from[i] > high[i]) end = begin;
      continue;
    }
    const double a = (low[i] - from[i]) / way, b = (high[i] - from[i]) / way;
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
  }
  return {begin, end};
}

/// Share of a stretch on which what is linear between two values is below a level.
double share_below(double a, double b, double level) {
  const double low = std::min(a, b), high = std::max(a, b);
  if (high <= level) return low < level || high < level ? 1.0 : 0.0;
  return low >= level ? 0.0 : (level - low) / (high - low);
}

}  // namespace

HeatPoints::HeatPoints(const TetMesh& mesh, std::span<const Vec3d> points) {
  const detail::TetLocator locator(mesh, {});
  for (const Vec3d& x : points) {
    const auto at = locator.locate(x);
    if (!at) {
      const auto [low, high] = box_of(mesh);
      throw std::invalid_argument("heat: " + in_mm(x) + " lies outside the body, which spans " + in_mm(low) + " to " +
                                  in_mm(high) + "; give a point within it");
    }
    places_.push_back({mesh.tets[at->tet], at->weights});
  }
}

std::vector<double> HeatPoints::read(std::span<const double> values) const {
  std::vector<double> read;
  for (const Place& p : places_) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) sum += p.weights[c] * values[p.vertices[c]];
    read.push_back(sum);
  }
  return read;
}

HeatLine::HeatLine(const TetMesh& mesh, const Vec3d& from, const Vec3d& to) {
  if (!(norm(to - from) > 0.0))
    throw std::invalid_argument("heat: a line from " + in_mm(from) + " to itself has no length");
  const auto [begin, end] = within_box(mesh, from, to);
  const Vec3d first = from + (to - from) * begin, way = (to - from) * (end - begin);
  const double length = norm(way);
  const int n = std::max(1, static_cast<int>(std::ceil(kSamplesAnEdge * length / mean_edge(mesh))));
  spacing_ = length / n;
  const detail::TetLocator locator(mesh, {});
  std::vector<Vec3d> inside;
  bool last = false;
  for (int k = 0; end > begin && k <= n; ++k) {
    const Vec3d x = first + way * (static_cast<double>(k) / n);
    const bool here = locator.locate(x).has_value();
    if (here && !inside.empty()) joined_.push_back(last ? 1 : 0);
    if (here) inside.push_back(x);
    last = here;
  }
  if (inside.size() < 2)
    throw std::invalid_argument("heat: the line from " + in_mm(from) + " to " + in_mm(to) + " misses the body");
  points_ = HeatPoints(mesh, inside);
}

double HeatLine::length_below(std::span<const double> values, double level) const {
  const std::vector<double> v = points_.read(values);
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < v.size(); ++k) {
    if (joined_[k] != 0) length += spacing_ * share_below(v[k], v[k + 1], level);
  }
  return length;
}

double HeatLine::integral(std::span<const double> values) const {
  const std::vector<double> v = points_.read(values);
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < v.size(); ++k) {
    if (joined_[k] != 0) sum += spacing_ * 0.5 * (v[k] + v[k + 1]);
  }
  return sum;
}

HeatPlane::HeatPlane(const TetMesh& mesh, const Vec3d& point, const Vec3d& normal) {
  if (!(norm(normal) > 0.0)) throw std::invalid_argument("heat: the normal of a plane has no length");
  const Vec3d n = unit(normal), other = std::abs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0},
              u = unit(cross(other, n)), v = cross(n, u);
  for (const Tet& t : mesh.tets) {
    std::array<double, 4> height;
    for (std::size_t c = 0; c < 4; ++c) height[c] = dot(mesh.vertices[t[c]] - point, n);
    std::vector<Corner> corners;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        if ((height[a] < 0.0) == (height[b] < 0.0)) continue;
        const double share = height[a] / (height[a] - height[b]);
        const Vec3d x = mesh.vertices[t[a]] * (1.0 - share) + mesh.vertices[t[b]] * share - point;
        corners.push_back({t[a], t[b], share, {dot(x, u), dot(x, v)}});
      }
    }
    if (corners.size() < 3) continue;
    if (corners.size() == 4) {  // in their order around the section: those of opposite edges are across from each other
      const auto meet = [](const Corner& x, const Corner& y) {
        return x.a == y.a || x.a == y.b || x.b == y.a || x.b == y.b;
      };
      if (!meet(corners[0], corners[1])) std::swap(corners[1], corners[2]);
      if (!meet(corners[1], corners[2])) std::swap(corners[2], corners[3]);
    }
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) triangles_.push_back({corners[0], corners[k], corners[k + 1]});
  }
  if (triangles_.empty()) throw std::invalid_argument("heat: a plane through " + in_mm(point) + " misses the body");
}

HeatPlane::Section HeatPlane::below(std::span<const double> values, double level) const {
  Section section;
  std::vector<double> low(kDirections, std::numeric_limits<double>::infinity()), high(kDirections, -low[0]);
  std::vector<std::array<double, 2>> directions;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    directions.push_back({std::cos(angle), std::sin(angle)});
  }
  const auto reach = [&](const std::array<double, 2>& x) {
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const double at = x[0] * directions[k][0] + x[1] * directions[k][1];
      low[k] = std::min(low[k], at), high[k] = std::max(high[k], at);
    }
  };
  for (const std::array<Corner, 3>& t : triangles_) {
    std::array<double, 3> f;
    for (std::size_t c = 0; c < 3; ++c) f[c] = std::lerp(values[t[c].a], values[t[c].b], t[c].share);
    if (std::min({f[0], f[1], f[2]}) >= level) continue;
    const auto edge = [&t](std::size_t i) { return std::array{t[i].at[0] - t[0].at[0], t[i].at[1] - t[0].at[1]}; };
    const double whole = 0.5 * std::abs(edge(1)[0] * edge(2)[1] - edge(1)[1] * edge(2)[0]);
    section.area += whole * heat::share_below(f, level);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      if (f[c] < level) reach(t[c].at);
      if ((f[c] < level) == (f[d] < level)) continue;
      const double s = (level - f[c]) / (f[d] - f[c]);
      reach({std::lerp(t[c].at[0], t[d].at[0], s), std::lerp(t[c].at[1], t[d].at[1], s)});
    }
  }
  for (std::size_t k = 0; k < directions.size(); ++k) section.width = std::max(section.width, high[k] - low[k]);
  return section;
}

IsothermExtent isotherm_extent(const TetMesh& mesh, std::span<const double> values, double level) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  IsothermExtent extent{.low = {kFar, kFar, kFar}, .high = {-kFar, -kFar, -kFar}};
  const auto reach = [&extent](const Vec3d& x) {
    for (std::size_t i = 0; i < 3; ++i)
      extent.low[i] = std::min(extent.low[i], x[i]), extent.high[i] = std::max(extent.high[i], x[i]);
  };
  for (std::size_t k = 0; k < mesh.tets.size(); ++k) {
    const Tet& t = mesh.tets[k];
    const std::array<double, 4> f{values[t[0]], values[t[1]], values[t[2]], values[t[3]]};
    if (*std::min_element(f.begin(), f.end()) >= level) continue;
    extent.volume += six_rest_volume(mesh, k) / 6.0 * heat::share_below(f, level);
    for (std::size_t a = 0; a < 4; ++a) {
      if (f[a] < level) reach(mesh.vertices[t[a]]);
      for (std::size_t b = a + 1; b < 4; ++b) {
        if ((f[a] < level) == (f[b] < level)) continue;
        const double s = (level - f[a]) / (f[b] - f[a]);
        reach(mesh.vertices[t[a]] * (1.0 - s) + mesh.vertices[t[b]] * s);
      }
    }
  }
  if (extent.volume == 0.0) extent.low = extent.high = {};
  return extent;
}

}  // namespace glisson

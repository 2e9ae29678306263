#include "scene/build/select.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "glisson/scene/body_places.h"
#include "glisson/scene/near_bounds.h"
#include "mesh/inspect/nearest_point.h"
#include "mesh/inspect/vertex_set.h"
#include "scene/parse/section.h"

namespace glisson::scene {
namespace {

std::string text_of(const Vec3d& x) { return Codec<Vec3d>::show(x); }

/// How far a place lies outside of bounds [m]; ≤ 0 inside.
using Beyond = std::function<double(const Vec3d&)>;

Beyond bounds_of(const TetMesh&, const Selection::Box& box) {
  return [box](const Vec3d& x) {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) most = std::max({most, box.min[i] - x[i], x[i] - box.max[i]});
    return most;
  };
}

Beyond bounds_of(const TetMesh&, const Selection::Sphere& ball) {
  return [ball](const Vec3d& x) { return norm(x - ball.center) - ball.radius; };
}

Beyond bounds_of(const TetMesh& mesh, const Selection::Side& side) {
  const auto axis = static_cast<std::size_t>(side.axis);
  const auto [low, high] = box_of(mesh);
  const double from = side.upper ? high[axis] : low[axis], other = side.upper ? low[axis] : high[axis];
  const double depth = side.upper ? -side.depth : side.depth;
  const double bound = side.share > 0.0 ? std::lerp(from, other, side.share) : from + depth;
  if (side.upper) return [axis, bound](const Vec3d& x) { return bound - x[axis]; };
  return [axis, bound](const Vec3d& x) { return x[axis] - bound; };
}

/// What is not picked by bounds.
template <class Other>
Beyond bounds_of(const TetMesh&, const Other&) {
  return {};
}

Vec3d centroid(const TetMesh& mesh, std::size_t tet) {
  Vec3d sum{};
  for (const std::uint32_t i : mesh.tets[tet]) sum += mesh.vertices[i] * 0.25;
  return sum;
}

/// Counts the places near bounds. @param place  of index i below `count`
template <class Place>
NearBounds count_near(const TetMesh& mesh, const Beyond& beyond, std::size_t count, const Place& place) {
  constexpr double kJustOutside = 1e3;  // tolerances: where files give coordinates in single precision or in six digits
  NearBounds near{.tolerance = detail::place_tolerance(mesh)};
  for (std::size_t i = 0; beyond && i < count; ++i) {
    const double by = beyond(place(i));
    near.inside += by <= near.tolerance;
    near.by_rounding += by > 0.0 && by <= near.tolerance;
    if (by <= near.tolerance || by > kJustOutside * near.tolerance) continue;
    ++near.just_outside;
    near.farthest = std::max(near.farthest, by);
  }
  return near;
}

std::string asked(const Selection::Box& b) { return "the box from " + text_of(b.min) + " to " + text_of(b.max) + " m"; }
std::string asked(const Selection::Sphere& s) {
  return "the ball of " + show(s.radius) + " m about " + text_of(s.center);
}
std::string asked(const Selection::Side& s) {
  const std::string depth = s.share > 0.0 ? show(s.share) + " of it" : show(s.depth) + " m";
  return std::string("the ") + (s.upper ? "upper" : "lower") + " end of " + "xyz"[s.axis] + ", " + depth + " deep";
}

std::vector<std::uint32_t> all_vertices(const TetMesh& mesh) {
  std::vector<std::uint32_t> ids(mesh.vertices.size());
  std::iota(ids.begin(), ids.end(), 0U);
  return ids;
}

std::vector<std::uint32_t> surface_vertices(const TetMesh& mesh) {
  std::vector<std::uint32_t> ids;
  for (const Triangle& t : boundary_triangles(mesh)) ids.insert(ids.end(), t.begin(), t.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// Vertices that a set is picked from.
std::vector<std::uint32_t> vertices_among(const TetMesh& mesh, const Selection& selection) {
  return selection.surface_only ? surface_vertices(mesh) : all_vertices(mesh);
}

/// Picks among some vertices; one overload a way to pick.
struct Picker {
  const TetMesh& mesh;
  const Selection& selection;
  std::string label;
  std::vector<std::uint32_t> among;

  [[noreturn]] void fail(const std::string& what) const { throw SceneError(label + ": " + what); }

  /// Those within bounds, which places on them belong to: a grid's coordinates carry rounding.
  template <class Bounds>
  std::vector<std::uint32_t> operator()(const Bounds& bounds) const {
    const Beyond beyond = bounds_of(mesh, bounds);
    const double tolerance = detail::place_tolerance(mesh);
    std::vector<std::uint32_t> found;
    std::copy_if(among.begin(), among.end(), std::back_inserter(found),
                 [&](auto i) { return beyond(mesh.vertices[i]) <= tolerance; });
    if (found.empty()) {
      fail("no vertex" + std::string(selection.surface_only ? " of the surface" : "") + " lies in " + asked(bounds) +
           "; the mesh spans " + extent_text(mesh));
    }
    return found;
  }
  /// Of vertices of the body; of those that are equally near up to rounding the ones of lowest number.
  std::vector<std::uint32_t> operator()(const Selection::Nearest& n) const {
    const std::vector<char> in_tet = vertices_in_tets(mesh);
    std::vector<std::pair<std::uint32_t, double>> near;
    for (const std::uint32_t i : among) {
      if (in_tet[i] != 0) near.emplace_back(i, norm(mesh.vertices[i] - n.point));
    }
    const auto count = static_cast<std::size_t>(n.count);
    if (count > near.size()) fail(show(n.count) + " vertices asked for, there are " + std::to_string(near.size()));
    std::vector<double> distances;
    for (const auto& [i, distance] : near) distances.push_back(double(distance));
    const auto last = distances.begin() + (n.count - 1);
    std::nth_element(distances.begin(), last, distances.end());
    const double tolerance = detail::place_tolerance(mesh), least = *last - tolerance, most = *last + tolerance;
    std::vector<std::uint32_t> ids;
    for (const auto& [i, distance] : near) {
      if (distance < least) ids.push_back(i);
    }
    for (std::size_t k = 0; k < near.size() && ids.size() < count; ++k) {
      if (near[k].second >= least && near[k].second <= most) ids.push_back(near[k].first);
    }
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  /// Of vertices of the surface.
  std::vector<std::uint32_t> operator()(const Selection::Facing& facing) const {
    try {
      const Vec3d place = facing_point(mesh, facing.at, facing.direction);
      return Picker{mesh, selection, label, surface_vertices(mesh)}(Selection::Nearest{place, facing.count});
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }
  std::vector<std::uint32_t> operator()(const Selection::Ids& list) const {
    std::vector<std::uint32_t> ids = list.vertices;
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const std::uint32_t i : ids) {
      if (i >= mesh.vertices.size()) {
        fail("vertex " + std::to_string(i) + " does not exist; allowed: 0 to " +
             std::to_string(mesh.vertices.size() - 1));
      }
      if (!std::binary_search(among.begin(), among.end(), i)) {
        fail("vertex " + std::to_string(i) + " is not on the surface; leave it out or set surface_only = false");
      }
    }
    return ids;
  }
};

}  // namespace

std::vector<std::uint32_t> select_vertices(const TetMesh& mesh, const std::string& name, const Selection& selection) {
  const std::string label = selection.origin.empty() ? "sets." + name : selection.origin;
  const Picker pick{mesh, selection, label, vertices_among(mesh, selection)};
  return std::visit(pick, selection.where);
}

std::vector<std::size_t> tets_within(const TetMesh& mesh, const RegionSpec& region) {
  const auto beyond = std::visit([&](const auto& where) { return bounds_of(mesh, where); }, region.where);
  const double tolerance = detail::place_tolerance(mesh);
  std::vector<std::size_t> found;
  for (std::size_t t = 0; beyond && t < mesh.tets.size(); ++t) {
    if (beyond(centroid(mesh, t)) <= tolerance) found.push_back(t);
  }
  return found;
}

std::string extent_text(const TetMesh& mesh) {
  const auto [low, high] = box_of(mesh);
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    text += (i ? ", " : "") + std::string(1, "xyz"[i]) + " " + show(low[i]) + " to " + show(high[i]) + " m";
  }
  return text;
}

std::string no_such_set(const std::string& name, std::span<const std::string> known) {
  return no_vertex_set(name, known) + (known.empty() ? ": pick vertices with [sets." + name + "]" : "");
}

int region_number(const TetMesh& mesh, const std::string& name) {
  for (const auto& [number, own_name] : mesh.region_names) {
    if (own_name == name) return number;
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (std::to_string(mesh.region_of(t)) == name) return mesh.region_of(t);
  }
  return -1;
}

}  // namespace glisson::scene

namespace glisson {

NearBounds near_bounds(const TetMesh& mesh, const Selection& selection) {
  using namespace scene;
  const auto beyond = std::visit([&](const auto& where) { return bounds_of(mesh, where); }, selection.where);
  const std::vector<std::uint32_t> among = vertices_among(mesh, selection);
  return count_near(mesh, beyond, among.size(), [&](std::size_t i) { return mesh.vertices[among[i]]; });
}

NearBounds near_bounds(const TetMesh& mesh, const RegionSpec& region) {
  using namespace scene;
  const auto beyond = std::visit([&](const auto& where) { return bounds_of(mesh, where); }, region.where);
  return count_near(mesh, beyond, mesh.tets.size(), [&](std::size_t t) { return centroid(mesh, t); });
}

}  // namespace glisson

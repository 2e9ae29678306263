#include "scene/parse/select.h"

#include <algorithm>
#include <numeric>

#include "mesh/inspect/vertex_set.h"
#include "scene/parse/section.h"

namespace glisson::scene {
namespace {

struct Extent {
  Vec3d min, max;
};

Extent extent_of(const TetMesh& mesh) {
  Extent e{mesh.vertices.front(), mesh.vertices.front()};
  for (const Vec3d& x : mesh.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      e.min[i] = std::min(e.min[i], x[i]);
      e.max[i] = std::max(e.max[i], x[i]);
    }
  }
  return e;
}

std::string text_of(const Vec3d& x) { return Codec<Vec3d>::show(x); }

bool inside(const Selection::Box& box, const Vec3d& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (x[i] < box.min[i] || x[i] > box.max[i]) return false;
  }
  return true;
}

bool inside(const Selection::Sphere& ball, const Vec3d& x) { return norm(x - ball.center) <= ball.radius; }

std::string asked(const Selection::Box& b) { return "the box from " + text_of(b.min) + " to " + text_of(b.max) + " m"; }
std::string asked(const Selection::Sphere& s) {
  return "the ball of " + show(s.radius) + " m about " + text_of(s.center);
}
std::string asked(const Selection::Side& s) {
  return std::string("the ") + (s.upper ? "upper" : "lower") + " end of " + "xyz"[s.axis] + ", " + show(s.depth) +
         " m deep";
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

/// Picks among some vertices; one overload a way to pick.
struct Picker {
  const TetMesh& mesh;
  const Selection& selection;
  std::string label;
  std::vector<std::uint32_t> among;

  [[noreturn]] void fail(const std::string& what) const { throw SceneError(label + ": " + what); }

  template <class Test>
  std::vector<std::uint32_t> where(const std::string& what, Test test) const {
    std::vector<std::uint32_t> found;
    std::copy_if(among.begin(), among.end(), std::back_inserter(found), [&](auto i) { return test(mesh.vertices[i]); });
    if (found.empty()) {
      fail("no vertex" + std::string(selection.surface_only ? " of the surface" : "") + " lies in " + what +
           "; the mesh spans " + extent_text(mesh));
    }
    return found;
  }

  std::vector<std::uint32_t> operator()(const Selection::Box& b) const {
    return where(asked(b), [&](const Vec3d& x) { return inside(b, x); });
  }
  std::vector<std::uint32_t> operator()(const Selection::Sphere& s) const {
    return where(asked(s), [&](const Vec3d& x) { return inside(s, x); });
  }
  std::vector<std::uint32_t> operator()(const Selection::Side& s) const {
    const Extent e = extent_of(mesh);
    const auto axis = static_cast<std::size_t>(s.axis);
    // A grid's coordinates carry rounding: a layer that is nominally at the depth belongs to it.
    const double reach = s.depth + 1e-9 * (e.max[axis] - e.min[axis]);
    return where(asked(s), [&](const Vec3d& x) {
      return s.upper ? x[axis] >= e.max[axis] - reach : x[axis] <= e.min[axis] + reach;
    });
  }
  std::vector<std::uint32_t> operator()(const Selection::Nearest& n) const {
    const auto count = static_cast<std::size_t>(n.count);
    if (count > among.size()) fail(show(n.count) + " vertices asked for, there are " + std::to_string(among.size()));
    std::vector<std::uint32_t> ids = among;
    const auto closer = [&](std::uint32_t a, std::uint32_t b) {
      const double da = norm(mesh.vertices[a] - n.point), db = norm(mesh.vertices[b] - n.point);
      return da < db || (da == db && a < b);
    };
    std::partial_sort(ids.begin(), ids.begin() + n.count, ids.end(), closer);
    ids.resize(count);
    std::sort(ids.begin(), ids.end());
    return ids;
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
  const Picker pick{mesh, selection, label, selection.surface_only ? surface_vertices(mesh) : all_vertices(mesh)};
  return std::visit(pick, selection.where);
}

std::vector<std::size_t> tets_within(const TetMesh& mesh, const RegionSpec& region) {
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d centroid{};
    for (const std::uint32_t i : mesh.tets[t]) centroid += mesh.vertices[i] * 0.25;
    const auto* box = std::get_if<Selection::Box>(&region.where);
    const auto* ball = std::get_if<Selection::Sphere>(&region.where);
    if ((box && inside(*box, centroid)) || (ball && inside(*ball, centroid))) found.push_back(t);
  }
  return found;
}

std::string extent_text(const TetMesh& mesh) {
  const Extent e = extent_of(mesh);
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    text += (i ? ", " : "") + std::string(1, "xyz"[i]) + " " + show(e.min[i]) + " to " + show(e.max[i]) + " m";
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

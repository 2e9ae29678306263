#include "compare/models/boundary.h"

#include <algorithm>

namespace glisson::models {
namespace {

void mark(std::vector<bool>& prescribed, std::span<const std::uint32_t> vertices, const Axes& axes) {
  for (const std::uint32_t v : vertices) {
    if (axes.x) prescribed[3 * v] = true;
    if (axes.y) prescribed[3 * v + 1] = true;
    if (axes.z) prescribed[3 * v + 2] = true;
  }
}

void take(Vec3d& into, const Vec3d& from, const Axes& axes) {
  if (axes.x) into.x = from.x;
  if (axes.y) into.y = from.y;
  if (axes.z) into.z = from.z;
}

}  // namespace

Vec3d tool_displacement(const Tool& tool, const Vec3d& rest, double time) {
  if (time <= tool.start) return {};
  if (const auto* motion = std::get_if<Motion>(&tool.motion)) return (*motion)(time);
  return std::get<PoseMotion>(tool.motion)(time).to_space(rest) - rest;
}

Boundary::Boundary(const Problem& problem) : problem_(problem), prescribed_(3 * problem.mesh.vertices.size(), false) {
  for (const Support& support : problem.supports) mark(prescribed_, support.vertices, support.axes);
  for (const Tool& tool : problem.tools) mark(prescribed_, tool.vertices, tool.axes);
}

void Boundary::set(double time, std::vector<Vec3d>& displacement) const {
  for (const Support& support : problem_.supports) {
    for (const std::uint32_t v : support.vertices) take(displacement[v], {}, support.axes);
  }
  for (const Tool& tool : problem_.tools) {
    for (const std::uint32_t v : tool.vertices) {
      take(displacement[v], tool_displacement(tool, problem_.mesh.vertices[v], time), tool.axes);
    }
  }
}

Vec3d Boundary::force(const std::vector<Vec3d>& own, const std::vector<Vec3d>& displacement) const {
  Vec3d sum;
  const auto add = [&](std::span<const std::uint32_t> vertices, const Axes& axes) {
    for (const std::uint32_t v : vertices) {
      Vec3d f;
      take(f, -own[v], axes);
      sum += problem_.moment_about ? cross(problem_.mesh.vertices[v] + displacement[v] - *problem_.moment_about, f) : f;
    }
  };
  if (!problem_.tools.empty()) {
    add(problem_.tools.front().vertices, problem_.tools.front().axes);
  } else if (!problem_.supports.empty()) {
    add(problem_.supports.front().vertices, problem_.supports.front().axes);
  }
  return sum;
}

double youngs_modulus(const LameParameters& lame) {
  return lame.mu * (3.0 * lame.lambda + 2.0 * lame.mu) / (lame.lambda + lame.mu);
}

std::vector<double> lumped_masses(const Problem& problem) {
  std::vector<double> masses(problem.mesh.vertices.size(), 0.0);
  for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
    const double quarter = problem.tissue_of(t).density * six_rest_volume(problem.mesh, t) / 24.0;
    for (const std::uint32_t v : problem.mesh.tets[t]) masses[v] += quarter;
  }
  return masses;
}

RestTet rest_tet(const TetMesh& mesh, std::size_t tet) {
  const Tet& v = mesh.tets[tet];
  const auto& x = mesh.vertices;
  const double six = six_rest_volume(mesh, tet);
  const Vec3d a = x[v[1]] - x[v[0]], b = x[v[2]] - x[v[0]], c = x[v[3]] - x[v[0]];
  RestTet rest;
  rest.volume = six / 6.0;
  rest.s[1] = cross(b, c) * (1.0 / six);
  rest.s[2] = cross(c, a) * (1.0 / six);
  rest.s[3] = cross(a, b) * (1.0 / six);
  rest.s[0] = -(rest.s[1] + rest.s[2] + rest.s[3]);
  return rest;
}

Mat3d deformation_gradient(const RestTet& rest, const Tet& tet, const std::vector<Vec3d>& displacement) {
  Mat3d f = identity<double>();
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3d& u = displacement[tet[a]];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) f(i, j) += u[i] * rest.s[a][j];
    }
  }
  return f;
}

std::vector<std::array<std::uint32_t, 2>> mesh_edges(const TetMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) edges.push_back({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace glisson::models

// ball.h — a ball of tets without a direction, for closed forms that depend on the radius alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "glisson/mesh.h"
#include "glisson/mesh_refinement.h"

namespace glisson::test {

/// An icosahedron of 20 tets around its middle, each split into eight some times, whose shells are moved onto spheres. Of its edges many have
/// obtuse tets on both sides. Sets: "wall" and "middle".
/// @param splits  20 · 8^splits tets
inline TetMesh ball_mesh(double radius, int splits) {
  constexpr double kGolden = std::numbers::phi;
  TetMesh mesh;
  mesh.vertices.push_back({});
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-kGolden, kGolden}) {
      for (const Vec3d& x : {Vec3d{0, a, b}, Vec3d{a, b, 0}, Vec3d{b, 0, a}}) mesh.vertices.push_back(x);
    }
  }
  // Edges are 2 long, all other distances more. A face's normal is the mean of its corners.
  std::vector<Vec3d> normals;
  const auto beside = [&](std::uint32_t i, std::uint32_t j) { return norm(mesh.vertices[i] - mesh.vertices[j]) < 2.1; };
  for (std::uint32_t i = 1; i < 13; ++i) {
    for (std::uint32_t j = i + 1; j < 13; ++j) {
      for (std::uint32_t k = j + 1; k < 13; ++k) {
        if (!beside(i, j) || !beside(j, k) || !beside(k, i)) continue;
        const Vec3d &p = mesh.vertices[i], &q = mesh.vertices[j], &r = mesh.vertices[k];
        mesh.tets.push_back(dot(p, cross(q, r)) > 0.0 ? Tet{0, i, j, k} : Tet{0, i, k, j});
        normals.push_back((p + q + r) * (1.0 / 3.0));
      }
    }
  }
  for (int s = 0; s < splits; ++s) mesh = refined(mesh);
  std::vector<std::uint32_t> wall;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    Vec3d& x = mesh.vertices[v];
    double shell = 0.0;  // 1 on the surface
    for (const Vec3d& n : normals) shell = std::max(shell, dot(n, x) / dot(n, n));
    if (shell > 1.0 - 1e-9) wall.push_back(v);
    if (v > 0) x = x * (radius * shell / norm(x));
  }
  mesh.vertex_sets["wall"] = std::move(wall), mesh.vertex_sets["middle"] = {0};
  return mesh;
}

}  // namespace glisson::test

// experiments.h — small experiments that have an answer by hand, for the models that the engine is compared with.
#pragma once

#include "compare/models/rival.h"

namespace glisson::models {

inline constexpr double kYoung = 3600.0, kPoisson = 0.4, kEdge = 0.02;

/// A cube of this edge and tissue, at rest: nothing is held.
inline Problem cube(std::array<int, 3> cells = {2, 2, 2}) {
  Problem problem;
  problem.mesh = box_mesh({.cells = cells, .size = {kEdge, kEdge, kEdge}, .split = BoxSplit::alternating});
  problem.tissues[0] = Tissue{.youngs_modulus = kYoung, .poisson_ratio = kPoisson};
  problem.motion.damping_rate = 30.0;
  problem.duration = 2.0;
  problem.stations = {1.0, 2.0};
  return problem;
}

inline Motion ramp_to(const Vec3d& end, double duration) {
  return [=](double t) { return end * std::min(1.0, t / duration); };
}

/// Stretched along z by a strain, free to contract: the sides x_min, y_min and z_min are planes of symmetry.
inline Problem stretched(double strain, std::array<int, 3> cells = {2, 2, 2}) {
  Problem p = cube(cells);
  p.tools.push_back({p.mesh.vertex_set("z_max"), {false, false, true}, ramp_to({0, 0, strain * kEdge}, p.duration)});
  p.supports.push_back({p.mesh.vertex_set("x_min"), {true, false, false}});
  p.supports.push_back({p.mesh.vertex_set("y_min"), {false, true, false}});
  p.supports.push_back({p.mesh.vertex_set("z_min"), {false, false, true}});
  return p;
}

/// Every vertex is moved to (1 + strain) x; the force of vertex `first` is read.
inline Problem dilated(double strain, std::uint32_t first, std::array<int, 3> cells) {
  Problem p = cube(cells);
  const auto add = [&](std::uint32_t v) {
    p.tools.push_back({{v}, {}, ramp_to(p.mesh.vertices[v] * strain, p.duration)});
  };
  add(first);
  for (std::uint32_t v = 0; v < p.mesh.vertices.size(); ++v) {
    if (v != first) add(v);
  }
  return p;
}

/// Contraction over stretch along x, where no side is held.
inline double contraction(const Problem& p, const Answer& answer, double strain) {
  double sum = 0.0;
  const auto& side = p.mesh.vertex_set("x_max");
  for (const std::uint32_t v : side) sum += answer.displacement[v].x;
  return -sum / static_cast<double>(side.size()) / (strain * kEdge);
}

}  // namespace glisson::models

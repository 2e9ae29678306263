// surface_load.h — bodies, options and supports that the tests of loads on faces have in common.
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/state/loads.h"
#include "glisson/glisson.h"
#include "support/bodies.h"

namespace glisson::surface_load_test {

inline SimulationOptions with(Integrator integrator) {
  SimulationOptions o;
  o.integrator = integrator;
  o.precision = Precision::double_precision;
  return o;
}

/// The vertex nearest to a place.
inline std::uint32_t vertex_at(const TetMesh& mesh, const Vec3d& place) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (norm(mesh.vertices[v] - place) < norm(mesh.vertices[best] - place)) best = v;
  }
  return best;
}

/// Holds the six rigid motions of a box at three of its corners, which a box in equilibrium does not feel.
inline void hold_three_corners(Simulation& s, const Vec3d& size) {
  s.fix(std::vector{vertex_at(s.mesh(), {0, 0, 0})});
  s.fix(std::vector{vertex_at(s.mesh(), {size.x, 0, 0})}, {false, true, true});
  s.fix(std::vector{vertex_at(s.mesh(), {0, size.y, 0})}, {false, false, true});
}

inline Tissue linear_tissue() {
  Tissue t;
  t.youngs_modulus = 10000.0;
  t.poisson_ratio = 0.3;
  return t;
}

inline Tissue neo_hookean(double mu, double bulk_modulus) {
  Tissue t;
  t.hyperelastic = NeoHookean{.mu = mu, .bulk_modulus = bulk_modulus};
  return t;
}

/// Loads on a body in a state, without a simulation.
struct Loaded {
  explicit Loaded(const TetMesh& mesh) : body(build_body(mesh, {{0, Tissue{}}})), loads(mesh.vertices.size()) {}
  Body body;
  Loads loads;
};

}  // namespace glisson::surface_load_test

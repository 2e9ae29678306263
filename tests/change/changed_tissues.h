// changed_tissues.h — bodies in two regions whose tissues change, and the kinds of tissue they change between.
#pragma once

#include <gtest/gtest.h>

#include "glisson/instruments/motion.h"
#include "support/bodies.h"

namespace glisson::test {

/// A box in two regions, the second above z = 0.04.
inline TetMesh two_regions() {
  TetMesh mesh = paper_mesh();
  for (const Tet& t : mesh.tets) {
    double z = 0.0;
    for (const std::uint32_t v : t) z += 0.25 * mesh.vertices[v].z;
    mesh.regions.push_back(z < 0.04 ? 0 : 1);
  }
  return mesh;
}

inline Simulation held_and_loaded(const TetMesh& mesh, const std::map<int, Tissue>& tissues,
                                  const SimulationOptions& o) {
  Simulation s(mesh, tissues, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  s.drive(paper_triangle(), press({.velocity = 0.05, .depth = 0.005, .start = 0.0, .hold = 1.0}));
  s.add_load(mesh.vertex_sets.at("x_max"), {0.05, 0.0, 0.0});
  return s;
}

inline void run(Simulation& s, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_LE(s.step().status, StepStatus::inverted);
}

/// Tissues of every way in which the engine can hold one.
inline std::vector<Tissue> kinds() {
  std::vector<Tissue> all(9);
  for (Tissue& t : all) t.youngs_modulus = 5000.0;
  all[1].viscosity = 4.0;
  all[2].law = LinearLaw{40000.0};
  all[3].kinematics = Kinematics::green, all[3].viscosity = 3.0;
  all[4].hyperelastic = NeoHookean{.mu = 1500.0, .bulk_modulus = 8000.0};
  all[5].kinematics = Kinematics::corotational, all[5].maxwell = {{0.3, 0.02}, {0.2, 0.5}};
  all[6].volume_change = VolumeChange::average_nodal, all[6].density = 1300.0;
  all[7].fibres = Fibres{{1.0, 0.0, 1.0}, 4000.0};
  all[8].measure = DeformationMeasure::solid_angle, all[8].law = LinearLaw{40000.0};  // no lanes: in double
  return all;
}

}  // namespace glisson::test

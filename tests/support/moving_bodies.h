// moving_bodies.h — a body below the simulation, driven by hand: what engine and determinism tests step.
#pragma once

#include <map>
#include <random>
#include <vector>

#include "element/body.h"
#include "engine/moving_body.h"
#include "support/bodies.h"

namespace glisson::test {

/// A jittered cube of a stiffening, a linear, a relaxing hyperelastic and a fibrous corotational tissue, from a random
/// state: held at the bottom, its top pushed down at 0.1 m/s, under gravity and damping.
struct BusyBody {
  std::mt19937 random{17};
  TetMesh mesh;
  std::map<int, Tissue> tissues;
  Body body;
  std::vector<double> damping;  ///< γ_i [kg/s]
  std::vector<Vec3d> u, v;      ///< the state it starts from
  std::vector<std::uint32_t> watched;
  double h = 0.0;  ///< half the stable step at rest [s]

  /// @param cells  cubes along each edge: 6 cells³ tets
  explicit BusyBody(int cells) {
    mesh = jittered_box({cells, cells, cells}, 0.06 / cells, 0.2, random);
    for (const Tet& t : mesh.tets) {
      const Vec3d x = mesh.vertices[t[0]], y = mesh.vertices[t[1]];
      mesh.regions.push_back((x.x + 0.4 * y.y < 0.04 ? 1 : 0) + (x.z + 0.3 * y.x < 0.035 ? 2 : 0));
    }
    Tissue law, linear, relaxing, fibrous;
    relaxing.hyperelastic = NeoHookean{.mu = 900.0, .bulk_modulus = 6000.0};
    relaxing.maxwell = {{.share = 0.3, .time = 0.02}, {.share = 0.2, .time = 0.5}};
    relaxing.volume_change = VolumeChange::average_nodal;
    fibrous.kinematics = Kinematics::corotational, fibrous.viscosity = 0.5;
    fibrous.fibres = Fibres{.direction = {1.0, 2.0, 0.5}, .stiffness = 2000.0};
    law.viscosity = 1.0, law.law = ExponentialLaw{.amplitude = 1000.0, .rate = 5.0};
    linear.youngs_modulus = 2000.0, linear.viscosity = 0.5;
    tissues = {{0, law}, {1, linear}, {2, relaxing}, {3, fibrous}};
    body = build_body(mesh, tissues);
    u = random_field(mesh.vertices.size(), 0.03 * 0.06 / cells, random);
    v = random_field(mesh.vertices.size(), 0.05, random);
    std::uniform_real_distribution<double> rate(0.0, 20.0);
    for (const double m : body.masses) damping.push_back(m * rate(random));
    for (const char* set : {"z_min", "z_max"}) {
      for (const std::uint32_t i : mesh.vertex_sets.at(set)) watched.push_back(i), u[i] = v[i] = {};
    }
    h = 0.5 * Simulation(mesh, tissues).stable_step();
  }

  void start(MovingBody& moving) const {
    moving.watch(watched, watched);
    moving.set_state(u, v);
  }

  /// One step, and the top one step down.
  const Advance& step(MovingBody& moving, bool accounted) const {
    const Advance& advance = moving.advance(h, {0.0, 0.0, -9.81}, accounted);
    const double middle = 0.03;
    for (ActiveVertex& w : moving.active()) {
      if (mesh.vertices[w.vertex].z < middle) continue;
      w.velocity = {0.0, 0.0, -0.1};
      w.displacement += w.velocity * h;
    }
    moving.place_active();
    return advance;
  }
};

}  // namespace glisson::test

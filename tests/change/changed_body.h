// changed_body.h — bodies that lose tets or are split in a test, and the body they are compared with.
//
// The yardstick of every change: a body built anew from present_mesh() feels the same forces in the same state.
// Forces are read off a step: F = m (v₊ − v₋) / h, with h given and far below h*, no nodal damping.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "glisson/simulation/simulation.h"
#include "support/bodies.h"

namespace glisson::test {

using Tissues = std::map<int, Tissue>;

/// Step for reading forces: a thousandth of h* of the bodies here [s].
inline constexpr double kProbeStep = 1e-6;

inline Tissue linear_tissue() { return {}; }

inline Tissue viscous_tissue() {
  Tissue tissue;
  tissue.viscosity = 3.0;
  return tissue;
}

inline Tissue law_tissue() {
  Tissue tissue = viscous_tissue();
  tissue.youngs_modulus = 5000.0;
  tissue.law = ExponentialLaw{.amplitude = 800.0, .rate = 5.0};
  return tissue;
}

/// Relaxing, in volumes of its own: what a body built anew has forgotten is the same here, since states that are set
/// have relaxed.
inline Tissue hyperelastic_tissue() {
  Tissue tissue;
  tissue.hyperelastic = MooneyRivlin{.c10 = 400.0, .c01 = 150.0, .bulk_modulus = 6000.0};
  tissue.maxwell = {{.share = 0.4, .time = 0.1}};
  return tissue;
}

/// Fibres, shared volumes, viscosity.
inline Tissue fibrous_tissue() {
  Tissue tissue = viscous_tissue();
  tissue.kinematics = Kinematics::corotational;
  tissue.fibres = Fibres{.direction = {1.0, 0.5, -0.2}, .stiffness = 2000.0};
  tissue.volume_change = VolumeChange::average_nodal;
  return tissue;
}

/// A tissue and a precision: what the tests of this folder are repeated for.
struct Kind {
  std::string name;
  Tissue tissue;
  Precision precision;

  /// Of forces, over the largest. Both bodies add the same numbers; lanes and submeshes do so in another order, which
  /// is a few roundings of 6e-8.
  double tolerance() const { return precision == Precision::double_precision ? 1e-14 : 1e-6; }
  SimulationOptions options(std::optional<double> step = kProbeStep) const {
    SimulationOptions o;
    o.step = step;
    o.precision = precision;
    return o;
  }
};

inline std::vector<Kind> every_kind() {
  const Precision one = Precision::single_precision, two = Precision::double_precision;
  return {{"linear", linear_tissue(), one},
          {"viscous", viscous_tissue(), one},
          {"law", law_tissue(), one},
          {"hyperelastic", hyperelastic_tissue(), one},
          {"fibrous", fibrous_tissue(), one},
          {"hyperelastic_in_double", hyperelastic_tissue(), two},
          {"fibrous_in_double", fibrous_tissue(), two},
          {"linear_in_double", linear_tissue(), two},
          {"viscous_in_double", viscous_tissue(), two},
          {"law_in_double", law_tissue(), two}};
}

inline std::string kind_name(const testing::TestParamInfo<Kind>& p) { return p.param.name; }
inline void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

struct FieldState {
  std::vector<Vec3d> u, v;
};

inline FieldState state_of(const Simulation& s) {
  return {{s.displacement().begin(), s.displacement().end()}, {s.velocity().begin(), s.velocity().end()}};
}

/// Up to 10 % strain and 10/s of its rate, another one at each vertex.
inline FieldState random_state(const TetMesh& mesh, double cell, std::mt19937& random) {
  return {random_field(mesh.vertices.size(), 0.05 * cell, random), random_field(mesh.vertices.size(), cell, random)};
}

/// Total force on each vertex in the state that the next step starts from; makes that step. [N]
inline std::vector<Vec3d> forces_by_step(Simulation& s) {
  const FieldState before = state_of(s);
  const double h = s.step_size();
  EXPECT_NE(s.step().status, StepStatus::not_finite);
  std::vector<Vec3d> forces(before.v.size());
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = (s.velocity()[i] - before.v[i]) * (s.masses()[i] / h);
  return forces;
}

inline std::vector<Vec3d> forces_in(Simulation& s, const FieldState& state) {
  s.set_state(state.u, state.v);
  return forces_by_step(s);
}

/// The forces of a body changed by removals and splits and those of one built anew, in the same state.
inline void expect_as_built_anew(Simulation& changed, const Tissues& tissues, const SimulationOptions& options,
                                 const FieldState& state, double tolerance) {
  Simulation anew(changed.present_mesh(), tissues, options);
  const std::vector<Vec3d> got = forces_in(changed, state), expected = forces_in(anew, state);
  EXPECT_LE(relative_difference(got, expected), tolerance);
  EXPECT_TRUE(std::equal(changed.masses().begin(), changed.masses().end(), anew.masses().begin()));
}

/// `count` different numbers below `n`.
inline std::vector<std::uint32_t> choose(std::size_t count, std::size_t n, std::mt19937& random) {
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0U);
  for (std::size_t i = 0; i < count; ++i) std::swap(all[i], all[i + random() % (n - i)]);
  all.resize(count);
  return all;
}

/// Tets whose rest centroid is where `inside` says.
template <class Inside>
std::vector<std::uint32_t> tets_where(const TetMesh& mesh, const Inside& inside) {
  std::vector<std::uint32_t> tets;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3d sum{};
    for (const std::uint32_t v : mesh.tets[t]) sum += mesh.vertices[v];
    if (inside(sum * 0.25)) tets.push_back(t);
  }
  return tets;
}

/// Sum of m v [kg m/s].
inline Vec3d momentum(const Simulation& s) {
  Vec3d sum{};
  for (std::size_t i = 0; i < s.masses().size(); ++i) sum += s.velocity()[i] * s.masses()[i];
  return sum;
}

inline double mass(const Simulation& s) { return std::accumulate(s.masses().begin(), s.masses().end(), 0.0); }

}  // namespace glisson::test

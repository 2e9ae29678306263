// engine_run.h — a submesh body set up for a test: which kernels, which cut, and its forces in the mesh's order.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "element/body.h"
#include "engine/submesh_body.h"
#include "support/bodies.h"

namespace glisson::test {

/// The kernels of every instruction set of this machine, the best first.
inline const std::vector<const engine::Kernels*>& every_kernels() {
  static const std::vector<const engine::Kernels*> all = engine::all_kernels();
  return all;
}

/// Elastic and viscous forces of the body on each vertex [N], and what else the evaluation told.
struct EngineForces {
  std::vector<Vec3d> elastic, viscous;
  Advance advance;
};

/// Evaluates the forces without a step. All vertices are active, so that every submesh keeps the two parts apart.
inline EngineForces engine_forces(const Body& body, std::span<const Vec3d> u, std::span<const Vec3d> v,
                                  const engine::SubmeshOptions& options) {
  engine::SubmeshBody moving(body, std::vector<double>(body.vertex_count, 0.0), options);
  std::vector<std::uint32_t> all(body.vertex_count);
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  moving.watch(all, all);
  moving.set_state(u, v);
  EngineForces f;
  f.advance = moving.advance(0.0, {}, false);
  for (const ActiveVertex& w : moving.active()) f.elastic.push_back(w.elastic), f.viscous.push_back(w.viscous);
  return f;
}

/// The state in the mesh's order.
struct EngineState {
  std::vector<Vec3d> u, v;
  bool operator==(const EngineState&) const = default;
};

inline EngineState state_of(const MovingBody& moving, std::size_t vertices) {
  EngineState s{std::vector<Vec3d>(vertices), std::vector<Vec3d>(vertices)};
  moving.read_state(s.u, s.v);
  return s;
}

/// The name of an instruction set as that of a test.
inline std::string kernels_name(const testing::TestParamInfo<const engine::Kernels*>& p) {
  return p.param->instruction_set;
}

}  // namespace glisson::test

namespace glisson::engine {
/// What a failed test says of its parameter.
inline void PrintTo(const Kernels* kernels, std::ostream* out) { *out << kernels->instruction_set; }
}  // namespace glisson::engine

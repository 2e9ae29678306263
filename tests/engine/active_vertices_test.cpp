// Active vertices stand still, are told the forces on them, and go where they are placed; all others move as ever.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/engine_run.h"

namespace glisson {
namespace {

using Vertices = std::vector<std::uint32_t>;

class Watch : public testing::TestWithParam<const engine::Kernels*> {
 protected:
  std::mt19937 random_{21};
  TetMesh mesh_ = test::jittered_box({6, 6, 6}, 0.01, 0.2, random_);
  Body body_ = make_body();
  std::size_t n_ = mesh_.vertices.size();
  std::vector<double> undamped_ = std::vector<double>(n_, 0.0);
  std::vector<Vec3d> u_ = test::random_field(n_, 1e-3, random_), v_ = test::random_field(n_, 1e-2, random_);
  engine::SubmeshOptions options_{.threads = 1, .kernels = GetParam(), .submesh_tets = 150};

  Body make_body() {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      mesh_.regions.push_back(mesh_.vertices[mesh_.tets[t][0]].z < 0.03);
    Tissue law, linear;
    law.viscosity = linear.viscosity = 2.0;
    law.law = LinearLaw{20000.0};
    return build_body(mesh_, {{0, law}, {1, linear}});
  }

  /// Three sets that overlap, of interface vertices and others; every submesh has vertices of neither.
  std::vector<Vertices> sets() {
    std::vector<Vertices> out(3);
    for (std::uint32_t v = 0; v < n_; ++v) {
      if (v % 17 == 0) out[0].push_back(v);
      if (v % 23 < 2) out[1].push_back(v);
      if (v % 34 == 0) out[2].push_back(v);
    }
    std::reverse(out[1].begin(), out[1].end());
    return out;
  }
  Vertices union_of_sets() {
    Vertices all;
    for (const Vertices& set : sets()) all.insert(all.end(), set.begin(), set.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
};

// Sets active one after the other add up to their union, and cover interiors and interfaces both.
TEST_P(Watch, SetsAddUp) {
  engine::SubmeshBody moving(body_, undamped_, options_);
  for (const Vertices& set : sets()) moving.watch(set, union_of_sets());
  const Vertices expected = union_of_sets();
  ASSERT_EQ(moving.active().size(), expected.size());
  std::size_t between = 0;
  const engine::Submeshes& submeshes = moving.submeshes();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(moving.active()[i].vertex, expected[i]);
    between += submeshes.record_of_vertex[expected[i]] >= submeshes.interface.first_record ? 1 : 0;
  }
  EXPECT_GT(between, 5U);
  EXPECT_GT(expected.size() - between, 5U);
}

// Their forces and states are those that a body with all vertices active tells, to the rounding of another sum.
TEST_P(Watch, TellsForcesAndStates) {
  const test::EngineForces all = test::engine_forces(body_, u_, v_, options_);
  for (const bool accounted : {false, true}) {
    engine::SubmeshBody moving(body_, undamped_, options_);
    for (const Vertices& set : sets()) moving.watch(set, union_of_sets());
    moving.set_state(u_, v_);
    moving.advance(1e-5, {0.0, 0.0, -9.81}, accounted);
    std::vector<Vec3d> elastic, viscous, expected_elastic, expected_viscous;
    for (const ActiveVertex& w : moving.active()) {
      elastic.push_back(w.elastic), viscous.push_back(w.viscous);
      expected_elastic.push_back(all.elastic[w.vertex]), expected_viscous.push_back(all.viscous[w.vertex]);
      EXPECT_EQ(w.displacement, u_[w.vertex]);
      EXPECT_EQ(w.velocity, v_[w.vertex]);
    }
    EXPECT_LE(test::relative_difference(elastic, expected_elastic), 2e-6);
    EXPECT_LE(test::relative_difference(viscous, expected_viscous), 2e-6);
  }
}

// A step moves all vertices but those, and the others as if none were active: their forces are two floats added
// instead of one sum, which shifts a step by some 1e-6 of its own change.
TEST_P(Watch, StandStillWhileOthersMove) {
  constexpr double h = 1e-4;
  engine::SubmeshBody watching(body_, undamped_, options_), free(body_, undamped_, options_);
  for (const Vertices& set : sets()) watching.watch(set, union_of_sets());
  for (engine::SubmeshBody* moving : {&watching, &free}) {
    moving->set_state(u_, v_);
    moving->advance(h, {0.0, 0.0, -9.81}, false);
  }
  const test::EngineState seen = test::state_of(watching, n_), expected = test::state_of(free, n_);
  const Vertices active = union_of_sets();
  double largest = 0.0;
  for (std::size_t i = 0; i < n_; ++i) largest = std::max(largest, norm(expected.v[i] - v_[i]));
  for (std::uint32_t i = 0; i < n_; ++i) {
    if (std::binary_search(active.begin(), active.end(), i)) {
      EXPECT_EQ(seen.u[i], u_[i]);
      EXPECT_EQ(seen.v[i], v_[i]);
    } else {
      EXPECT_NE(seen.u[i], u_[i]);
      EXPECT_LE(norm(seen.v[i] - expected.v[i]), 2e-6 * largest);
    }
  }
}

// What is let go goes on from where it was placed, with the same bytes as if it had never been active.
TEST_P(Watch, LetsVerticesGo) {
  engine::SubmeshBody letting(body_, undamped_, options_), never(body_, undamped_, options_);
  const Vertices kept = sets()[0];
  for (const Vertices& set : sets()) letting.watch(set, union_of_sets());
  letting.watch_only(kept);
  never.watch(kept, kept);
  for (engine::SubmeshBody* moving : {&letting, &never}) {
    moving->set_state(u_, v_);
    moving->advance(1e-4, {0.0, 0.0, -9.81}, false);
  }
  ASSERT_EQ(letting.active().size(), kept.size());
  EXPECT_EQ(test::state_of(letting, n_), test::state_of(never, n_));
}

// Placing moves exactly those, to where they were told, and a watch taken later tells the placed state.
TEST_P(Watch, PlacingMovesExactlyThose) {
  engine::SubmeshBody moving(body_, undamped_, options_);
  moving.set_state(u_, v_);
  const std::vector<Vertices> all = sets();
  moving.watch(all[0], all[0]);
  moving.watch(all[1], all[1]);
  test::EngineState expected{u_, v_};
  for (ActiveVertex& w : moving.active()) {
    expected.u[w.vertex] = w.displacement = {1e-3 * w.vertex, -1.0, 2.0};
    expected.v[w.vertex] = w.velocity = {0.5, 1e-2 * w.vertex, 0.0};
  }
  moving.place_active();
  EXPECT_EQ(test::state_of(moving, n_), expected);
  moving.watch(all[2], all[2]);
  for (const ActiveVertex& w : moving.active()) {
    EXPECT_EQ(w.displacement, expected.u[w.vertex]);
    EXPECT_EQ(w.velocity, expected.v[w.vertex]);
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Watch, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson

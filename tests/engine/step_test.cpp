// The submesh engine makes the same steps as the element loop in double: the same motion, the same books.
#include <gtest/gtest.h>

#include "engine/element_body.h"
#include "engine/engine_run.h"
#include "support/moving_bodies.h"

namespace glisson {
namespace {

using test::BusyBody;

/// Sums of a run: work of the kicks [J] by the trapezoid of v₋ and v₊, and the last kinetic energy.
struct Books {
  double elastic = 0.0, viscous = 0.0, damping = 0.0, loads = 0.0, kinetic = 0.0;

  void add(const KickWork& w, double h) {
    elastic += 0.5 * h * (w.before.elastic + w.after.elastic);
    viscous += 0.5 * h * (w.before.viscous + w.after.viscous);
    damping += 0.5 * h * (w.before.damping + w.after.damping);
    loads += 0.5 * h * (w.before.loads + w.after.loads);
    kinetic = w.kinetic;
  }
};

Books run(const BusyBody& busy, MovingBody& moving, int steps, bool accounted) {
  Books books;
  busy.start(moving);
  for (int i = 0; i < steps; ++i) books.add(busy.step(moving, accounted).work, busy.h);
  return books;
}

class Step : public testing::TestWithParam<const engine::Kernels*> {
 protected:
  BusyBody busy_{6};
  engine::SubmeshOptions options_{.threads = 1, .kernels = GetParam(), .submesh_tets = 200};
  engine::ElementBody exact_{busy_.body, busy_.damping, Precision::double_precision};
  engine::SubmeshBody moving_{busy_.body, busy_.damping, options_};

  void expect_same_motion(const test::EngineState& a, const test::EngineState& b, double tolerance) const {
    EXPECT_LE(test::relative_difference(a.u, b.u), tolerance) << "displacement";
    EXPECT_LE(test::relative_difference(a.v, b.v), tolerance) << "velocity";
  }
  test::EngineState state(const MovingBody& moving) const { return test::state_of(moving, busy_.body.vertex_count); }
};

// A hundred steps of a stiffening, viscous body of two tissues, held below and pushed above, under gravity and
// damping. Forces differ by 1e-5 at most and by both signs, and what they move stays in double.
TEST_P(Step, MovesAsTheElementLoop) {
  run(busy_, exact_, 100, false);
  run(busy_, moving_, 100, false);
  expect_same_motion(state(moving_), state(exact_), 1e-5);
}

// Each kind of work agrees to 1e-5 of the largest, and the kinetic energy to 1e-5 of itself.
TEST_P(Step, KeepsTheSameBooks) {
  const Books exact = run(busy_, exact_, 100, true), seen = run(busy_, moving_, 100, true);
  expect_same_motion(state(moving_), state(exact_), 1e-5);
  double largest = 0.0;
  for (const double w : {exact.elastic, exact.viscous, exact.damping, exact.loads})
    largest = std::max(largest, std::abs(w));
  EXPECT_NEAR(seen.elastic, exact.elastic, 1e-5 * largest);
  EXPECT_NEAR(seen.viscous, exact.viscous, 1e-5 * largest);
  EXPECT_NEAR(seen.damping, exact.damping, 1e-5 * largest);
  EXPECT_NEAR(seen.loads, exact.loads, 1e-5 * largest);
  EXPECT_NEAR(seen.kinetic, exact.kinetic, 1e-5 * exact.kinetic);
  for (const double w : {exact.elastic, exact.viscous, exact.damping, exact.loads}) {
    EXPECT_GT(std::abs(w), 1e-3 * largest) << "the run does not exercise one of the works";
  }
}

// Accounting changes the order of two sums and nothing else.
TEST_P(Step, MovesTheSameWithoutBooks) {
  engine::SubmeshBody other(busy_.body, busy_.damping, options_);
  run(busy_, moving_, 100, true);
  run(busy_, other, 100, false);
  expect_same_motion(state(other), state(moving_), 1e-5);
}

// A step of length 0 moves nothing, however often.
TEST_P(Step, OfNoLengthMovesNothing) {
  busy_.start(moving_);
  const test::EngineState before = state(moving_);
  for (int i = 0; i < 3; ++i) moving_.advance(0.0, {0.0, 0.0, -9.81}, i % 2 == 0);
  EXPECT_EQ(state(moving_), before);
}

// A vertex in no tet has no mass and no force: it stays, under gravity and damping, and costs the others nothing.
TEST_P(Step, LeavesAVertexInNoTetWhereItIs) {
  Body body = busy_.body;
  std::vector<double> damping = busy_.damping;
  for (const double gamma : {0.0, 1e-3}) {
    ++body.vertex_count, body.masses.push_back(0.0), body.rest_positions.push_back({1.0, 1.0, 1.0});
    damping.push_back(gamma);
  }
  engine::SubmeshBody moving(body, damping, options_);
  std::vector<Vec3d> u = busy_.u, v = busy_.v;
  u.resize(body.vertex_count, {0.1, 0.2, 0.3}), v.resize(body.vertex_count);
  moving.set_state(u, v);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(moving.advance(busy_.h, {0.0, 0.0, -9.81}, i % 2 == 0).finite);
  const test::EngineState end = test::state_of(moving, body.vertex_count);
  for (std::size_t i = busy_.body.vertex_count; i < body.vertex_count; ++i) {
    EXPECT_EQ(end.u[i], u[i]);
    EXPECT_EQ(end.v[i], Vec3d{});
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Step, testing::ValuesIn(test::every_kernels()), test::kernels_name);

// Two hundred steps on one instruction set end where they do on any other: their forces differ by the order of a
// few sums, 1e-6 of the largest. Velocity has it all at the pitch of the mesh, displacement little of it.
TEST(Step, OfEveryInstructionSetIsTheSame) {
  const BusyBody busy(6);
  std::vector<test::EngineState> ends;
  for (const engine::Kernels* kernels : test::every_kernels()) {
    engine::SubmeshBody moving(busy.body, busy.damping, {.threads = 1, .kernels = kernels, .submesh_tets = 200});
    run(busy, moving, 200, false);
    ends.push_back(test::state_of(moving, busy.body.vertex_count));
    EXPECT_LE(test::relative_difference(ends.back().u, ends.front().u), 1e-5) << kernels->instruction_set;
    EXPECT_LE(test::relative_difference(ends.back().v, ends.front().v), 5e-5) << kernels->instruction_set;
  }
}

}  // namespace
}  // namespace glisson

// The engine gives the same bytes on any number of threads, run to run, and beside other bodies.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <optional>
#include <thread>
#include <vector>

#include "engine/submesh_body.h"
#include "support/moving_bodies.h"

namespace glisson {
namespace {

/// oneTBB has as many workers as cores unless told otherwise: eight threads are to be eight on any machine.
class RealThreads : public testing::Environment {
 public:
  void SetUp() override { control_.emplace(oneapi::tbb::global_control::max_allowed_parallelism, 8); }
  void TearDown() override { control_.reset(); }

 private:
  std::optional<oneapi::tbb::global_control> control_;
};
const auto* const kRealThreads = testing::AddGlobalTestEnvironment(new RealThreads);

/// All that a run shows of itself, to the last bit.
struct Trace {
  std::vector<Vec3d> u, v;
  std::vector<double> told;  ///< books, stiffening and watched forces of every step

  bool operator==(const Trace&) const = default;
};

Trace run(const test::BusyBody& busy, int threads, int steps, bool accounted) {
  engine::SubmeshBody moving(busy.body, busy.damping, {.threads = threads, .submesh_tets = 100});
  busy.start(moving);
  Trace trace{std::vector<Vec3d>(busy.body.vertex_count), std::vector<Vec3d>(busy.body.vertex_count), {}};
  for (int i = 0; i < steps; ++i) {
    const Advance& a = busy.step(moving, accounted);
    trace.told.insert(trace.told.end(), a.stiffening.begin(), a.stiffening.end());
    for (const KickPower& p : {a.work.before, a.work.after}) {
      trace.told.insert(trace.told.end(), {p.elastic, p.viscous, p.damping, p.loads});
    }
    trace.told.push_back(a.work.kinetic);
    for (const ActiveVertex& w : moving.active()) trace.told.push_back(norm(w.elastic) + norm(w.viscous));
  }
  moving.read_state(trace.u, trace.v);
  return trace;
}

class EngineThreads : public testing::TestWithParam<bool> {
 protected:
  static const test::BusyBody& busy() {
    static const test::BusyBody body(9);  // 4374 tets in 44 submeshes, and two runs of interface vertices
    return body;
  }
};

// One thread to eight: state, books, stiffness and forces.
TEST_P(EngineThreads, OneToEight) {
  const Trace alone = run(busy(), 1, 60, GetParam());
  for (int threads = 2; threads <= 8; ++threads) {
    EXPECT_TRUE(run(busy(), threads, 60, GetParam()) == alone) << threads << " threads";
  }
}

// Run to run, where the threads meet differently each time.
TEST_P(EngineThreads, RunToRun) {
  const Trace first = run(busy(), 4, 60, GetParam());
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(run(busy(), 4, 60, GetParam()) == first) << "run " << i;
}

// Two bodies at once, each on threads of its own that share oneTBB's workers.
TEST_P(EngineThreads, SideBySide) {
  const Trace alone = run(busy(), 3, 60, GetParam());
  Trace left, right;
  {
    const std::jthread a([&] { left = run(busy(), 3, 60, GetParam()); });
    const std::jthread b([&] { right = run(busy(), 2, 60, GetParam()); });
  }
  EXPECT_TRUE(left == alone);
  EXPECT_TRUE(right == alone);
}

INSTANTIATE_TEST_SUITE_P(Books, EngineThreads, testing::Bool(), [](const testing::TestParamInfo<bool>& p) {
  return std::string(p.param ? "accounted" : "unaccounted");
});

}  // namespace
}  // namespace glisson

// A number that is not finite is told of, stays where it is, and goes when the state is set anew.
#include <gtest/gtest.h>

#include <limits>

#include "engine/engine_run.h"

namespace glisson {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Body two_tissues(TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(mesh.vertices[mesh.tets[t][0]].z < 0.03);
  Tissue law, linear;
  law.viscosity = linear.viscosity = 2.0;
  law.law = ExponentialLaw{500.0, 6.0};
  return build_body(mesh, {{0, law}, {1, linear}});
}

bool is_finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class NotFinite : public testing::TestWithParam<const engine::Kernels*> {
 protected:
  std::mt19937 random_{9};
  TetMesh mesh_ = test::jittered_box({6, 6, 6}, 0.01, 0.2, random_);
  Body body_ = two_tissues(mesh_);
  std::vector<double> undamped_ = std::vector<double>(mesh_.vertices.size(), 0.0);
  std::vector<Vec3d> u_ = test::random_field(mesh_.vertices.size(), 1e-4, random_);
  std::vector<Vec3d> v_ = test::random_field(mesh_.vertices.size(), 1e-2, random_);

  /// Two steps from a state with one bad vertex. @return vertices that are not finite then
  std::vector<std::uint32_t> bad_after(engine::SubmeshBody& moving, std::span<const Vec3d> u, std::span<const Vec3d> v,
                                       bool accounted) {
    moving.set_state(u, v);
    for (int i = 0; i < 2; ++i) EXPECT_FALSE(moving.advance(1e-5, {0.0, 0.0, -9.81}, accounted).finite);
    const test::EngineState s = test::state_of(moving, u_.size());
    std::vector<std::uint32_t> bad;
    for (std::uint32_t i = 0; i < u_.size(); ++i) {
      if (!is_finite(s.u[i]) || !is_finite(s.v[i])) bad.push_back(i);
    }
    return bad;
  }
};

// One bad component of one vertex, in either tissue, inside a submesh or between some: no other vertex takes it over.
TEST_P(NotFinite, IsToldAndDoesNotSpread) {
  engine::SubmeshBody moving(body_, undamped_, {.threads = 2, .kernels = GetParam(), .submesh_tets = 100});
  for (std::uint32_t vertex = 0; vertex < u_.size(); vertex += 13) {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
      std::vector<Vec3d> u = u_, v = v_;
      (vertex % 2 == 0 ? u : v)[vertex][vertex % 3] = bad;
      const auto seen = bad_after(moving, u, v, vertex % 4 < 2);
      EXPECT_EQ(seen, bad == 1e300 ? std::vector<std::uint32_t>{} : std::vector<std::uint32_t>{vertex}) << bad;
    }
  }
}

// After that a body whose state is set anew is as good as a new one.
TEST_P(NotFinite, GoesWithTheState) {
  const engine::SubmeshOptions options{.threads = 1, .kernels = GetParam(), .submesh_tets = 100};
  engine::SubmeshBody moving(body_, undamped_, options), fresh(body_, undamped_, options);
  std::vector<Vec3d> u = u_;
  u[40].y = kNaN;
  bad_after(moving, u, v_, true);
  for (engine::SubmeshBody* body : {&moving, &fresh}) {
    body->set_state(u_, v_);
    EXPECT_TRUE(body->advance(1e-5, {}, true).finite);
  }
  EXPECT_EQ(test::state_of(moving, u_.size()), test::state_of(fresh, u_.size()));
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, NotFinite, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson

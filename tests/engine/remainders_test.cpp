// However the tets fill chains, batches, blocks and submeshes, the forces are the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "engine/engine_run.h"
#include "material/reference/reference.h"
#include "mesh/partition/partition.h"

namespace glisson {
namespace {

/// A body of the first `tets` tets of a jittered box, in a random state.
struct Patch {
  TetMesh mesh;
  std::map<int, Tissue> tissues;
  std::vector<Vec3d> u, v;

  Patch(std::size_t tets, const Tissue& tissue) : tissues{{0, tissue}} {
    std::mt19937 random(static_cast<unsigned>(tets));
    const TetMesh box = test::jittered_box({3, 3, 3}, 0.01, 0.2, random);
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> number(box.vertices.size(), kUnused);
    for (std::size_t t = 0; t < tets; ++t) {
      mesh.tets.push_back(box.tets[t]);
      for (std::uint32_t& vertex : mesh.tets.back()) {
        std::uint32_t& n = number[vertex];
        if (n == kUnused)
          n = static_cast<std::uint32_t>(mesh.vertices.size()), mesh.vertices.push_back(box.vertices[vertex]);
        vertex = n;
      }
    }
    u = test::random_field(mesh.vertices.size(), 0.001, random);
    v = test::random_field(mesh.vertices.size(), 0.01, random);
  }
};

Tissue stiffening() {
  Tissue tissue;
  tissue.viscosity = 5.0;
  tissue.law = LinearLaw{20000.0};
  return tissue;
}
Tissue linear(double viscosity) {
  Tissue tissue;
  tissue.viscosity = viscosity;
  return tissue;
}

class Remainders : public testing::TestWithParam<const engine::Kernels*> {};

// Every number of tets from one to two full batches of the widest lanes, and three more: alone and in chains, in batches
// and blocks that are partly filled. By elements, and by edges with and without viscosity.
TEST_P(Remainders, EveryNumberOfTets) {
  for (const Tissue& tissue : {stiffening(), linear(0.0), linear(5.0)}) {
    for (std::size_t tets = 1; tets <= 2 * engine::kChainTets * engine::kMaxLanes + 3; ++tets) {
      const Patch p(tets, tissue);
      const Body body = build_body(p.mesh, p.tissues);
      const test::EngineForces f = test::engine_forces(body, p.u, p.v, {.threads = 1, .kernels = GetParam()});
      const reference::MeshForces exact = reference::mesh_forces(p.mesh, p.tissues, p.u, p.v);
      // float, as in forces_test.cpp
      EXPECT_LE(test::relative_difference(f.elastic, exact.elastic), 1e-5) << tets << " tets";
      EXPECT_LE(test::relative_difference(f.viscous, exact.viscous), 1e-5) << tets << " tets";
    }
  }
}

// Cut into submeshes of a tet, a few or many, the body has the forces of one submesh, to the rounding of its sums, and
// that one those of the reference. A twentieth of the tets is missing: chains of all lengths, closed fans and open ones.
TEST_P(Remainders, EveryCut) {
  std::mt19937 random(7);
  TetMesh mesh = test::jittered_box({9, 9, 12}, 0.01, 0.2, random, BoxSplit::alternating);
  std::erase_if(mesh.tets, [&](const Tet&) { return random() % 20 == 0; });
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(mesh.vertices[mesh.tets[t][0]].z > 0.09);
  const std::map<int, Tissue> tissues{{0, stiffening()}, {1, linear(5.0)}};
  const Body body = build_body(mesh, tissues);
  const std::vector<Vec3d> u = test::random_field(mesh.vertices.size(), 0.001, random);
  const std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 0.01, random);
  const auto forces = [&](std::size_t tets) {
    return test::engine_forces(body, u, v, {.threads = 1, .kernels = GetParam(), .submesh_tets = tets});
  };
  const test::EngineForces whole = forces(mesh.tets.size());
  const reference::MeshForces exact = reference::mesh_forces(mesh, tissues, u, v);
  EXPECT_LE(test::relative_difference(whole.elastic, exact.elastic), 1e-5);
  EXPECT_LE(test::relative_difference(whole.viscous, exact.viscous), 1e-5);
  for (const std::size_t tets : {1U, 7U, 64U, 1000U}) {
    const test::EngineForces cut = forces(tets);
    EXPECT_LE(test::relative_difference(cut.elastic, whole.elastic), 5e-6) << tets << " tets a submesh";
    EXPECT_LE(test::relative_difference(cut.viscous, whole.viscous), 5e-6) << tets << " tets a submesh";
  }
}

// A submesh whose tets share no vertex has as many local vertices as can be numbered: the forces are those of small submeshes.
TEST_P(Remainders, AsManyVerticesAsCanBeNumbered) {
  std::mt19937 random(11);
  constexpr std::size_t kTets = engine::kMaxLocalVertices / 4;
  TetMesh mesh;
  for (std::uint32_t t = 0; t < kTets; ++t) {
    const Vec3d corner{0.02 * (t % 32), 0.02 * (t / 32 % 32), 0.02 * (t / 1024)};
    for (const Vec3d& edge : {Vec3d{}, Vec3d{0.01, 0, 0}, Vec3d{0, 0.01, 0}, Vec3d{0, 0, 0.01}}) {
      mesh.vertices.push_back(corner + edge);
    }
    mesh.tets.push_back({4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3});
  }
  const std::vector<Vec3d> u = test::random_field(mesh.vertices.size(), 0.001, random);
  const std::vector<Vec3d> v = test::random_field(mesh.vertices.size(), 0.01, random);
  for (const Tissue& tissue : {stiffening(), linear(5.0)}) {
    const Body body = build_body(mesh, {{0, tissue}});
    const auto forces = [&](std::size_t tets) {
      return test::engine_forces(body, u, v, {.threads = 1, .kernels = GetParam(), .submesh_tets = tets});
    };
    const test::EngineForces whole = forces(kTets), parts = forces(500);
    EXPECT_LE(test::relative_difference(whole.elastic, parts.elastic), 1e-5);
    EXPECT_LE(test::relative_difference(whole.viscous, parts.viscous), 1e-5);
  }
  // Edges are found by halves when tets are removed: lane after lane they ascend.
  const std::size_t lanes = GetParam()->lanes;
  const Body body = build_body(mesh, {{0, linear(0.0)}});
  const engine::Submeshes submeshes = engine::build_submeshes(body, lanes, kTets);
  const engine::EdgeBatches& edges = submeshes.parts.at(0).edges;
  std::vector<std::pair<int, int>> in_order;
  for (std::size_t k = 0; k < 6 * kTets; ++k) {
    const std::uint16_t* index = edges.index.data() + k % edges.count * 2 * lanes + k / edges.count;
    in_order.emplace_back(index[0], index[lanes]);
  }
  EXPECT_TRUE(std::is_sorted(in_order.begin(), in_order.end()));
}

// However many tets, a submesh of the size aimed at can lose all connections: partitions exceed it by kPartSlack at most.
TEST(SubmeshTets, LeaveRoomForEveryCorner) {
  EXPECT_EQ(engine::submesh_tets(768, false), 2048U);
  EXPECT_EQ(engine::submesh_tets(96'000, false), 6000U);
  EXPECT_EQ(engine::submesh_tets(96'000, true), 2048U);
  const std::size_t most = engine::submesh_tets(10'000'000, false);
  EXPECT_GT(most, 15'000U);
  EXPECT_LE(4.0 * ((1.0 + detail::kPartSlack) * static_cast<double>(most) + 1.0), engine::kMaxLocalVertices);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Remainders, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson

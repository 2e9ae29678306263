// A push of first Piola–Kirchhoff stresses puts f_a = −V P s_a on the four vertices of each tet, in every instruction
// set, wherever the tet is in its chain.
#include <gtest/gtest.h>

#include <memory>

#include "engine/engine_run.h"

namespace glisson {
namespace {

using engine::Kernels;

constexpr float kThere = 0.015625F;  // a force before [N]; of the size of those added

/// A submesh of one part with a stress of its own in every tet. A twentieth of the tets is missing, so that there are chains
/// of all lengths, closed fans and open ones.
struct Stressed {
  Body body;
  engine::Submeshes submeshes;
  std::size_t lanes;
  std::vector<Mat3d> P;  ///< of each element, of floats [Pa]

  Stressed(int cells, std::size_t lane_count) : lanes(lane_count) {
    std::mt19937 random(5);
    std::map<int, Tissue> tissues{{0, Tissue{}}};
    tissues.at(0).law = LinearLaw{20000.0};
    TetMesh mesh = test::jittered_box({cells, cells, cells}, 0.01, 0.2, random, BoxSplit::alternating);
    std::erase_if(mesh.tets, [&](const Tet&) { return random() % 20 == 0; });
    body = build_body(mesh, tissues);
    submeshes = engine::build_submeshes(body, lanes, body.elements.size());
    std::uniform_real_distribution<float> pressure(-1000.0F, 1000.0F);
    P.resize(body.elements.size());
    for (Mat3d& p : P) {
      for (std::size_t k = 0; k < 9; ++k) p(k / 3, k % 3) = double(pressure(random));
    }
  }
  const engine::Submesh& part() const { return submeshes.parts.at(0); }

  /// The stresses of n batches from `begin`, [item][9][lane]; of lanes without a tet, too: they carry nothing.
  engine::LaneVector<float> lanes_of(std::size_t begin, std::size_t n) const {
    const std::size_t items = engine::kChainTets * n;
    engine::LaneVector<float> out(items * 9 * lanes, 1.0F);
    for (std::size_t i = 0; i < items * lanes; ++i) {
      const std::uint32_t e = part().chains.element[begin * engine::kChainTets * lanes + i];
      if (e == engine::kNoElement) continue;
      for (std::size_t k = 0; k < 9; ++k) out[(i / lanes * 9 + k) * lanes + i % lanes] = float(P[e](k / 3, k % 3));
    }
    return out;
  }
  /// In double, by local vertex.
  std::vector<Vec3d> exact() const {
    std::vector<Vec3d> f(part().local_vertices());
    for (std::size_t e = 0; e < body.elements.size(); ++e) {
      const auto& s = body.rest[e].s;
      const Vec3d gradients[4]{-(s[0] + s[1] + s[2]), s[0], s[1], s[2]};
      for (std::size_t a = 0; a < 4; ++a) {
        f[part().local_of_record(submeshes.record_of_vertex[body.elements[e][a]])] -=
            P[e] * gradients[a] * body.rest[e].volume;
      }
    }
    return f;
  }
};

class PiolaLanes : public testing::TestWithParam<const Kernels*> {};

// Blocks of every length, the last one shorter, added to a force that is there already; by two, which fans need, the two
// chains of fans together. A force is a sum of some 24 terms of three products in float, each within 6e-8 of the largest.
TEST_P(PiolaLanes, ForcesAreMinusVolumeTimesStressTimesGradient) {
  for (const int cells : {1, 2, 5, 12}) {
    const Stressed s(cells, GetParam()->lanes);
    const std::vector<Vec3d> exact = s.exact();
    EXPECT_TRUE(cells < 12 || s.part().chains.pairs > s.part().chains.closed_pairs);
    EXPECT_TRUE(cells < 12 || s.part().chains.closed_pairs > 0);
    for (std::size_t n = 1; n <= engine::kBlockBatches; ++n) {
      engine::LaneVector<float> forces(s.part().local_vertices() * engine::kForceFloats, kThere);
      engine::Elements e;
      e.index = s.part().chains.index.data();
      e.rest = s.part().chains.rest.data();
      if (n % 2 == 0) e.pairs = s.part().chains.pairs, e.closed_pairs = s.part().chains.closed_pairs;
      for (std::size_t b = 0; b < s.part().chains.count; b += n) {
        const std::size_t count = std::min(n, s.part().chains.count - b);
        const engine::LaneVector<float> piola = s.lanes_of(b, count);
        GetParam()->push_piola(e, b, count, piola.data(), forces.data());
      }
      double largest = 0.0, error = 0.0;
      for (std::size_t v = 0; v < exact.size(); ++v) {
        for (std::size_t i = 0; i < 3; ++i) {
          largest = std::max(largest, std::abs(exact[v][i]));
          error =
              std::max(error, std::abs(double(forces[engine::kForceFloats * v + i]) - double(kThere) - exact[v][i]));
        }
      }
      EXPECT_GT(largest, 0.02);
      EXPECT_LE(error, 2e-6 * largest) << cells << " cells, blocks of " << n;
    }
  }
}

// Two stresses pushed at once leave the bytes that each leaves alone.
TEST_P(PiolaLanes, TwoAtOnceLeaveTheForcesOfEach) {
  const Stressed s(12, GetParam()->lanes);
  const std::size_t n = s.part().local_vertices(), floats = n * engine::kForceFloats;
  engine::LaneVector<float> pairs(2 * floats, kThere), apart(2 * floats), first(floats, kThere), second(floats, kThere);
  engine::Elements e;
  e.index = s.part().chains.index.data(), e.rest = s.part().chains.rest.data();
  e.pairs = s.part().chains.pairs, e.closed_pairs = s.part().chains.closed_pairs;
  e.pairs_of_forces = pairs.data();
  for (std::size_t b = 0; b < s.part().chains.count; b += engine::kBlockBatches) {
    const std::size_t count = std::min(engine::kBlockBatches, s.part().chains.count - b);
    const engine::LaneVector<float> piola = s.lanes_of(b, count);
    engine::LaneVector<float> other(piola.rbegin(), piola.rend());
    GetParam()->push_piolas_apart(e, b, count, piola.data(), other.data());
    GetParam()->push_piola(e, b, count, piola.data(), first.data());
    GetParam()->push_piola(e, b, count, other.data(), second.data());
  }
  GetParam()->part_forces(pairs.data(), n, apart.data(), apart.data() + floats);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), apart.begin()));
  EXPECT_TRUE(std::equal(second.begin(), second.end(), apart.begin() + std::ptrdiff_t(floats)));
  EXPECT_NE(first, second);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, PiolaLanes, testing::ValuesIn(test::every_kernels()), test::kernels_name);

}  // namespace
}  // namespace glisson

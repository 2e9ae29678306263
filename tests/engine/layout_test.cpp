// The layout of layout.h holds: nothing lost, nothing twice, every number within its bounds, and it is small.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/engine_run.h"

namespace glisson {
namespace {

using engine::Submesh;
using engine::Submeshes;

struct Layout {
  const char* name;
  std::size_t lanes, target_tets;
};

class LayoutInvariants : public testing::TestWithParam<Layout> {
 protected:
  Body body_ = make_body();
  Submeshes submeshes_ = engine::build_submeshes(body_, GetParam().lanes, GetParam().target_tets);
  std::vector<std::uint32_t> vertex_of_record_ = inverse();

  /// A box of a stiffening and a linear tissue, up to eight tets around an edge, mixed at random along a wavy border.
  static Body make_body() {
    std::mt19937 random(13);
    TetMesh mesh = test::jittered_box({7, 6, 5}, 0.01, 0.2, random, BoxSplit::alternating);
    for (const Tet& t : mesh.tets) mesh.regions.push_back(mesh.vertices[t[0]].x + 0.3 * mesh.vertices[t[1]].y < 0.04);
    std::map<int, Tissue> tissues{{0, Tissue{}}, {1, Tissue{}}};
    tissues.at(0).law = LinearLaw{20000.0};
    return build_body(mesh, tissues);
  }
  std::vector<std::uint32_t> inverse() const {
    std::vector<std::uint32_t> vertex(body_.vertex_count, engine::kNoElement);
    for (std::uint32_t v = 0; v < body_.vertex_count; ++v) vertex.at(submeshes_.record_of_vertex.at(v)) = v;
    return vertex;
  }
  std::size_t record_of(const Submesh& part, std::size_t local) const {
    return local < part.interior_count ? part.first_interior + local : part.shared.at(local - part.interior_count);
  }
  /// The mesh vertex of a stored local index.
  std::uint32_t vertex_of(const Submesh& part, std::uint16_t local) const {
    EXPECT_LT(local, part.local_vertices());
    return local < part.local_vertices() ? vertex_of_record_[record_of(part, local)] : engine::kNoElement;
  }
  /// Of a vertex in an element that has it.
  Vec3d shape_gradient(std::uint32_t element, std::uint32_t vertex) const {
    const auto& s = body_.rest[element].s;
    const Tet& t = body_.elements[element];
    const auto a = static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
    return a == 0 ? -(s[0] + s[1] + s[2]) : s.at(a - 1);
  }
  std::vector<std::set<std::size_t>> parts_of_vertices() const {
    std::vector<std::set<std::size_t>> parts(body_.vertex_count);
    for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
      for (const std::uint32_t e : submeshes_.parts[p].elements) {
        for (const std::uint32_t v : body_.elements[e]) parts[v].insert(p);
      }
    }
    return parts;
  }
};

// Every element is in one submesh, of its own tissue, and every vertex has a record of its own.
TEST_P(LayoutInvariants, EveryElementOnce) {
  std::vector<int> seen(body_.elements.size(), 0);
  for (const Submesh& part : submeshes_.parts) {
    const TissueBlock& block = body_.blocks.at(part.block);
    for (const std::uint32_t e : part.elements) {
      ++seen.at(e);
      EXPECT_TRUE(e >= block.begin && e < block.end);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
  EXPECT_EQ(std::count(vertex_of_record_.begin(), vertex_of_record_.end(), engine::kNoElement), 0);
}

// A vertex of one submesh is in its interior; one of several is in the interface, and each of them lists it once.
TEST_P(LayoutInvariants, InteriorsAreOfOneSubmesh) {
  const auto parts = parts_of_vertices();
  std::size_t next = 0;
  for (const Submesh& part : submeshes_.parts) {
    EXPECT_EQ(part.first_interior, next) << "interiors follow each other";
    next += part.interior_count;
    EXPECT_LE(part.local_vertices(), engine::kMaxLocalVertices);
    EXPECT_EQ(std::adjacent_find(part.shared.begin(), part.shared.end(), std::greater_equal<>()), part.shared.end());
  }
  EXPECT_EQ(submeshes_.interface.first_record, next);
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const std::uint32_t record = submeshes_.record_of_vertex[v];
    ASSERT_EQ(record < next, parts[v].size() == 1);
    for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
      const Submesh& part = submeshes_.parts[p];
      const bool inside = record >= part.first_interior && record < part.first_interior + part.interior_count;
      const bool shared = std::binary_search(part.shared.begin(), part.shared.end(), record);
      ASSERT_EQ(inside || shared, parts[v].count(p) == 1);
    }
  }
}

// Each element of a law is in one lane of the batches; the local vertices there are its own, the products of edges make
// its gradients, and lanes without one have no w.
TEST_P(LayoutInvariants, ChainsHoldEveryElement) {
  constexpr std::array<std::array<std::size_t, 3>, engine::kChainTets> kVertices{{{1, 4, 2}, {1, 2, 3}, {1, 3, 5}}};
  const std::size_t L = GetParam().lanes;
  for (const Submesh& part : submeshes_.parts) {
    if (engine::is_linear(body_.blocks[part.block])) continue;
    std::multiset<std::uint32_t> held;
    for (std::size_t k = 0; k < part.chains.element.size(); ++k) {
      const std::size_t batch = k / (engine::kChainTets * L), which = k / L % engine::kChainTets, lane = k % L;
      const std::uint32_t e = part.chains.element[k];
      const float* rest = part.chains.rest.data() + batch * engine::kChainRest * L + lane;
      const std::uint16_t* index = part.chains.index.data() + batch * engine::kChainVertices * L + lane;
      const double w = double(rest[(engine::kRestScale + which) * L]);
      if (e == engine::kNoElement) {
        EXPECT_EQ(w, 0.0);
        continue;
      }
      held.insert(e);
      EXPECT_EQ(w, double(float(1.0 / (6.0 * body_.rest[e].volume))));
      const auto row = [&](std::size_t from) {
        return Vec3d{double(rest[from * L]), double(rest[(from + 1) * L]), double(rest[(from + 2) * L])};
      };
      const auto& [one, behind, ahead] = kVertices[which];
      const std::array<Vec3d, 3> gradients{row(engine::kRestAcross + 3 * which) * w,
                                           row(engine::kRestSpoke[ahead]) * -w, row(engine::kRestSpoke[behind]) * w};
      std::vector<std::uint32_t> vertices{vertex_of(part, index[0])};
      for (std::size_t a = 0; a < 3; ++a) {
        vertices.push_back(vertex_of(part, index[kVertices[which][a] * L]));
        const Vec3d exact = shape_gradient(e, vertices.back());
        EXPECT_LE(norm(gradients[a] - exact), 2e-7 * norm(exact));
      }
      EXPECT_THAT(vertices, testing::UnorderedElementsAreArray(body_.elements[e]));
    }
    EXPECT_THAT(held, testing::UnorderedElementsAreArray(part.elements));
    EXPECT_EQ(part.edges.count, 0U);
  }
}

// The two chains of a fan have the edge in common, and the second begins where the first ends; a closed one ends where the
// first begins. All six tets are there. The whole box in one submesh has fans of both kinds, where there are enough for a batch.
TEST_P(LayoutInvariants, FansAreTwoChainsAroundOneEdge) {
  const std::size_t L = GetParam().lanes;
  std::size_t pairs = 0, closed = 0;
  for (const Submesh& part : submeshes_.parts) {
    EXPECT_LE(part.chains.closed_pairs, part.chains.pairs);
    EXPECT_LE(2 * part.chains.pairs, part.chains.count);
    pairs += part.chains.pairs, closed += part.chains.closed_pairs;
    for (std::size_t k = 0; k < part.chains.pairs * L; ++k) {
      const std::uint16_t* first = part.chains.index.data() + 2 * (k / L) * engine::kChainVertices * L + k % L;
      const std::uint16_t* second = first + engine::kChainVertices * L;
      EXPECT_EQ(first[0], second[0]);
      EXPECT_EQ(first[L], second[L]);
      EXPECT_EQ(first[5 * L], second[4 * L]);
      if (k / L < part.chains.closed_pairs) {
        EXPECT_EQ(first[4 * L], second[5 * L]);
      }
      for (std::size_t which = 0; which < 2 * engine::kChainTets; ++which) {
        EXPECT_NE(part.chains.element[(2 * (k / L) * engine::kChainTets + which) * L + k % L], engine::kNoElement);
      }
    }
  }
  if (GetParam().target_tets < body_.elements.size()) return;
  EXPECT_GT(closed, 0U);
  if (L == 1) {
    EXPECT_GT(pairs, closed);
  }
}

// A linear submesh has each of its edges in one lane, and no chains.
TEST_P(LayoutInvariants, EdgesHoldEveryEdge) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  for (const Submesh& part : submeshes_.parts) {
    if (!engine::is_linear(body_.blocks[part.block])) continue;
    std::set<Edge> expected;
    for (const std::uint32_t e : part.elements) {
      for (const std::uint32_t i : body_.elements[e]) {
        for (const std::uint32_t j : body_.elements[e]) {
          if (i < j) expected.insert({i, j});
        }
      }
    }
    std::multiset<Edge> held;
    const std::size_t L = GetParam().lanes;
    for (std::size_t k = 0; k < part.edges.count * L; ++k) {
      const std::uint16_t* index = part.edges.index.data() + k / L * 2 * L + k % L;
      const std::uint32_t i = vertex_of(part, index[0]), j = vertex_of(part, index[L]);
      if (i != j) held.insert({std::min(i, j), std::max(i, j)});
    }
    EXPECT_THAT(held, testing::ElementsAreArray(expected));
    EXPECT_EQ(part.chains.count, 0U);
  }
}

// An interface vertex has a slot of each of its submeshes, ascending, and no slot is another's.
TEST_P(LayoutInvariants, SlotsAscend) {
  const engine::Interface& shared = submeshes_.interface;
  std::vector<std::uint32_t> record_of_slot(shared.slot_count, engine::kNoElement);
  for (const Submesh& part : submeshes_.parts) {
    for (std::size_t k = 0; k < part.shared.size(); ++k) {
      std::uint32_t& record = record_of_slot.at(part.first_slot + k);
      EXPECT_EQ(record, engine::kNoElement);
      record = part.shared[k];
    }
  }
  EXPECT_EQ(shared.slots.size(), shared.slot_count);
  for (std::size_t i = 0; i < shared.size(); ++i) {
    for (std::uint32_t k = shared.slot_begin[i]; k < shared.slot_begin[i + 1]; ++k) {
      EXPECT_EQ(record_of_slot.at(shared.slots[k]), shared.first_record + i);
      EXPECT_TRUE(k == shared.slot_begin[i] || shared.slots[k - 1] < shared.slots[k]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, LayoutInvariants,
                         testing::Values(Layout{"wide", 16, 200}, Layout{"middle", 8, 64}, Layout{"narrow", 4, 7},
                                         Layout{"scalar", 1, 1}, Layout{"whole", 16, 100000},
                                         Layout{"whole_scalar", 1, 100000}),
                         [](const testing::TestParamInfo<Layout>& p) { return std::string(p.param.name); });

// A step of a large body with a law reads and writes at most 72 bytes a tet: 32 of rest data, 4 of indices, 11 of state and
// 6 of interfaces, and a little for lanes without a tet.
TEST(LayoutSize, IsAtMost72BytesATet) {
  std::map<int, Tissue> tissues{{0, Tissue{}}};
  tissues.at(0).viscosity = 2.0;
  tissues.at(0).law = LinearLaw{20000.0};
  const Body body = build_body(box_mesh({.cells = {32, 32, 33}, .size = {0.32, 0.32, 0.33}}), tissues);
  const engine::Kernels& kernels = engine::best_kernels();
  EXPECT_LE(engine::bytes_per_tet(engine::build_submeshes(body, kernels.lanes), body.elements.size()), 72.0);
}

}  // namespace
}  // namespace glisson

// Fans: six tets around one edge in order, no tet twice, and most of a mesh in them.
#include "mesh/partition/tet_fans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mesh/partition/partition.h"
#include "support/random.h"

namespace glisson::detail {
namespace {

std::vector<std::uint32_t> common(const std::vector<std::uint32_t>& a, const Tet& b) {
  std::vector<std::uint32_t> both;
  std::copy_if(a.begin(), a.end(), std::back_inserter(both),
               [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
  return both;
}

/// What every list of fans must be: "" or what is wrong.
std::string fault(std::span<const Tet> tets, const std::vector<TetFan>& fans) {
  std::vector<int> seen(tets.size(), 0);
  bool open = false;
  for (const TetFan& fan : fans) {
    if (fan.closed && open) return "a closed fan after an open one";
    open = !fan.closed;
    const Tet& first = tets[fan.tets[0]];
    std::vector<std::uint32_t> edge(first.begin(), first.end());
    for (std::size_t k = 0; k < kFanTets; ++k) {
      ++seen[fan.tets[k]];
      const Tet &t = tets[fan.tets[k]], &next = tets[fan.tets[(k + 1) % kFanTets]];
      edge = common(edge, t);
      const std::size_t shared = common({t.begin(), t.end()}, next).size();
      if ((k + 1 < kFanTets || fan.closed) && shared != 3) return "two in a row do not share a face";
    }
    if (edge.size() != 2) return "the six do not share an edge";
  }
  return std::all_of(seen.begin(), seen.end(), [](int n) { return n <= 1; }) ? "" : "a tet is there twice";
}

/// Share of a mesh's tets that fans of its submeshes take, of some 2000 tets each [-].
double share(const TetMesh& mesh) {
  std::vector<std::uint32_t> chosen(mesh.tets.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  const TetPartition partition = partition_tets(mesh.vertices, mesh.tets, chosen, 2048);
  std::size_t taken = 0;
  for (std::size_t p = 0; p < partition.parts(); ++p) {
    std::vector<Tet> tets;
    for (const std::uint32_t t : partition.part(p)) tets.push_back(mesh.tets[t]);
    const auto fans = fan_tets(tets);
    EXPECT_EQ(fault(tets, fans), "");
    taken += kFanTets * fans.size();
  }
  return static_cast<double>(taken) / static_cast<double>(mesh.tets.size());
}

// Whatever tets of a mesh are given, in whatever order: fans, and no tet of two. None is left that could be taken.
RC_GTEST_PROP(TetFans, AreSixTetsAroundAnEdge, ()) {
  const int n = test::integer(1, 6);
  const BoxSplit kind = test::integer(0, 2) ? BoxSplit::kuhn : BoxSplit::alternating;
  std::vector<Tet> tets = box_mesh({.cells = {n, n, n}, .split = kind}).tets;
  std::shuffle(tets.begin(), tets.end(), std::mt19937(static_cast<unsigned>(test::integer(0, 1000))));
  tets.resize(static_cast<std::size_t>(test::integer(0, static_cast<int>(tets.size()) + 1)));
  const auto fans = fan_tets(tets);
  RC_ASSERT(fault(tets, fans) == "");
  RC_ASSERT(fan_tets(tets) == fans);
  std::vector<char> taken(tets.size(), 0);
  for (const TetFan& fan : fans) {
    for (const std::uint32_t t : fan.tets) taken[t] = 1;
  }
  std::vector<Tet> left;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (taken[t] == 0) left.push_back(tets[t]);
  }
  RC_ASSERT(fan_tets(left).empty());
}

// The cubes of a box, six tets around a diagonal each: all of it where it is one submesh.
TEST(TetFans, TakeEveryCube) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 8}});
  const auto fans = fan_tets(mesh.tets);
  EXPECT_EQ(fault(mesh.tets, fans), "");
  EXPECT_EQ(fans.size(), 128U);
  EXPECT_TRUE(std::all_of(fans.begin(), fans.end(), [](const TetFan& f) { return f.closed; }));
}

TEST(TetFans, TakeMostOfLargeMeshes) {
  EXPECT_GE(share(box_mesh({.cells = {20, 20, 40}})), 0.90);
  EXPECT_GE(share(box_mesh({.cells = {20, 20, 40}, .split = BoxSplit::alternating})), 0.95);
  EXPECT_GE(share(cylinder_mesh({.radius = 0.05, .height = 0.08, .radial_cells = 12, .axial_cells = 20})), 0.83);
}

// Eight tets around an edge are an open fan and two more; five, or six with a gap between them, are none.
TEST(TetFans, NeedSixInARow) {
  const auto ring = [](std::uint32_t n, std::uint32_t without) {
    std::vector<Tet> tets;
    for (std::uint32_t k = 0; k < n; ++k) {
      if (k != without) tets.push_back({0, 1, 2 + k, 2 + (k + 1) % n});
    }
    return tets;
  };
  const auto eight = fan_tets(ring(8, 8));
  ASSERT_EQ(eight.size(), 1U);
  EXPECT_FALSE(eight[0].closed);
  ASSERT_EQ(fan_tets(ring(6, 6)).size(), 1U);
  EXPECT_TRUE(fan_tets(ring(6, 6))[0].closed);
  EXPECT_EQ(fan_tets(ring(7, 3)).size(), 1U);
  EXPECT_TRUE(fan_tets(ring(5, 5)).empty());
  EXPECT_TRUE(fan_tets(ring(6, 2)).empty());
  std::vector<Tet> gaps = ring(9, 4);
  gaps.erase(gaps.begin());
  EXPECT_TRUE(fan_tets(gaps).empty());
}

}  // namespace
}  // namespace glisson::detail

// Pairs of face neighbours: every tet once, partners share exactly a face, and hardly any tet stays single.
#include "mesh/tet_pairs.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mesh/partition.h"
#include "support/random.h"

namespace glisson::detail {
namespace {

std::size_t common_vertices(const Tet& a, const Tet& b) {
  return static_cast<std::size_t>(
      std::count_if(a.begin(), a.end(), [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

std::size_t singles(const std::vector<TetPair>& pairs) {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](const TetPair& p) { return p.second == kNoTet; }));
}

/// What every list of pairs must be, whatever the tets: "" or what is wrong.
std::string fault(std::span<const Tet> tets, const std::vector<TetPair>& pairs) {
  std::vector<int> seen(tets.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [first, second] = pairs[i];
    if (i > 0 && pairs[i - 1].first >= first) return "not in ascending order";
    ++seen[first];
    if (second == kNoTet) continue;
    ++seen[second];
    if (second <= first) return "second is not the larger";
    if (common_vertices(tets[first], tets[second]) != 3) return "partners do not share a face";
  }
  return std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }) ? "" : "a tet is not there once";
}

/// Two singles that share a face could be a pair.
bool neighbours_left_single(std::span<const Tet> tets, const std::vector<TetPair>& pairs) {
  std::vector<std::uint32_t> alone;
  for (const TetPair& p : pairs) {
    if (p.second == kNoTet) alone.push_back(p.first);
  }
  for (const std::uint32_t a : alone) {
    for (const std::uint32_t b : alone) {
      if (a != b && common_vertices(tets[a], tets[b]) == 3) return true;
    }
  }
  return false;
}

/// Share of single tets over all submeshes of a mesh [-].
double single_share(const TetMesh& mesh, std::size_t target) {
  std::vector<std::uint32_t> chosen(mesh.tets.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  const TetPartition partition = partition_tets(mesh.vertices, mesh.tets, chosen, target);
  std::size_t alone = 0;
  for (std::size_t p = 0; p < partition.parts(); ++p) {
    std::vector<Tet> tets;
    for (const std::uint32_t t : partition.part(p)) tets.push_back(mesh.tets[t]);
    const auto pairs = pair_tets(tets);
    EXPECT_EQ(fault(tets, pairs), "");
    alone += singles(pairs);
  }
  return static_cast<double>(alone) / static_cast<double>(mesh.tets.size());
}

// Whatever tets of a mesh are given, in whatever order, the pairs hold each once and join faces only.
RC_GTEST_PROP(TetPairs, CoverAnyListOnceAndJoinFaces, ()) {
  const int n = test::integer(1, 6);
  const BoxSplit kind = test::integer(0, 2) ? BoxSplit::kuhn : BoxSplit::alternating;
  std::vector<Tet> tets = box_mesh({.cells = {n, n, n}, .split = kind}).tets;
  std::shuffle(tets.begin(), tets.end(), std::mt19937(static_cast<unsigned>(test::integer(0, 1000))));
  tets.resize(static_cast<std::size_t>(test::integer(0, static_cast<int>(tets.size()) + 1)));
  const auto pairs = pair_tets(tets);
  RC_ASSERT(fault(tets, pairs) == "");
  RC_ASSERT(!neighbours_left_single(tets, pairs));
  RC_ASSERT(pair_tets(tets) == pairs);
}

// Four tets in a row, the inner two numbered first: greedy pairs would take these and leave both ends single.
TEST(TetPairs, TakeLooseEndsFirst) {
  const std::vector<Tet> row{{1, 2, 3, 4}, {2, 3, 4, 5}, {0, 1, 2, 3}, {3, 4, 5, 6}};
  EXPECT_EQ(pair_tets(row), (std::vector<TetPair>{{0, 2}, {1, 3}}));
}

// A whole box can be paired without rest: every cell is three pairs.
TEST(TetPairs, LeaveNoneOfABoxSingle) {
  for (const BoxSplit kind : {BoxSplit::kuhn, BoxSplit::alternating}) {
    const TetMesh mesh = box_mesh({.split = kind});
    EXPECT_EQ(singles(pair_tets(mesh.tets)), 0u);
  }
}

// Submeshes have jagged borders, where some tet may have no partner: at most 5 in 1000 of boxes and cylinders
// (0.4 to 2 measured; a submesh of an odd number of tets must leave one).
TEST(TetPairs, LeaveFewOfASubmeshSingle) {
  EXPECT_LT(single_share(box_mesh({.cells = {16, 16, 16}}), 1024), 0.005);
  EXPECT_LT(single_share(box_mesh({.cells = {16, 16, 16}, .split = BoxSplit::alternating}), 1024), 0.005);
  EXPECT_LT(single_share(cylinder_mesh({.radial_cells = 10, .axial_cells = 10, .grading = 3.0}), 1024), 0.005);
}

// A face of three tets is no mesh, and still nothing is lost: two of them are a pair.
TEST(TetPairs, TakeAFaceOfThreeTets) {
  const std::vector<Tet> fan{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  const auto pairs = pair_tets(fan);
  EXPECT_EQ(fault(fan, pairs), "");
  EXPECT_EQ(singles(pairs), 1u);
}

// Two copies of one tet have four vertices in common and are no pair; no tets give no pairs.
TEST(TetPairs, DoNotPairATetWithItsCopy) {
  const std::vector<Tet> copies{{0, 1, 2, 3}, {1, 0, 3, 2}};
  EXPECT_EQ(singles(pair_tets(copies)), 2u);
  EXPECT_TRUE(pair_tets({}).empty());
}

}  // namespace
}  // namespace glisson::detail

// Chains of face neighbours: every tet once, neighbours share exactly a face, and there are as few chains as can be.
#include "mesh/partition/tet_chains.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mesh/partition/partition.h"
#include "support/random.h"

namespace glisson::detail {
namespace {

std::size_t common_vertices(const Tet& a, const Tet& b) {
  return static_cast<std::size_t>(
      std::count_if(a.begin(), a.end(), [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

/// What every list of chains must be, whatever the tets: "" or what is wrong.
std::string fault(std::span<const Tet> tets, const std::vector<TetChain>& chains) {
  std::vector<int> seen(tets.size(), 0);
  std::uint32_t last = 0;
  for (const TetChain& c : chains) {
    if (c.middle == kNoTet) return "no middle";
    if (c.ends[0] == kNoTet && c.ends[1] != kNoTet) return "the second end without the first";
    const std::uint32_t smallest = std::min({c.middle, c.ends[0], c.ends[1]});
    if (&c != chains.data() && smallest <= last) return "not in ascending order";
    last = smallest;
    ++seen[c.middle];
    for (const std::uint32_t end : c.ends) {
      if (end == kNoTet) continue;
      ++seen[end];
      if (common_vertices(tets[c.middle], tets[end]) != 3) return "an end does not share a face with the middle";
    }
  }
  return std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }) ? "" : "a tet is not there once";
}

/// Two chains that are not full, with tets that share a face, one of them alone, could be one chain.
bool could_be_joined(std::span<const Tet> tets, const std::vector<TetChain>& chains) {
  for (const TetChain& a : chains) {
    for (const TetChain& b : chains) {
      if (a.size() != 1 || b.size() > 2 || a == b) continue;
      for (const std::uint32_t t : {b.middle, b.ends[0]}) {
        if (t != kNoTet && common_vertices(tets[a.middle], tets[t]) == 3) return true;
      }
    }
  }
  return false;
}

/// Chains of all submeshes of a mesh, over the least number that would hold as many tets [-].
double excess(const TetMesh& mesh, std::size_t target) {
  std::vector<std::uint32_t> chosen(mesh.tets.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  const TetPartition partition = partition_tets(mesh.vertices, mesh.tets, chosen, target);
  std::size_t count = 0, least = 0;
  for (std::size_t p = 0; p < partition.parts(); ++p) {
    std::vector<Tet> tets;
    for (const std::uint32_t t : partition.part(p)) tets.push_back(mesh.tets[t]);
    const auto chains = chain_tets(tets);
    EXPECT_EQ(fault(tets, chains), "");
    count += chains.size();
    least += (tets.size() + 2) / 3;
  }
  return static_cast<double>(count) / static_cast<double>(least);
}

// Whatever tets of a mesh are given, in whatever order, the chains hold each once and join faces only.
RC_GTEST_PROP(TetChains, CoverAnyListOnceAndJoinFaces, ()) {
  const int n = test::integer(1, 6);
  const BoxSplit kind = test::integer(0, 2) ? BoxSplit::kuhn : BoxSplit::alternating;
  std::vector<Tet> tets = box_mesh({.cells = {n, n, n}, .split = kind}).tets;
  std::shuffle(tets.begin(), tets.end(), std::mt19937(static_cast<unsigned>(test::integer(0, 1000))));
  tets.resize(static_cast<std::size_t>(test::integer(0, static_cast<int>(tets.size()) + 1)));
  const auto chains = chain_tets(tets);
  RC_ASSERT(fault(tets, chains) == "");
  RC_ASSERT(!could_be_joined(tets, chains));
  RC_ASSERT(chain_tets(tets) == chains);
}

// Three thousand pieces of a box: no single tet is left beside a chain that has room. One in some hundreds had one, where
// a pair was parted after the single had been asked.
TEST(TetChains, NoSingleIsLeftBesideRoom) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    std::mt19937 random(seed);
    const int n = 2 + static_cast<int>(random() % 2);
    std::vector<Tet> tets =
        box_mesh({.cells = {n, n, n}, .split = seed % 2 == 0 ? BoxSplit::kuhn : BoxSplit::alternating}).tets;
    std::shuffle(tets.begin(), tets.end(), random);
    tets.resize(tets.size() / 4 + random() % (tets.size() / 2));
    EXPECT_FALSE(could_be_joined(tets, chain_tets(tets))) << seed;
  }
}

/// Tets along a strip: each shares a face with the next, numbered as given.
std::vector<Tet> strip(const std::vector<std::uint32_t>& places) {
  std::vector<Tet> tets;
  for (const std::uint32_t p : places) tets.push_back({p, p + 1, p + 2, p + 3});
  return tets;
}

// Six tets in a row, the inner four numbered first: taken in that order, three chains would come of it.
TEST(TetChains, TakeLooseEndsFirst) { EXPECT_EQ(chain_tets(strip({2, 3, 1, 4, 0, 5})).size(), 2u); }

// Of any row of n tets there are ⌈n/3⌉ chains.
TEST(TetChains, OfARowAreAsFewAsCanBe) {
  for (std::uint32_t n = 1; n < 40; ++n) {
    std::vector<std::uint32_t> row(n);
    std::iota(row.begin(), row.end(), 0u);
    std::shuffle(row.begin(), row.end(), std::mt19937(n));
    EXPECT_EQ(chain_tets(strip(row)).size(), (n + 2) / 3) << n;
  }
}

// A whole box can be chained without rest: every cell of a Kuhn split is two chains, and of an alternating one there
// is a rest of less than three tets.
TEST(TetChains, LeaveNoneOfABox) {
  for (const BoxSplit kind : {BoxSplit::kuhn, BoxSplit::alternating}) {
    const TetMesh mesh = box_mesh({.split = kind});
    EXPECT_EQ(chain_tets(mesh.tets).size(), (mesh.tets.size() + 2) / 3);
  }
}

// Submeshes have jagged borders, where some tet may have no neighbour to go with: at most 2 chains in 1000 more than
// the least that boxes and cylinders could have (none measured).
TEST(TetChains, LeaveFewOfASubmesh) {
  EXPECT_LT(excess(box_mesh({.cells = {16, 16, 16}}), 1024), 1.002);
  EXPECT_LT(excess(box_mesh({.cells = {16, 16, 16}, .split = BoxSplit::alternating}), 1024), 1.002);
  EXPECT_LT(excess(cylinder_mesh({.radial_cells = 10, .axial_cells = 10, .grading = 3.0}), 1024), 1.002);
}

// A face of three tets is no mesh, and still nothing is lost: two of them, on different sides of it, are a chain. Tets on
// one side, whose corners go round the face the same way, are none: kernels count on the sides.
TEST(TetChains, TakeAFaceOfThreeTets) {
  const std::vector<Tet> three{{0, 1, 2, 3}, {0, 1, 2, 4}, {1, 0, 2, 5}};
  const auto chains = chain_tets(three);
  EXPECT_EQ(fault(three, chains), "");
  EXPECT_EQ(chains.size(), 2u);
  EXPECT_EQ(chain_tets(std::span(three).first(2)).size(), 2u);
}

// Two copies of one tet have four vertices in common and are no chain; no tets give no chains.
TEST(TetChains, DoNotChainATetWithItsCopy) {
  const std::vector<Tet> copies{{0, 1, 2, 3}, {1, 0, 3, 2}};
  EXPECT_EQ(chain_tets(copies).size(), 2u);
  EXPECT_TRUE(chain_tets({}).empty());
}

}  // namespace
}  // namespace glisson::detail

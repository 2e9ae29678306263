// The stars of vertices stay those of the mesh through any sequence of changes: what removal and cutting rest on.
#include "mesh/topology/vertex_stars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <functional>

#include "support/random.h"

namespace glisson::detail {
namespace {

using Star = std::vector<std::uint32_t>;

TetMesh box(int nx, int ny, int nz) { return box_mesh({.cells = {nx, ny, nz}}); }

bool holds(const Tet& tet, std::uint32_t vertex) { return std::find(tet.begin(), tet.end(), vertex) != tet.end(); }

Star star_of(const VertexStars& stars, std::uint32_t vertex) {
  const auto star = stars.tets_at(vertex);
  return {star.begin(), star.end()};
}

/// A mesh that changes, and its stars by looking at all of it.
struct Model {
  std::vector<Tet> tets;
  std::vector<bool> living;
  std::uint32_t vertices;

  explicit Model(const TetMesh& mesh)
      : tets(mesh.tets), living(tets.size(), true), vertices(static_cast<std::uint32_t>(mesh.vertices.size())) {}

  Star star(std::uint32_t vertex) const {
    Star star;
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      if (living[t] && holds(tets[t], vertex)) star.push_back(t);
    }
    return star;
  }

  bool agrees_with(const VertexStars& stars) const {
    if (stars.vertices() != vertices) return false;
    for (std::uint32_t v = 0; v < vertices; ++v) {
      if (star_of(stars, v) != star(v)) return false;
    }
    return true;
  }
};

std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(test::integer(0, static_cast<int>(count))); }

void change_at_random(Model& model, VertexStars& stars) {
  const std::uint32_t tet = below(model.tets.size());
  const std::uint32_t corner = below(4), to = below(model.vertices);
  switch (below(4)) {
    case 0: {
      const std::uint32_t added = below(3);
      stars.add_vertices(added);
      model.vertices += added;
      break;
    }
    case 1:
      if (!model.living[tet]) break;
      stars.remove(tet, model.tets[tet]);
      model.living[tet] = false;
      break;
    default:
      if (!model.living[tet] || holds(model.tets[tet], to)) break;
      stars.move(tet, model.tets[tet][corner], to);
      model.tets[tet][corner] = to;
  }
}

// Whatever tets go, corners move and vertices come, each star holds the living tets of its vertex, ascending.
RC_GTEST_PROP(VertexStars, FollowEveryChange, ()) {
  Model model(box(test::integer(1, 4), test::integer(1, 4), test::integer(1, 4)));
  VertexStars stars(model.tets, model.vertices);
  RC_ASSERT(model.agrees_with(stars));
  for (int changes = test::integer(0, 300); changes > 0; --changes) change_at_random(model, stars);
  RC_ASSERT(model.agrees_with(stars));
}

// A vertex that no tet holds has an empty star, and a mesh may be without any tet.
TEST(VertexStars, AreEmptyWhereThereIsNoTet) {
  const std::vector<Tet> tets{{0, 1, 2, 4}};
  const VertexStars stars(tets, 6);
  EXPECT_EQ(star_of(stars, 4), Star{0});
  EXPECT_TRUE(stars.tets_at(3).empty());
  EXPECT_TRUE(stars.tets_at(5).empty());
  EXPECT_EQ(VertexStars({}, 0).vertices(), 0u);
}

// A million tets must fit beside their engine: at most 20 bytes each. 16 and 9 a vertex, of which there are 0.17 a tet.
TEST(VertexStars, TakeTwentyBytesATet) {
  const TetMesh mesh = box(25, 25, 25);
  const VertexStars stars(mesh.tets, mesh.vertices.size());
  EXPECT_LE(stars.bytes(), 20 * mesh.tets.size());
}

std::string fault_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

// A change that does not fit the stars is refused with its numbers, and nothing is changed.
TEST(VertexStars, RefuseWhatDoesNotFit) {
  const TetMesh mesh = box(1, 1, 1);
  const Model model(mesh);
  VertexStars stars(mesh.tets, 8);
  const Tet first = mesh.tets[0];
  const auto outside = static_cast<std::uint32_t>(
      std::find_if(mesh.tets.begin(), mesh.tets.end(), [&](const Tet& t) { return !holds(t, first[1]); }) -
      mesh.tets.begin());
  ASSERT_LT(outside, mesh.tets.size());

  using ::testing::HasSubstr;
  EXPECT_THAT(fault_of([&] { stars.move(outside, first[1], 0); }),
              HasSubstr("tet " + std::to_string(outside) + " does not hold vertex " + std::to_string(first[1])));
  EXPECT_THAT(fault_of([&] { stars.move(0, first[0], first[1]); }),
              HasSubstr("tet 0 holds vertex " + std::to_string(first[1]) + " already"));
  EXPECT_THAT(fault_of([&] { stars.move(0, first[0], 8); }), HasSubstr("no vertex 8 among 8 vertices"));
  EXPECT_THAT(fault_of([&] { stars.remove(outside, first); }), HasSubstr("does not hold"));
  EXPECT_TRUE(model.agrees_with(stars));

  stars.remove(0, first);
  EXPECT_THAT(fault_of([&] { stars.remove(0, first); }), HasSubstr("tet 0 does not hold"));
  EXPECT_THAT(fault_of([&] { VertexStars(mesh.tets, 7); }), HasSubstr("no vertex 7 among 7 vertices"));
}

}  // namespace
}  // namespace glisson::detail

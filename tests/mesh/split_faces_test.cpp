// Splitting along faces doubles the vertices that the cut passes through and no other: a cut mesh is what is left
// when tets are glued together at all faces but the split ones.
#include "mesh/cut/split_faces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesh/topology/faces.h"
#include "support/random.h"

namespace glisson::detail {
namespace {

using ::testing::HasSubstr;
using Numbers = std::vector<std::uint32_t>;

/// The face of a tet opposite one of its corners: a name that no split changes.
struct Side {
  std::uint32_t tet;
  std::uint8_t corner;
};

TetMesh box(std::array<int, 3> cells, BoxSplit split = BoxSplit::kuhn) {
  return box_mesh({.cells = cells, .size = {0.1, 0.1, 0.1}, .split = split});
}

/// One side of every inner face.
std::vector<Side> inner_faces(const TetMesh& mesh) {
  std::vector<Side> inner;
  for_each_face(mesh, {}, [&](std::span<const FaceSide> sides) {
    if (sides.size() == 2) inner.push_back({sides[0].tet, sides[0].corner});
  });
  return inner;
}

Triangle face_of(std::span<const Tet> tets, const Side& side) {
  const auto& c = kFaceCorners[side.corner];
  return {tets[side.tet][c[0]], tets[side.tet][c[1]], tets[side.tet][c[2]]};
}

/// The inner faces in the plane x = half the box.
std::vector<Side> middle_plane(const TetMesh& mesh) {
  std::vector<Side> faces = inner_faces(mesh);
  std::erase_if(faces, [&](const Side& side) {
    const Triangle face = face_of(mesh.tets, side);
    return !std::all_of(face.begin(), face.end(),
                        [&](std::uint32_t v) { return std::abs(mesh.vertices[v].x - 0.05) < 1e-9; });
  });
  return faces;
}

/// A mesh under the knife, with what a caller keeps beside it.
struct Body {
  TetMesh mesh;
  VertexStars stars{mesh.tets, mesh.vertices.size()};
  std::vector<Triangle> closed;

  explicit Body(TetMesh whole) : mesh(std::move(whole)) {}

  SplitPlan plan(std::span<const Side> sides) const {
    std::vector<Triangle> faces;
    for (const Side& side : sides) faces.push_back(face_of(mesh.tets, side));
    return plan_split(mesh.tets, stars, faces, static_cast<std::uint32_t>(mesh.vertices.size()), closed);
  }

  void split(std::span<const Side> sides) {
    const SplitPlan plan = this->plan(sides);
    for (const std::uint32_t v : plan.origins) mesh.vertices.push_back(mesh.vertices[v]);
    apply_split(plan, mesh.tets, stars);
    closed = plan.closed;
  }
};

/// The corners of tets in classes: two are in one if they are the same vertex. A class goes by its first corner.
Numbers classes_of(std::span<const Tet> tets) {
  std::map<std::uint32_t, std::uint32_t> first;
  Numbers classes;
  for (const Tet& tet : tets) {
    for (const std::uint32_t v : tet) {
      classes.push_back(first.emplace(v, static_cast<std::uint32_t>(classes.size())).first->second);
    }
  }
  return classes;
}

/// The same classes from the definition: loose tets glued together at every inner face that is not split.
Numbers glued_classes(const TetMesh& mesh, std::span<const Side> split) {
  std::set<Triangle> open;
  const auto name = [&](const Side& side) {
    Triangle face = face_of(mesh.tets, side);
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const Side& side : split) open.insert(name(side));
  Numbers classes(4 * mesh.tets.size());
  std::iota(classes.begin(), classes.end(), 0u);
  const auto glue = [&](std::uint32_t a, std::uint32_t b) {
    while (classes[a] != a) a = classes[a];
    while (classes[b] != b) b = classes[b];
    classes[std::max(a, b)] = std::min(a, b);
  };
  for_each_face(mesh, {}, [&](std::span<const FaceSide> sides) {
    if (sides.size() != 2 || open.contains(name({sides[0].tet, sides[0].corner}))) return;
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t j = 0; j < 4; ++j) {
        if (mesh.tets[sides[0].tet][i] == mesh.tets[sides[1].tet][j]) glue(4 * sides[0].tet + i, 4 * sides[1].tet + j);
      }
    }
  });
  for (std::uint32_t& c : classes) c = classes[c];
  return classes;
}

// A plane through a box leaves two whole halves: the (n + 1)² vertices in it are doubled, all tets keep their shape,
// and the boundary gains two triangles a face.
TEST(SplitFaces, PlaneCutLeavesTwoPieces) {
  for (const BoxSplit kind : {BoxSplit::kuhn, BoxSplit::alternating}) {
    constexpr int n = 5;
    Body body(box({4, n, n}, kind));
    const TetMesh whole = body.mesh;
    const auto faces = middle_plane(whole);
    ASSERT_EQ(faces.size(), 2u * n * n);

    body.split(faces);
    require_valid(body.mesh);
    EXPECT_EQ(inspect(body.mesh).pieces, 2u);
    EXPECT_EQ(body.mesh.vertices.size(), whole.vertices.size() + (n + 1) * (n + 1));
    EXPECT_EQ(boundary_triangles(body.mesh).size(), boundary_triangles(whole).size() + 2 * faces.size());
    EXPECT_TRUE(body.closed.empty());
    ASSERT_EQ(body.mesh.tets.size(), whole.tets.size());
    for (std::size_t t = 0; t < whole.tets.size(); ++t) {
      EXPECT_EQ(six_rest_volume(body.mesh, t), six_rest_volume(whole, t)) << "tet " << t;
    }
  }
}

// A single inner face has its three vertices at the rim of the crack: nothing is doubled, and the face is kept in mind.
TEST(SplitFaces, OneInnerFaceStaysClosed) {
  const Body body(box({6, 5, 5}));
  const auto faces = middle_plane(body.mesh);
  std::size_t deep = 0;
  for (const Side& side : faces) {
    Triangle face = face_of(body.mesh.tets, side);
    const bool at_surface = std::any_of(face.begin(), face.end(), [&](std::uint32_t v) {
      const Vec3d& x = body.mesh.vertices[v];
      return std::min({x.y, x.z, 0.1 - x.y, 0.1 - x.z}) < 1e-9;
    });
    if (at_surface) continue;
    ++deep;
    const SplitPlan plan = body.plan(std::vector{side});
    EXPECT_TRUE(plan.origins.empty());
    EXPECT_TRUE(plan.corners.empty());
    std::sort(face.begin(), face.end());
    EXPECT_EQ(plan.closed, std::vector<Triangle>{face});
  }
  EXPECT_EQ(deep, 18u);  // 3 × 3 cells away from the surface
}

// A disc inside the body opens in its middle only: the one vertex within it is doubled, its rim is not.
TEST(SplitFaces, DiscOpensInsideItsRim) {
  Body body(box({4, 4, 4}));
  const Vec3d middle{0.05, 0.05, 0.05};
  auto faces = middle_plane(body.mesh);
  std::erase_if(faces, [&](const Side& side) {
    const Triangle face = face_of(body.mesh.tets, side);
    return std::none_of(face.begin(), face.end(),
                        [&](std::uint32_t v) { return norm(body.mesh.vertices[v] - middle) < 1e-9; });
  });
  const std::size_t vertices = body.mesh.vertices.size(), triangles = boundary_triangles(body.mesh).size();
  body.split(faces);
  EXPECT_EQ(body.mesh.vertices.size(), vertices + 1);
  EXPECT_LT(norm(body.mesh.vertices.back() - middle), 1e-9);
  EXPECT_EQ(boundary_triangles(body.mesh).size(), triangles + 2 * faces.size());
  EXPECT_EQ(inspect(body.mesh).pieces, 1u);
  EXPECT_TRUE(body.closed.empty());
}

// Cut face by face, in any order, a plane ends in the two pieces that one cut gives, though nearly every face is
// closed when it is split. Only vertex numbers may differ.
RC_GTEST_PROP(SplitFaces, FaceByFaceEndsInTwoPieces, ()) {
  const int n = test::integer(1, 5);
  const TetMesh whole = box({2, n, n}, test::integer(0, 2) == 0 ? BoxSplit::kuhn : BoxSplit::alternating);
  auto faces = middle_plane(whole);
  Body at_once(whole), in_steps(whole);
  at_once.split(faces);
  std::shuffle(faces.begin(), faces.end(), std::mt19937(static_cast<unsigned>(test::integer(0, 1000))));
  for (const Side& side : faces) in_steps.split(std::vector{side});

  RC_ASSERT(inspect(in_steps.mesh).pieces == 2u);
  RC_ASSERT(classes_of(in_steps.mesh.tets) == classes_of(at_once.mesh.tets));
  RC_ASSERT(in_steps.mesh.vertices.size() == whole.vertices.size() + static_cast<std::size_t>((n + 1) * (n + 1)));
  RC_ASSERT(in_steps.closed.empty());
}

/// Splits the faces in up to `calls` calls of random size.
void split_in_calls(Body& body, std::span<const Side> faces, int calls) {
  for (; calls > 1 && !faces.empty(); --calls) {
    const auto count = static_cast<std::size_t>(test::integer(0, static_cast<int>(faces.size()) + 1));
    body.split(faces.first(count));
    faces = faces.subspan(count);
  }
  body.split(faces);
}

// Any set of inner faces, split in any number of calls, leaves the mesh that loose tets give when they are glued
// together at all other faces; copies lie where their origins are, and the stars are those of the mesh.
RC_GTEST_PROP(SplitFaces, EqualsGluingAllOtherFaces, ()) {
  const TetMesh whole = box({test::integer(1, 6), test::integer(1, 6), test::integer(1, 6)});
  auto faces = inner_faces(whole);
  std::shuffle(faces.begin(), faces.end(), std::mt19937(static_cast<unsigned>(test::integer(0, 1000))));
  faces.resize(static_cast<std::size_t>(test::integer(0, static_cast<int>(faces.size()) + 1)));

  Body body(whole);
  split_in_calls(body, faces, test::integer(1, 5));
  RC_ASSERT(classes_of(body.mesh.tets) == glued_classes(whole, faces));
  for (std::size_t t = 0; t < whole.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      RC_ASSERT(body.mesh.vertices[body.mesh.tets[t][i]] == whole.vertices[whole.tets[t][i]]);
    }
  }
  require_valid(body.mesh);
  RC_ASSERT(inspect(body.mesh).unused_vertices.empty());
  const VertexStars anew(body.mesh.tets, body.mesh.vertices.size());
  for (std::uint32_t v = 0; v < anew.vertices(); ++v)
    RC_ASSERT(std::ranges::equal(body.stars.tets_at(v), anew.tets_at(v)));
}

// The order of faces, of their vertices, and faces given twice do not show in the plan.
RC_GTEST_PROP(SplitFaces, PlanIsAFunctionOfTheSetOfFaces, ()) {
  const Body body(box({3, 3, 3}));
  std::vector<Triangle> faces;
  for (const Side& side : inner_faces(body.mesh)) {
    if (test::integer(0, 2) == 0) faces.push_back(face_of(body.mesh.tets, side));
  }
  const auto first_new = static_cast<std::uint32_t>(body.mesh.vertices.size());
  const SplitPlan plan = plan_split(body.mesh.tets, body.stars, faces, first_new);

  std::mt19937 random(static_cast<unsigned>(test::integer(0, 1000)));
  faces.insert(faces.end(), faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 3));
  for (Triangle& face : faces) std::shuffle(face.begin(), face.end(), random);
  std::shuffle(faces.begin(), faces.end(), random);
  const SplitPlan again = plan_split(body.mesh.tets, body.stars, faces, first_new);
  RC_ASSERT(again.origins == plan.origins);
  RC_ASSERT(again.corners == plan.corners);
  RC_ASSERT(again.closed == plan.closed);
}

/// Tets in a row, each on the last face of the one before: tet i holds vertices i … i + 3.
std::vector<Tet> row_of_tets(std::uint32_t count) {
  std::vector<Tet> tets;
  for (std::uint32_t i = 0; i < count; ++i) tets.push_back({i, i + 1, i + 2, i + 3});
  return tets;
}

// The largest group keeps the vertex, of equal ones that with the smallest tet number: a row of tets 0 … 4 is cut
// between 1 and 2.
TEST(SplitFaces, LargestGroupKeepsTheVertex) {
  const auto five = row_of_tets(5);
  const SplitPlan plan = plan_split(five, VertexStars(five, 8), std::vector<Triangle>{{2, 3, 4}}, 8);
  // Vertex 2: tets 0 1 | 2. Vertex 3: tets 0 1 | 2 3. Vertex 4: tets 1 | 2 3 4.
  EXPECT_EQ(plan.origins, (Numbers{2, 3, 4}));
  EXPECT_EQ(plan.corners, (std::vector<CornerChange>{{2, 0, 8}, {2, 1, 9}, {3, 0, 9}, {1, 3, 10}}));
  EXPECT_TRUE(plan.closed.empty());
}

// Around a vertex whose tets are cut in three, each group but the largest gets a copy of its own.
TEST(SplitFaces, EveryOtherGroupGetsACopy) {
  const auto tets = row_of_tets(4);
  const SplitPlan plan = plan_split(tets, VertexStars(tets, 7), std::vector<Triangle>{{1, 2, 3}, {3, 4, 5}}, 7);
  // Vertex 3: tets 0 | 1 2 | 3.
  EXPECT_EQ(plan.origins, (Numbers{1, 2, 3, 3, 4, 5}));
  EXPECT_THAT(plan.corners, ::testing::IsSupersetOf(std::vector<CornerChange>{{0, 3, 9}, {3, 0, 10}}));
}

/// The first inner face that stays closed when it is split alone.
Side closed_face(const Body& body) {
  const auto faces = inner_faces(body.mesh);
  const auto at = std::find_if(faces.begin(), faces.end(),
                               [&](const Side& side) { return body.plan(std::vector{side}).origins.empty(); });
  return faces.at(static_cast<std::size_t>(at - faces.begin()));
}

// A closed face whose tet is removed afterwards is no face to split any more: it is dropped, not refused.
TEST(SplitFaces, ForgetsClosedFacesOfRemovedTets) {
  Body body(box({6, 5, 5}));
  const Side deep = closed_face(body);
  body.split(std::vector{deep});
  ASSERT_EQ(body.closed.size(), 1u);
  body.stars.remove(deep.tet, body.mesh.tets[deep.tet]);
  EXPECT_TRUE(body.plan({}).closed.empty());
}

// A closed face opens when removals take away what held it: of the tets around one of its vertices only its own are left.
TEST(SplitFaces, OpensClosedFacesThatRemovalsFreed) {
  Body body(box({6, 5, 5}));
  const Side deep = closed_face(body);
  body.split(std::vector{deep});
  ASSERT_EQ(body.closed.size(), 1u);
  const auto [a, b, c] = body.closed[0];
  const auto star = body.stars.tets_at(a);
  for (const std::uint32_t t : Numbers(star.begin(), star.end())) {
    const Tet& tet = body.mesh.tets[t];
    const bool beside = std::count(tet.begin(), tet.end(), b) + std::count(tet.begin(), tet.end(), c) == 2;
    if (!beside) body.stars.remove(t, tet);
  }
  const SplitPlan plan = body.plan({});
  EXPECT_THAT(plan.origins, ::testing::Contains(a));
  EXPECT_TRUE(plan.closed.empty());
}

// Tets that meet at a vertex only, as removals leave them, are parted when a face is split there.
TEST(SplitFaces, PartsTetsThatMeetAtAVertexOnly) {
  auto tets = row_of_tets(4);
  VertexStars stars(tets, 7);
  stars.remove(1, tets[1]);  // tet 0 meets tets 2 and 3 at vertices 2 and 3
  const SplitPlan plan = plan_split(tets, stars, std::vector<Triangle>{{3, 4, 5}}, 7);
  EXPECT_EQ(plan.origins, (Numbers{3, 3, 4, 5}));
}

std::string fault_of(std::span<const Tet> tets, const Triangle& face) {
  try {
    plan_split(tets, VertexStars(tets, 7), std::vector{face}, 7);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

// A face that cannot be split is refused with its vertices, the fault and the way out.
TEST(SplitFaces, RefusesFacesThatAreNotInside) {
  auto tets = row_of_tets(3);
  EXPECT_EQ(fault_of(tets, {2, 3, 1}), "none");
  EXPECT_THAT(fault_of(tets, {1, 7, 2}), HasSubstr("face (1, 7, 2) refers to vertex 7, but the mesh has 7 vertices"));
  EXPECT_THAT(fault_of(tets, {1, 2, 1}), HasSubstr("face (1, 2, 1) holds vertex 1 twice"));
  EXPECT_THAT(fault_of(tets, {0, 2, 5}), HasSubstr("face (0, 2, 5) belongs to no tet; give"));
  EXPECT_THAT(fault_of(tets, {0, 1, 2}), HasSubstr("face (0, 1, 2) belongs to tet 0 alone"));
  tets.push_back({1, 2, 3, 6});
  EXPECT_THAT(fault_of(tets, {1, 2, 3}), HasSubstr("face (1, 2, 3) is shared by 3 tets"));
}

}  // namespace
}  // namespace glisson::detail

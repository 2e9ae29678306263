// From a body of 96 000 tets, 1, 5, 20 and 100 go at random: each time the forces are those of a body built anew.
#include "change/changed_body.h"
#include "engine/submesh_body.h"

namespace glisson::test {
namespace {

class RemovalFromLarge : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, RemovalFromLarge, testing::Values(every_kind()[0], every_kind()[1], every_kind()[2]),
                         kind_name);

struct Forces {
  std::vector<Vec3d> elastic, viscous;
};

/// Forces without a step; all vertices are watched, so that the two parts are kept apart.
Forces forces_of(engine::SubmeshBody& moving, const FieldState& state) {
  moving.set_state(state.u, state.v);
  moving.advance(0.0, {}, false);
  Forces f;
  for (const ActiveVertex& w : moving.active()) f.elastic.push_back(w.elastic), f.viscous.push_back(w.viscous);
  return f;
}

Forces forces_built_anew(TetMesh mesh, const Tissues& tissues, const Body& changed, const BodyChanger& changer,
                         const FieldState& state) {
  std::vector<Tet> left;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (!changer.is_removed(t)) left.push_back(mesh.tets[t]);
  }
  mesh.tets = std::move(left);
  const Body body = build_body(mesh, tissues);
  EXPECT_EQ(body.masses, changed.masses);  // to the bit: added up in the same order
  engine::SubmeshBody anew(body, std::vector<double>(body.vertex_count, 0.0));
  anew.watch(all_vertices(mesh), all_vertices(mesh));
  return forces_of(anew, state);
}

TEST_P(RemovalFromLarge, LeavesTheForcesOfABodyBuiltAnew) {
  std::mt19937 random(11);
  constexpr double kEdge = 0.002;
  const TetMesh mesh = jittered_box({20, 20, 40}, kEdge, 0.2, random);
  ASSERT_EQ(mesh.tets.size(), 96000U);
  const Tissues tissues{{0, GetParam().tissue}};
  Body body = build_body(mesh, tissues);
  const std::vector<double> damping(body.vertex_count, 0.0);
  engine::SubmeshBody moving(body, damping);
  moving.watch(all_vertices(mesh), all_vertices(mesh));
  BodyChanger changer(body);
  const FieldState state = random_state(mesh, kEdge, random);
  for (const std::size_t count : {1U, 5U, 20U, 100U}) {
    const BodyChange change = changer.remove(changer.living_elements(choose(count, mesh.tets.size(), random)));
    EXPECT_EQ(change.removed.size(), count);
    moving.apply(change, changer.stars(), damping);
    const Forces got = forces_of(moving, state), expected = forces_built_anew(mesh, tissues, body, changer, state);
    // float forces of at most 12 submeshes and some 24 tets a vertex, added in another order: a few roundings of 6e-8
    EXPECT_LE(relative_difference(got.elastic, expected.elastic), 1e-6) << count << " tets";
    EXPECT_LE(relative_difference(got.viscous, expected.viscous), 1e-6) << count << " tets";
  }
}

}  // namespace
}  // namespace glisson::test

// Copies of split vertices belong to the sets, supports and tools of their origin, and share its loads.
#include "change/changed_body.h"
#include "change/faces.h"
#include "glisson/instruments/motion.h"
#include "support/must_step.h"

namespace glisson::test::split_follow_test {
namespace {

class Followers : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Followers, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.005;

/// A box cut upright through its middle, so that the cut meets its lower and its upper face.
struct Upright {
  TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {4 * kCell, 4 * kCell, 4 * kCell}});
  std::vector<Triangle> faces = faces_on_plane(mesh, 0, 2 * kCell);
  const VertexSet& set(const char* name) const { return mesh.vertex_sets.at(name); }
};

std::size_t copies_in(const SplitReport& report, const VertexSet& set) {
  return static_cast<std::size_t>(std::count_if(report.origins.begin(), report.origins.end(), [&](std::uint32_t v) {
    return std::binary_search(set.begin(), set.end(), v);
  }));
}

// Named sets of the mesh grow by the copies and stay sorted; those that the cut does not meet are the same.
TEST(FollowersOfSets, GrowByTheCopies) {
  const Upright box;
  Simulation s(box.mesh, {{0, law_tissue()}}, {});
  const SplitReport report = s.split_faces(box.faces);
  for (const auto& [name, set] : s.mesh().vertex_sets) {
    EXPECT_TRUE(std::is_sorted(set.begin(), set.end())) << name;
    EXPECT_EQ(set.size(), box.set(name.c_str()).size() + copies_in(report, box.set(name.c_str()))) << name;
  }
  EXPECT_EQ(s.present_mesh().vertex_sets, s.mesh().vertex_sets);
  EXPECT_EQ(s.mesh().vertex_sets.at("x_min"), box.set("x_min"));
  EXPECT_EQ(s.mesh().vertex_sets.at("z_min").size(), 25U + 5U);
}

// Supports hold the copies, tools drive them, and both read the force on them: as in a body built of the cut mesh.
TEST_P(Followers, OfSupportsAndTools) {
  const Upright box;
  const SimulationOptions options = GetParam().options(1e-5);
  const Motion motion = press({.velocity = 0.1, .depth = 0.01, .hold = 1.0});
  const auto set_up = [&](Simulation& s) {
    const TetMesh& mesh = s.mesh();
    VertexSet wall = mesh.vertex_sets.at("y_max");
    std::erase_if(wall, [&](std::uint32_t v) { return std::abs(mesh.vertices[v].z - 2 * kCell) > 1.5 * kCell; });
    s.fix(mesh.vertex_sets.at("z_min"), {true, false, true});
    s.drive(mesh.vertex_sets.at("z_max"), motion, {false, true, true});
    s.drive(wall, press({.direction = {1, 0, 0}, .velocity = 0.1, .start = 0.002}), {true, false, false}, 0.002);
  };
  Simulation cut(box.mesh, {{0, GetParam().tissue}}, options);
  set_up(cut);
  cut.split_faces(box.faces);
  Simulation built(cut.present_mesh(), {{0, GetParam().tissue}}, options);
  set_up(built);
  for (int i = 0; i < 400; ++i) test::must_step(cut), test::must_step(built);
  EXPECT_LE(relative_difference(cut.displacement(), built.displacement()), GetParam().tolerance());
  for (const std::size_t c : {0U, 1U, 2U}) {
    const Vec3d expected = built.force({c}).total();
    EXPECT_LE(norm(cut.force({c}).total() - expected), 30 * GetParam().tolerance() * norm(expected)) << c;
  }
}

// A tool that holds already takes the copies along from where their origins are, without a jump.
TEST_P(Followers, JoinAToolThatMoves) {
  const Upright box;
  Simulation s(box.mesh, {{0, GetParam().tissue}}, GetParam().options(std::nullopt));
  s.fix(box.set("z_min"));
  const ConstraintId tool = s.drive(box.set("z_max"), press({.velocity = 0.02, .depth = 0.01, .hold = 1.0}));
  for (int i = 0; i < 40; ++i) test::must_step(s);
  const ForceParts before = s.force(tool);
  const SplitReport report = s.split_faces(box.faces);
  EXPECT_EQ(s.force(tool).total(), before.total());
  const double t = s.time(), h = s.step_size();
  test::must_step(s);
  for (std::size_t i = 0; i < report.origins.size(); ++i) {
    if (!std::binary_search(box.set("z_max").begin(), box.set("z_max").end(), report.origins[i])) continue;
    EXPECT_NEAR(s.displacement()[report.first_new + i].z, -0.02 * (t + h), 1e-12);
    EXPECT_EQ(s.displacement()[report.first_new + i], s.displacement()[report.origins[i]]);
  }
}

// A load is spread over origins and copies, and its total is what it was: the body's momentum grows by F t.
TEST_P(Followers, ShareLoads) {
  const Upright box;
  Simulation s(box.mesh, {{0, GetParam().tissue}}, GetParam().options(1e-5));
  const Vec3d force{0.3, -0.2, 0.5};
  s.add_load(box.set("z_max"), force);
  s.split_faces(box.faces);
  s.split_faces(faces_on_plane(s.present_mesh(), 1, 2 * kCell));
  for (int i = 0; i < 100; ++i) test::must_step(s);
  const Vec3d expected = force * s.time();
  EXPECT_LE(norm(momentum(s) - expected),
            (GetParam().precision == Precision::single_precision ? 1e-6 : 1e-12) * norm(expected));
  const VertexSet all = s.mesh().vertex_sets.at("z_max");
  EXPECT_EQ(all.size(), 25U + 5U + 6U);
}

// What holds an origin holds its copies: one that would move them is refused.
TEST(FollowersOfSupports, AreHeldAlready) {
  const Upright box;
  Simulation s(box.mesh, {{0, linear_tissue()}}, {});
  s.fix(box.set("z_min"));
  const SplitReport report = s.split_faces(box.faces);
  const Motion still = [](double) { return Vec3d{}; };  // by another course than that of what is held
  for (std::uint32_t i = 0; i < report.origins.size(); ++i) {
    const std::uint32_t copy = report.first_new + i;
    if (std::binary_search(box.set("z_min").begin(), box.set("z_min").end(), report.origins[i])) {
      EXPECT_THROW(s.drive({&copy, 1}, still), std::invalid_argument);
    } else {
      EXPECT_NO_THROW(s.drive({&copy, 1}, still));
    }
  }
}

}  // namespace
}  // namespace glisson::test::split_follow_test

// Sets that are held may share vertices and move: a component is held once, its force counts once, and what moves alike carries
// the body without strain; sets that contradict each other are refused by their names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "glisson/archive.h"
#include "scene/scene_text.h"
#include "support/bodies.h"
#include "support/folder.h"
#include "support/integrators.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kTime = 0.02;

Simulation pressed(Integrator integrator) {
  std::mt19937 random(3);
  SimulationOptions options{.integrator = integrator, .gravity = {0.0, 0.0, -9.81}};
  if (!capabilities(integrator).any_step_is_stable) options.damping_rate = 5.0;
  if (capabilities(integrator).any_step_is_stable) options.step = 0.005;
  Tissue tissue;
  tissue.poisson_ratio = 0.4;
  return {test::jittered_box({3, 3, 3}, 0.01, 0.2, random), {{0, tissue}}, options};
}

std::vector<std::uint32_t> united(const TetMesh& mesh, std::initializer_list<const char*> names) {
  std::set<std::uint32_t> all;
  for (const char* name : names) all.insert(mesh.vertex_sets.at(name).begin(), mesh.vertex_sets.at(name).end());
  return {all.begin(), all.end()};
}

Vec3d sum_of(const Simulation& simulation, const std::vector<ConstraintId>& constraints) {
  Vec3d sum{};
  for (const ConstraintId id : constraints) sum += simulation.force(id).total();
  return sum;
}

// Three faces of a box that meet in edges and a corner, held one by one, are the union of their vertices: the same bytes of the
// state, and forces whose sum is that of the union, under every integrator. A set all of whose vertices others hold bears nothing.
TEST(Supports, ThatShareVerticesAreTheirUnion) {
  for (const Integrator integrator : test::every_integrator()) {
    SCOPED_TRACE(word_of(integrator));
    Simulation one = pressed(integrator), several = pressed(integrator);
    const ConstraintId whole = one.fix(united(one.mesh(), {"z_min", "x_min", "y_min"}));
    std::vector<ConstraintId> parts;
    for (const char* set : {"z_min", "x_min", "y_min"}) parts.push_back(several.fix(set));
    const test::VertexSet corner{0};
    parts.push_back(several.fix(corner));
    ASSERT_TRUE(one.advance_to(kTime).made());
    ASSERT_TRUE(several.advance_to(kTime).made());
    EXPECT_EQ(one.state_hash(), several.state_hash());
    const Vec3d all = one.force(whole).total();
    EXPECT_GT(norm(all), 0.0);
    // the same numbers summed in another order: some 30 of them
    EXPECT_LE(norm(sum_of(several, parts) - all), 1e-13 * norm(all) + 1e-15);
    EXPECT_EQ(norm(several.force(parts.back()).total()), 0.0);
  }
}

// Of a component that two sets name the first bears the force, and the second only what is left: x by one set, all by the other,
// which then bears y and z where they overlap.
TEST(Supports, AComponentBelongsToTheFirst) {
  Simulation sliding = pressed(Integrator::central_difference), shared = pressed(Integrator::central_difference);
  const auto corner = [](const Simulation& s) { return s.mesh().vertex_sets.at("z_min"); };
  const ConstraintId across = sliding.fix(corner(sliding), {true, false, false}),
                     rest = sliding.fix(corner(sliding), {false, true, true});
  const ConstraintId first = shared.fix(corner(shared), {true, false, false}), second = shared.fix(corner(shared));
  ASSERT_TRUE(sliding.advance_to(kTime).made());
  ASSERT_TRUE(shared.advance_to(kTime).made());
  EXPECT_EQ(sliding.state_hash(), shared.state_hash());
  EXPECT_EQ(shared.force(first).total().x, sliding.force(across).total().x);
  EXPECT_EQ(shared.force(second).total().x, 0.0);
  EXPECT_EQ(shared.force(second).total().z, sliding.force(rest).total().z);
}

// A checkpoint of shared supports goes on with the same bytes.
TEST(Supports, ACheckpointKeepsWhatIsShared) {
  const auto built = [] {
    Simulation s = pressed(Integrator::central_difference);
    s.fix("z_min"), s.fix("x_min");
    return s;
  };
  Simulation whole = built(), before = built(), after = built();
  ASSERT_TRUE(whole.advance_to(kTime).made());
  ASSERT_TRUE(before.advance_to(0.5 * kTime).made());
  std::stringstream file;
  before.save(file);
  after.load(file);
  ASSERT_TRUE(after.advance_to(whole.time()).made());
  EXPECT_EQ(after.state_hash(), whole.state_hash());
}

class MovedSupports : public testing::Test {
 protected:
  Scene parse(const std::string& text) { return parse_scene(text, "s.toml", folder_.path()); }
  BuiltVariant built(const std::string& text) { return build_variant(parse(text).variants.front(), {}); }
  std::string fault(const std::string& text) {
    try {
      built(text);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no fault";
  }
  void SetUp() override {
    folder_.write("breath.csv", "time_s,x_mm,y_mm,z_mm\n0,5,0,0\n1,5,0,3\n2,5,0,1\n");
    folder_.write("lift.csv", "time_s,depth_mm\n0,0\n1,3\n2,1\n");
    folder_.write("other.csv", "time_s,depth_mm\n0,0\n1,2\n2,1\n");
  }
  test::Folder folder_;
};

const std::string kBody = R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[motion]
integrator = "quasi_static"
step_s = 0.25
)";

std::string fixed(const std::string& set, const std::string& keys = "") {
  return "[[fixed]]\nset = \"" + set + "\"\n" + keys;
}

// Sets that share an edge and follow one record, of places or of depths, carry the body as it is: every vertex goes where the
// record goes, no tet is strained, and the run ends with the record where no tool ends it.
TEST_F(MovedSupports, CarryTheBodyWithoutStrain) {
  BuiltVariant b = built(kBody + fixed("z_min", "record.path = \"breath.csv\"\n") +
                         fixed("x_min", "record.path = \"lift.csv\"\ndirection = [0, 0, 2]\n"));
  ASSERT_TRUE(b.simulation.advance_to(1.0).made());
  // Newton's method ends where forces are 1e-8 of those that move the body in a step, which leaves as much of 3 mm
  for (const Vec3d& u : b.simulation.displacement()) EXPECT_LE(norm(u - Vec3d{0.0, 0.0, 0.003}), 1e-8);
  ASSERT_TRUE(b.simulation.advance_to(2.0).made());
  for (const Vec3d& u : b.simulation.displacement()) EXPECT_LE(norm(u - Vec3d{0.0, 0.0, 0.001}), 1e-8);
  EXPECT_LE(b.simulation.energies().elastic, 1e-12);
  EXPECT_EQ(run_duration(parse(kBody + fixed("z_min", "record.path = \"lift.csv\"\n")).variants.front()), 2.0);
}

// What a record leaves at rest may be held by others: the side slides along the record's axis, and the base moves along it.
TEST_F(MovedSupports, ShareWhatTheyLeaveAtRest) {
  BuiltVariant b = built(kBody + fixed("x_min", "axes = \"xy\"\n") + fixed("z_min", "record.path = \"lift.csv\"\n"));
  ASSERT_TRUE(b.simulation.advance_to(1.0).made());
  EXPECT_LE(norm(b.simulation.displacement()[0] - Vec3d{0.0, 0.0, -0.003}), 1e-12);
}

TEST_F(MovedSupports, ContradictionsAreNamed) {
  const std::string moved = fixed("z_min", "record.path = \"lift.csv\"\n");
  EXPECT_THAT(fault(kBody + fixed("x_min") + moved),
              AllOf(HasSubstr("s.toml:10:1: fixed.1"), HasSubstr("component z of vertex "),
                    HasSubstr("belongs to [[fixed]] \"z_min\", moved by lift.csv and to [[fixed]] \"x_min\", at rest"),
                    HasSubstr("leave the component out of `axes`")));
  EXPECT_THAT(fault(kBody + moved + fixed("x_min", "record.path = \"other.csv\"\n")),
              HasSubstr("\"x_min\", moved by other.csv and to [[fixed]] \"z_min\", moved by lift.csv"));
  EXPECT_THAT(fault(kBody + fixed("x_min") + "[[tool]]\nname = \"plate\"\nset = \"z_max\"\ndepth_mm = 1\n"),
              HasSubstr("belongs to [[tool]] \"plate\" and to [[fixed]] \"x_min\", at rest"));
  EXPECT_THAT(fault(kBody + fixed("x_min", "direction = [0, 0, 1]\n") + "[[tool]]\nset = \"x_max\"\ndepth_mm = 1\n"),
              HasSubstr("direction: belongs to a set that moves; give `record`"));
  EXPECT_THAT(fault(kBody + fixed("x_min", "record.path = \"none.csv\"\n")), HasSubstr("fixed.0.record"));
}

}  // namespace
}  // namespace glisson

// A change that cannot be made is refused with the numbers at fault, and then nothing has changed.
#include "change/changed_body.h"
#include "support/must_step.h"

namespace glisson::test {
namespace {

/// A running body with some tets gone already.
struct Running {
  std::mt19937 random{9};
  TetMesh mesh = jittered_box({4, 4, 4}, 0.01, 0.2, random);
  Simulation simulation;

  explicit Running(Precision precision) : simulation(mesh, {{0, law_tissue()}}, options(precision)) {
    simulation.fix(mesh.vertex_sets.at("z_min"));
    const FieldState state = random_state(mesh, 0.01, random);
    simulation.set_state(std::vector<Vec3d>(state.u.size()), state.v);
    const std::vector<std::uint32_t> gone{7, 8, 9};
    simulation.remove_tets(gone);
    for (int i = 0; i < 10; ++i) test::must_step(simulation);
  }
  static SimulationOptions options(Precision precision) {
    SimulationOptions o;
    o.precision = precision;
    return o;
  }
};

/// Refuses with a text that holds all of `parts`, and goes on as one that was never asked.
template <class Change>
void expect_refused(const Change& change, const std::vector<std::string>& parts) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    Running asked(precision), other(precision);
    try {
      change(asked);
      ADD_FAILURE() << "not refused";
    } catch (const std::invalid_argument& error) {
      for (const std::string& part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(asked.simulation.state_hash(), other.simulation.state_hash());
    EXPECT_EQ(asked.simulation.present_mesh(), other.simulation.present_mesh());
    EXPECT_EQ(asked.simulation.step_size(), other.simulation.step_size());
    for (int i = 0; i < 5; ++i) test::must_step(asked.simulation), test::must_step(other.simulation);
    EXPECT_EQ(asked.simulation.state_hash(), other.simulation.state_hash());
    EXPECT_EQ(asked.simulation.force({0}).total(), other.simulation.force({0}).total());
    EXPECT_EQ(asked.simulation.energies().removed, other.simulation.energies().removed);
  }
}

TEST(Refusal, OfATetThatIsNot) {
  expect_refused(
      [](Running& r) {
        r.simulation.remove_tets(std::vector<std::uint32_t>{0, 1, 384});
      },
      {"remove_tets", "384", "0 to 383"});
  expect_refused([](Running& r) { (void)r.simulation.is_removed(384); }, {"is_removed", "384", "0 to 383"});
}

TEST(Refusal, OfAFaceThatNoTetHas) {
  expect_refused(
      [](Running& r) {
        r.simulation.split_faces(std::vector<Triangle>{{0, 50, 124}});
      },
      {"split", "(0, 50, 124)", "no tet"});
  expect_refused(
      [](Running& r) {
        r.simulation.split_faces(std::vector<Triangle>{{0, 1, 125}});
      },
      {"split", "125", "numbered from 0"});
}

// A face of the box, and one that became a boundary by the removals, beside one that could be split.
TEST(Refusal, OfAFaceAtTheBoundary) {
  const Running body(Precision::single_precision);
  const TetMesh present = body.simulation.present_mesh();
  const Triangle face = boundary_triangles(present).front();
  const Tet inner = present.tets[present.tets.size() / 2];
  expect_refused(
      [&](Running& r) {
        r.simulation.split_faces(std::vector<Triangle>{{inner[0], inner[1], inner[2]}, face});
      },
      {"split", "boundary", std::to_string(face[0])});
}

// Nothing to do is no fault and no change: no step falls, no tet is counted twice.
TEST(Refusal, NotOfNothing) {
  Running asked(Precision::single_precision), other(Precision::single_precision);
  EXPECT_EQ(asked.simulation.remove_tets({}).tets, 0U);
  EXPECT_EQ(asked.simulation.remove_tets(std::vector<std::uint32_t>{7, 8}).mass, 0.0);
  EXPECT_TRUE(asked.simulation.split_faces({}).origins.empty());
  for (int i = 0; i < 5; ++i) test::must_step(asked.simulation), test::must_step(other.simulation);
  EXPECT_EQ(asked.simulation.state_hash(), other.simulation.state_hash());
}

// A call that takes nothing out of a body leaves its step as it is.
TEST(Refusal, NothingLeavesTheStepAsItIs) {
  std::mt19937 random(1);
  Simulation simulation(jittered_box({4, 4, 4}, 0.01, 0.2, random), {{0, law_tissue()}}, {});
  const double step = simulation.step_size();
  simulation.remove_tets({});
  simulation.split_faces({});
  EXPECT_EQ(simulation.step_size(), step);
}

}  // namespace
}  // namespace glisson::test

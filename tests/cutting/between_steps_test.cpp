// Between steps an interaction may change its body: each step starts from the body as it was left, and all are told of it.
#include "cutting/cut_body.h"
#include "glisson/instruments/blade.h"
#include "glisson/instruments/tool_motion.h"

namespace glisson::test::between_steps_test {
namespace {

/// Takes a tet away after each step, and counts what it is told.
class Remover final : public Interaction {
 public:
  std::size_t told = 0, visits = 0;
  std::uint32_t removed = 0;

  void attached(const BodyView&, double) override {}
  void body_changed(const BodyView& body, std::span<const std::uint32_t>) override {
    EXPECT_TRUE(body.is_removed(removed - 1));
    ++told;
  }
  std::span<const std::uint32_t> reach(double, double) override { return {}; }
  void between_steps(Simulation& body) override {
    if (visits++ == 0) return;  // attached only
    const std::uint32_t tet = removed++;
    body.remove_tets(std::span(&tet, 1));
  }
};

// It is called when it is attached and after every step that was made, and its changes are those of a program's own calls.
TEST(BetweenSteps, ChangesAreTakenOver) {
  const TetMesh mesh = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
  Simulation body(mesh, {{0, Tissue{}}});
  const auto remover = std::make_shared<Remover>();
  body.attach(remover);
  EXPECT_EQ(remover->visits, 1u);
  EXPECT_EQ(remover->told, 0u);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(body.step().made());
  EXPECT_EQ(remover->visits, 4u);
  EXPECT_EQ(remover->told, 3u);
  EXPECT_EQ(body.present_mesh().tets.size(), mesh.tets.size() - 3);
}

std::uint64_t hash_of_cut(bool moved) {
  std::mt19937 random(2);
  std::vector<Simulation> home;
  home.emplace_back(jittered_box({8, 8, 8}, 0.005, 0.1, random), std::map<int, Tissue>{{0, linear_tissue()}},
                    SimulationOptions{.damping_rate = 30.0});
  home[0].fix(home[0].mesh().vertex_sets.at("z_min"));
  const BladeOptions options{.edge_from = {0, -0.03, 0}, .edge_to = {0, 0.03, 0}, .toughness = 1.0};
  const Pose start{{0.0213, 0.02, 0.0385}, identity<double>()};
  const auto blade =
      std::make_shared<Blade>(options, std::make_shared<PathDriver>(start, steady_path({.velocity = 0.5})));
  home[0].attach(blade);
  EXPECT_GT(blade->length_in_tissue(), 0.0) << "in the tissue from the start";
  static_cast<void>(home[0].advance_to(0.005));
  if (moved) home.reserve(2 * home.capacity());
  static_cast<void>(home[0].advance_to(0.02));
  EXPECT_GT(blade->area(), 0.04 * 0.005);
  Simulation another(TetMesh(home[0].mesh()), {{0, linear_tissue()}});
  EXPECT_THROW(another.attach(blade), std::invalid_argument) << "one body has it for good";
  return home[0].state_hash();
}

// A blade is attached like any instrument, cuts as its body is stepped, and goes on where the Simulation is moved.
TEST(BetweenSteps, BladeFollowsItsBody) { EXPECT_EQ(hash_of_cut(true), hash_of_cut(false)); }

// A cutter of a program's own goes back with its body by its own state; left behind, it says so in the place of cutting what is not there.
TEST(BetweenSteps, ACutterGoesBackWithItsBody) {
  const TetMesh mesh = box_mesh({.cells = {4, 4, 4}, .size = {0.02, 0.02, 0.02}});
  Simulation body(mesh, {{0, Tissue{}}});
  body.fix(mesh.vertex_sets.at("z_min"));
  Cutter cutter(body);
  const auto edge = [](double z) { return BladeEdge{{0.0093, -0.001, z}, {0.0093, 0.021, z}}; };
  cutter.place(edge(0.021));
  const State whole = body.save_state();
  const auto cutter_whole = cutter.save_state();
  std::vector<double> areas;
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < 2; ++i) {
    areas.push_back(cutter.advance(edge(0.009)).area);
    EXPECT_GT(body.mesh().vertices.size(), mesh.vertices.size());
    for (int k = 0; k < 20; ++k) ASSERT_TRUE(body.step().made());
    hashes.push_back(body.state_hash());
    body.load_state(whole);
    if (i == 0) {
      EXPECT_THROW(cutter.advance(edge(0.005)), std::invalid_argument);
      cutter.load_state(cutter_whole);
    }
  }
  EXPECT_GT(areas[0], 1e-4);
  EXPECT_EQ(areas[1], areas[0]);
  EXPECT_EQ(hashes[1], hashes[0]);
}

}  // namespace
}  // namespace glisson::test::between_steps_test

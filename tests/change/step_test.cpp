// After any change the automatic step is stable, and a given one is used exactly as long as it holds.
#include "change/changed_body.h"
#include "change/faces.h"
#include "support/must_step.h"

namespace glisson::test::step_test {
namespace {

class Step : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Step, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.01;

struct Noisy {
  std::mt19937 random{21};
  TetMesh mesh = jittered_box({5, 5, 5}, kCell, 0.25, random);
  Tissues tissues;
  SimulationOptions options;
  Simulation simulation;

  explicit Noisy(const Kind& kind, std::optional<double> step = std::nullopt)
      : tissues{{0, kind.tissue}}, options(kind.options(step)), simulation(mesh, tissues, options) {}
  /// Velocities without any smoothness: every mode is in them, the highest too.
  void shake() {
    const std::vector<Vec3d> rest(simulation.mesh().vertices.size());
    simulation.set_state(rest, random_field(rest.size(), 0.02, random));
  }
  /// Removes tets until those left hang together by faces, edges and corners only.
  void change() {
    simulation.split_faces(faces_on_plane(simulation.present_mesh(), 2, 0.02));
    simulation.remove_tets(choose(400, mesh.tets.size(), random));
  }
  double built_anew() const { return Simulation(simulation.present_mesh(), tissues, options).stable_step(); }
};

// The step after a change is at most 0.9 h* of a body built anew, and not needlessly small.
TEST_P(Step, IsBelowThatOfABodyBuiltAnew) {
  Noisy body(GetParam());
  const double before = body.simulation.step_size();
  for (int i = 0; i < 4; ++i) {
    body.change();
    const double stable = body.built_anew();
    EXPECT_LE(body.simulation.step_size(), 0.9 * stable);
    EXPECT_LE(body.simulation.stable_step(), stable);
  }
  EXPECT_GE(body.simulation.step_size(), 0.1 * before);
}

// Two thousand steps of a torn body full of noise: energy never grows beyond what was there.
TEST_P(Step, KeepsATornBodyStable) {  // long: *_in_double
  Noisy body(GetParam());
  body.change();
  body.shake();
  const double initial = body.simulation.energies().initial;
  double most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const StepResult result = body.simulation.step();
    ASSERT_TRUE(result.status == StepStatus::ok || result.status == StepStatus::inverted);
    const Energies e = body.simulation.energies();
    most = std::max(most, e.kinetic + e.elastic);
  }
  // ½ Σ m v₋·v₊ + ½ uᵀKu is conserved to rounding without viscosity; a law only moves energy into its secant
  EXPECT_LE(most, 1.001 * initial);
  EXPECT_LE(std::abs(body.simulation.energies().imbalance()), 1e-10 * initial);
}

// Removing in the middle of a noisy run, again and again, never lets it blow up.
TEST_P(Step, KeepsABodyStableThatIsTornInMotion) {  // long: *_in_double
  Noisy body(GetParam());
  body.shake();
  const double initial = body.simulation.energies().initial;
  for (int i = 0; i < 2000; ++i) {
    if (i % 100 == 0) body.simulation.remove_tets(choose(15, body.mesh.tets.size(), body.random));
    test::must_step(body.simulation);
    const Energies e = body.simulation.energies();
    ASSERT_LE(e.kinetic, 1.001 * initial);
  }
}

// A given step far below h* goes on through any change.
TEST_P(Step, GivenAndSmallGoesOn) {
  const double step = 0.1 * Noisy(GetParam()).simulation.stable_step();
  Noisy body(GetParam(), step);
  body.shake();
  for (int i = 0; i < 5; ++i) {
    body.change();
    ASSERT_NE(body.simulation.step().status, StepStatus::step_too_large);
    EXPECT_EQ(body.simulation.step_size(), step);
  }
}

/// Whether a body built anew in this state takes the step.
bool takes(const TetMesh& mesh, const Tissues& tissues, const SimulationOptions& options, const FieldState& state) {
  try {
    Simulation anew(mesh, tissues, options);
    anew.set_state(state.u, state.v);
    return anew.step().status != StepStatus::step_too_large;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// A given step near h* is told to be too large exactly where a body built anew in the same state, stiffened or not,
// refuses it: h* of what is left decides, not the bound that holds for any part, and no room for further stiffening.
TEST_P(Step, GivenIsHeldAgainstTheStableStepOfWhatIsLeft) {
  std::size_t went_on = 0, told = 0;
  const double stable = Noisy(GetParam()).simulation.stable_step();
  for (unsigned seed = 1; seed <= 24; ++seed) {
    Noisy body(GetParam(), stable * (0.75 + 0.01 * seed));
    body.random.seed(seed);
    FieldState state = random_state(body.mesh, 0.4 * kCell, body.random);
    body.simulation.set_state(state.u, state.v);
    if (body.simulation.step().status != StepStatus::ok) continue;
    body.simulation.remove_tets(choose(seed % 2 == 0 ? 300 : 3, body.mesh.tets.size(), body.random));
    state = state_of(body.simulation);
    body.simulation.set_state(state.u, state.v);
    const bool takes_it = body.simulation.step().status != StepStatus::step_too_large;
    EXPECT_EQ(takes_it, takes(body.simulation.present_mesh(), body.tissues, body.options, state)) << seed;
    ++(takes_it ? went_on : told);
    if (takes_it) continue;
    EXPECT_EQ(body.simulation.steps(), 1U);
    EXPECT_EQ(body.simulation.step().status, StepStatus::step_too_large);
  }
  EXPECT_GT(went_on, 5U);
  EXPECT_GT(told, 2U);
}

}  // namespace
}  // namespace glisson::test::step_test

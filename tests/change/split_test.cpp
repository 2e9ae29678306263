// Splitting along faces leaves the body that one would build of the parted mesh: same forces, mass, motion, energy.
#include "change/changed_body.h"
#include "change/faces.h"
#include "glisson/instruments/motion.h"

namespace glisson::test::split_test {
namespace {

class Split : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Split, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.004;

struct Cut {
  std::mt19937 random{13};
  TetMesh mesh = box_mesh({.cells = {8, 8, 12}, .size = {8 * kCell, 8 * kCell, 12 * kCell}});
  Tissues tissues;
  Kind kind;
  Simulation simulation;

  explicit Cut(const Kind& k) : tissues{{0, k.tissue}}, kind(k), simulation(mesh, tissues, k.options()) {}
  std::vector<Triangle> middle() const { return faces_on_plane(simulation.mesh(), 2, 6 * kCell); }
  void expect_as_built_anew() {
    const FieldState state = random_state(simulation.mesh(), kCell, random);
    test::expect_as_built_anew(simulation, tissues, kind.options(), state, kind.tolerance());
  }
};

// Through the middle: the copies are all of the plane's vertices, the halves share no vertex, and forces are theirs.
TEST_P(Split, ThroughTheMiddle) {  // long: *_in_double
  Cut body(GetParam());
  const double whole = mass(body.simulation);
  const SplitReport report = body.simulation.split_faces(body.middle());
  EXPECT_EQ(report.first_new, 9U * 9U * 13U);
  EXPECT_EQ(report.origins.size(), 81U);
  EXPECT_EQ(report.closed_faces, 0U);
  EXPECT_NEAR(mass(body.simulation), whole, 1e-14 * whole);
  EXPECT_EQ(inspect(body.simulation.present_mesh()).pieces, 2U);
  body.expect_as_built_anew();
}

// A cut that ends inside, then further removals and cuts through what was cut.
TEST_P(Split, AndRemoveInTurns) {  // long: *_in_double
  Cut body(GetParam());
  std::vector<Triangle> part = faces_where(body.middle(), body.mesh, [](const Vec3d& x) { return x.x < 0.018; });
  EXPECT_GT(body.simulation.split_faces(part).origins.size(), 20U);
  body.expect_as_built_anew();
  body.simulation.remove_tets(choose(200, body.mesh.tets.size(), body.random));
  body.expect_as_built_anew();
  const TetMesh present = body.simulation.present_mesh();
  EXPECT_GT(body.simulation.split_faces(faces_on_plane(present, 0, 4 * kCell)).origins.size(), 40U);
  body.expect_as_built_anew();
  body.simulation.remove_tets(tets_where(body.mesh, [](const Vec3d& x) { return norm(x) < 0.02; }));
  body.expect_as_built_anew();
}

// Face by face, in any order, a cut ends as in one call.
TEST_P(Split, FaceByFaceEndsAsInOneCall) {  // long: *_in_double
  Cut at_once(GetParam()), in_steps(GetParam());
  std::vector<Triangle> faces = faces_where(at_once.middle(), at_once.mesh, [](const Vec3d& x) { return x.x < 0.02; });
  at_once.simulation.split_faces(faces);
  std::shuffle(faces.begin(), faces.end(), in_steps.random);
  for (const Triangle& face : faces) in_steps.simulation.split_faces(std::span(&face, 1));
  EXPECT_EQ(in_steps.simulation.masses().size(), at_once.simulation.masses().size());
  EXPECT_EQ(star_sizes(in_steps.simulation), star_sizes(at_once.simulation));
  in_steps.expect_as_built_anew();
}

// While it is pressed and moves: momentum, energies and the tool's force pass the split unchanged, then balance.
TEST_P(Split, WhileItMoves) {  // long: *_in_double
  SimulationOptions options = GetParam().options(std::nullopt);
  options.gravity = {0.0, 0.0, -9.81};
  options.damping_rate = 5.0;
  Cut body(GetParam());
  Simulation s(body.mesh, body.tissues, options);
  s.fix(body.mesh.vertex_sets.at("z_min"));
  const ConstraintId tool =
      s.drive(body.mesh.vertex_sets.at("z_max"), press({.velocity = 0.05, .depth = 0.01, .hold = 1}));
  for (int i = 0; i < 100; ++i) ASSERT_EQ(s.step().status, StepStatus::ok);
  const Vec3d p = momentum(s), f = s.force(tool).total();
  const Energies e = s.energies();
  const double scale = e.kinetic + e.elastic + e.dissipated;
  s.split_faces(body.middle());
  EXPECT_LE(norm(momentum(s) - p), 1e-14 * norm(p));
  EXPECT_EQ(s.force(tool).total(), f);
  EXPECT_EQ(s.energies().kinetic, e.kinetic);
  EXPECT_EQ(s.energies().elastic, e.elastic);
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(s.step().status, StepStatus::ok);
    EXPECT_LE(std::abs(s.energies().imbalance()), 1e-10 * scale);
  }
  // near balance the sums at a vertex are a tenth of the terms: ten times the tolerance of a random state
  Simulation anew(s.present_mesh(), body.tissues, GetParam().options());
  body.simulation.split_faces(body.middle());
  const FieldState now = state_of(s);
  EXPECT_LE(relative_difference(forces_in(body.simulation, now), forces_in(anew, now)), 10 * GetParam().tolerance());
}

// Cut off and not held, the upper half falls as one: v = −g t and u as the scheme sums it up, to rounding.
TEST_P(Split, TheUpperHalfFallsFreely) {  // long: *_in_double
  SimulationOptions options = GetParam().options(1e-4);
  const Cut body(GetParam());
  options.gravity = {0.0, 0.0, -9.81};
  Simulation falling(body.mesh, body.tissues, options);
  falling.fix(body.mesh.vertex_sets.at("z_min"));
  const SplitReport report = falling.split_faces(body.middle());
  const std::vector<char> upper = vertices_of(falling.mesh(), [&](const Vec3d& x) { return x.z > 6 * kCell; });
  ASSERT_EQ(report.origins.size(), 81U);
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) ASSERT_EQ(falling.step().status, StepStatus::ok);
  const double v = -9.81 * kSteps * 1e-4, u = -9.81 * 1e-8 * kSteps * (kSteps + 1) / 2.0;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    if (upper[i] == 0) continue;
    EXPECT_LE(norm(falling.velocity()[i] - Vec3d{0.0, 0.0, v}), 1e-12 * -v);
    EXPECT_LE(norm(falling.displacement()[i] - Vec3d{0.0, 0.0, u}), 1e-12 * -u);
  }
}

}  // namespace
}  // namespace glisson::test::split_test

// Cuts of bodies that move and are deformed: watertight whatever the body does meanwhile, and as if built so.
#include <sstream>

#include "cutting/cut_body.h"
#include "glisson/instruments/motion.h"
#include "support/must_step.h"

namespace glisson::test::cut_motion_test {
namespace {

class CutsInMotion : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, CutsInMotion, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.01;
constexpr double kReach = 0.2;

/// A block that is squeezed and shaken while a blade goes through it.
struct Squeezed {
  std::mt19937 random;
  TetMesh mesh;
  Tissues tissues;
  SimulationOptions options;
  Simulation body;
  std::optional<Cutter> cutter;
  CutPlane plane;

  explicit Squeezed(const Kind& kind, unsigned seed, int threads = 1)
      : random(seed), mesh(jittered_box({5, 5, 6}, kCell, 0.15, random)), tissues{{0, kind.tissue}},
        options(shaken(kind, threads)), body(mesh, tissues, options),
        plane(random_plane(Vec3d{0.025, 0.025, 0.028} + random_field(1, 0.5 * kCell, random)[0], random)) {
    body.fix(mesh.vertex_sets.at("z_min"));
    body.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.3, .depth = 0.006, .hold = 1.0}));
    body.add_load(mesh.vertex_sets.at("x_max"), {0.1, 0.05, 0.0}, [](double t) { return std::sin(300.0 * t); });
    cutter.emplace(body);
    cutter->place(edge_on(plane, kReach, -kReach));
  }
  static SimulationOptions shaken(const Kind& kind, int threads) {
    SimulationOptions o = kind.options(std::nullopt);
    o.gravity = {0.0, 0.0, -9.81};
    o.threads = threads;
    return o;
  }
  /// Goes on from `first` to `last` of `whole` steps of the blade, with steps of the body in between.
  void run(int first, int last, int whole, int steps) {
    for (int i = first; i < last; ++i) {
      for (int k = 0; k < steps; ++k) ASSERT_LE(body.step().status, StepStatus::inverted);
      cutter->advance(edge_on(plane, kReach, -kReach + 2.0 * kReach * (i + 1) / whole));
    }
  }
  bool finite() const {
    for (const auto* field : {&body}) {
      for (const Vec3d& u : field->displacement()) {
        if (!std::isfinite(norm(u))) return false;
      }
    }
    return true;
  }
};

// The block falls in two pieces, its energies balance, and what is left is a body built anew.
TEST_P(CutsInMotion, PartTheBody) {  // long: *_in_double
  for (unsigned seed = 0; seed < 4; ++seed) {
    Squeezed block(GetParam(), seed);
    const double mass_before = mass(block.body);
    for (int i = 0; i < 60; ++i) {
      block.run(i, i + 1, 60, 3);
      const Energies e = block.body.energies();
      const double scale = std::abs(e.elastic) + std::abs(e.dissipated) + std::abs(e.kinetic) + std::abs(e.removed);
      ASSERT_LE(std::abs(e.imbalance()), 1e-9 * scale);
    }
    EXPECT_EQ(piece_sizes(block.body.present_mesh()).size(), 2U) << seed;
    EXPECT_TRUE(block.finite());
    EXPECT_NEAR(mass(block.body), mass_before, 1e-13 * mass_before);
    EXPECT_GE(worst_quality(block.body.present_mesh()),
              std::min(CutOptions{}.least_quality, worst_quality(block.mesh)));
    Simulation anew(block.body.present_mesh(), block.tissues, block.options);
    EXPECT_LE(block.body.step_size(), 0.9 * anew.stable_step());
  }
}

// Forces after a cut are those of a body built of the cut mesh.
TEST_P(CutsInMotion, LeaveABodyAsBuiltAnew) {
  std::mt19937 random(3);
  const TetMesh mesh = jittered_box({5, 5, 6}, kCell, 0.15, random);
  const Tissues tissues{{0, GetParam().tissue}};
  SimulationOptions options = GetParam().options();
  options.step = 0.1 * kProbeStep;
  Simulation body(mesh, tissues, options);
  Cutter cutter(body);
  for (int i = 0; i < 3; ++i) {
    const CutReport report = cut_along(cutter, random_plane({0.025, 0.025, 0.03}, random), kReach, i * 0.01, 4);
    EXPECT_GT(report.moved_vertices, 0U);
    const FieldState state = random_state(body.mesh(), 0.4 * kCell, random);
    // a tet may be 0.4 times as thin as the thinnest before, and velocities are read off a step that is a tenth as long
    expect_as_built_anew(body, tissues, options, state, 20 * GetParam().tolerance());
  }
}

// A move onto the cut leaves the body where it is: a homogeneously deformed body keeps its displacement field.
TEST_P(CutsInMotion, KeepAHomogeneousDeformation) {
  std::mt19937 random(6);
  const TetMesh mesh = jittered_box({5, 5, 6}, kCell, 0.15, random);
  Simulation body(mesh, {{0, GetParam().tissue}}, GetParam().options(std::nullopt));
  const auto field = [](const Vec3d& x) { return Vec3d{0.1 * x.x + 0.3 * x.y, -0.05 * x.y, 0.2 * x.x + 0.15 * x.z}; };
  FieldState state{{}, std::vector<Vec3d>(mesh.vertices.size())};
  for (const Vec3d& x : mesh.vertices) state.u.push_back(field(x));
  body.set_state(state.u, state.v);
  const double elastic = body.energies().elastic;
  Cutter cutter(body);
  EXPECT_GT(cut_along(cutter, random_plane({0.03, 0.025, 0.03}, random), kReach, kReach, 6).moved_vertices, 0U);
  EXPECT_EQ(piece_sizes(body.present_mesh()).size(), 2U);
  for (std::size_t v = 0; v < body.mesh().vertices.size(); ++v) {
    EXPECT_LE(norm(body.displacement()[v] - field(body.mesh().vertices[v])), 1e-15);
  }
  EXPECT_NEAR(body.energies().elastic, elastic, 1e-12 * elastic);
}

struct Trace {
  std::vector<std::uint64_t> hashes;
  std::vector<Vec3d> forces;
  std::vector<Tet> tets;
  bool operator==(const Trace&) const = default;
};

// On any number of threads, and again, the same bytes.
TEST_P(CutsInMotion, GiveTheSameBytesOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    std::mt19937 random(17);
    const TetMesh mesh = jittered_box({9, 9, 12}, 0.004, 0.1, random);  // 5832 tets: several submeshes
    SimulationOptions options = GetParam().options(std::nullopt);
    options.threads = threads;
    options.gravity = {0.0, 0.0, -9.81};
    Simulation s(mesh, {{0, GetParam().tissue}}, options);
    s.fix(mesh.vertex_sets.at("z_min"));
    const ConstraintId tool = s.drive(mesh.vertex_sets.at("z_max"), press({.velocity = 0.1, .depth = 0.01, .hold = 1}));
    Cutter cutter(s);
    const CutPlane plane = plane_at({0.018, 0.02, 0.024}, {0.9, 0.2, -0.3});
    cutter.place(edge_on(plane, 0.1, -0.04));
    Trace trace;
    for (int i = 1; i <= 10; ++i) {
      cutter.advance(edge_on(plane, 0.1, -0.04 + 0.007 * i));
      for (int k = 0; k < 3; ++k) test::must_step(s);
      trace.hashes.push_back(s.state_hash());
      trace.forces.push_back(s.force(tool).total());
    }
    trace.tets = s.mesh().tets;
    return trace;
  };
  const Trace one = run(1);
  EXPECT_EQ(run(1), one);
  if (GetParam().precision == Precision::double_precision) return;
  for (const int threads : {2, 4}) EXPECT_EQ(run(threads), one) << threads << " threads";
}

// Saved in the middle of a cut, body and blade go on with the same bytes.
TEST_P(CutsInMotion, GoOnFromACheckpointToTheByte) {
  Squeezed whole(GetParam(), 5);
  whole.run(0, 33, 60, 2);
  std::stringstream body_file, blade_file;
  whole.body.save(body_file);
  whole.cutter->save(blade_file);
  Squeezed continued(GetParam(), 5);
  continued.body.load(body_file);
  continued.cutter->load(blade_file);
  EXPECT_EQ(continued.body.mesh(), whole.body.mesh());
  EXPECT_EQ(continued.body.state_hash(), whole.body.state_hash());
  whole.run(33, 60, 60, 2);
  continued.run(33, 60, 60, 2);
  EXPECT_EQ(continued.body.mesh(), whole.body.mesh());
  EXPECT_EQ(continued.body.state_hash(), whole.body.state_hash());
  EXPECT_EQ(piece_sizes(whole.body.present_mesh()).size(), 2U);
}

// Supports, tools and loads of a body that is cut hold it on as they would one built of the cut mesh.
TEST_P(CutsInMotion, KeepSupportsAndTools) {
  Squeezed block(GetParam(), 2);
  block.plane = plane_at({0.0243, 0.025, 0.03}, {1.0, 0.07, 0.05});  // through the held and the driven face
  block.cutter->place(edge_on(block.plane, kReach, -kReach));
  block.run(0, 60, 60, 3);
  const Vec3d top{0.0, 0.0, -std::min(0.006, 0.3 * block.body.time())};
  const auto& sets = block.body.mesh().vertex_sets;
  EXPECT_GT(sets.at("z_max").size(), block.mesh.vertex_sets.at("z_max").size());
  for (const std::uint32_t v : sets.at("z_min")) EXPECT_LE(norm(block.body.displacement()[v]), 1e-15);
  for (const std::uint32_t v : sets.at("z_max")) EXPECT_LE(norm(block.body.displacement()[v] - top), 1e-12);
}

// Implicit and static runs follow, too.
TEST(CutsOfOtherIntegrators, PartTheBody) {
  for (const Integrator integrator : {Integrator::semi_implicit, Integrator::implicit, Integrator::quasi_static}) {
    std::mt19937 random(8);
    const TetMesh mesh = jittered_box({4, 4, 5}, kCell, 0.1, random);
    SimulationOptions options;
    options.integrator = integrator;
    options.gravity = {0.0, 0.0, -9.81};
    Simulation body(mesh, {{0, law_tissue()}}, options);
    body.fix(mesh.vertex_sets.at("z_min"));
    Cutter cutter(body);
    const CutPlane plane = plane_at({0.019, 0.02, 0.024}, {1.0, 0.2, 0.1});
    cutter.place(edge_on(plane, kReach, -0.06));
    for (int i = 1; i <= 8; ++i) {
      ASSERT_EQ(body.step().status, StepStatus::ok) << static_cast<int>(integrator);
      cutter.advance(edge_on(plane, kReach, -0.06 + 0.015 * i));
    }
    EXPECT_EQ(piece_sizes(body.present_mesh()).size(), 2U) << static_cast<int>(integrator);
    ASSERT_EQ(body.step().status, StepStatus::ok) << static_cast<int>(integrator);
    const Energies e = body.energies();
    if (integrator != Integrator::quasi_static) {
      EXPECT_LE(std::abs(e.imbalance()), 1e-6 * (std::abs(e.elastic) + std::abs(e.kinetic))) << e.imbalance();
    }
  }
}

}  // namespace
}  // namespace glisson::test::cut_motion_test

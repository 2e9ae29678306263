// A vertex moved at rest is another point of the same material: mass, volume and affine states stay, and the body that
// is left is one built anew.
#include "change/changed_body.h"
#include "change/faces.h"
#include "glisson/instruments/motion.h"

namespace glisson::test::move_test {
namespace {

class Moves : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Moves, testing::ValuesIn(every_kind()), kind_name);

constexpr double kCell = 0.01;

/// Inner vertices moved by up to a tenth of a cell, and vertices of the top within the top.
std::vector<VertexMove> some_moves(const TetMesh& mesh, std::size_t count, std::mt19937& random) {
  std::vector<VertexMove> moves;
  const std::vector<Vec3d> shift = random_field(mesh.vertices.size(), 0.1 * kCell, random);
  for (const std::uint32_t v : choose(count, mesh.vertices.size(), random)) {
    Vec3d to = mesh.vertices[v];
    for (std::size_t a = 0; a < 3; ++a) {
      const bool free = to[a] > 0.5 * kCell && to[a] < (a == 2 ? 5.5 : 3.5) * kCell;
      if (free) to[a] += shift[v][a];
    }
    moves.push_back({v, to});
  }
  return moves;
}

struct Moved {
  std::mt19937 random{9};
  TetMesh mesh = jittered_box({4, 4, 6}, kCell, 0.1, random);
  Tissues tissues;
  SimulationOptions options;
  Simulation simulation;

  explicit Moved(const Kind& kind, std::optional<double> step = kProbeStep)
      : tissues{{0, kind.tissue}}, options(kind.options(step)), simulation(mesh, tissues, options) {}
};

// Mass and volume stay, and forces are those of a body built of the moved mesh; with a split in the same call too.
TEST_P(Moves, LeaveABodyAsBuiltAnew) {
  Moved body(GetParam());
  const double mass_before = mass(body.simulation), volume_before = volume(body.mesh);
  for (int i = 0; i < 3; ++i) {
    const TetMesh present = body.simulation.present_mesh();
    std::vector<VertexMove> moves = some_moves(body.mesh, 20, body.random);
    // away from the plane that is split
    std::erase_if(moves, [&](const VertexMove& m) { return std::abs(body.mesh.vertices[m.vertex].z - 0.03) < 1e-9; });
    body.simulation.split_faces(i == 1 ? faces_on_plane(present, 2, 0.0) : std::vector<Triangle>{}, moves);
    for (const VertexMove& m : moves) EXPECT_EQ(body.simulation.mesh().vertices[m.vertex], m.rest);
    EXPECT_NEAR(mass(body.simulation), mass_before, 1e-13 * mass_before);
    EXPECT_NEAR(volume(body.simulation.present_mesh()), volume_before, 1e-13 * volume_before);
    const FieldState state = random_state(body.simulation.mesh(), kCell, body.random);
    expect_as_built_anew(body.simulation, body.tissues, body.options, state, GetParam().tolerance());
  }
}

// Where displacement and velocity are affine in the rest position, a move changes neither of the two fields, nor the
// energy, nor the momentum.
TEST_P(Moves, KeepAnAffineState) {
  Moved body(GetParam());
  const auto affine = [](const Vec3d& x, double scale) {
    return Vec3d{0.02 * x.x + 0.05 * x.y - 0.01 * x.z, 0.03 * x.x - 0.02 * x.y, 0.04 * x.z + 0.01} * scale;
  };
  FieldState state;
  for (const Vec3d& x : body.mesh.vertices) state.u.push_back(affine(x, 1.0)), state.v.push_back(affine(x, 7.0));
  body.simulation.set_state(state.u, state.v);
  const Energies before = body.simulation.energies();
  const Vec3d momentum_before = momentum(body.simulation);
  std::vector<VertexMove> moves = some_moves(body.mesh, 60, body.random);
  body.simulation.split_faces({}, moves);
  for (const VertexMove& m : moves) {
    EXPECT_LE(norm(body.simulation.displacement()[m.vertex] - affine(m.rest, 1.0)), 1e-15);
    EXPECT_LE(norm(body.simulation.velocity()[m.vertex] - affine(m.rest, 7.0)), 1e-14);
  }
  const Energies after = body.simulation.energies();
  EXPECT_NEAR(after.elastic, before.elastic, 1e-11 * before.elastic);
  // lumped masses give ½ m v² of a linear field only to the size of a tet: a hundredth here
  EXPECT_NEAR(after.kinetic, before.kinetic, 1e-2 * before.kinetic);
  EXPECT_LE(std::abs(after.imbalance()), 1e-13 * (before.elastic + before.kinetic));
  EXPECT_LE(norm(momentum(body.simulation) - momentum_before), 1e-13 * norm(momentum_before));
}

// In motion, under gravity, tool and load: the balance of energies stays exact, and a tool goes on without a jump.
TEST_P(Moves, KeepTheBalanceExact) {
  Moved body(GetParam(), std::nullopt);
  Simulation& s = body.simulation;
  s.fix(body.mesh.vertex_sets.at("z_min"));
  s.drive(body.mesh.vertex_sets.at("z_max"), press({.velocity = 0.05, .depth = 0.01, .hold = 1.0}));
  s.add_load(body.mesh.vertex_sets.at("x_max"), {0.02, 0.0, 0.01});
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) ASSERT_EQ(s.step().status, StepStatus::ok);
    s.split_faces({}, some_moves(s.mesh(), 30, body.random));
    const Energies e = s.energies();
    const double scale = std::abs(e.elastic) + std::abs(e.dissipated) + std::abs(e.kinetic) + std::abs(e.removed);
    EXPECT_LE(std::abs(e.imbalance()), 1e-10 * scale);
    ASSERT_EQ(s.step().status, StepStatus::ok);
    EXPECT_LE(std::abs(s.energies().imbalance()), 1e-10 * scale);
    for (const std::uint32_t v : body.mesh.vertex_sets.at("z_max")) {
      EXPECT_NEAR(s.displacement()[v].z, -0.05 * s.time(), 1e-12);
    }
  }
}

// The automatic step follows tets that have become flat.
TEST_P(Moves, KeepTheStepStable) {
  Moved body(GetParam(), std::nullopt);
  const double before = body.simulation.step_size();
  // an inner vertex goes most of the way to the plane of a face opposite to it
  const TetMesh& mesh = body.simulation.mesh();
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    const Vec3d x = mesh.vertices[tet[0]];
    if (x.x < 0.005 || x.x > 0.035 || x.y < 0.005 || x.y > 0.035 || x.z < 0.005 || x.z > 0.055) continue;
    const Vec3d middle = (mesh.vertices[tet[1]] + mesh.vertices[tet[2]] + mesh.vertices[tet[3]]) * (1.0 / 3.0);
    const VertexMove move{tet[0], x + (middle - x) * 0.9};
    body.simulation.split_faces({}, {&move, 1});
    break;
  }
  EXPECT_LE(body.simulation.step_size(), 0.4 * before);
  EXPECT_LE(body.simulation.step_size(),
            0.9 * Simulation(body.simulation.present_mesh(), body.tissues, body.options).stable_step());
}

// What cannot be is refused with the vertex, and nothing has changed.
TEST(MovesRefused, LeaveEverythingAsItWas) {
  std::mt19937 random(4);
  const TetMesh mesh = jittered_box({3, 3, 3}, kCell, 0.1, random);
  Simulation s(mesh, {{0, linear_tissue()}}, {});
  const auto expect_refusal = [&](const VertexMove& bad, const std::string& fragment) {
    const std::uint32_t inner = 21;
    const std::vector<VertexMove> moves{{inner, mesh.vertices[inner] + Vec3d{1e-4, 0, 0}}, bad};
    try {
      s.split_faces({}, moves);
      ADD_FAILURE() << "accepted, expected: " << fragment;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
    }
    EXPECT_EQ(s.mesh(), mesh);
    EXPECT_EQ(s.present_mesh(), mesh);
  };
  expect_refusal({64, {}}, "vertex 64 is outside the mesh, 0 to 63");
  expect_refusal({21, mesh.vertices[21] + Vec3d{2 * kCell, 0, 0}}, "vertex 21 would turn tet");
  expect_refusal({22, {std::nan(""), 0, 0}}, "not finite");
}

}  // namespace
}  // namespace glisson::test::move_test

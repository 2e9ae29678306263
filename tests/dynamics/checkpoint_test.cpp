// A run continued from a checkpoint has the bytes of the one that was not interrupted; a file that does not fit is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "dynamics/state/checkpoint.h"
#include "glisson/instruments/motion.h"
#include "support/bodies.h"
#include "support/must_step.h"

namespace glisson {
namespace {

struct Case {
  const char* name;
  Integrator integrator;
  TimeScheme scheme = TimeScheme::backward_euler;
  Precision precision = Precision::single_precision;
  bool large = false;   ///< corotational with Maxwell branches, else the paper's tissue with a law
  bool linear = false;  ///< without one
  Preconditioner preconditioner = Preconditioner::automatic;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Checkpoint : public testing::TestWithParam<Case> {
 protected:
  TetMesh mesh = test::paper_mesh();

  Tissue tissue() const {
    Tissue t;
    t.viscosity = 20.0;
    if (GetParam().large) {
      t.kinematics = Kinematics::corotational;
      t.maxwell = {{0.3, 0.02}, {0.2, 0.5}};
    } else if (!GetParam().linear) {
      t.law = LinearLaw{20.0 * t.youngs_modulus};
    }
    return t;
  }
  Simulation made() const {
    SimulationOptions o;
    o.integrator = GetParam().integrator;
    o.precision = GetParam().precision;
    o.implicit.scheme = GetParam().scheme;
    o.implicit.preconditioner = GetParam().preconditioner;
    o.gravity = {0.0, 0.0, -9.81};
    o.gravity_ramp = 0.05;
    o.damping_rate = 5.0;
    Simulation s(mesh, {{0, tissue()}}, o);
    s.fix(mesh.vertex_sets.at("z_min"));
    s.drive(test::paper_triangle(), press({.velocity = 0.05, .depth = 0.01, .start = 0.01, .hold = 0.1}), {}, 0.01);
    s.add_load(mesh.vertex_sets.at("x_max"), {0.02, 0.0, 0.0}, [](double t) { return std::sin(20.0 * t); });
    return s;
  }
  static void run(Simulation& s, int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_LE(s.step().status, StepStatus::inverted);
  }
  /// Everything that can be asked.
  static std::vector<double> told(const Simulation& s) {
    std::vector<double> all{s.time(), s.step_size(), s.stable_step(), s.force_time(), static_cast<double>(s.steps())};
    for (const std::size_t c : {0, 1}) {
      const ForceParts f = s.force({c});
      for (const Vec3d& v : {f.elastic, f.viscous, f.damping, f.inertial, f.gravity, f.load}) {
        all.insert(all.end(), {v.x, v.y, v.z});
      }
    }
    const Energies e = s.energies();
    all.insert(all.end(),
               {e.elastic, e.kinetic, e.dissipated, e.numerical, e.work_tools, e.work_loads, e.removed, e.changed});
    return all;
  }
  static int length() { return capabilities(GetParam().integrator).any_step_is_stable ? 6 : 150; }
};

// Saved before and after the tool takes hold, and right at the start: the rest of the run has the same bytes, and what is
// told at once and at the end the same numbers.
TEST_P(Checkpoint, ContinuesToTheByte) {
  for (const int first : {0, 2, length()}) {
    Simulation whole = made();
    run(whole, first);
    std::stringstream file;
    whole.save(file);
    Simulation continued = made();
    continued.load(file);
    EXPECT_EQ(continued.state_hash(), whole.state_hash());
    EXPECT_EQ(told(continued), told(whole)) << "as saved after " << first;
    run(whole, length());
    run(continued, length());
    EXPECT_EQ(continued.state_hash(), whole.state_hash()) << "saved after " << first << " steps";
    EXPECT_EQ(told(continued), told(whole)) << "at the end, saved after " << first;
  }
}

/// Faces of the mesh in the plane x = 0.02, between two heights.
std::vector<Triangle> in_plane(const TetMesh& mesh, double low, double high) {
  std::vector<Triangle> cut;
  for (const Tet& t : mesh.tets) {
    for (const Triangle& f : {Triangle{t[0], t[1], t[2]}, Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[2], t[3]},
                              Triangle{t[1], t[2], t[3]}}) {
      bool in = true;
      for (const std::uint32_t v : f)
        in = in && std::abs(mesh.vertices[v].x - 0.02) < 1e-9 && mesh.vertices[v].z > low && mesh.vertices[v].z < high;
      if (in) cut.push_back(f);
    }
  }
  return cut;
}

// Tets removed, faces split and vertices moved before it was saved are so in the one that goes on, and what is changed in both
// from there on leads to the same bytes, too.
TEST_P(Checkpoint, FollowsChangesOfTheMesh) {
  Simulation whole = made();
  run(whole, 3);
  whole.remove_tets(std::vector<std::uint32_t>{700, 701, 702, 703});
  run(whole, 2);
  const std::vector<Triangle> cut = in_plane(mesh, 0.039, 0.071);
  const std::uint32_t moved = cut.front().front();
  const VertexMove move{moved, mesh.vertices[moved] + Vec3d{2e-4, 0.0, 0.0}};
  EXPECT_FALSE(whole.split_faces(cut, {{move}}).origins.empty());
  std::stringstream at_once;
  whole.save(at_once);
  Simulation just_cut = made();
  just_cut.load(at_once);
  EXPECT_EQ(told(just_cut), told(whole));
  run(whole, 3);
  run(just_cut, 3);
  EXPECT_EQ(just_cut.state_hash(), whole.state_hash()) << "saved right after the split";
  std::stringstream file;
  whole.save(file);
  Simulation continued = made();
  continued.load(file);
  EXPECT_EQ(told(continued), told(whole));
  EXPECT_TRUE(continued.is_removed(702));
  EXPECT_EQ(continued.mesh().vertices, whole.mesh().vertices);
  EXPECT_EQ(continued.mesh().tets, whole.mesh().tets);
  EXPECT_EQ(continued.mesh().vertex_sets, whole.mesh().vertex_sets);
  EXPECT_TRUE(std::ranges::equal(continued.masses(), whole.masses()));
  run(whole, 5);
  run(continued, 5);
  EXPECT_EQ(continued.state_hash(), whole.state_hash());
  for (Simulation* s : {&whole, &continued}) {
    s->split_faces(in_plane(mesh, -1e-9, 0.021));
    s->remove_tets(std::vector<std::uint32_t>{10, 11, 704});
    run(*s, 5);
  }
  EXPECT_EQ(continued.state_hash(), whole.state_hash());
  EXPECT_EQ(told(continued), told(whole));
}

std::string case_name(const testing::TestParamInfo<Case>& c) { return c.param.name; }
using enum Integrator;
INSTANTIATE_TEST_SUITE_P(
    Integrators, Checkpoint,
    testing::Values(
        Case{"explicit_single", central_difference},
        Case{.name = "explicit_double", .integrator = central_difference, .precision = Precision::double_precision},
        Case{.name = "explicit_maxwell", .integrator = central_difference, .large = true},
        Case{.name = "explicit_maxwell_double",
             .integrator = central_difference,
             .precision = Precision::double_precision,
             .large = true},
        Case{.name = "explicit_linear", .integrator = central_difference, .linear = true},
        Case{"semi_implicit_single", semi_implicit},
        Case{.name = "semi_implicit_double", .integrator = semi_implicit, .precision = Precision::double_precision},
        Case{.name = "semi_implicit_maxwell", .integrator = semi_implicit, .large = true}, Case{"implicit", implicit},
        Case{"implicit_newmark", implicit, TimeScheme::newmark},
        Case{.name = "implicit_alpha_maxwell",
             .integrator = implicit,
             .scheme = TimeScheme::generalised_alpha,
             .large = true},
        Case{.name = "implicit_blocks",
             .integrator = implicit,
             .large = true,
             .preconditioner = Preconditioner::block_diagonal},
        Case{"static_law", quasi_static}, Case{.name = "static_maxwell", .integrator = quasi_static, .large = true}),
    case_name);

/// A cut body under a tool, and what it writes.
Simulation cut_body(const TetMesh& mesh) {
  Tissue tissue;
  tissue.law = LinearLaw{20.0 * tissue.youngs_modulus};
  Simulation s(mesh, {{0, tissue}});
  s.fix(mesh.vertex_sets.at("z_min"));
  return s;
}

// What is forged in a body that has been cut is refused, or it makes a body that can be stepped, cut and asked; what was
// refused has left one of which this is true, too.
TEST(CheckpointFile, OfACutBodyCannotBeForgedIntoACrash) {
  const TetMesh mesh = test::paper_mesh();
  Simulation whole = cut_body(mesh);
  whole.split_faces(in_plane(mesh, 0.039, 0.071));
  whole.remove_tets(std::vector<std::uint32_t>{700, 701});
  test::must_step(whole);
  std::ostringstream saved;
  whole.save(saved);
  std::istringstream file(saved.str());
  const std::string sound = read_checkpoint(file).bytes();
  std::size_t refused = 0, taken = 0;
  for (std::size_t at = 0; at < sound.size(); at += 1 + sound.size() / 400) {
    std::string forged = sound;
    for (std::size_t k = at; k < std::min(at + 4, sound.size()); ++k)
      forged[k] = char(forged[k] ^ (at % 2 == 0 ? 0xff : 0x02));
    std::stringstream made;
    write_checkpoint(Archive(forged), made);
    Simulation s = cut_body(mesh);
    try {
      s.load(made);
      ++taken;
    } catch (const std::runtime_error&) {
      ++refused;
    }
    static_cast<void>(s.step());
    try {
      s.split_faces(in_plane(mesh, -1e-9, 0.021));
      s.remove_tets(std::vector<std::uint32_t>{10, 11, 704});
    } catch (const std::invalid_argument&) {  // of a body of other faces
    }
    static_cast<void>(s.step());
    s.tet_fields();
  }
  EXPECT_GT(refused, 100U);
  EXPECT_GT(taken, 50U);
}

std::string saved_press(const SimulationOptions& o = {}) {
  const TetMesh mesh = test::paper_mesh();
  Simulation s(mesh, {{0, Tissue{}}}, o);
  s.fix(mesh.vertex_sets.at("z_min"));
  test::must_step(s);
  std::ostringstream file;
  s.save(file);
  return file.str();
}

void expect_refusal(Simulation& s, const std::string& bytes, const std::string& fragment) {
  std::istringstream file(bytes);
  try {
    s.load(file);
    ADD_FAILURE() << "accepted, expected: " << fragment;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos) << error.what();
  }
}

// A file that is cut, changed, of another version, or of another simulation is refused with what is wrong.
TEST(CheckpointFile, IsRefusedWhereItDoesNotFit) {
  const std::string good = saved_press();
  const TetMesh mesh = test::paper_mesh();
  Simulation s(mesh, {{0, Tissue{}}});
  s.fix(mesh.vertex_sets.at("z_min"));
  expect_refusal(s, "", "this is not a checkpoint");
  expect_refusal(s, "hello, I am no checkpoint at all", "this is not a checkpoint");
  for (const std::size_t n : {std::size_t(21), good.size() / 2, good.size() - 1}) {
    expect_refusal(s, good.substr(0, n), "it is cut");
  }
  expect_refusal(s, good + "x", "or has grown");
  std::string changed = good;
  changed[good.size() / 2] ^= 1;
  expect_refusal(s, changed, "checksum is wrong");
  std::string later = good;
  later[7] = '9';
  expect_refusal(s, later, "this is not a checkpoint that this program reads");
  SimulationOptions o;
  o.integrator = Integrator::semi_implicit;
  expect_refusal(s, saved_press(o), "another integrator");
  Tissue soft;
  soft.youngs_modulus = 100.0;
  Simulation other(mesh, {{0, soft}});
  expect_refusal(other, good, "another mesh or other tissues");
  Simulation unheld(mesh, {{0, Tissue{}}});
  expect_refusal(unheld, good, "same mesh, tissues, options, constraints");
  std::istringstream file(good);
  EXPECT_NO_THROW(s.load(file)) << "after all those refusals";
}

}  // namespace
}  // namespace glisson

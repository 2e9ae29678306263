// A run continued from a checkpoint has the bytes of the one that was not interrupted; a file that does not fit is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <sstream>

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
  bool large = false;  ///< corotational with Maxwell branches, else the paper's tissue with a law
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
    } else {
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
  static int length() {
    const bool newton = GetParam().integrator == Integrator::implicit || GetParam().integrator == Integrator::static_;
    return newton ? 6 : 150;
  }
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

// Tets removed and faces split before it was saved are so in the one that goes on.
TEST_P(Checkpoint, FollowsChangesOfTheMesh) {
  Simulation whole = made();
  run(whole, 3);
  const std::vector<std::uint32_t> out{700, 701, 702, 703};
  whole.remove_tets(out);
  run(whole, 2);
  std::vector<Triangle> cut;
  for (const Tet& t : mesh.tets) {  // faces in the plane x = 0.02 above z = 0.04
    for (const Triangle& f : {Triangle{t[0], t[1], t[2]}, Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[2], t[3]},
                              Triangle{t[1], t[2], t[3]}}) {
      bool in = true;
      for (const std::uint32_t v : f)
        in = in && std::abs(mesh.vertices[v].x - 0.02) < 1e-9 && mesh.vertices[v].z > 0.039 &&
             mesh.vertices[v].z < 0.071;
      if (in) cut.push_back(f);
    }
  }
  EXPECT_FALSE(whole.split_faces(cut).origins.empty());
  run(whole, 3);
  std::stringstream file;
  whole.save(file);
  Simulation continued = made();
  continued.load(file);
  EXPECT_EQ(told(continued), told(whole));
  EXPECT_TRUE(continued.is_removed(702));
  EXPECT_EQ(continued.mesh().vertices.size(), whole.mesh().vertices.size());
  run(whole, 5);
  run(continued, 5);
  EXPECT_EQ(continued.state_hash(), whole.state_hash());
  EXPECT_EQ(told(continued), told(whole));
}

std::string case_name(const testing::TestParamInfo<Case>& c) { return c.param.name; }
using enum Integrator;
INSTANTIATE_TEST_SUITE_P(
    Integrators, Checkpoint,
    testing::Values(
        Case{"explicit_single", explicit_},
        Case{.name = "explicit_double", .integrator = explicit_, .precision = Precision::double_precision},
        Case{.name = "explicit_maxwell", .integrator = explicit_, .large = true},
        Case{.name = "explicit_maxwell_double",
             .integrator = explicit_,
             .precision = Precision::double_precision,
             .large = true},
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
        Case{"static_law", static_}, Case{.name = "static_maxwell", .integrator = static_, .large = true}),
    case_name);

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
  expect_refusal(s, "", "this is none");
  expect_refusal(s, "hello, I am no checkpoint at all", "this is none");
  for (const std::size_t n : {std::size_t(21), good.size() / 2, good.size() - 1}) {
    expect_refusal(s, good.substr(0, n), "it is cut");
  }
  expect_refusal(s, good + "x", "or has grown");
  std::string changed = good;
  changed[good.size() / 2] ^= 1;
  expect_refusal(s, changed, "checksum is wrong");
  std::string later = good;
  later[8] = 9;
  expect_refusal(s, later, "version 9 is not known");
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

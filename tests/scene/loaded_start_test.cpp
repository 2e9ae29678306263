// motion.start = "loaded": a run begins in equilibrium at the mesh of the scene, whatever the integrator; places of the scene are those
// of that mesh; what cannot start loaded is refused where it is asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "glisson/scene/advice.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kSize = 0.0917;  ///< diagonal of the body [m]

/// A slab that hangs from one side, sags by 5 mm, and has a probe, a pad and a finger.
std::string slab(const std::string& motion, const std::string& more = "") {
  return R"([mesh]
kind = "box"
cells = [6, 4, 3]
size_m = [0.07, 0.05, 0.03]
[tissue]
youngs_modulus_Pa = 9000
poisson_ratio = 0.4
kinematics = "corotational"
viscosity_Pa_s = 1
[[tissue.maxwell]]
share = 0.3
time_s = 0.5
[[fixed]]
set = "x_min"
[[load]]
set = "z_min"
spring_N_m = [2, 2, 10]
[motion]
gravity_m_s2 = [0, 0, -9.81]
duration_s = 0.03
)" + motion +
         more;
}

BuiltVariant built(const std::string& text) { return build_variant(test::parse(text).variants.at(0), {}); }

std::vector<Vec3d> mesh_places(const std::string& text) {
  return build_mesh(test::parse(text).variants.at(0), {}).vertices;
}

double farthest(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double most = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, norm(a[v] - b[v]));
  return most;
}

std::string error_of(const std::string& text) {
  try {
    built(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "it was built";
}

// The body does not move from where the mesh has it: with springs, branches and viscosity, by every integrator; without `loaded` it
// would have fallen by millimetres. In single precision forces are rounded to 1e-7 of their sums, which moves it by less than that
// of its size.
TEST(LoadedStart, BodyStaysWhereItIs) {
  for (const std::string how :
       {"integrator = \"central_difference\"", "precision = \"double\"", "integrator = \"semi_implicit\"",
        "integrator = \"implicit\"", "integrator = \"quasi_static\"\nbranches = \"relaxed\"",
        "integrator = \"quasi_static\"\nbranches = \"follow\""}) {
    SCOPED_TRACE(how);
    const std::string text = slab("start = \"loaded\"\n" + how + "\n");
    const std::vector<Vec3d> places = mesh_places(text);
    BuiltVariant body = built(text);
    ASSERT_TRUE(body.unloaded);
    EXPECT_GT(body.unloaded->largest_shift, 4e-3);
    EXPECT_NEAR(body.unloaded->volume, 0.07 * 0.05 * 0.03, 1e-12);
    EXPECT_LE(farthest(body.simulation.positions(), places), 1e-12);
    EXPECT_TRUE(body.simulation.advance_to(0.03).made());
    EXPECT_LE(farthest(body.simulation.positions(), places), 1e-7 * kSize);
  }
  BuiltVariant falls = built(slab("start = \"rest\"\n"));
  EXPECT_FALSE(falls.unloaded);
  EXPECT_TRUE(falls.simulation.advance_to(0.03).made());
  EXPECT_GT(farthest(falls.simulation.positions(), mesh_places(slab(""))), 1e-3);
}

// The supports bear the weight of the body from the first step on, and its stored energy counts as what it began with.
TEST(LoadedStart, SupportsBearTheWeight) {
  const std::string text = slab("start = \"loaded\"\nintegrator = \"implicit\"\n");
  BuiltVariant body = built(text);
  const double weight = 9.81 * [&] {
    double sum = 0.0;
    for (const double m : body.simulation.masses()) sum += m;
    return sum;
  }();
  const Energies before = body.simulation.energies();
  EXPECT_GT(before.initial, 1e-5);
  EXPECT_EQ(before.elastic, before.initial);
  ASSERT_TRUE(body.simulation.step().made());
  double springs = 0.0;
  const TetMesh& rest = body.simulation.mesh();
  const auto& below = rest.vertex_set("z_min");
  for (const std::uint32_t v : below) {
    springs -= 10.0 / static_cast<double>(below.size()) * body.simulation.displacement()[v].z;
  }
  EXPECT_GT(springs, 0.05 * weight);
  EXPECT_NEAR(body.simulation.force(body.supports[0]).total().z + springs, weight, 1e-6 * weight);
}

// A probe, an aim and a set are where the mesh of the scene has them: the probe follows the material that is there at the start, the
// finger begins its clearance before the surface there.
TEST(LoadedStart, PlacesAreThoseOfTheMesh) {
  const std::string more = R"(
[sets.tip]
nearest_m = { point = [0.07, 0.05, 0.03] }
[[probe]]
name = "inside"
point_m = [0.06, 0.021, 0.011]
[[instrument]]
kind = "ball"
name = "finger"
radius_mm = 6
direction = [0, 0, -1]
aim.point_m = [0.06, 0.025, 0.015]
aim.clearance_mm = 2
[instrument.motion]
kind = "press"
depth_mm = 1
velocity_mm_s = 10
)";
  const std::string text = slab("start = \"loaded\"\n", more);
  BuiltVariant body = built(text);
  const std::vector<double> row = body.probes.read(body.simulation);
  const Vec3d u{row.at(0), row.at(1), row.at(2)};
  EXPECT_GT(norm(u), 2e-3);
  // that material's place at rest and its displacement add up to the point
  BuiltVariant at_rest = built(slab("start = \"rest\"\n", more));
  EXPECT_EQ(body.instruments.at(0)->centre_line().back(), at_rest.instruments.at(0)->centre_line().back());
  EXPECT_EQ(body.simulation.mesh().vertex_set("tip"), at_rest.simulation.mesh().vertex_set("tip"));
  const TetMesh& rest = body.simulation.mesh();
  Probes direct(body.simulation, {{.name = "inside", .where = ProbePoint{Vec3d{0.06, 0.021, 0.011} - u}}});
  EXPECT_NEAR(
      norm(Vec3d{direct.read(body.simulation)[0], direct.read(body.simulation)[1], direct.read(body.simulation)[2]} -
           u),
      0.0, 1e-9);
  EXPECT_EQ(rest.vertices.size(), at_rest.simulation.mesh().vertices.size());
  EXPECT_THAT(error_of(slab("start = \"loaded\"\n", "[[probe]]\npoint_m = [0.06, 0.021, 0.05]\n")),
              AllOf(HasSubstr("outside of the body"), HasSubstr("its nearest point is [0.06, 0.021, 0.0")));
}

// Loads count as at time 0: one that grows from 0 is not in the balance, one that is there is; a tool that takes hold later holds nothing.
TEST(LoadedStart, LoadsCountAsAtTheStart) {
  const auto shift = [](const std::string& more) {
    return built(slab("start = \"loaded\"\n", more)).unloaded->largest_shift;
  };
  const double own = shift("");
  EXPECT_EQ(shift("[[load]]\nset = \"x_max\"\nforce_N = [0, 0, -0.1]\nramp_s = 0.1\n"), own);
  EXPECT_GT(shift("[[load]]\nset = \"x_max\"\nforce_N = [0, 0, -0.1]\n"), 1.1 * own);
  EXPECT_EQ(shift("[[tool]]\nset = \"x_max\"\nstart_s = 0.01\ndepth_mm = 1\n"), own);
  EXPECT_LT(shift("[[tool]]\nset = \"x_max\"\ndepth_mm = 1\n"), 0.5 * own) << "it holds from the start on";
}

TEST(LoadedStart, WhatCannotStartLoadedIsRefused) {
  const std::string start = "start = \"loaded\"\n";
  EXPECT_THAT(test::complaint(slab(start + "gravity_ramp_s = 0.2\n")),
              AllOf(HasSubstr("s.toml:22:"),
                    HasSubstr("motion.gravity_ramp_s: start = \"loaded\" begins under the whole gravity")));
  EXPECT_THAT(test::complaint(slab(start + "mass_scaling_step_s = 1e-3\n")), HasSubstr("mass_scaling = \"variable\""));
  EXPECT_EQ(test::complaint(slab(start + "mass_scaling_step_s = 1e-3\nmass_scaling = \"variable\"\n")), "");
  EXPECT_THAT(error_of(slab(start, "[container]\nkind = \"box\"\nwidth_mm = 90\nlength_mm = 90\n")),
              AllOf(HasSubstr("s.toml:21:9: motion.start: "), HasSubstr("[container]"), HasSubstr("[[fixed]]")));
  EXPECT_THAT(error_of(slab(start, "[[fixed]]\nset = \"x_max\"\naxes = \"x\"\n")), HasSubstr("it was built"));
}

// A body too soft for its weight: the message has the place, the load at which the search ends, and the ways out.
TEST(LoadedStart, BodyThatIsTooSoftIsRefused) {
  const std::string text = R"([mesh]
kind = "box"
cells = [2, 2, 6]
size_m = [0.02, 0.02, 0.06]
[tissue]
youngs_modulus_Pa = 150
kinematics = "corotational"
[[fixed]]
set = "z_min"
[motion]
gravity_m_s2 = [0, 0, -9.81]
duration_s = 0.1
start = "loaded"
)";
  EXPECT_THAT(error_of(text), AllOf(HasSubstr("s.toml:13:9: motion.start: no unloaded shape was found beyond "),
                                    HasSubstr(" % of gravity and loads"), HasSubstr("youngs_modulus_Pa")));
  std::string free = text;
  free.replace(free.find("[[fixed]]\nset = \"z_min\""), 23, "");
  EXPECT_THAT(error_of(free),
              AllOf(HasSubstr("s.toml:12:9: motion.start: a piece of 63 vertices"), HasSubstr("by [[fixed]]")));
}

// `glisson check` and the report say how far the unloaded shape is; rules look at the mesh of the scene.
TEST(LoadedStart, CheckSaysHowFar) {
  const Variant variant = test::parse(slab("start = \"loaded\"\n")).variants.at(0);
  const BuiltVariant body = build_variant(variant, {});
  const std::vector<Advice> all = advise_at_rest(variant, body.simulation);
  const auto said = std::find_if(all.begin(), all.end(), [](const Advice& x) { return x.rule == "loaded"; });
  ASSERT_NE(said, all.end());
  EXPECT_THAT(said->text, HasSubstr("the run starts loaded"));
  EXPECT_NEAR(*VariantAtRest(variant, body.simulation).largest_shift, body.unloaded->largest_shift, 1e-12);
  EXPECT_LE(farthest(VariantAtRest(variant, body.simulation).mesh.vertices, mesh_places(slab(""))), 1e-12);
}

}  // namespace
}  // namespace glisson

// every_key_test.cpp — each key of the schema reaches the struct it is documented to fill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "scene/every_instrument.h"
#include "scene/parse/sections.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::parse;
using ::testing::ElementsAre;

const std::string kEveryKey = R"(title = "All keys"
description = "A scene with every key away from its default."
notes = ["one", "two"]

[mesh]
kind = "box"
cells = [3, 4, 5]
size_m = [0.03, 0.04, 0.05]
origin_m = [1, 2.5, -3]
split = "alternating"

[sets.boxed]
box_m = { min = [0, 0, 0], max = [1, 2, 3] }
surface_only = true
[sets.ball]
sphere_m = { center = [1, 2, 3], radius = 0.5 }
[sets.near]
nearest_m = { point = [4, 5, 6], count = 7 }
[sets.end]
side = { axis = "y", end = "upper", depth_m = 0.125 }
[sets.shared]
side = { axis = "x", end = "lower", share = 0.25 }
[sets.faced]
facing = { direction = [0, 2, 1], count = 4, point_m = [7, 8, 9] }
[sets.faced_region]
facing = { direction = [0, 0, 1], region = "stone" }
[sets.listed]
vertices = [3, 1, 2]

[tissue]
preset = "paper_liver"
name = "liver"
youngs_modulus_Pa = 5000
poisson_ratio = 0.45
density_kg_m3 = 1060
viscosity_Pa_s = 12.5
viscous_tensor = "deviatoric"
measure = "one_minus_q"
law = { kind = "step", threshold = 0.25, above_Pa = 9000, width = 0.0625 }

[[region]]
name = "stone"
box_m = { min = [0, 0, 0], max = [1, 1, 1] }
tissue = { lambda_Pa = 6000, mu_Pa = 2000, lambda_law = { kind = "linear", slope_Pa = 10 }, mu_law = { kind = "linear", slope_Pa = 20 } }
[[region]]
name = "core"
sphere_m = { center = [0, 0, 1], radius = 2 }
[[region]]
name = "band"
box_m = { min = [0, 0, 0], max = [1, 1, 1] }
tissue = { kinematics = "green", law_form = "energy", fibres = { direction = [0, 3, 0], stiffness_Pa = 700 } }
[[region]]
name = "brain"
box_m = { min = [0, 0, 0], max = [1, 1, 1] }
tissue.hyperelastic = { kind = "neo_hookean", mu_Pa = 800, bulk_modulus_Pa = 9000 }
tissue.maxwell = [{ share = 0.5, time_s = 2 }, { share = 0.25, time_s = 30, time_law = { kind = "power", exponent = 1.5, reference = 0.2, least = 0.01, most = 50 } }]
tissue.measure = "one_minus_q"
tissue.maxwell_part = "all"
tissue.volume_change = "average_nodal"

[motion]
integrator = "implicit"
implicit = { scheme = "generalised_alpha", spectral_radius = 0.5, largest_step_s = 0.02, tolerance = 1e-6, most_iterations = 12, most_cuts = 5, preconditioner = "block_diagonal" }
step_s = 1e-4
mass_scaling_step_s = 2e-4
mass_scaling = "variable"
mass_scaling_inertia = 0.01
drag_stages = 3
branches = "follow"
precision = "double"
precision_error = 0.01
damping_rate_per_s = 3
nodal_damping_kg_per_s = 0.002
gravity_m_s2 = [0, 0, -9.81]
gravity_ramp_s = 0.5
start = "rest"
on_inversion = "stop"
duration_s = 2.5
max_steps = 1000

[[fixed]]
set = "z_min"
axes = "xz"

[[load]]
set = "x_max"
force_N = [1, 2, 3]
ramp_s = 0.75
[[load]]
set = "x_min"
traction_Pa = [4, 5, 6]
pressure_Pa = 7
moment_N_m = [8, 9, 10]
follows = true
spring_N_m = [11, 12, 13]
spring_Pa_m = [14, 15, 16]
dashpot_N_s_m = [17, 18, 19]
dashpot_Pa_s_m = [20, 21, 22]
times_s = [0, 1]
factors = [0.5, 2]

[[tool]]
name = "punch"
set = "near"
direction = [0, -2, 0]
velocity_mm_s = 2.5
depth_mm = 4
start_s = 0.1
ramp_s = 0.2
hold_s = 0.3
returns = true
sideways = "free"

[[probe]]
name = "tip"
point_m = [1, 2, 3]
tip = "catheter"
[[probe]]
name = "end"
set = "x_max"
[[probe]]
name = "stone"
region = "stone"
[[probe]]
name = "cut"
plane_m = { point = [0, 0, 2], normal = [0, 3, 4] }

[output]
sample_rate_hz = 250
frames = 7
stored_energy = true

[[chart]]
title = "Force"
x = "depth_m"
y = "force_N"
x_scale = 1000
y_scale = 2
x_label = "depth [mm]"
y_label = "force [N]"
measured = []
variants = ["only"]

[[chart]]
title = "Map"
x = "position_x_m"
y = "position_y_m"
value = "force_N"
value_scale = 3
value_label = "force [N/3]"

[[check]]
what = "it presses"
column = "force_N"
at = "peak"
at_least = 0.5
at_most = 2
variants = ["only"]

[compare]
models = ["xpbd"]
meshes = 3
finer = 2
stations = 7
times_s = [0.25, 0.5]
target = 0.02
cut = "lobe"
cut_at_s = 0.5
measured_N = [0.5, 1.5]

[[variant]]
name = "only"
label = "the only one"
)";

void expect_equal(const Vec3d& a, const Vec3d& b) { EXPECT_EQ(a, b) << a.x << " " << a.y << " " << a.z; }

// What a scene says once is kept as written.
TEST(EveryKey, OfTheSceneIsRead) {
  const Scene scene = parse(kEveryKey);
  EXPECT_EQ(scene.title, "All keys");
  EXPECT_EQ(scene.description, "A scene with every key away from its default.");
  EXPECT_THAT(scene.notes, ElementsAre("one", "two"));
  EXPECT_EQ(scene.source, kEveryKey);
  EXPECT_EQ(scene.file, "s.toml");
  ASSERT_EQ(scene.charts.size(), 2u);
  EXPECT_EQ(scene.charts[0].value.column, "") << "lines";
  EXPECT_EQ(scene.charts[1].value.column, "force_N");
  EXPECT_EQ(scene.charts[1].value.scale, 3.0);
  EXPECT_EQ(scene.charts[1].value.label, "force [N/3]");
  ASSERT_EQ(scene.checks.size(), 1u);
  EXPECT_EQ(scene.checks[0].what, "it presses");
  EXPECT_EQ(scene.checks[0].column, "force_N");
  EXPECT_EQ(scene.checks[0].at, CheckSpec::At::peak);
  EXPECT_EQ(scene.checks[0].at_least, 0.5);
  EXPECT_EQ(scene.checks[0].at_most, 2.0);
  EXPECT_THAT(scene.checks[0].variants, ElementsAre("only"));
  EXPECT_THAT(scene.compare.models, ElementsAre("xpbd"));
  EXPECT_EQ(scene.compare.meshes, 3);
  EXPECT_EQ(scene.compare.finer, 2);
  EXPECT_EQ(scene.compare.stations, 7);
  EXPECT_THAT(scene.compare.times, ElementsAre(0.25, 0.5));
  EXPECT_EQ(scene.compare.target, 0.02);
  EXPECT_EQ(scene.compare.cut, "lobe");
  EXPECT_EQ(scene.compare.cut_at, 0.5);
  EXPECT_THAT(scene.compare.measured, ElementsAre(0.5, 1.5));
  EXPECT_EQ(scene.charts[0].title, "Force");
  EXPECT_EQ(scene.charts[0].x.column, "depth_m");
  EXPECT_EQ(scene.charts[0].x.scale, 1000.0);
  EXPECT_EQ(scene.charts[0].x.label, "depth [mm]");
  EXPECT_EQ(scene.charts[0].y.column, "force_N");
  EXPECT_EQ(scene.charts[0].y.scale, 2.0);
  EXPECT_EQ(scene.charts[0].y.label, "force [N]");
  EXPECT_THAT(scene.charts[0].variants, ElementsAre("only"));
  ASSERT_EQ(scene.variants.size(), 1u);
  EXPECT_EQ(scene.variants[0].name, "only");
  EXPECT_EQ(scene.variants[0].label, "the only one");
  EXPECT_EQ(scene.variants[0].scene_name, "s.toml");
}

// The box is the one described, and every way of picking vertices keeps its numbers.
TEST(EveryKey, OfMeshAndSetsIsRead) {
  const Variant v = parse(kEveryKey).variants[0];
  const auto& box = std::get<BoxOptions>(v.mesh);
  EXPECT_THAT(box.cells, ElementsAre(3, 4, 5));
  expect_equal(box.size, {0.03, 0.04, 0.05});
  expect_equal(box.origin, {1, 2.5, -3});
  EXPECT_EQ(box.split, BoxSplit::alternating);
  ASSERT_EQ(v.sets.size(), 8u);
  const auto& boxed = std::get<Selection::Box>(v.sets.at("boxed").where);
  expect_equal(boxed.min, {0, 0, 0});
  expect_equal(boxed.max, {1, 2, 3});
  EXPECT_TRUE(v.sets.at("boxed").surface_only);
  const auto& ball = std::get<Selection::Sphere>(v.sets.at("ball").where);
  expect_equal(ball.center, {1, 2, 3});
  EXPECT_EQ(ball.radius, 0.5);
  EXPECT_FALSE(v.sets.at("ball").surface_only);
  const auto& near = std::get<Selection::Nearest>(v.sets.at("near").where);
  expect_equal(near.point, {4, 5, 6});
  EXPECT_EQ(near.count, 7);
  const auto& end = std::get<Selection::Side>(v.sets.at("end").where);
  EXPECT_EQ(end.axis, 1);
  EXPECT_TRUE(end.upper);
  EXPECT_EQ(end.depth, 0.125);
  EXPECT_EQ(std::get<Selection::Side>(v.sets.at("shared").where).share, 0.25);
  const auto& faced = std::get<Selection::Facing>(v.sets.at("faced").where);
  expect_equal(faced.direction, {0, 2, 1});
  EXPECT_EQ(faced.count, 4);
  expect_equal(faced.at.point.value(), {7, 8, 9});
  EXPECT_EQ(std::get<Selection::Facing>(v.sets.at("faced_region").where).at.region, "stone");
  EXPECT_THAT(std::get<Selection::Ids>(v.sets.at("listed").where).vertices, ElementsAre(3, 1, 2));
}

// A tissue keeps its moduli, density, viscosity, measure and law.
TEST(EveryKey, OfTissueIsRead) {
  const Tissue t = parse(kEveryKey).variants[0].tissue;
  EXPECT_EQ(t.name, "liver");
  EXPECT_EQ(t.youngs_modulus, 5000.0);
  EXPECT_EQ(t.poisson_ratio, 0.45);
  EXPECT_EQ(t.density, 1060.0);
  EXPECT_EQ(t.viscosity, 12.5);
  EXPECT_EQ(t.viscous_tensor, ViscousTensor::deviatoric);
  EXPECT_EQ(t.measure, DeformationMeasure::one_minus_q);
  EXPECT_EQ(std::get<StepLaw>(t.law), (StepLaw{0.25, 9000, 0.0625}));
  EXPECT_FALSE(t.lambda_law || t.mu_law);
}

// A region has the body's tissue but for the keys it gives; λ and μ of a region take the place of the body's E and ν.
TEST(EveryKey, OfRegionsIsReadAndTheRestInherited) {
  const Variant v = parse(kEveryKey).variants[0];
  ASSERT_EQ(v.regions.size(), 4u);
  const RegionSpec& stone = v.regions[0];
  EXPECT_EQ(stone.name, "stone");
  EXPECT_EQ(stone.tissue.name, "stone");
  expect_equal(std::get<Selection::Box>(stone.where).max, {1, 1, 1});
  EXPECT_NEAR(stone.tissue.lame().lambda, 6000.0, 1e-9);
  EXPECT_NEAR(stone.tissue.lame().mu, 2000.0, 1e-9);
  EXPECT_EQ(stone.tissue.density, 1060.0);
  EXPECT_TRUE(std::holds_alternative<ConstantLaw>(stone.tissue.law)) << "lambda_law and mu_law replace the body's law";
  EXPECT_EQ(std::get<LinearLaw>(stone.tissue.lambda_law.value()).slope, 10.0);
  EXPECT_EQ(std::get<LinearLaw>(stone.tissue.mu_law.value()).slope, 20.0);
  const RegionSpec& core = v.regions[1];
  EXPECT_EQ(std::get<Selection::Sphere>(core.where).radius, 2.0);
  EXPECT_EQ(core.tissue.youngs_modulus, 5000.0);
  EXPECT_EQ(law_name(core.tissue.law), "step");
}

// What large deformation needs is kept: kinematics, the law's form, fibres, a hyperelastic law, relaxation, the cure of
// locking.
TEST(EveryKey, OfLargeDeformationIsRead) {
  const Variant v = parse(kEveryKey).variants[0];
  const Tissue& band = v.regions.at(2).tissue;
  EXPECT_EQ(band.kinematics, Kinematics::green);
  EXPECT_EQ(band.law_form, LawForm::energy);
  ASSERT_TRUE(band.fibres);
  expect_equal(band.fibres->direction, {0, 3, 0});
  EXPECT_EQ(band.fibres->stiffness, 700.0);
  const Tissue& brain = v.regions.at(3).tissue;
  EXPECT_EQ(std::get<NeoHookean>(brain.hyperelastic.value()), (NeoHookean{800, 9000}));
  const PowerTime slower{.exponent = 1.5, .reference = 0.2, .least = 0.01, .most = 50.0};
  EXPECT_EQ(brain.maxwell, (std::vector<MaxwellBranch>{{0.5, 2.0}, {0.25, 30.0, slower}}));
  EXPECT_EQ(brain.measure, DeformationMeasure::one_minus_q);
  EXPECT_EQ(brain.maxwell_part, MaxwellPart::all);
  EXPECT_EQ(brain.volume_change, VolumeChange::average_nodal);
}

// Time, supports, loads, tools and output keep their numbers, in SI.
TEST(EveryKey, OfMotionToolsAndOutputIsRead) {
  const Variant v = parse(kEveryKey).variants[0];
  EXPECT_EQ(v.simulation.step, 1e-4);
  EXPECT_EQ(v.simulation.integrator, Integrator::implicit);
  const ImplicitOptions& implicit = v.simulation.implicit;
  EXPECT_EQ(implicit.scheme, TimeScheme::generalised_alpha);
  EXPECT_EQ(implicit.spectral_radius, 0.5);
  EXPECT_EQ(implicit.largest_step, 0.02);
  EXPECT_EQ(implicit.tolerance, 1e-6);
  EXPECT_EQ(implicit.most_iterations, 12);
  EXPECT_EQ(implicit.most_cuts, 5);
  EXPECT_EQ(implicit.preconditioner, Preconditioner::block_diagonal);
  EXPECT_EQ(v.simulation.precision, Precision::double_precision);
  EXPECT_EQ(v.simulation.precision_error, 0.01);
  EXPECT_EQ(v.simulation.mass_scaling_step, 2e-4);
  EXPECT_EQ(v.simulation.mass_scaling, MassScalingKind::variable);
  EXPECT_EQ(v.simulation.mass_scaling_inertia, 0.01);
  EXPECT_EQ(v.simulation.damping_rate, 3.0);
  EXPECT_EQ(v.simulation.drag_stages, 3);
  EXPECT_EQ(v.simulation.branches, StaticBranches::follow);
  EXPECT_EQ(v.simulation.nodal_damping, 0.002);
  expect_equal(v.simulation.gravity, {0, 0, -9.81});
  EXPECT_EQ(v.simulation.gravity_ramp, 0.5);
  EXPECT_TRUE(v.simulation.enforce_stability) << "no scene may exceed the stable step";
  EXPECT_EQ(v.start, Start::rest) << "with gravity_ramp_s; loaded_start_test.cpp has the other";
  EXPECT_EQ(v.on_inversion, OnInversion::stop);
  EXPECT_EQ(v.duration, 2.5);
  EXPECT_EQ(v.max_steps, 1000u);
  ASSERT_EQ(v.fixed.size(), 1u);
  EXPECT_EQ(v.fixed[0].set, "z_min");
  EXPECT_TRUE(v.fixed[0].axes.x && !v.fixed[0].axes.y && v.fixed[0].axes.z);
  ASSERT_EQ(v.loads.size(), 2u);
  EXPECT_EQ(v.loads[0].set, "x_max");
  expect_equal(v.loads[0].load.force, {1, 2, 3});
  EXPECT_EQ(v.loads[0].ramp, 0.75);
  const SurfaceLoad& load = v.loads[1].load;
  expect_equal(load.traction, {4, 5, 6});
  EXPECT_EQ(load.pressure, 7.0);
  expect_equal(load.moment, {8, 9, 10});
  EXPECT_TRUE(load.follows);
  expect_equal(load.spring, {11, 12, 13});
  expect_equal(load.spring_per_area, {14, 15, 16});
  expect_equal(load.dashpot, {17, 18, 19});
  expect_equal(load.dashpot_per_area, {20, 21, 22});
  EXPECT_THAT(v.loads[1].times, ElementsAre(0, 1));
  EXPECT_THAT(v.loads[1].factors, ElementsAre(0.5, 2));
  ASSERT_EQ(v.tools.size(), 1u);
  const ToolSpec& tool = v.tools[0];
  EXPECT_EQ(tool.name, "punch");
  EXPECT_EQ(tool.set, "near");
  expect_equal(tool.motion.direction, {0, -2, 0});
  EXPECT_EQ(tool.motion.velocity, 0.0025);
  EXPECT_EQ(tool.motion.depth, 0.004);
  EXPECT_EQ(tool.motion.start, 0.1);
  EXPECT_EQ(tool.motion.ramp, 0.2);
  EXPECT_EQ(tool.motion.hold, 0.3);
  EXPECT_TRUE(tool.motion.returns);
  EXPECT_TRUE(tool.sideways_free);
  ASSERT_EQ(v.probes.size(), 4u);
  EXPECT_EQ(v.probes[0].options.name, "tip");
  expect_equal(std::get<ProbePoint>(v.probes[0].options.where).position, {1, 2, 3});
  EXPECT_EQ(v.probes[0].tip, "catheter");
  EXPECT_EQ(std::get<ProbeSet>(v.probes[1].options.where).set, "x_max");
  EXPECT_EQ(std::get<ProbeRegion>(v.probes[2].options.where).region, "stone");
  expect_equal(std::get<ProbePlane>(v.probes[3].options.where).point, {0, 0, 2});
  expect_equal(std::get<ProbePlane>(v.probes[3].options.where).normal, {0, 3, 4});
  EXPECT_EQ(v.output.sample_rate, 250.0);
  EXPECT_EQ(v.output.frames, 7);
  EXPECT_TRUE(v.output.stored_energy);
}

const std::string kRotations = R"(
[mesh]
kind = "box"
[[tool]]
name = "speed"
set = "z_max"
axial = "free"
rotation = { axis = [0, 0, 2], center_m = [1, 2, 3], angle_deg = 30, rate_deg_s = 60, start_s = 0.1, ramp_s = 0.2, hold_s = 0.3, returns = true }
[[tool]]
name = "table"
set = "z_min"
rotation = { axis = [1, 1, 0], times_s = [0, 2], angles_deg = [0, 45] }
)";

// A tool that turns keeps its axis, its angle over time and what is free.
TEST(EveryKey, OfRotationsIsRead) {
  const Variant v = parse(kRotations).variants[0];
  ASSERT_EQ(v.tools.size(), 2u);
  EXPECT_TRUE(v.tools[0].axial_free);
  const RotationMotion& turn = v.tools[0].rotation.value();
  expect_equal(turn.axis, {0, 0, 2});
  expect_equal(turn.center, {1, 2, 3});
  EXPECT_EQ(turn.angle_deg, 30.0);
  EXPECT_EQ(turn.rate_deg_s, 60.0);
  EXPECT_EQ(turn.start, 0.1);
  EXPECT_EQ(turn.ramp, 0.2);
  EXPECT_EQ(turn.hold, 0.3);
  EXPECT_TRUE(turn.returns);
  EXPECT_FALSE(v.tools[1].axial_free);
  EXPECT_THAT(v.tools[1].rotation->times, ElementsAre(0, 2));
  EXPECT_THAT(v.tools[1].rotation->angles_deg, ElementsAre(0, 45));
  EXPECT_EQ(run_duration(v), 2.0);
}

const std::string kPalpation = R"(
[mesh]
kind = "box"
[[instrument]]
kind = "ball"
tip_m = [0.02, 0.02, 0.09]
motion = { kind = "palpation", columns = 3, rows = 2, spacing_mm = 4, indentation_mm = 2, velocity_mm_s = 40, clearance_mm = 1, move_s = 0.2, hold_s = 0.1, start_s = 0.5 }
)";

// A palpation keeps its grid and its times; each press takes move, down and up, and hold.
TEST(EveryKey, OfAPalpationIsRead) {
  const Variant v = parse(kPalpation).variants[0];
  const auto& p = std::get<PalpationSpec>(v.instruments.at(0).motion.how);
  EXPECT_EQ(p.columns, 3);
  EXPECT_EQ(p.rows, 2);
  EXPECT_EQ(p.spacing, 0.004);
  EXPECT_EQ(p.indentation, 0.002);
  EXPECT_EQ(p.velocity, 0.04);
  EXPECT_EQ(p.clearance, 0.001);
  EXPECT_EQ(p.move, 0.2);
  EXPECT_EQ(p.hold, 0.1);
  EXPECT_EQ(p.start, 0.5);
  EXPECT_NEAR(run_duration(v), 0.5 + 6 * (0.2 + 2 * 3e-3 / 0.04 + 0.1), 1e-12);
}

const std::string kAims = R"(
[mesh]
kind = "box"
[[instrument]]
kind = "needle"
aim = { region = "tumour", distance_mm = 90 }
motion = { kind = "press" }
[[instrument]]
kind = "ball"
name = "ball"
aim = { point_m = [1, 2, 3], clearance_mm = 7 }
motion = { kind = "press" }
)";

// An aim keeps its point, and how far from it or from the surface an instrument starts.
TEST(EveryKey, OfAnAimIsRead) {
  const Variant v = parse(kAims).variants[0];
  const AimSpec &needle = v.instruments.at(0).aim.value(), &ball = v.instruments.at(1).aim.value();
  EXPECT_EQ(needle.at.region, "tumour");
  EXPECT_EQ(needle.distance, 0.09);
  expect_equal(ball.at.point.value(), {1, 2, 3});
  EXPECT_EQ(ball.clearance, 0.007);
  EXPECT_FALSE(ball.distance);
}

// The two other kinds of mesh keep their numbers; a file is looked for beside the scene.
TEST(EveryKey, OfCylinderAndFileIsRead) {
  const std::string rest = "\n[motion]\nduration_s = 1\n";
  const Scene cylinder = parse(
      "[mesh]\nkind = \"cylinder\"\nradius_m = 0.1\nheight_m = 0.2\nradial_cells = 3\naxial_cells = 4\n"
      "grading = 5\n" +
      rest);
  const auto& c = std::get<CylinderOptions>(cylinder.variants[0].mesh);
  EXPECT_EQ(c.radius, 0.1);
  EXPECT_EQ(c.height, 0.2);
  EXPECT_EQ(c.radial_cells, 3);
  EXPECT_EQ(c.axial_cells, 4);
  EXPECT_EQ(c.grading, 5.0);
  const Scene file = parse("[mesh]\nkind = \"file\"\npath = \"organs/liver.vtu\"\nscale = 0.001\n" + rest);
  const auto& f = std::get<MeshFile>(file.variants[0].mesh);
  EXPECT_EQ(f.path, "/scenes/organs/liver.vtu");
  EXPECT_EQ(f.scale, 0.001);
  const Scene any = parse("[mesh]\nkind = \"file\"\npath = \"organs/liver.vtu\"\nscale = \"auto\"\n" + rest);
  EXPECT_FALSE(std::get<MeshFile>(any.variants[0].mesh).scale);
  const Scene absolute = parse("[mesh]\nkind = \"file\"\npath = \"/data/liver.vtu\"\n" + rest);
  EXPECT_EQ(std::get<MeshFile>(absolute.variants[0].mesh).path, "/data/liver.vtu");
}

// The liver's keys arrive as they are written.
TEST(EveryKey, OfTheLiverIsRead) {
  const Scene scene = parse(
      "[mesh]\nkind = \"liver\"\nedge_mm = 9\nscale = 0.9\nvessels = false\ngallbladder = true\n"
      "tumour_center_mm = [1, 2, 3]\ntumour_radius_mm = 4\nmax_tets = 5000\ngrowth = 0.2\n[motion]\nduration_s = 1\n");
  const auto& l = std::get<LiverOptions>(scene.variants[0].mesh);
  EXPECT_DOUBLE_EQ(l.edge, 0.009);
  EXPECT_EQ(l.scale, 0.9);
  EXPECT_FALSE(l.vessels);
  EXPECT_TRUE(l.gallbladder);
  EXPECT_NEAR(norm(l.tumour_center - Vec3d{0.001, 0.002, 0.003}), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(l.tumour_radius, 0.004);
  EXPECT_EQ(l.max_tets, 5000u);
  EXPECT_EQ(l.growth, 0.2);
}

/// Keys of [heat], beside mechanics of their own.
const std::string kHeatKeys = R"([mesh]
kind = "box"
[heat]
duration_s = 120
sample_every_s = 4
temperature_C = 35
step_s = 0.5
first_step_s = 0.02
longest_step_s = 30
tolerance_K = 0.1
isotherms_C = [-5, -15]
[heat.ice]
factor = 50
viscosity_factor = 20
expansion = 0.06
every_s = 0.25
[[heat.tissue]]
preset = "soft_tissue"
region = "core"
density_kg_m3 = 1010
conductivity_W_m_K = 0.51
frozen_conductivity_W_m_K = 2.1
specific_heat_J_kg_K = 3610
frozen_specific_heat_J_kg_K = 1810
latent_heat_J_kg = 251e3
freezing_begins_C = -1.5
freezing_ends_C = -8.5
perfusion_per_s = 6e-4
blood_temperature_C = 36
blood_heat_capacity_J_m3_K = 3.7e6
metabolic_heat_W_m3 = 4300
death = { cold_C = -20, cold_time_s = 60, ln_frequency_factor = 200, activation_energy_J_mol = 6e5 }
electric_conductivity_S_m = 0.2
electric_rise_per_K = 0.015
dry_share = 0.02
[[heat.boundary]]
set = "x_min"
times_s = [0, 60]
temperatures_C = [-10, -20]
coefficient_W_m2_K = 25
cycles = 2
[[heat.boundary]]
region = "core"
temperature_C = 36.5
[[heat.boundary]]
set = "x_max"
flux_W_m2 = 100
[[heat.boundary]]
set = "y_max"
times_s = [0, 30]
fluxes_W_m2 = [1, 2]
[[heat.boundary]]
region = "vein"
temperature_C = 37
vessel = { diameter_mm = 8, speed_mm_s = 90, length_mm = 40, conductivity_W_m_K = 0.5, heat_capacity_J_m3_K = 3.7e6, viscosity_Pa_s = 4e-3, density_kg_m3 = 1050 }
[[heat.boundary]]
set = "z_max"
temperature_C = 20
times_s = [0, 30]
coefficients_W_m2_K = [10, 0]
[[heat.probe]]
name = "left"
from_m = [0.01, 0.01, 0.01]
to_m = [0.01, 0.01, 0.05]
active_length_mm = 30
radius_mm = 0.75
times_s = [0, 50]
temperatures_C = [-140, -150]
coefficients_W_m_K = [5, 6]
[[heat.probe]]
name = "right"
from_m = [0.02, 0.01, 0.01]
to_m = [0.02, 0.01, 0.05]
temperature_C = -100
coefficient_W_m_K = 4
[[heat.probe]]
name = "middle"
from_m = [0.02, 0.02, 0.01]
to_m = [0.02, 0.02, 0.05]
power_W_m = -200
[[heat.probe]]
name = "fourth"
from_m = [0.03, 0.02, 0.01]
to_m = [0.03, 0.02, 0.05]
times_s = [0, 10]
powers_W_m = [-100, -200]
[[heat.power]]
region = "core"
power_W_m3 = 1e5
[[heat.power]]
times_s = [0, 10]
powers_W_m3 = [0, 1e5]
[[heat.power]]
total_W = 30
pattern = { middle_m = [0.01, 0.02, 0.03], axis = [1, 0, 0], across_mm = 5, along_mm = 12 }
[[heat.power]]
times_s = [0, 10]
totals_W = [20, 10]
[[heat.radio]]
name = "needle"
from_m = [0.01, 0.02, 0.01]
to_m = [0.01, 0.02, 0.05]
active_length_mm = 20
radius_mm = 0.8
ground = "x_min"
power_W = 25
[[heat.radio]]
name = "plates"
set = "x_max"
ground = "x_min"
times_s = [0, 10]
voltages_V = [10, 20]
[[heat.radio]]
name = "constant"
set = "y_max"
ground = "x_min"
voltage_V = 15
[[heat.radio]]
name = "table"
set = "y_max"
ground = "x_min"
times_s = [0, 10]
powers_W = [10, 20]
[[heat.sensor]]
name = "one"
point_m = [0.01, 0.02, 0.03]
[[heat.sensor]]
name = "row"
from_m = [0, 0, 0]
to_m = [0.01, 0, 0]
count = 4
[[heat.sensor]]
name = "mean"
region = "core"
[[heat.front]]
name = "ice"
from_m = [0, 0, 0]
to_m = [0.02, 0, 0]
temperature_C = -2
above_C = -30
[[heat.isotherm]]
name = "kill"
temperature_C = -40
region = "core"
plane_m = { point = [0, 0, 0.01], normal = [0, 1, 1] }
[[check]]
what = "w"
column = "kill_area_m2"
over = "kill_volume_m3"
expected = 2
tolerance = 0.5
[[check]]
what = "w"
column = "frozen_m3"
expected = -4
tolerance_percent = 10
)";

// Every key of [heat] and of checks arrives.
TEST(EveryKey, OfHeatIsRead) {
  const Scene scene = parse(kHeatKeys);
  const HeatSpec& h = *scene.variants.at(0).heat;
  EXPECT_EQ(h.duration, 120.0);
  EXPECT_EQ(h.sample_every, 4.0);
  EXPECT_EQ(h.options.temperature, 35.0);
  EXPECT_EQ(h.options.step, 0.5);
  EXPECT_EQ(h.options.first_step, 0.02);
  EXPECT_EQ(h.options.longest_step, 30.0);
  EXPECT_EQ(h.options.tolerance, 0.1);
  EXPECT_THAT(h.options.isotherms, ElementsAre(-5.0, -15.0));
  EXPECT_EQ(h.ice->options.factor, 50.0);
  EXPECT_EQ(h.ice->options.viscosity_factor, 20.0);
  EXPECT_EQ(h.ice->options.expansion, 0.06);
  EXPECT_EQ(h.ice->every, 0.25);
  ASSERT_EQ(h.tissues.size(), 1U);
  EXPECT_EQ(h.tissues[0].region, "core");
  ThermalTissue t{.density = 1010, .conductivity = 0.51, .frozen_conductivity = 2.1, .specific_heat = 3610};
  t.frozen_specific_heat = 1810, t.latent_heat = 251e3, t.freezing_begins = -1.5, t.freezing_ends = -8.5;
  t.perfusion = 6e-4, t.blood_temperature = 36, t.blood_heat_capacity = 3.7e6, t.metabolic_heat = 4300;
  t.death = TissueDeath{.cold = -20, .cold_time = 60, .ln_frequency_factor = 200, .activation_energy = 6e5};
  t.electric_conductivity = 0.2, t.electric_rise = 0.015, t.dry_share = 0.02;
  EXPECT_EQ(h.tissues[0].tissue, t);
  ASSERT_EQ(h.boundaries.size(), 6U);
  EXPECT_EQ(h.boundaries[0].set, "x_min");
  EXPECT_THAT(h.boundaries[0].times, ElementsAre(0.0, 60.0));
  EXPECT_THAT(h.boundaries[0].temperatures, ElementsAre(-10.0, -20.0));
  EXPECT_EQ(h.boundaries[0].coefficient, 25.0);
  EXPECT_EQ(h.boundaries[0].cycles, 2);
  EXPECT_EQ(h.boundaries[1].region, "core");
  EXPECT_EQ(h.boundaries[1].temperature, 36.5);
  EXPECT_EQ(h.boundaries[2].flux, 100.0);
  EXPECT_THAT(h.boundaries[3].fluxes, ElementsAre(1.0, 2.0));
  const VesselWall& vessel = h.boundaries[4].vessel.value();
  EXPECT_DOUBLE_EQ(vessel.diameter, 0.008);
  EXPECT_DOUBLE_EQ(vessel.speed, 0.09);
  EXPECT_DOUBLE_EQ(vessel.length, 0.04);
  EXPECT_EQ(vessel.conductivity, 0.5);
  EXPECT_EQ(vessel.heat_capacity, 3.7e6);
  EXPECT_EQ(vessel.viscosity, 4e-3);
  EXPECT_EQ(vessel.density, 1050.0);
  EXPECT_THAT(h.boundaries[5].coefficients, ElementsAre(10.0, 0.0));
  ASSERT_EQ(h.probes.size(), 4U);
  EXPECT_EQ(h.probes[0].name, "left");
  EXPECT_EQ(h.probes[0].from, (Vec3d{0.01, 0.01, 0.01}));
  EXPECT_EQ(h.probes[0].to, (Vec3d{0.01, 0.01, 0.05}));
  EXPECT_DOUBLE_EQ(*h.probes[0].active_length, 0.03);
  EXPECT_DOUBLE_EQ(h.probes[0].radius, 0.00075);
  EXPECT_THAT(h.probes[0].temperatures, ElementsAre(-140.0, -150.0));
  EXPECT_THAT(h.probes[0].coefficients, ElementsAre(5.0, 6.0));
  EXPECT_EQ(h.probes[1].temperature, -100.0);
  EXPECT_EQ(h.probes[1].coefficient, 4.0);
  EXPECT_EQ(h.probes[2].power, -200.0);
  EXPECT_THAT(h.probes[3].powers, ElementsAre(-100.0, -200.0));
  EXPECT_EQ(h.powers.at(0).power, 1e5);
  EXPECT_THAT(h.powers.at(1).powers, ElementsAre(0.0, 1e5));
  EXPECT_EQ(h.powers.at(2).total, 30.0);
  EXPECT_EQ(h.powers[2].pattern->middle, (Vec3d{0.01, 0.02, 0.03}));
  EXPECT_EQ(h.powers[2].pattern->axis, (Vec3d{1, 0, 0}));
  EXPECT_DOUBLE_EQ(h.powers[2].pattern->across, 0.005);
  EXPECT_DOUBLE_EQ(*h.powers[2].pattern->along, 0.012);
  EXPECT_THAT(h.powers.at(3).totals, ElementsAre(20.0, 10.0));
  ASSERT_EQ(h.radios.size(), 4U);
  EXPECT_EQ(h.radios[0].name, "needle");
  EXPECT_EQ(*h.radios[0].from, (Vec3d{0.01, 0.02, 0.01}));
  EXPECT_DOUBLE_EQ(*h.radios[0].active_length, 0.02);
  EXPECT_DOUBLE_EQ(h.radios[0].radius, 0.0008);
  EXPECT_EQ(h.radios[0].ground, "x_min");
  EXPECT_EQ(h.radios[0].power, 25.0);
  EXPECT_EQ(h.radios[1].set, "x_max");
  EXPECT_THAT(h.radios[1].voltages, ElementsAre(10.0, 20.0));
  EXPECT_EQ(h.radios[2].voltage, 15.0);
  EXPECT_THAT(h.radios[3].powers, ElementsAre(10.0, 20.0));
  EXPECT_EQ(h.sensors.at(0).point, (Vec3d{0.01, 0.02, 0.03}));
  EXPECT_EQ(h.sensors.at(1).count, 4);
  EXPECT_EQ(h.sensors.at(2).region, "core");
  EXPECT_EQ(h.fronts.at(0).temperature, -2.0);
  EXPECT_EQ(h.fronts[0].above, -30.0);
  EXPECT_EQ(h.isotherms.at(0).temperature, -40.0);
  EXPECT_EQ(h.isotherms[0].region, "core");
  EXPECT_EQ(h.isotherms[0].plane->normal, (Vec3d{0, 1, 1}));
  EXPECT_EQ(scene.checks.at(0).over, "kill_volume_m3");
  EXPECT_EQ(scene.checks[0].at_least, 1.5);
  EXPECT_EQ(scene.checks[0].at_most, 2.5);
  EXPECT_NEAR(*scene.checks.at(1).tolerance, 0.4, 1e-15);
}

/// Every key of a section and of the sections in it.
void collect(const scene::SectionSpec& section, std::set<std::string>& keys) {
  for (const scene::KeySpec& key : section.keys) {
    keys.insert(key.name);
    if (key.section) collect(*key.section, keys);
  }
  const bool of_instruments = section.name.rfind("instrument", 0) == 0 || section.name == "container";
  for (const scene::KindSpec& kind : section.kinds) {
    if (of_instruments) collect(kind.section, keys);
  }
}

// The scene above is what it says: no key of the schema is missing from it (laws and other meshes have their own tests).
TEST(EveryKey, IsInTheSceneOfThisTest) {
  std::set<std::string> keys;
  collect(scene::scene_section(), keys);
  collect(scene::variant_section(), keys);
  EXPECT_GT(keys.size(), 60u);
  const std::string text = kEveryKey + kHeatKeys + kRotations + kPalpation + kAims + test::kEveryInstrument;
  for (const char* key : {"path", "file", "record", "poses", "x_offset", "loss", "quantity", "unit_Pa"})
    keys.erase(key);  // of files, which have tests of their own
  for (const std::string& key : keys) EXPECT_NE(text.find(key), std::string::npos) << key;
}

// Keys that are not given have the defaults of the structs, which are the documented ones.
TEST(Defaults, AreThoseOfTheStructs) {
  const Variant v = parse(test::kSmallScene).variants.at(0);
  const Variant initial;
  EXPECT_EQ(v.name, "main");
  EXPECT_EQ(v.label, "main");
  EXPECT_EQ(v.tissue.youngs_modulus, initial.tissue.youngs_modulus);
  EXPECT_EQ(v.tissue.poisson_ratio, initial.tissue.poisson_ratio);
  EXPECT_EQ(v.tissue.density, initial.tissue.density);
  EXPECT_EQ(v.tissue.viscosity, 0.0);
  EXPECT_TRUE(std::holds_alternative<ConstantLaw>(v.tissue.law));
  EXPECT_FALSE(v.simulation.step) << "auto";
  EXPECT_EQ(v.simulation.precision, Precision::single_precision);
  EXPECT_EQ(v.on_inversion, OnInversion::go_on);
  EXPECT_FALSE(v.duration || v.max_steps);
  EXPECT_EQ(v.output.sample_rate, 500.0);
  EXPECT_EQ(v.output.frames, 60);
  EXPECT_EQ(v.tools.at(0).motion.velocity, 0.01);
  EXPECT_FALSE(v.tools[0].sideways_free);
  EXPECT_EQ(parse(test::kSmallScene).title, "s") << "the file's name";
  EXPECT_FALSE(parse(test::kSmallScene + "[motion]\nstep_s = \"auto\"\n").variants[0].simulation.step);
}

}  // namespace
}  // namespace glisson

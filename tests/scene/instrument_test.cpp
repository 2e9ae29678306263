// instrument_test.cpp — what a scene says of instruments and capsules reaches them, drives them and ends the run; what does
// not fit is told with its line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "scene/every_instrument.h"
#include "scene/scene_text.h"
#include "support/folder.h"

namespace glisson {
namespace {

using test::complaint;
using test::kEveryInstrument;
using test::parse;
using ::testing::HasSubstr;

void expect_near(const Vec3d& a, const Vec3d& b) {
  EXPECT_NEAR(norm(a - b), 0.0, 1e-15) << a.x << " " << a.y << " " << a.z;
}

const InstrumentSpec& instrument(const Variant& v, const std::string& name) {
  for (const InstrumentSpec& x : v.instruments) {
    if (x.name == name) return x;
  }
  throw std::logic_error("no instrument " + name);
}

// A needle keeps its sizes, what its tip needs, its friction and what bends it.
TEST(Instruments, NeedleIsRead) {
  const Variant v = parse(kEveryInstrument).variants.at(0);
  const InstrumentSpec& x = instrument(v, "18 G");
  const auto& n = std::get<NeedleOptions>(x.what);
  expect_near(x.tip, {0.02, 0.021, 0.041});
  expect_near(x.direction, {0, 0, -3});
  expect_near(x.side, {0, 2, 1});
  EXPECT_DOUBLE_EQ(n.diameter, 1.2e-3);
  EXPECT_DOUBLE_EQ(n.length, 0.09);
  EXPECT_DOUBLE_EQ(n.zone, 4e-3);
  EXPECT_DOUBLE_EQ(n.spacing, 1.5e-3);
  EXPECT_EQ(n.rupture.toughness, 120.0);
  EXPECT_FALSE(n.rupture.force);
  EXPECT_DOUBLE_EQ(n.rupture.membrane_thickness, 2e-4);
  EXPECT_EQ(n.tip.cutting, 0.25);
  EXPECT_EQ(n.tip.puncture, 0.5);
  EXPECT_EQ(x.regions.at("vessel").cutting, 0.5);
  EXPECT_EQ(x.regions.at("vessel").puncture, 1.25);
  EXPECT_EQ(n.friction.static_in, 18.0);
  EXPECT_EQ(n.friction.static_out, 17.0);
  EXPECT_EQ(n.friction.dynamic_in, 10.0);
  EXPECT_EQ(n.friction.dynamic_out, 11.0);
  EXPECT_EQ(n.friction.viscous_in, 212.0);
  EXPECT_EQ(n.friction.viscous_out, 239.0);
  EXPECT_DOUBLE_EQ(n.friction.stick_speed, 2.5e-4);
  EXPECT_EQ(n.youngs_modulus, 2e11);
  EXPECT_DOUBLE_EQ(n.inner_diameter, 8e-4);
  EXPECT_EQ(n.bevel_share, 0.3);
  ASSERT_EQ(n.membranes.size(), 2U);
  EXPECT_DOUBLE_EQ(n.membranes[0].depth, 4e-3);
  EXPECT_EQ(n.membranes[0].puncture, 0.75);
  EXPECT_EQ(n.membranes[0].cutting, 0.375);
  EXPECT_DOUBLE_EQ(n.membranes[1].depth, 6.5e-3);
  EXPECT_FALSE(n.membranes[1].cutting);
  ASSERT_TRUE(n.drawn_membranes);
  EXPECT_DOUBLE_EQ(n.drawn_membranes->spacing, 7e-3);
  EXPECT_EQ(n.drawn_membranes->puncture, 2.0);
  EXPECT_EQ(n.drawn_membranes->spread, 0.25);
  EXPECT_EQ(n.drawn_membranes->seed, 9U);
}

// Shapes keep their sizes and how they touch.
TEST(Instruments, ShapesAreRead) {
  const Variant v = parse(kEveryInstrument).variants.at(0);
  const auto contact = [&](const char* name) -> const auto& {
    return std::get<ContactOptions>(instrument(v, name).what);
  };
  const ContactOptions& pressed = contact("punch");
  const auto& punch = std::get<FlatPunch>(pressed.shape);
  EXPECT_DOUBLE_EQ(punch.radius, 3e-3);
  EXPECT_DOUBLE_EQ(punch.edge_radius, 5e-4);
  EXPECT_DOUBLE_EQ(punch.length, 0.02);
  EXPECT_EQ(pressed.friction, 0.4);
  EXPECT_TRUE(pressed.bonded);
  EXPECT_DOUBLE_EQ(pressed.push_out_speed, 0.012);
  EXPECT_DOUBLE_EQ(std::get<Ball>(contact("ball").shape).radius, 7e-3);
  const auto& probe = std::get<NeedleShape>(contact("probe").shape);
  EXPECT_DOUBLE_EQ(probe.diameter, 2e-3);
  EXPECT_DOUBLE_EQ(probe.length, 0.05);
  EXPECT_EQ(probe.tip, TipForm::bevelled);
  EXPECT_EQ(probe.tip_angle, 0.5);
  EXPECT_TRUE(std::holds_alternative<Plate>(contact("plate").shape));
  EXPECT_FALSE(contact("plate").bonded);
  const auto& block = std::get<Block>(contact("block").shape);
  expect_near(block.size, {4e-3, 5e-3, 6e-3});
  EXPECT_DOUBLE_EQ(block.edge_radius, 1e-3);
}

// Each motion moves its tool as its keys say, along the tool's direction where it gives none, and ends when it ends.
TEST(Instruments, MoveAsTheyAreTold) {
  const Variant v = parse(kEveryInstrument).variants.at(0);
  const auto at = [&](const std::string& name, double time) {
    const InstrumentSpec& x = instrument(v, name);
    return make_driver(x)->advance(time, 0.0, {}).position - x.tip;
  };
  // 30 mm at 5 mm/s with a ramp of 0.1 s, rest 2 s, √5 mm aside at 1 mm/s, back over √905 mm at 5 mm/s.
  expect_near(at("18 G", 0.125 + 6.1), {0, 0, -0.03});
  expect_near(at("18 G", 0.125 + 8.1), {0, 0, -0.03});
  expect_near(at("18 G", 0.125 + 8.1 + std::sqrt(5.0)), {0.001, 0.002, -0.03});
  EXPECT_NEAR(*make_driver(instrument(v, "18 G"))->end(), 0.125 + 8.1 + std::sqrt(5.0) + std::sqrt(905.0) / 5.0, 1e-12);
  EXPECT_NEAR(at("punch", 2.0).z, -(0.001 + 0.002 * std::sin(2 * M_PI * 3 * 1.5)), 1e-15);
  EXPECT_DOUBLE_EQ(*make_driver(instrument(v, "punch"))->end(), 4.5);
  EXPECT_NEAR(at("probe", 0.5 + 0.05 + 4.0 / 3.0).z, -0.004, 1e-15);
  EXPECT_DOUBLE_EQ(*make_driver(instrument(v, "ball"))->end(), 3.1);
  const PushSpec& push = std::get<PushSpec>(instrument(v, "ball").motion.how);
  EXPECT_EQ(push.force, 2.0);
  EXPECT_EQ(push.swing, 0.5);
  EXPECT_EQ(push.frequency, 4.0);
  EXPECT_EQ(push.ramp, 0.2);
  EXPECT_EQ(push.tool.mass, 0.1);
  EXPECT_EQ(push.tool.damping, 6.0);
  EXPECT_FALSE(push.tool.guided);
  EXPECT_DOUBLE_EQ(*push.tool.stop, 0.008);
  EXPECT_DOUBLE_EQ(run_duration(v), *make_driver(instrument(v, "18 G"))->end()) << "the run ends with the last of them";
}

// A tool's own z axis points back along its direction, its x axis as far towards the side as that is across; the axes are a
// rotation.
TEST(Instruments, StandAsTheyPoint) {
  const Variant v = parse(kEveryInstrument).variants.at(0);
  const Pose pose = start_pose(instrument(v, "18 G"));
  expect_near(pose.axes * Vec3d{0, 0, 1}, {0, 0, 1});
  expect_near(pose.axes * Vec3d{1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(determinant(pose.axes), 1.0, 1e-15);
}

// A capsule keeps its law, strength and set.
TEST(Instruments, CapsuleIsRead) {
  const CapsuleSpec c = parse(kEveryInstrument).variants.at(0).capsules.at(0);
  EXPECT_EQ(c.options.name, "skin");
  EXPECT_EQ(c.set, "top");
  EXPECT_DOUBLE_EQ(c.options.thickness, 1.5e-4);
  EXPECT_EQ(c.options.youngs_modulus, 5e6);
  EXPECT_EQ(c.options.poisson_ratio, 0.3);
  EXPECT_EQ(c.options.prestretch, 1.02);
  EXPECT_EQ(c.options.stiffening, 4.0);
  EXPECT_EQ(c.options.strength, 90.0);
  EXPECT_DOUBLE_EQ(c.options.averaging_length, 3e-3);
}

// A blade keeps its edge, the toughness it meets and how it cuts.
TEST(Instruments, BladeIsRead) {
  const Variant v = parse(kEveryInstrument).variants.at(0);
  const auto& blade = std::get<BladeOptions>(instrument(v, "scalpel").what);
  expect_near(blade.edge_from, {0, -0.003, 0.001});
  expect_near(blade.edge_to, {0, 0.004, 0.002});
  EXPECT_EQ(blade.toughness, 150.0);
  EXPECT_EQ(blade.cut_every, 0.004);
  EXPECT_FALSE(blade.cutting.snap);
  EXPECT_EQ(blade.cutting.least_quality, 0.2);
  EXPECT_EQ(blade.cutting.least_step, 0.5);
}

// A container keeps its vessel and how it holds the tissue.
TEST(Instruments, ContainerIsRead) {
  const auto options = [](const std::string& text) { return parse(text).variants.at(0).container.value().options; };
  const ContainerOptions wet = options(kEveryInstrument);
  const auto& box = std::get<BoxVessel>(wet.vessel);
  EXPECT_DOUBLE_EQ(box.width, 0.04);
  EXPECT_DOUBLE_EQ(box.length, 0.041);
  EXPECT_DOUBLE_EQ(box.height, 0.042);
  expect_near(wet.pose.position, {0.02, 0.02, 0});
  EXPECT_TRUE(wet.holds_floor && wet.holds_wall && !wet.bonded);
  EXPECT_EQ(wet.friction, 0.2);
  EXPECT_DOUBLE_EQ(wet.push_out_speed, 0.008);
  const std::string rest = "\n[mesh]\nkind = \"cylinder\"\n[motion]\nduration_s = 1\n";
  const ContainerOptions bonded = options("[container]\nkind = \"cylinder\"\nradius_mm = 30\nhold = \"bonded\"" + rest);
  EXPECT_DOUBLE_EQ(std::get<CylinderVessel>(bonded.vessel).radius, 0.03);
  EXPECT_TRUE(std::isinf(std::get<CylinderVessel>(bonded.vessel).height));
  EXPECT_TRUE(bonded.bonded && !bonded.holds_floor && !bonded.holds_wall);
  const ContainerOptions free = options("[container]\nkind = \"cylinder\"\nradius_mm = 30" + rest);
  EXPECT_FALSE(free.bonded || free.holds_floor || free.holds_wall);
}

/// A block with a needle above it, in lines that messages can be counted on: [[instrument]] is line 8.
const std::string kNeedle = R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.04, 0.04, 0.04]
[[fixed]]
set = "z_min"

[[instrument]]
kind = "needle"
name = "needle"
tip_m = [0.02, 0.021, 0.041]
motion = { kind = "press", depth_mm = 10, velocity_mm_s = 50 }
)";

std::string changed(std::string text, const std::string& find, const std::string& replace) {
  const std::size_t at = text.find(find);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + find);
  return text.replace(at, find.size(), replace);
}

// What is wrong is said with line, key, value, range and way out.
TEST(Instruments, MistakesAreTold) {
  EXPECT_EQ(complaint(changed(kNeedle, "tip_m", "tip")),
            "s.toml:8:1: instrument.0: give one of `tip_m`, `aim`\n"
            "s.toml:11:7: instrument.0.tip: expected a table, got a list of 3");
  EXPECT_THAT(complaint(changed(kNeedle, "name =", "diametre_mm = 1\nname =")),
              HasSubstr("s.toml:10:1: instrument.0.diametre_mm: unknown key; did you mean `diameter_mm`?"));
  EXPECT_THAT(complaint(changed(kNeedle, "name =", "radius_mm = 1\nname =")),
              HasSubstr("instrument.0.radius_mm: unknown key here; it belongs in [[instrument]] of kind \"punch\""));
  EXPECT_THAT(
      complaint(changed(kNeedle, "velocity_mm_s = 50", "velocity_mm_s = 0")),
      HasSubstr(
          "s.toml:12:59: instrument.0.motion.velocity_mm_s: 0 mm/s is out of range; allowed: > 0 and ≤ 1e+09 mm/s"));
  EXPECT_THAT(complaint(changed(kNeedle, "\"press\"", "\"pres\"")), HasSubstr("did you mean \"press\"?"));
  EXPECT_THAT(complaint(changed(kNeedle, "name =", "direction = [0, 0, 0]\nname =")), HasSubstr("has no direction"));
  EXPECT_THAT(
      complaint(changed(kNeedle, "name =", "side = [0, 0, 2]\nname =")),
      HasSubstr("s.toml:10:8: instrument.0.side: `side` [0, 0, 2] does not point across `direction` [0, 0, -1]"));
  EXPECT_THAT(complaint(kNeedle + "friction = { static_in_N_m = 1, dynamic_in_N_m = 2 }\n"),
              HasSubstr("dynamic_in_N_m: 2 N/m is above static_in = 1 N/m; tissue that slips holds no more"));
  EXPECT_THAT(complaint(kNeedle + "rupture = { force_N = 1, toughness_J_m2 = 2 }\n"),
              HasSubstr("contradicts `force_N`"));
  EXPECT_THAT(complaint(kNeedle + "inner_diameter_mm = 2\n"),
              HasSubstr("inner_diameter_mm: 2 mm is not below the diameter, 1.27 mm"));
  EXPECT_THAT(complaint(kNeedle + "membranes = [{ depth_mm = 3 }, { depth_mm = 2 }]\n"),
              HasSubstr("membranes: number 2, at 2 mm, is not below the one before it, at 3 mm"));
  EXPECT_THAT(complaint(kNeedle + "membranes = [{ puncture_N = 1 }]\n"), HasSubstr("missing key `depth_mm`"));
  EXPECT_THAT(complaint(kNeedle + "drawn_membranes = { spacing_mm = 0.01 }\n"),
              HasSubstr("drawn_membranes.spacing_mm: 0.01 mm is out of range; allowed: 0.1 to 1e+07 mm"));
  EXPECT_THAT(complaint(kNeedle + "[[instrument]]\nkind = \"ball\"\nname = \"Needle\"\ntip_m = [0, 0, 1]\n"
                                  "motion = { kind = \"press\" }\n"),
              HasSubstr("\"Needle\" is taken"));
  EXPECT_THAT(complaint(kNeedle + "[[tool]]\nname = \"needle\"\nset = \"z_max\"\n"), HasSubstr("is taken by a tool"));
  EXPECT_THAT(complaint(kNeedle + "[[capsule]]\nset = \"skin\"\n"), HasSubstr("capsule.0.set: no vertex set \"skin\""));
  EXPECT_THAT(complaint(changed(kNeedle, "\"press\", depth_mm = 10, velocity_mm_s = 50", "\"strokes\", strokes = []")),
              HasSubstr("is empty; give at least one stroke"));
  EXPECT_THAT(complaint(changed(kNeedle, "\"press\", depth_mm = 10, velocity_mm_s = 50", "\"push\"")),
              HasSubstr("nothing says when the run ends"));
}

// Needles, blades, rigid tools in contact, containers and capsules support long steps, also where a push moves them.
TEST(Instruments, NeedAnIntegratorThatSupportsThem) {
  for (const std::string word : {"implicit", "quasi_static"}) {
    const std::string implicit = "[motion]\nintegrator = \"" + word + "\"\n";
    EXPECT_EQ(complaint(kNeedle + implicit), "");
    EXPECT_EQ(
        complaint(kNeedle + implicit + "[container]\nkind = \"box\"\nwidth_mm = 10\nlength_mm = 10\n[[capsule]]\n"),
        "");
    const std::string push = "\"push\", duration_s = 1";
    EXPECT_EQ(complaint(changed(kNeedle, "\"press\", depth_mm = 10, velocity_mm_s = 50", push) + implicit), "");
    const std::string ball = "[mesh]\nkind = \"box\"\n[[instrument]]\nkind = \"ball\"\ntip_m = [0, 0, 1]\n";
    EXPECT_EQ(complaint(ball + "motion = { kind = \"press\" }\n" + implicit), "");
    EXPECT_EQ(complaint(ball + "motion = { kind = \"push\", duration_s = 1 }\n" + implicit), "");
    EXPECT_EQ(complaint(ball + "bonded = true\nmotion = { kind = \"press\" }\n" + implicit), "");
    EXPECT_EQ(complaint(ball + "friction = 0.2\nmotion = { kind = \"press\" }\n" + implicit), "");
    const std::string blade = changed(ball, "\"ball\"", "\"blade\"");
    EXPECT_EQ(complaint(blade + "motion = { kind = \"press\" }\n" + implicit), "");
    EXPECT_EQ(complaint(blade + "motion = { kind = \"push\", duration_s = 1 }\n" + implicit), "");
  }
  const std::string semi = kNeedle + "[motion]\nintegrator = \"semi_implicit\"\n";
  EXPECT_EQ(complaint(semi), "");
  EXPECT_EQ(complaint(semi + "[tissue]\nviscosity_Pa_s = 1\n"), "");
  EXPECT_EQ(complaint(changed(semi, kNeedle.substr(kNeedle.find("[[instrument]]")), "[[capsule]]\n") +
                      "duration_s = 1\n[tissue]\nviscosity_Pa_s = 1\n"),
            "");
  EXPECT_EQ(complaint(changed(semi, "\"press\", depth_mm = 10, velocity_mm_s = 50", "\"push\", duration_s = 1") +
                      "[tissue]\nviscosity_Pa_s = 1\n"),
            "");
}

struct Recorder : RunObserver {
  std::vector<Sample> samples;
  std::vector<RunEvent> events;
  std::size_t instruments = 0;
  void on_built(const BuiltVariant& built) override { instruments = built.instruments.size(); }
  void on_sample(const Sample& s) override {
    const double last = events.empty() ? 0.0 : events.back().what.time;
    EXPECT_LE(last, s.time + 0.003) << "events come before later samples; a step is 2 ms";
    samples.push_back(s);
  }
  void on_event(const RunEvent& e) override { events.push_back(e); }
};

const std::atomic<bool> kGoOn{false};

// A needle goes through the whole of a run: depths follow its motion, its force presses, contact and puncture are told in
// their order at the depth where the surface is and later, and variants of its speed come from one scene.
TEST(Instruments, ANeedleRunsFromAScene) {
  const std::string text = kNeedle +
                           "rupture.force_N = 0.05\ntip.cutting_N = 0.01\n[output]\nsample_rate_hz = 1000\nframes = 0\n"
                           "[[variant]]\nname = \"slow\"\n[[variant]]\nname = \"fast\"\n"
                           "instrument.needle.motion.velocity_mm_s = 100\n";
  const Scene scene = parse(text);
  ASSERT_EQ(scene.variants.size(), 2u);
  EXPECT_DOUBLE_EQ(run_duration(scene.variants[0]), 0.2);
  EXPECT_DOUBLE_EQ(run_duration(scene.variants[1]), 0.1);
  Recorder seen;
  const RunSummary summary = run_variant(scene.variants[1], {}, seen, kGoOn);
  EXPECT_EQ(summary.end, RunSummary::End::finished);
  EXPECT_EQ(seen.instruments, 1u);
  ASSERT_GE(seen.events.size(), 2u);
  EXPECT_EQ(seen.events[0].what.event, "contact");
  EXPECT_NEAR(seen.events[0].what.depth, 0.001, 0.1 * summary.step_s + 1e-9) << "1 mm above the surface, a step's way";
  EXPECT_EQ(seen.events[1].what.event, "puncture");
  EXPECT_GT(seen.events[1].what.depth, seen.events[0].what.depth);
  double peak = 0.0;
  for (const Sample& s : seen.samples) {
    EXPECT_NEAR(s.instruments.at(0).depth, 0.1 * s.time, 0.1 * summary.step_s + 1e-9);
    peak = std::max(peak, -s.instruments[0].force.z);
  }
  EXPECT_GT(peak, 0.045);
  EXPECT_NEAR(summary.peak_force_N, peak, 1e-12);
}

// A blade from a scene parts the body: new vertices come, and the edge works against the toughness of the tissue. In long steps, too.
TEST(Instruments, ABladeCutsFromAScene) {
  const std::string blade =
      "kind = \"blade\"\nedge_from_mm = [0, -30, 0]\nedge_to_mm = [0, 30, 0]\ntoughness_J_m2 = 2\n";
  const std::string deep = changed(changed(kNeedle, "[4, 4, 4]", "[6, 6, 8]"), "depth_mm = 10", "depth_mm = 21");
  for (const std::string motion :
       {"", "[motion]\nintegrator = \"implicit\"\n", "[motion]\nintegrator = \"quasi_static\"\nstep_s = 0.01\n",
        "[motion]\nintegrator = \"semi_implicit\"\n[tissue]\nviscosity_Pa_s = 3\n"}) {
    const Scene scene = parse(changed(deep, "kind = \"needle\"\n", blade) + motion + "[output]\nframes = 0\n");
    BuiltVariant built(scene.variants.at(0), {});
    const std::size_t before = built.simulation.mesh().vertices.size();
    while (built.simulation.time() < 0.42) ASSERT_LE(built.simulation.step().status, StepStatus::inverted) << motion;
    EXPECT_GT(built.simulation.mesh().vertices.size(), before) << motion;
    EXPECT_GT(dynamic_cast<const Blade&>(*built.instruments.at(0)).area(), 0.3 * 0.04 * 0.02) << motion;
  }
}

// A region that a needle is told of must be one.
TEST(Instruments, UnknownRegionIsToldWhenTheMeshIsKnown) {
  const Scene scene = parse(kNeedle + "regions.vessel = { cutting_N = 1 }\n");
  try {
    build_variant(scene.variants.at(0), {});
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("s.toml:8:1: instrument.0: the mesh has no region \"vessel\""));
  }
}

/// A file of a record that is gone with the test; what is said of it begins with its name alone.
struct RecordFile {
  test::Folder folder;
  std::filesystem::path path;
  explicit RecordFile(const std::string& text) : path(folder.write("record.csv", text)) {}
  std::string complaint() const {
    try {
      load_record(path, {0, 0, -1});
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return {};
  }
};

// A record is read whatever its line ends, the order of its columns and its unit; what is wrong is told with its line.
TEST(Record, IsReadOrRefusedWithItsLine) {
  const RecordFile depths("# from a robot\n\"time_s\", force_N ,depth_mm\r\n0,1,0\r\n\n0.5,2,4\n1,3,10\n");
  const RecordedMotion record = load_record(depths.path, {0, 0, -1});
  EXPECT_EQ(record.times, (std::vector<double>{0, 0.5, 1}));
  expect_near(record.positions.at(2), {0, 0, -0.01});
  const RecordFile places("z_m,x_m,time_s,y_m\n3,1,0,2\n6,4,1,5\n");
  expect_near(load_record(places.path, {0, 0, -1}).positions.at(1), {4, 5, 6});
  const std::string name = "record.csv";
  EXPECT_EQ(RecordFile("t,depth_m\n0,1\n").complaint(),
            name + ":1: no column `time_s`; the first line names the columns: time_s, depth_m");
  EXPECT_THAT(RecordFile("time_s,x_m\n0,1\n").complaint(), HasSubstr(":1: neither `depth_m` nor"));
  EXPECT_EQ(RecordFile("time_s,depth_m\n0,1\n1,high\n").complaint(),
            name + ":3: \"high\" in column 2 is no finite number");
  EXPECT_THAT(RecordFile("time_s,depth_m\n0,1\n1\n").complaint(), HasSubstr(":3: \"\" in column 2"));
  EXPECT_THAT(RecordFile("time_s,depth_m\n0,1\n1,inf\n").complaint(), HasSubstr(":3: \"inf\""));
  EXPECT_EQ(RecordFile("time_s,depth_m\n0,1\n1,2\n1,3\n").complaint(),
            name + ":4: time_s = 1 is not later than on the line before");
  EXPECT_THAT(RecordFile("time_s,depth_m\n0,1\n").complaint(), HasSubstr("fewer than two times"));
  EXPECT_THAT(RecordFile("").complaint(), HasSubstr("fewer than two times"));
}

// A scene finds its record beside itself, follows it and ends with it; one that is not there is told at the motion's line.
TEST(Record, DrivesAnInstrument) {
  const RecordFile file("time_s,depth_m\n5,0\n6,0.01\n8,0\n");
  const std::string text = changed(kNeedle, "\"press\", depth_mm = 10, velocity_mm_s = 50",
                                   "\"record\", start_s = 0.5, path = \"" + file.path.filename().string() + "\"");
  const Scene scene = parse_scene(text, "s.toml", file.path.parent_path());
  EXPECT_DOUBLE_EQ(run_duration(scene.variants.at(0)), 3.5);
  const auto driver = make_driver(scene.variants[0].instruments.at(0));
  expect_near(driver->advance(1.5, 0.0, {}).position, {0.02, 0.021, 0.031});
  EXPECT_THAT(complaint(text), HasSubstr("s.toml:12:10: instrument.0.motion: /scenes/" + file.path.filename().string() +
                                         ": cannot be read"));
}

// A tool follows a record, too, from its start on and along its direction; speed and depth contradict it, and an override
// takes the place of those of the scene.
TEST(Record, DrivesATool) {
  const RecordFile file("time_s,depth_mm\n5,2\n6,3\n8,2.5\n");
  const std::string record = "record = { path = \"" + file.path.string() + "\", start_s = 0.5 }";
  const std::string text = changed(test::kSmallScene, "depth_mm = 1", record);
  const Variant v = parse(text).variants.at(0);
  EXPECT_DOUBLE_EQ(run_duration(v), 3.5);
  expect_near(tool_path(v.tools.at(0)).displacement(1.5), {0, 0, -0.001});
  EXPECT_EQ(tool_start(v.tools[0]), 0.5);
  EXPECT_THAT(complaint(text + "velocity_mm_s = 5\n"), HasSubstr("tool.0.velocity_mm_s: contradicts `record`"));
  EXPECT_THAT(complaint(changed(text, file.path.string(), "none.csv")),
              HasSubstr("tool.0.record: /scenes/none.csv: cannot be read"));
  const Override set{"tool.press.record.path", file.path.string()};
  EXPECT_TRUE(parse(test::kSmallScene, {set}).variants.at(0).tools.at(0).record);
}

}  // namespace
}  // namespace glisson

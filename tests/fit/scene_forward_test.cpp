// scene_forward_test.cpp — a scene as forward model is the scene's own run, led along the measured displacement.
#include "fit/forward/scene_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>

#include "fit/data/curve_file.h"
#include "fit/forward/offset_model.h"
#include "fit/search/cached_model.h"
#include "glisson/instruments/driven_set.h"
#include "support/places.h"
#include "support/scene_runs.h"

namespace glisson::fit {
namespace {

using ::testing::HasSubstr;

Curve press(double velocity, double depth, int points) {
  Curve c;
  c.name = "press", c.velocity = velocity;
  for (int i = 0; i < points; ++i) {
    c.displacement.push_back(depth * i / (points - 1));
    c.time.push_back(c.displacement.back() / velocity);
  }
  c.force.assign(c.size(), 0.0);
  return c;
}

const std::string kBlock = R"([mesh]
kind = "box"
cells = [3, 3, 3]
size_m = [0.03, 0.03, 0.03]
[tissue]
law = { kind = "polynomial", coefficients_Pa = [20000, 0] }
[motion]
damping_rate_per_s = 100
[[fixed]]
set = "z_min"
)";
const std::string kTool = "[[tool]]\nname = \"plate\"\nset = \"z_max\"\nvelocity_mm_s = 10\ndepth_mm = 4\n";
const std::string kPunch = R"([[instrument]]
kind = "punch"
name = "punch"
tip_m = [0.015, 0.015, 0.0305]
radius_mm = 6
motion = { kind = "press", velocity_mm_s = 10, depth_mm = 4.5 }
)";

SceneText made(const std::string& text) {
  return {.text = text, .name = "s.toml", .base = "/scenes", .overrides = {}, .variant = {}};
}

std::vector<double> force(const MotionModel& model, const std::vector<double>& values, double contact = 0.0) {
  const Prediction p = model.predict_from(0, values, contact);
  EXPECT_EQ(p.failure, "");
  return p.force;
}

double largest(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0, [](double a, double b) { return std::max(a, std::abs(b)); });
}

/// Samples of a run as it is written: time and the force that a model shows.
struct OwnRun final : RunObserver {
  std::vector<double> time, force;
  std::shared_ptr<Instrument> tool;
  void on_built(const BuiltVariant& built) override { tool = built.instruments.at(0); }
  void on_sample(const Sample& s) override {
    time.push_back(s.time);
    const auto* set = dynamic_cast<const DrivenSet*>(tool.get());
    const Vec3d inertial = set != nullptr ? set->parts().inertial : Vec3d{};
    force.push_back(-(s.instruments.at(0).force - inertial).z);
  }
  double at(double t) const {
    for (std::size_t i = 1; i < time.size(); ++i) {
      if (time[i] >= t) return force[i - 1] + (force[i] - force[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
    }
    return force.back();
  }
};
OwnRun own_run(const std::string& text) {
  OwnRun run;
  const std::atomic<bool> never{false};
  run_variant(parse_scene(text, "s.toml", "/", {}).variants.at(0), {}, run, never);
  return run;
}

// A curve at the speed of the scene's own press is that press: the same steps, a record in place of it. What is left is the
// sampling, 200 Hz and more, of forces that ring at some 100 Hz for the first tenth of a second.
TEST(SceneModel, FollowsTheCurveAsTheSceneItsPress) {
  const SceneModel tool(made(kBlock + kTool), {}, {press(0.01, 0.004, 41)});
  const OwnRun plate = own_run(kBlock + kTool + "[output]\nsample_rate_hz = 5000\n");
  const std::vector<double> f = force(tool, {});
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_NEAR(f[i], plate.at(0.01 * static_cast<double>(i)), 0.01 * largest(f));
  // half a millimetre of approach, and as much before the force counts
  const SceneModel punch(made(kBlock + kPunch), {}, {press(0.01, 0.004, 41)}, {.approach = 0.0005});
  const OwnRun way = own_run(kBlock + kPunch + "[output]\nsample_rate_hz = 5000\n");
  const std::vector<double> p = force(punch, {});
  EXPECT_GT(largest(p), 0.05);
  for (std::size_t i = 0; i < p.size(); ++i)
    EXPECT_NEAR(p[i], way.at(0.05 + 0.01 * static_cast<double>(i)), 0.02 * largest(p));
}

// Parameters reach the run, an element of a list alone; a contact that lies deeper is a shorter way.
TEST(SceneModel, TakesParametersAndContact) {
  const std::vector<std::string> keys{"tissue.youngs_modulus_Pa", "tissue.law.coefficients_Pa[1]"};
  const std::string quiet = kBlock.substr(0, kBlock.find("damping")) +
                            "integrator = \"quasi_static\"\nstep_s = 0.02\n" + kBlock.substr(kBlock.find("[[fixed]]")) +
                            kTool;
  const SceneModel rest(made(quiet), keys, {press(0.01, 0.004, 41)});
  const std::vector<double> base = force(rest, {3600, 0}), twice = force(rest, {7200, 0}),
                            bent = force(rest, {3600, 1e5});
  EXPECT_GT(twice.back(), 1.3 * base.back());
  EXPECT_GT(bent.back(), 1.1 * base.back());
  const std::vector<double> later = force(rest, {3600, 0}, 0.001);
  EXPECT_EQ(later[5], 0.0);
  // cubics between static steps of 0.02 s, not at the same places of the way
  for (std::size_t i = 12; i < later.size(); ++i) EXPECT_NEAR(later[i], base[i - 10], 2e-3 * base.back());
}

// What cannot run is told, with the curve or the key, and not thrown.
TEST(SceneModel, FailsInWords) {
  const SceneModel model(made(kBlock + kTool), std::vector<std::string>{"tissue.poisson_ratio"},
                         {press(0.01, 0.004, 11)});
  EXPECT_THAT(model.predict(0, std::vector{0.6}).failure, HasSubstr("tissue.poisson_ratio: 0.6 is out of range"));
  const SceneModel other(made(kBlock + kTool), {}, {press(0.01, 0.004, 11)}, {.tool = "needle"});
  EXPECT_THAT(other.predict(0, {}).failure, HasSubstr("no tool or instrument \"needle\"; the scene has: plate"));
  const SceneModel vessel(made(kBlock + kTool), {}, {press(0.01, 0.004, 11)}, {.force = "bottom"});
  EXPECT_THAT(vessel.predict(0, {}).failure, HasSubstr("the scene has none"));
  const SceneModel wrong(made(kBlock + "law = 3\n"), {}, {press(0.01, 0.004, 11)});
  EXPECT_THROW(wrong.variant(0, {}), SceneError);
  EXPECT_THAT(wrong.predict(0, {}).failure, HasSubstr("s.toml:11:1: fixed.0.law"));
  const std::atomic<bool> stopped{true};
  const SceneModel halted(made(kBlock + kTool), {}, {press(0.01, 0.004, 11)}, {.stop = &stopped});
  EXPECT_THAT(halted.predict(0, {}).failure, HasSubstr("interrupted"));
  Curve back = press(0.01, 0.004, 11);
  back.time[5] = back.time[4];
  EXPECT_THROW(SceneModel(made(kBlock + kTool), {}, {back}), std::invalid_argument);
}

// What the floor carries is what the punch presses, once nothing moves any more: action and reaction.
TEST(SceneModel, MeasuresTheFloorOfAContainer) {
  const std::string vessel =
      kBlock.substr(0, kBlock.find("[[fixed]]")) +
      "[container]\nkind = \"box\"\nwidth_mm = 60\nlength_mm = 60\nfloor_m = [0.015, 0.015, 0]\nhold = \"bonded\"\n" +
      kPunch;
  Curve held = press(0.01, 0.002, 11);
  for (const double t : {0.3, 0.5, 0.7, 1.0})
    held.time.push_back(held.time.back() + t), held.displacement.push_back(0.002);
  held.force.assign(held.size(), 0.0);
  const SceneModel floor(made(vessel), {}, {held}, {.force = "bottom", .approach = 0.0005});
  const SceneModel punch(made(vessel), {}, {held}, {.approach = 0.0005});
  const double carried = force(floor, {}).back(), pressed = force(punch, {}).back();
  EXPECT_GT(pressed, 0.05);
  EXPECT_NEAR(carried, pressed, 0.01 * pressed);
}

// Many runs at once have the bytes of one.
TEST(SceneModel, RunsSideBySide) {
  const SceneModel model(made(kBlock + kTool), std::vector<std::string>{"tissue.youngs_modulus_Pa"},
                         {press(0.02, 0.004, 11)});
  const std::vector<double> once = force(model, {5000});
  std::vector<std::vector<double>> all(8);
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t i) { all[i] = model.predict(0, std::vector{5000.0}).force; });
  for (const auto& f : all) EXPECT_EQ(f, once);
}

/// A press that begins `first` into the file's displacements.
Curve press_from(double first, double velocity, double depth, int points, const std::string& name = "press") {
  Curve c = press(velocity, depth - first, points);
  c.name = name;
  for (double& d : c.displacement) d += first;
  return c;
}

std::string quasi_static(const std::string& scene) {
  const std::size_t at = scene.find("damping");
  return scene.substr(0, at) + "integrator = \"quasi_static\"\nstep_s = 0.01\n" + scene.substr(scene.find("[[fixed]]"));
}

// A press at constant speed that meets the tissue elsewhere is read from one run. Equal steps of a static scheme are at the
// same places in either run, so only the points between them and rounding are left; the explicit scheme samples ringing forces
// elsewhere, and its means are over 1 % of another length of run.
TEST(SceneModel, ReadsAnotherContactFromTheSameRun) {
  const Curve curve = press_from(0.001, 0.01, 0.004, 31);
  const std::vector<double> E{5000};
  for (const bool still : {true, false}) {
    const SceneText scene = made(still ? quasi_static(kBlock + kTool) : kBlock + kTool);
    const std::vector<std::string> key{"tissue.youngs_modulus_Pa"};
    const SceneModel shared(scene, key, {curve}, {.contacts = {{-0.001, 0.0008}}}), own(scene, key, {curve});
    int runs = 0;
    for (const double contact : {0.0, -0.001, -0.0003, 0.0008}) {
      const Prediction read = shared.predict_from(0, E, contact);
      ASSERT_EQ(read.failure, "");
      if (!read.reused) ++runs;
      const std::vector<double> made_for_it = force(own, E, contact);
      for (std::size_t i = 0; i < made_for_it.size(); ++i)
        EXPECT_NEAR(read.force[i], made_for_it[i], (still ? 1e-6 : 0.01) * largest(made_for_it)) << contact;
    }
    EXPECT_EQ(runs, 1);
  }
}

// An instrument goes its approach first, in the shared run as in one of its own.
TEST(SceneModel, ReadsAnotherContactAfterAnApproach) {
  const Curve curve = press_from(0.001, 0.01, 0.004, 31);
  const SceneModel shared(made(kBlock + kPunch), {}, {curve}, {.approach = 0.0005, .contacts = {{-0.001, 0.0008}}}),
      own(made(kBlock + kPunch), {}, {curve}, {.approach = 0.0005});
  const std::vector<double> made_for_it = force(own, {}, 0.0005), read = force(shared, {}, 0.0005);
  EXPECT_GT(largest(read), 0.05);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_NEAR(read[i], made_for_it[i], 0.01 * largest(made_for_it));
}

// Zero of the force and contact are no runs of the scene; nor are repetitions that differ in them, whatever rows they have.
TEST(SceneModel, RunsOnceForOffsetsAndRepetitions) {
  const std::vector<Curve> curves{press_from(0.001, 0.01, 0.004, 31, "a"), press_from(0.0012, 0.01, 0.0039, 17, "b")};
  const std::vector<Parameter> parameters{{.name = "tissue.youngs_modulus_Pa", .unit = {}, .low = 1e3, .high = 1e4},
                                          {.name = "curve.a.contact_mm", .unit = {}, .low = -0.5, .high = 0.5},
                                          {.name = "curve.b.contact_mm", .unit = {}, .low = -0.5, .high = 0.5},
                                          {.name = "curve.force_offset_N", .unit = {}, .low = -1, .high = 1}};
  std::vector<std::string> keys;
  for (const Parameter& p : parameters) keys.push_back(p.name);
  const std::vector<ContactRange> contacts = contact_ranges(parameters, curves);
  EXPECT_DOUBLE_EQ(contacts[1].low, -0.0005);
  const auto scene = std::make_shared<SceneModel>(made(kBlock + kTool), inner_keys(keys), curves,
                                                  SceneModelOptions{.contacts = contacts});
  const CachedModel model(std::make_shared<OffsetModel>(scene, keys), curves, {1, 1});
  const std::vector<double> first = model.predict(0, std::vector{5000.0, 0.0, 0.0, 0.0}).force;
  const std::vector<double> higher = model.predict(0, std::vector{5000.0, 0.0, 0.1, 0.25}).force;
  ASSERT_EQ(first.size(), 31u);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_DOUBLE_EQ(higher[i], first[i] + 0.25);
  EXPECT_LT(model.predict(0, std::vector{5000.0, 0.5, 0.0, 0.0}).force.back(), first.back());
  EXPECT_EQ(model.predict(1, std::vector{5000.0, 0.5, -0.5, 0.1}).force.size(), 17u);
  EXPECT_EQ(model.runs(), 1u);
  model.predict(1, std::vector{6000.0, 0.5, -0.5, 0.1});
  EXPECT_EQ(model.runs(), 2u);
}

// What goes other than straight from rest has a run for each contact; a force offset is free there, too.
TEST(SceneModel, RunsEachContactOfAHold) {
  Curve held = press_from(0.001, 0.01, 0.004, 16);
  held.time.push_back(held.time.back() + 0.1), held.displacement.push_back(0.004), held.force.push_back(0.0);
  const SceneModel model(made(kBlock + kTool), {}, {held}, {.contacts = {{-0.001, 0.0005}}});
  EXPECT_FALSE(model.predict_from(0, {}, 0.0).reused);
  EXPECT_FALSE(model.predict_from(0, {}, 0.0002).reused);
  EXPECT_TRUE(model.predict_from(0, {}, 0.0002).reused);
}

// A shared run that ends early serves the contacts that need no more of it; the others hear why.
TEST(SceneModel, ReadsWhatARunLeftBeforeItFailed) {
  const Curve deep = press_from(0.001, 0.1, 0.024, 24);
  const std::string stops = "[motion]\non_inversion = \"stop\"\n", scene = quasi_static(kBlock + kTool);
  const std::string careful =
      scene.substr(0, scene.find("[motion]\n")) + stops + scene.substr(scene.find("integrator"));
  const SceneModel model(made(careful), {}, {deep}, {.contacts = {{-0.008, 0.0008}}});  // the block is 30 mm high
  const Prediction shallow = model.predict_from(0, {}, 0.0008), beyond = model.predict_from(0, {}, -0.008);
  EXPECT_EQ(shallow.failure, "");
  EXPECT_EQ(shallow.force.size(), deep.size());
  EXPECT_TRUE(beyond.reused);
  EXPECT_TRUE(beyond.force.empty());
  EXPECT_THAT(beyond.failure, HasSubstr("curve \"press\": the run stopped at "));
}

/// A shipped file of the container's scene.
Curve shipped(const std::string& name, double velocity) {
  const std::string file = (test::shipped("scenes/fit/liver_velocity") / (name + ".csv")).string();
  const CurveFile table = read_curve_file(file);
  EXPECT_EQ(table.units, (std::vector<std::string>{"s", "mm", "N"}));
  Curve c;
  c.name = name, c.velocity = velocity;
  for (const CurveFile::Row& row : table.rows) {
    c.time.push_back(*parse_number(row.fields[0].text, '.'));
    c.displacement.push_back(1e-3 * *parse_number(row.fields[1].text, '.'));
    c.force.push_back(*parse_number(row.fields[2].text, '.'));
  }
  return c;
}

/// E, slope and η [Pa], [Pa s] that a shipped file's second line names.
std::vector<double> made_with(const std::string& name) {
  std::ifstream file(test::shipped("scenes/fit/liver_velocity") / (name + ".csv"));
  std::string line;
  std::getline(file, line), std::getline(file, line);
  std::vector<double> values;
  for (const char* word : {"E = ", "slope = ", "eta = "})
    values.push_back(std::stod(line.substr(line.find(word) + std::strlen(word))));
  return values;
}

// The shipped curves are the shipped scene at the parameters that their header names, and 2 % of noise: with 150 points its
// rms is known to 6 %, and three of these are allowed.
TEST(SceneModel, GivesTheShippedCurves) {  // long
  SceneText scene = scene_text(test::shipped("scenes/fit/liver_container.toml").string());
  scene.variant = "slow";
  const std::vector<Curve> curves{shipped("2mm_s_1", 0.002), shipped("6mm_s_2", 0.006), shipped("10mm_s_3", 0.01)};
  const std::vector<std::string> keys{"tissue.youngs_modulus_Pa", "tissue.law.slope_Pa", "tissue.viscosity_Pa_s"};
  const SceneModel model(scene, keys, curves);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Prediction p = model.predict(c, made_with(curves[c].name));
    ASSERT_EQ(p.failure, "");
    double sum = 0.0;
    for (std::size_t i = 0; i < p.force.size(); ++i) sum += std::pow(p.force[i] - curves[c].force[i], 2);
    const double rms = std::sqrt(sum / static_cast<double>(p.force.size()));
    EXPECT_NEAR(rms / (0.02 * largest(p.force)), 1.0, 0.18) << curves[c].name;
    EXPECT_GT(p.force.front(), 0.02 * 0.002 * static_cast<double>(c)) << "the overhead of the first instant";
  }
}

}  // namespace
}  // namespace glisson::fit

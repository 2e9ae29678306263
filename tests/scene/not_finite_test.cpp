// A run that says `finished` has finite numbers: what would overflow is refused by its range, and what overflows all the same ends
// the run with a status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/text.h"
#include "scene/parse/allowed_range.h"
#include "scene/parse/sections.h"
#include "scene/run/run_watch.h"
#include "scene/scene_text.h"

namespace glisson::not_finite_test {
namespace {

using test::complaint;
using test::kSmallScene;
using test::parse;
using ::testing::HasSubstr;

using End = RunSummary::End;

const std::atomic<bool> kGoOn{false};

void expect_ends(const scene::SectionSpec& section) {
  for (const scene::KeySpec& key : section.keys) {
    if (key.section) expect_ends(*key.section);
    if (key.type != scene::ValueType::number) continue;
    const Range range = scene::allowed_range(key);
    EXPECT_TRUE(std::isfinite(range.min) && std::isfinite(range.max))
        << section.name << "." << key.name << " [" << key.unit << "]: " << range.text();
  }
  for (const scene::KindSpec& kind : section.kinds) expect_ends(kind.section);
}

// Every number of a scene has a least and a largest value.
TEST(NotFinite, EveryNumberHasTwoEnds) {
  expect_ends(scene::scene_section());
  expect_ends(scene::variant_section());
}

// Numbers that overflowed into nan in silence are refused, with the range.
TEST(NotFinite, WhatOverflowsIsRefused) {
  const auto refusal = [](const std::string& key, const std::string& value) {
    return complaint(kSmallScene, {{key, value}});
  };
  EXPECT_THAT(refusal("tissue.density_kg_m3", "1e-300"), HasSubstr("allowed: 0.001 to 1e+09 kg/m³"));
  EXPECT_THAT(refusal("tissue.density_kg_m3", "1e300"), HasSubstr("allowed: 0.001 to 1e+09 kg/m³"));
  EXPECT_THAT(refusal("load", R"([{set="x_max",pressure_Pa=1e300,follows=true}])"),
              HasSubstr("allowed: -1e+12 to 1e+12 Pa"));
  EXPECT_THAT(refusal("motion.gravity_m_s2", "[0,0,1e30]"), HasSubstr("allowed: -1000000 to 1000000 m/s²"));
  EXPECT_THAT(refusal("motion.mass_scaling_step_s", "1e30"), HasSubstr("allowed: > 0 and ≤ 1e+09 s"));
  EXPECT_THAT(refusal("tool.press.direction", "[0,0,1e-200]"), HasSubstr("has no direction"));
  EXPECT_THAT(refusal("tool.press.direction", "[0,0,1e200]"), HasSubstr("allowed: -1e+12 to 1e+12"));
}

/// Whether all that a run shows is finite, looked at from outside.
struct Finite : RunObserver {
  bool all = true;
  void see(double x) { all = all && std::isfinite(x); }
  void see(const Vec3d& v) { see(v.x), see(v.y), see(v.z); }
  void on_sample(const Sample& s) override {
    see(s.time);
    for (const ForceParts& f : s.supports) see(f.total());
    for (const InstrumentSample& x : s.instruments) see(x.force), see(x.depth);
    const Energies& e = s.energies;
    for (const double x : {e.elastic, e.kinetic, e.dissipated, e.work_tools, e.work_loads, e.numerical}) see(x);
  }
  void on_frame(const Simulation& s) override {
    for (const Vec3d& u : s.displacement()) see(u);
  }
};

/// How a scene with other keys ends after some steps; none where it is refused.
std::optional<End> end_with(const std::vector<Override>& keys, bool& finite) {
  const std::string scene =
      kSmallScene + "[[load]]\nset = \"x_max\"\nforce_N = [0.001, 0, 0]\n[motion]\nmax_steps = 30\n";
  Finite seen;
  try {
    const End end = run_variant(parse(scene, keys).variants.at(0), {}, seen, kGoOn).end;
    finite = seen.all;
    return end;
  } catch (const SceneError&) {
    return {};
  }
}

// At both ends of each range, and far below a range that is open at 0, a run either is refused, ends with a status or is finite.
TEST(NotFinite, FinishedMeansFiniteAtTheEndsOfEveryRange) {
  const std::vector<std::pair<std::string, const scene::SectionSpec*>> tables{{"tissue", &scene::tissue_section()},
                                                                              {"motion", &scene::motion_section()},
                                                                              {"load.x_max", &scene::load_section()},
                                                                              {"tool.press", &scene::tool_section()}};
  int finished = 0, runs = 0;
  for (const auto& [table, section] : tables) {
    for (const scene::KeySpec& key : section->keys) {
      if (key.type != scene::ValueType::number || key.shape == scene::Shape::list) continue;
      const Range range = scene::allowed_range(key);
      std::vector<double> values{range.min, range.max};
      if (range.min_open && range.min == 0.0) values.push_back(1e-300);
      for (const double value : values) {
        const std::string one = detail::number_text(value, 17);
        const std::string text = key.shape == scene::Shape::three ? "[" + one + ", " + one + ", " + one + "]" : one;
        SCOPED_TRACE(table + "." + key.name + " = " + text);
        bool finite = true;
        const std::optional<End> end = end_with({{table + "." + key.name, text}}, finite);
        ++runs;
        if (end != End::finished) continue;
        ++finished;
        EXPECT_TRUE(finite);
      }
    }
  }
  EXPECT_GT(runs, 50);
  EXPECT_GT(finished, runs / 4) << "most ends can be run";
}

// A program's own path that gives nan ends the run, and says whose number it was and when.
TEST(NotFinite, AForceThatIsNotFiniteEndsTheRun) {
  Variant v = parse(kSmallScene).variants.at(0);
  v.tools[0].path = ToolPath{[](double t) { return Vec3d{0.0, 0.0, t > 0.02 ? std::nan("") : -0.01 * t}; }, 0.05};
  Finite seen;
  const RunSummary s = run_variant(v, {}, seen, kGoOn);
  EXPECT_EQ(s.end, End::stopped_not_finite);
  EXPECT_LT(s.time_s, 0.025);
  EXPECT_THAT(s.trouble, HasSubstr("not finite"));
}

// Each kind of number of a sample is looked at, and named.
TEST(NotFinite, SamplesAreLookedAt) {
  const Variant v = parse(kSmallScene).variants.at(0);
  const BuiltVariant built(v, {});
  const auto why = [&](const std::function<void(Sample&)>& spoil) {
    Sample s;
    s.supports.resize(1), s.instruments.resize(1);
    spoil(s);
    RunWatch watch(v, built);
    return watch.see(s).why;
  };
  EXPECT_EQ(why([](Sample&) {}), "");
  EXPECT_THAT(why([](Sample& s) { s.supports[0].inertial.y = INFINITY; }),
              HasSubstr("the force of the support on \"z_min\""));
  EXPECT_THAT(why([](Sample& s) { s.instruments[0].force.x = NAN; }),
              HasSubstr("the force of \"press\" is not finite at 0 s"));
  EXPECT_THAT(why([](Sample& s) { s.instruments[0].depth = NAN; }), HasSubstr("the depth of \"press\""));
  EXPECT_THAT(why([](Sample& s) { s.energies.kinetic = INFINITY; }), HasSubstr("an energy"));
  EXPECT_THAT(why([](Sample& s) { s.time = NAN; }), HasSubstr("the time"));
  EXPECT_THAT(why([](Sample& s) { s.container.emplace().bottom.z = NAN; }), HasSubstr("the force on the container"));
}

}  // namespace
}  // namespace glisson::not_finite_test

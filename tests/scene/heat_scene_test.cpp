// heat_scene_test.cpp — [heat] of a scene: its keys reach the structs, its mistakes are named, and it runs as HeatSimulation does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "glisson/heat/vessel_wall.h"
#include "glisson/scene/heat_run.h"
#include "glisson/scene/tissue_presets.h"
#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::parse;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kBox = "[mesh]\nkind = \"box\"\ncells = [4, 4, 4]\nsize_m = [0.04, 0.04, 0.04]\n";
const std::string kHeat = "[heat]\nduration_s = 60\n";
const std::string kAgar = "[[heat.tissue]]\npreset = \"agar\"\n";
const std::string kProbe = "[[heat.probe]]\nfrom_m = [0.02, 0.02, 0.01]\nto_m = [0.02, 0.02, 0.03]\n";

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

std::string build_message_of(const std::string& text) {
  try {
    BuiltHeat(parse(text).variants.at(0), {});
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

class Samples final : public HeatObserver {
 public:
  void on_start(const Variant&, const BuiltHeat& built) override {
    temperature_columns = built.temperature_columns(), heat_columns = built.heat_columns();
  }
  void on_sample(const HeatSample& sample) override {
    rows.push_back(sample);
    if (rows.size() == stop_after) *stop = true;
  }
  void on_frame(const HeatSimulation& s) override { frames.push_back(s.time()); }
  void on_end(const HeatRunSummary& s) override { summary = s; }

  double at_end(const std::string& column) const {
    for (std::size_t i = 0; i < temperature_columns.size(); ++i) {
      if (temperature_columns[i] == column) return rows.back().temperatures[i];
    }
    for (std::size_t i = 0; i < heat_columns.size(); ++i) {
      if (heat_columns[i] == column) return rows.back().heat[i];
    }
    ADD_FAILURE() << "no column " << column;
    return std::nan("");
  }
  std::vector<std::string> temperature_columns, heat_columns;
  std::vector<HeatSample> rows;
  std::vector<double> frames;
  HeatRunSummary summary;
  std::size_t stop_after = 0;
  std::shared_ptr<std::atomic<bool>> stop = std::make_shared<std::atomic<bool>>(false);
};

Samples run_of(const std::string& text, std::size_t stop_after = 0) {
  Samples samples;
  samples.stop_after = stop_after;
  run_heat(parse(text).variants.at(0), {}, samples, *samples.stop);
  return samples;
}

// A table is linear between its times; of two entries of one time the first holds there, so that what ends at a jump is made by what was
// before it; cycles run through it again, and corners are at all its times.
TEST(HeatScene, TablesOverTime) {
  const TimeFunction<double> f = table_course({0, 10, 10, 20}, {1, 3, -5, -5}, 2);
  EXPECT_EQ(f(0.0), 1.0);
  EXPECT_EQ(f(5.0), 2.0);
  EXPECT_EQ(f(10.0), 3.0);
  EXPECT_EQ(f(10.0 + 1e-9), -5.0);
  EXPECT_EQ(f(20.0), -5.0);
  EXPECT_EQ(f(25.0), 2.0) << "the second cycle";
  EXPECT_EQ(f(35.0), -5.0);
  EXPECT_EQ(f(100.0), -5.0) << "after the last";
  EXPECT_EQ(f.corners.after(10.0), 20.0);
  EXPECT_EQ(f.corners.after(20.0), 30.0);
  EXPECT_EQ(table_course({}, {7.0})(123.0), 7.0);
  EXPECT_EQ(table_course({5, 15}, {1, 2})(0.0), 1.0) << "before the first";
}

// Presets give what they say, and keys of the table win over them, in a variant too.
TEST(HeatScene, PresetsAndVariants) {
  const Scene scene =
      parse(kBox + kHeat + "[[heat.tissue]]\npreset = \"liver\"\nperfusion_per_s = 0.01\n" +
            "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\nheat.tissue.0.latent_heat_J_kg = 1e5\n"
            "heat.temperature_C = 30\n");
  const ThermalTissue &a = scene.variants.at(0).heat->tissues.at(0).tissue,
                      &b = scene.variants.at(1).heat->tissues.at(0).tissue, &liver = thermal_preset("liver");
  EXPECT_EQ(a.perfusion, 0.01);
  EXPECT_EQ(a.latent_heat, liver.latent_heat);
  EXPECT_EQ(a.density, liver.density);
  ASSERT_TRUE(a.death);
  EXPECT_EQ(a.death->cold, -40.0);
  EXPECT_EQ(b.latent_heat, 1e5);
  EXPECT_EQ(b.perfusion, 0.01);
  EXPECT_EQ(scene.variants[1].heat->options.temperature, 30.0);
  EXPECT_GE(thermal_presets().size(), 3U);
  for (const ThermalPreset& p : thermal_presets()) EXPECT_FALSE(p.source.empty() || p.confirmed.empty()) << p.name;
}

// Mistakes are named with the way out: kelvin, tables that run backwards, missing properties, power no tissue bears, mechanics beside it.
TEST(HeatScene, RefusesByName) {
  const std::string good = kBox + kHeat + kAgar;
  EXPECT_EQ(message_of(good + kProbe + "power_W_m = -300\n"), "no error");
  EXPECT_THAT(
      message_of(kBox + "[heat]\nduration_s = 60\ntemperature_C = 310\n" + kAgar),
      HasSubstr(
          "heat.temperature_C: 310 °C is out of range; allowed: -200 to 200 °C; temperatures are in °C, not in K"));
  EXPECT_THAT(message_of(good + "[[heat.boundary]]\nset = \"x_min\"\ntemperature_C = 273.15\n"), HasSubstr("not in K"));
  EXPECT_THAT(message_of(good + kProbe + "times_s = [0, 600, 500]\npowers_W_m = [0, -300, -300]\n"),
              HasSubstr("times_s: runs backwards: 500 s comes after 600 s"));
  EXPECT_THAT(message_of(good + kProbe + "times_s = [0, 600]\npowers_W_m = [0, -300, -300]\n"),
              HasSubstr("has 3 values for 2 times"));
  EXPECT_THAT(message_of(good + kProbe + "power_W_m = -4000\n"), HasSubstr("no tissue bears"));
  EXPECT_THAT(message_of(good + "[[heat.power]]\npower_W_m3 = 1e10\n"), HasSubstr("no tissue bears"));
  EXPECT_THAT(message_of(good + kProbe), HasSubstr("give one of `power_W_m`"));
  EXPECT_THAT(message_of(good + kProbe + "temperature_C = -140\n"), HasSubstr("needs `coefficient_W_m_K` with it"));
  EXPECT_THAT(message_of(good + kProbe + "power_W_m = -300\nactive_length_mm = 21\n"),
              HasSubstr("longer than the probe, 20 mm"));
  EXPECT_THAT(message_of(good + kProbe + "power_W_m = -300\ncycles = 2\n"), HasSubstr("belongs to a table over time"));
  EXPECT_THAT(message_of(kBox + kHeat + "[[heat.tissue]]\ndensity_kg_m3 = 1000\nconductivity_W_m_K = 0.5\n"),
              HasSubstr("the tissue lacks `frozen_conductivity_W_m_K`, `specific_heat_J_kg_K`"));
  EXPECT_THAT(message_of(kBox + kHeat), HasSubstr("heat: missing key `tissue`"));
  EXPECT_THAT(message_of(good + "[[region]]\nname = \"a\"\nsphere_m = { center = [0, 0, 0], radius = 1 }\n"
                                "tissue.density_kg_m3 = 1000\n"),
              HasSubstr("region.0.tissue: belongs to mechanics"));
  EXPECT_THAT(message_of(good + "[motion]\nduration_s = 1\n"), HasSubstr("motion: belongs to mechanics"));
  EXPECT_THAT(message_of(good + "[[heat.boundary]]\nset = \"x_mni\"\ntemperature_C = 0\n"), HasSubstr("\"x_min\""));
  EXPECT_THAT(
      message_of(
          good +
          "[[heat.sensor]]\nname = \"a\"\npoint_m = [0, 0, 0]\n[[heat.sensor]]\nname = \"A\"\npoint_m = [0, 0, 0]\n"),
      HasSubstr("is taken"));
  const std::string front = "[[heat.front]]\nfrom_m = [0, 0, 0]\nto_m = [0.01, 0, 0]\n";
  EXPECT_THAT(message_of(good + front + "above_C = -40\n"), HasSubstr("needs `temperature_C` with it"));
  EXPECT_THAT(message_of(good + front + "above_C = 0\ntemperature_C = -40\n"), HasSubstr("nothing lies between them"));
  EXPECT_THAT(message_of(good + "[[check]]\nwhat = \"w\"\ncolumn = \"c\"\nexpected = 1\n"),
              HasSubstr("needs `tolerance`"));
  EXPECT_THAT(message_of(good + "[[check]]\nwhat = \"w\"\ncolumn = \"c\"\nexpected = 1\ntolerance = 1\nat_most = 3\n"),
              HasSubstr("contradicts"));
}

// What needs the mesh is refused when it is built, at its place in the scene.
TEST(HeatScene, RefusesWhatTheBodyDoesNotHave) {
  const std::string good = kBox + kHeat + kAgar;
  EXPECT_THAT(
      build_message_of(
          good +
          "[[heat.probe]]\nname = \"p\"\nfrom_m = [0.02, 0.02, 0.01]\nto_m = [0.02, 0.02, 0.06]\npower_W_m = -300\n"),
      ::testing::AllOf(HasSubstr("heat.probe.0"), HasSubstr("probe \"p\""), HasSubstr("leaves the body at (20, 20, "),
                       HasSubstr("the body spans")));
  EXPECT_THAT(build_message_of(good + "[[heat.sensor]]\npoint_m = [0.05, 0, 0]\n"),
              ::testing::AllOf(HasSubstr("heat.sensor.0"), HasSubstr("lies outside the body")));
  EXPECT_THAT(build_message_of(kBox + kHeat + "[[heat.tissue]]\nregion = \"vein\"\npreset = \"agar\"\n"),
              HasSubstr("the body has no region \"vein\"; it has: 0"));
  EXPECT_THAT(build_message_of(
                  kBox + "[[region]]\nname = \"core\"\nsphere_m = { center = [0.02, 0.02, 0.02], radius = 0.015 }\n" +
                  kHeat + "[[heat.tissue]]\nregion = \"core\"\npreset = \"agar\"\n"),
              HasSubstr("region \"0\" has no thermal tissue"));
  try {
    build_variant(parse(good).variants.at(0), {});
    ADD_FAILURE() << "built as mechanics";
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the scene is one of heat"));
  }
}

// A run gives what the simulation itself gives, to the last bit: a probe that freezes, holds and thaws in two cycles, in two tissues.
TEST(HeatScene, RunsAsTheSimulationDoes) {
  const std::string scene =
      kBox + "[[region]]\nname = \"core\"\nsphere_m = { center = [0.02, 0.02, 0.02], radius = 0.012 }\n" +
      "[heat]\nduration_s = 95\nsample_every_s = 10\ntemperature_C = 36\nisotherms_C = [0, -10]\n"
      "[[heat.tissue]]\npreset = \"agar\"\n[[heat.tissue]]\nregion = \"core\"\npreset = \"liver\"\n" +
      kProbe +
      "active_length_mm = 15\nradius_mm = 1\ntimes_s = [0, 30, 30, 40]\ntemperatures_C = [-140, -140, 20, 20]\n"
      "coefficients_W_m_K = [8, 8, 2, 2]\ncycles = 2\n"
      "[[heat.boundary]]\nset = \"z_max\"\ntemperature_C = 25\ncoefficient_W_m2_K = 30\n"
      "[[heat.boundary]]\nset = \"x_min\"\nflux_W_m2 = 500\n"
      "[[heat.power]]\nregion = \"core\"\npower_W_m3 = 2000\n"
      "[[heat.sensor]]\nname = \"tip\"\npoint_m = [0.02, 0.02, 0.01]\n"
      "[[heat.sensor]]\nname = \"row\"\nfrom_m = [0.02, 0.02, 0.02]\nto_m = [0.04, 0.02, 0.02]\ncount = 3\n"
      "[[heat.sensor]]\nname = \"core\"\nregion = \"core\"\n"
      "[[heat.front]]\nname = \"ice\"\nfrom_m = [0, 0.02, 0.02]\nto_m = [0.04, 0.02, 0.02]\ntemperature_C = 0\n"
      "[[heat.front]]\nname = \"shell\"\nfrom_m = [0, 0.02, 0.02]\nto_m = [0.04, 0.02, 0.02]\ntemperature_C = "
      "20\nabove_C = 0\n"
      "[[heat.isotherm]]\nname = \"cold\"\ntemperature_C = 20\nplane_m = { point = [0.02, 0.02, 0.02] }\n"
      "[output]\nframes = 3\n";
  const Samples run = run_of(scene);
  EXPECT_EQ(run.summary.end, RunSummary::End::finished) << run.summary.trouble;
  ASSERT_EQ(run.rows.size(), 11U);
  EXPECT_EQ(run.rows.back().temperatures.front(), 95.0);
  EXPECT_EQ(run.frames.size(), 3U);
  EXPECT_EQ(run.frames.front(), 0.0);
  EXPECT_EQ(run.frames.back(), 95.0);
  EXPECT_THAT(run.temperature_columns, ElementsAre("time_s", "tip_C", "row_1_C", "row_2_C", "row_3_C", "core_C"));
  for (const HeatSample& row : run.rows) {
    EXPECT_EQ(row.temperatures.size(), run.temperature_columns.size());
    EXPECT_EQ(row.heat.size(), run.heat_columns.size());
  }

  Variant variant = parse(scene).variants.at(0);
  const TetMesh mesh = build_mesh(variant, {});
  HeatOptions options{.temperature = 36.0};
  options.isotherms = {0.0, -10.0};
  const int core = mesh.region_names.begin()->first;
  HeatSimulation s(mesh, {{0, thermal_preset("agar")}, {core, thermal_preset("liver")}}, options);
  s.add_convection("z_max", 30.0, [](double) { return 25.0; });
  s.add_flux("x_min", [](double) { return 500.0; });
  s.add_line_source({.from = {0.02, 0.02, 0.01},
                     .to = {0.02, 0.02, 0.025},
                     .temperature = table_course({0, 30, 30, 40}, {-140, -140, 20, 20}, 2),
                     .coefficient = table_course({0, 30, 30, 40}, {8, 8, 2, 2}, 2),
                     .radius = 1e-3});
  s.add_source(core, [](double) { return 2000.0; });
  for (int k = 1; k <= 10; ++k) ASSERT_EQ(s.advance_to(std::min(95.0, 10.0 * k)).status, HeatStatus::ok);
  const std::vector<Vec3d> tip{{0.02, 0.02, 0.01}};
  EXPECT_EQ(run.at_end("tip_C"), HeatPoints(s.mesh(), tip).read(s.temperature())[0]);
  EXPECT_EQ(run.at_end("frozen_m3"), s.frozen_volume());
  EXPECT_EQ(run.at_end("dead_core_m3"), s.dead_volume(core));
  EXPECT_EQ(run.at_end("cold_volume_m3"), isotherm_extent(s.mesh(), s.temperature(), 20.0).volume);
  EXPECT_EQ(run.at_end("blood_J"), s.ledger().blood);
  const HeatLine across(s.mesh(), {0, 0.02, 0.02}, {0.04, 0.02, 0.02});
  EXPECT_EQ(run.at_end("shell_m"),
            across.length_below(s.temperature(), 20.0) - across.length_below(s.temperature(), 0.0));
  EXPECT_GT(run.at_end("cold_area_m2"), 0.0);
  EXPECT_LT(run.summary.lowest_C, 0.0);
  EXPECT_LT(std::abs(run.at_end("imbalance_J")), 1e-9 * std::abs(run.at_end("sources_J")));
  double most = 0.0;
  for (const HeatSample& row : run.rows) most = std::max(most, row.heat[3]);
  EXPECT_GT(most, 0.0) << "it froze";
}

const std::string kVein = "[[region]]\nname = \"vein\"\nsphere_m = { center = [0.02, 0.02, 0.02], radius = 0.012 }\n";

// A vessel of a scene is blood: its region needs no tissue, its wall takes the coefficient of its flow, over time where that changes.
TEST(HeatScene, VesselsWithFlow) {
  const std::string
      start = kBox + kVein + "[heat]\nduration_s = 60\n" + kAgar,
      wall =
          "[[heat.boundary]]\nset = \"x_min\"\ntemperature_C = -60\n[[heat.boundary]]\nregion = \"vein\"\n"
          "temperature_C = 36\n";
  const Samples by_law = run_of(start + wall + "vessel = { diameter_mm = 8, speed_mm_s = 120, length_mm = 20 }\n"),
                by_value =
                    run_of(start + wall + "coefficient_W_m2_K = " +
                           std::to_string(wall_coefficient({.diameter = 0.008, .speed = 0.12, .length = 0.02})) + "\n"),
                off = run_of(start + wall + "times_s = [0, 60]\ncoefficients_W_m2_K = [0, 0]\n");
  EXPECT_GT(by_law.at_end("surface_J"), 0.0);
  EXPECT_NEAR(by_law.at_end("surface_J"), by_value.at_end("surface_J"), 1e-5 * by_law.at_end("surface_J"));
  EXPECT_EQ(off.at_end("surface_J"), 0.0);
  EXPECT_LT(off.at_end("imbalance_J"), 1e-10 * std::abs(off.at_end("held_J")));
  EXPECT_THAT(message_of(start + wall + "vessel = { diameter_mm = 30, speed_mm_s = 900 }\n"), HasSubstr("not laminar"));
  EXPECT_THAT(message_of(start + wall + "vessel = { speed_mm_s = 900 }\n"), HasSubstr("diameter_mm"));
}

// A total of power in a bell: the ledger has it to rounding, and the warmest place is its middle.
TEST(HeatScene, PatternsOfPower) {
  const std::string start = kBox + "[heat]\nduration_s = 30\n" + kAgar +
                            "[[heat.sensor]]\nname = \"middle\"\npoint_m = [0.01, 0.02, 0.02]\n[[heat.power]]\n";
  const std::string bell =
      "pattern = { middle_m = [0.01, 0.02, 0.02], axis = [1, 0, 0], across_mm = 6, along_mm = 9 }\n";
  const Samples run = run_of(start + "times_s = [0, 10, 10, 30]\ntotals_W = [5, 5, 0, 0]\n" + bell);
  EXPECT_NEAR(run.at_end("sources_J"), 50.0, 1e-9);
  EXPECT_EQ(run.at_end("middle_C"), run.at_end("highest_C"));
  EXPECT_NEAR(run_of(start + "total_W = 2\n").at_end("sources_J"), 60.0, 1e-9) << "evenly";
  EXPECT_THAT(message_of(start + "power_W_m3 = 100\n" + bell), HasSubstr("pattern"));
  EXPECT_THAT(build_message_of(start + "total_W = 2\npattern = { middle_m = [5, 0, 0], across_mm = 1 }\n"),
              HasSubstr("far outside"));
}

// Radio frequency of a scene: its power is met, its columns are there, and what cannot be is named.
TEST(HeatScene, RadioFrequency) {
  const std::string
      tissue = kAgar + "electric_conductivity_S_m = 0.3\n",
      start = kBox + "[heat]\nduration_s = 30\n" + tissue + "[[heat.radio]]\nname = \"rf\"\nground = \"z_min\"\n",
      needle = "from_m = [0.02, 0.02, 0.01]\nto_m = [0.02, 0.02, 0.04]\nactive_length_mm = 15\nradius_mm = 1\n";
  const Samples run = run_of(start + needle + "power_W = 4\n");
  EXPECT_NEAR(run.at_end("sources_J"), 120.0, 1e-8);
  EXPECT_NEAR(run.at_end("rf_power_W"), 4.0, 1e-12);
  EXPECT_NEAR(run.at_end("rf_voltage_V"), std::sqrt(4.0 * run.at_end("rf_ohm")), 1e-9);
  const Samples plates = run_of(start + "set = \"z_max\"\nvoltage_V = 20\n");
  EXPECT_GT(plates.at_end("rf_ohm"), 0.0);
  EXPECT_LT(plates.at_end("rf_ohm"), 1.0 / (0.3 * 0.04)) << "warm tissue leads better than at 37 °C";
  EXPECT_THAT(message_of(start + needle), HasSubstr("give one of `voltage_V`"));
  EXPECT_THAT(message_of(start + "voltage_V = 20\n"), HasSubstr("give one of `set`"));
  EXPECT_THAT(message_of(start + "set = \"z_max\"\nradius_mm = 1\nvoltage_V = 20\n"),
              HasSubstr("needs `from_m` with it"));
  EXPECT_THAT(build_message_of(start + "from_m = [0.02, 0.02, 0.01]\nto_m = [0.02, 0.02, 0.05]\nvoltage_V = 20\n"),
              HasSubstr("leaves the body"));
  EXPECT_THAT(build_message_of(start + "set = \"z_min\"\nvoltage_V = 20\n"), HasSubstr("share vertex"));
}

// A run that is stopped keeps what it has and says so; one below absolute zero ends with the way out.
TEST(HeatScene, EndsEarly) {
  const Samples stopped = run_of(kBox + kHeat + kAgar + kProbe + "power_W_m = -300\n", 3);
  EXPECT_EQ(stopped.summary.end, RunSummary::End::interrupted);
  EXPECT_EQ(stopped.rows.size(), 3U);
  EXPECT_EQ(stopped.summary.time_s, 20.0);
  const Samples cold = run_of(kBox + "[heat]\nduration_s = 4000\n" + kAgar + "[[heat.power]]\npower_W_m3 = -1e6\n");
  EXPECT_EQ(cold.summary.end, RunSummary::End::stopped_too_cold);
  EXPECT_THAT(cold.summary.trouble, HasSubstr("below absolute zero"));
  EXPECT_LT(cold.summary.time_s, 4000.0);
}

}  // namespace
}  // namespace glisson

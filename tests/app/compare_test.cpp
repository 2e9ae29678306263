// `glisson compare` gives one scene to many models: a row a run with errors and times, a page, and a word where a model or a scene cannot.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "app/program.h"
#include "glisson/math.h"
#include "support/places.h"

namespace glisson::test {
namespace {

constexpr const char* kBlock = R"(
title = "a block"
[mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 1285.714, bulk_modulus_Pa = 6000 }
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
velocity_mm_s = 2
depth_mm = 2
ramp_s = 0.1
[compare]
meshes = 1
stations = 2
)";

class Compare : public ProgramTest {};

TEST_F(Compare, GivesARowToEachModel) {
  const std::string scene = write("block.toml", kBlock);
  const Outcome outcome =
      run({"compare", scene, "--out", (folder_ / "o").string(), "--json", (folder_ / "c.json").string()});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json json = read_json(folder_ / "c.json");
  EXPECT_EQ(json, read_json(folder_ / "o/compare.json"));
  std::set<std::string> models;
  double glisson = -1.0, at_rest = -1.0, springs = -1.0;
  for (const nlohmann::json& row : json["rows"]) {
    models.insert(row["model"].get<std::string>());
    EXPECT_GT(row["wall_s"].get<double>() + (row["note"].get<std::string>().empty() ? 0.0 : 1.0), 0.0);
    if (row["model"] == "glisson") glisson = row["error_force"].get<double>();
    if (row["model"] == "glisson_quasi_static") at_rest = row["error_force"].get<double>();
    if (row["model"] == "spring_mass_volume_rule") springs = row["error_force"].get<double>();
    if (row["model"] == "chain_mail") {
      EXPECT_TRUE(row["error_force"].is_null());
    }
    if (row["model"] == "schwartz_tensor_mass") {
      EXPECT_THAT(row["note"].get<std::string>(), ::testing::HasSubstr("no stiffness law"));
    }
  }
  EXPECT_GE(models.size(), 10U);
  EXPECT_GT(glisson, 0.0);
  EXPECT_NEAR(glisson, at_rest, 0.02) << "in steps and at rest";
  EXPECT_GT(springs, 0.0);
  EXPECT_GT(json["reference"]["tets"].get<int>(), 48);
  EXPECT_THAT(run({"compare", scene, "--out", (folder_ / "o").string(), "--set", "compare.models=[\"linear_fem\"]"}),
              Exits(0))
      << "into the same folder again";
  const nlohmann::json page = report_data(folder_ / "o/report.html");
  EXPECT_EQ(page["scenes"][0]["charts"].size(), 2U);
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("within 1 % of the force and the surface"));
}

// Viscous tissue: its reference is in motion, models without viscosity take part, and of several variants a last table has all.
TEST_F(Compare, TakesVariantsOfAViscousScene) {
  const std::string scene = write("viscous.toml", std::string(kBlock) + R"(
models = ["linear_fem", "miller_brain", "glisson", "glisson_quasi_static"]
[[variant]]
name = "quick"
tool.z_max.velocity_mm_s = 20
tool.z_max.ramp_s = 0.02
[[variant]]
name = "held"
motion.duration_s = 3
)");
  const std::vector<std::string> command{"compare", scene,
                                         "--json",  (folder_ / "c.json").string(),
                                         "--out",   (folder_ / "o").string(),
                                         "--set",   "tissue.maxwell=[{share=0.5,time_s=0.3}]"};
  const Outcome outcome = run(command);
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("the scene's own tissue in motion"));
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("error of the force by variant"));
  const nlohmann::json json = read_json(folder_ / "c.json");
  ASSERT_EQ(json["variants"].size(), 2U);
  std::map<std::string, double> last;  // force, by variant and model
  for (const nlohmann::json& row : json["rows"]) {
    EXPECT_EQ(row["note"], "");
    last[row["variant"].get<std::string>() + " " + row["model"].get<std::string>()] = row["forces"].back()[2];
  }
  EXPECT_EQ(last.size(), 8U);
  EXPECT_LT(last["quick glisson_quasi_static"] / last["quick glisson"], 0.8)
      << "its branch has relaxed, the block's has not";
  EXPECT_NEAR(last["held glisson_quasi_static"] / last["held glisson"], 1.0, 0.02) << "after seven times τ both have";
  EXPECT_EQ(report_data(folder_ / "o/report.html")["scenes"].size(), 2U);
}

// Times of one's own: the end is added, and what is beyond it or out of order is refused.
TEST_F(Compare, TakesTimes) {
  const std::string scene = write("block.toml", kBlock);
  const std::string json = (folder_ / "c.json").string(), out = (folder_ / "o").string();
  const auto with = [&](const std::string& times) {
    return run({"compare", scene, "--json", json, "--out", out, "--set", "compare.models=[\"linear_fem\"]", "--set",
                "compare.times_s=" + times});
  };
  ASSERT_THAT(with("[0.25, 0.75]"), Exits(0));
  EXPECT_EQ(read_json(folder_ / "c.json")["stations_s"].size(), 3U);
  Outcome outcome = with("[0.5, 0.25]");
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("0.25 s comes after 0.5 s"));
  outcome = with("[3]");
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("3 s is beyond the end of variant main"));
}

// The reference's range holds the exact force, known from elements of high order of another program: of plane strain, whose sets are chosen
// by boxes on every mesh, and of a cube between bonded plates, whose edges let forces converge more slowly than three meshes show.
TEST_F(Compare, ReferenceHoldsTheExactForce) {
  struct Known {
    const char *scene, *variant;
    double force;
  };
  for (const Known& known : {Known{"strip_wide", "nu049_nodal", 0.05876101},
                             {"strip_wide", "nu049_element", 0.05876101},
                             {"strip_wide_large", "nu0499_nodal", 0.5573253},
                             {"cube_bonded", "nu049_element", 0.01463614}}) {
    const std::string scene =
        test::shipped(std::string("tests/scene/converge_cases/") + known.scene + ".toml").string();
    ASSERT_THAT(run({"compare", scene, "--variant", known.variant, "--out", (folder_ / known.scene).string(), "--json",
                     (folder_ / "c.json").string(), "--set", "compare.models=[\"linear_fem\"]"}),
                Exits(0));
    const nlohmann::json r = read_json(folder_ / "c.json")["reference"];
    const auto last = r["forces"].back().get<std::array<double, 3>>();
    const double force = norm(Vec3d{last[0], last[1], last[2]});
    EXPECT_LE(force * (1.0 + r["limit_low"].get<double>()), known.force) << known.scene << known.variant;
    EXPECT_GE(force * (1.0 + r["limit_high"].get<double>()), known.force) << known.scene << known.variant;
    EXPECT_LT(r["limit_high"].get<double>() - r["limit_low"].get<double>(), 0.15);
  }
}

// What other programs are given is the scene: its block, its moduli, what holds and moves it, and the reference's shape.
TEST_F(Compare, WritesTheExperimentForOtherPrograms) {
  const std::string scene = write("block.toml", kBlock);
  ASSERT_THAT(run({"compare", scene, "--out", (folder_ / "o").string(), "--problem", (folder_ / "p.json").string(),
                   "--set", "compare.models=[\"linear_fem\"]", "--set", "compare.meshes=2"}),
              Exits(0));
  const nlohmann::json p = read_json(folder_ / "p.json");
  EXPECT_NEAR(p["tissues"][0]["mu_Pa"].get<double>(), 1285.714, 1e-9);
  EXPECT_NEAR(p["tissues"][0]["lambda_Pa"].get<double>(), 6000.0 - 2.0 / 3.0 * 1285.714, 1e-9);
  EXPECT_EQ(p["tissues"][0]["law"], "neo_hookean");
  EXPECT_EQ(p["tissues"][0]["viscous"], false);
  EXPECT_EQ(p["damping_per_s"].get<double>(), 20.0);
  ASSERT_EQ(p["meshes"].size(), 2U);
  EXPECT_EQ(p["meshes"][1]["tets"].size(), 8 * p["meshes"][0]["tets"].size());
  EXPECT_EQ(p["reference"]["displacement_m"].size(), p["meshes"][1]["vertices_m"].size());
  const double duration = p["stations_s"].back().get<double>();
  ASSERT_EQ(p["times_s"].size(), p["stations_s"].size() * p["times_per_station"].get<std::size_t>());
  EXPECT_EQ(p["times_s"].back().get<double>(), duration);
  for (const nlohmann::json& mesh : p["meshes"]) {
    const nlohmann::json &x = mesh["vertices_m"], &held = mesh["supports"][0], &tool = mesh["tools"][0];
    for (const nlohmann::json& v : held["vertices"]) EXPECT_EQ(x[v.get<std::size_t>()][2].get<double>(), 0.0);
    for (const nlohmann::json& v : tool["vertices"]) EXPECT_NEAR(x[v.get<std::size_t>()][2].get<double>(), 0.02, 1e-15);
    EXPECT_EQ(held["vertices"].size(), tool["vertices"].size());
    ASSERT_EQ(tool["displacements_m"].size(), p["times_s"].size());
    for (const nlohmann::json& u : tool["displacements_m"].back()) EXPECT_NEAR(u[2].get<double>(), -0.002, 1e-12);
    double volume = 0.0;
    for (const nlohmann::json& t : mesh["tets"]) {
      const auto at = [&](std::size_t k) { return x[t[k].get<std::size_t>()].get<std::array<double, 3>>(); };
      const std::array a{at(0), at(1), at(2), at(3)};
      const auto edge = [&](std::size_t k) { return Vec3d{a[k][0] - a[0][0], a[k][1] - a[0][1], a[k][2] - a[0][2]}; };
      volume += dot(edge(1), cross(edge(2), edge(3))) / 6.0;
    }
    EXPECT_NEAR(volume, 8e-6, 1e-15);
  }
  for (const nlohmann::json& v : p["surface"]) EXPECT_LT(v.get<std::size_t>(), p["meshes"][0]["vertices_m"].size());
}

// A region is taken out while the body is loaded: rows say what that took, forces before it are those of the whole block and those after it
// smaller, and what is no cut is refused.
TEST_F(Compare, CutsARegionOutInMidRun) {
  const std::string scene = write("notch.toml", std::string(kBlock) +
                                                    "cut_at_s = 0.7\ncut = \"slot\"\n[[region]]\n"
                                                    "name = \"slot\"\nbox_m = { min = [0, 0, 0.01], "
                                                    "max = [0.01, 0.02, 0.02] }\n");
  const auto cut = [&](const std::string& key, const std::string& value) {
    return run({"compare", scene, "--out", (folder_ / "o").string(), "--json", (folder_ / "c.json").string(), "--set",
                "compare.models=[\"linear_fem\", \"glisson\", \"hybrid\"]", "--set", "compare." + key + "=" + value});
  };
  const std::string whole = write("whole.toml", kBlock);
  ASSERT_THAT(run({"compare", whole, "--out", (folder_ / "w").string(), "--json", (folder_ / "w.json").string(),
                   "--set", "compare.models=[\"linear_fem\", \"glisson\", \"hybrid\"]"}),
              Exits(0));
  ASSERT_THAT(cut("meshes", "1"), Exits(0));
  const nlohmann::json of_cut = read_json(folder_ / "c.json"), of_whole = read_json(folder_ / "w.json");
  ASSERT_EQ(of_cut["rows"].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const nlohmann::json &row = of_cut["rows"][i], &before = of_whole["rows"][i];
    EXPECT_THAT(row["note"].get<std::string>(), ::testing::StartsWith("the cut took ")) << row["model"];
    const auto kept = [&](std::size_t k) {
      return row["forces"][k][2].get<double>() / before["forces"][k][2].get<double>();
    };
    EXPECT_NEAR(kept(0), 1.0, 1e-5) << row["model"];
    const double left = kept(1);
    EXPECT_GT(left, 0.4) << row["model"];  // half of the block's upper half is gone
    EXPECT_LT(left, 0.8) << row["model"];
  }
  Outcome outcome = cut("cut", "\"none\"");
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err,
              ::testing::HasSubstr("compare.cut: region \"none\" has 0 of the 48 tets; name a [[region]]"));
  outcome = cut("cut_at_s", "5");
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("compare.cut_at_s: 5 s is not before the end of the run"));
}

// Against a measurement, the error is that of the force's size at each station.
TEST_F(Compare, HoldsForcesAgainstAMeasurement) {
  const std::string scene = write("block.toml", kBlock);
  const auto against = [&](const std::string& measured) {
    return run({"compare", scene, "--out", (folder_ / "o").string(), "--json", (folder_ / "c.json").string(), "--set",
                "compare.models=[\"linear_fem\", \"chain_mail\"]", "--set", "compare.measured_N=" + measured});
  };
  Outcome outcome = against("[0.1, 0.2]");
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("measured"));
  const nlohmann::json written = read_json(folder_ / "c.json");
  for (const nlohmann::json& row : written["rows"]) {
    if (row["model"] == "chain_mail") {
      EXPECT_TRUE(row["error_measured"].is_null());
      continue;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto f = row["forces"][i].get<std::array<double, 3>>();
      sum += std::pow(norm(Vec3d{f[0], f[1], f[2]}) - 0.1 * static_cast<double>(i + 1), 2);
    }
    EXPECT_NEAR(row["error_measured"].get<double>(), std::sqrt(sum / 2.0) / 0.2, 1e-9);
  }
  outcome = against("[0.1]");
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("compare.measured_N: 1 forces; give one for each of the 2 stations"));
}

// A stiff tissue asks for hours of explicit steps: that is said and refused before anything runs, with the models that would do. A soft
// one runs, and is told its time first.
TEST_F(Compare, RefusesHoursOfExplicitSteps) {
  const std::string scene = write("block.toml", kBlock), out = (folder_ / "o").string();
  const std::string stiff = "tissue={youngs_modulus_Pa=1e12, poisson_ratio=0.3}";
  const std::vector<std::string> models{"--set", "compare.models=[\"linear_fem\", \"glisson\"]"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> command{"compare", scene, "--out", out};
    command.insert(command.end(), models.begin(), models.end());
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  };
  // 82 944 tets in about 8e7 steps: half a day on a fast core
  const Outcome refused = with({"--set", stiff, "--set", "mesh.cells=[24,24,24]"});
  EXPECT_THAT(refused, Exits(2));
  EXPECT_THAT(refused.err, ::testing::HasSubstr("explicit steps would take about"));
  EXPECT_THAT(refused.err, ::testing::HasSubstr("(glisson "));
  EXPECT_THAT(refused.err, ::testing::HasSubstr("more than --allow-hours 1"));
  EXPECT_THAT(refused.err, ::testing::HasSubstr("--set 'compare.models=[\"linear_fem\"]'"));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is written";
  EXPECT_THAT(with({"--set", stiff, "--set", "compare.models=[\"linear_fem\"]"}), Exits(0));
  const Outcome soft = with({});
  EXPECT_THAT(soft, Exits(0));
  EXPECT_THAT(soft.err, ::testing::HasSubstr("explicit steps will take about"));
  EXPECT_THAT(soft.err, ::testing::HasSubstr("the longest: glisson "));
  EXPECT_THAT(with({"--allow-hours", "1e-9"}), Exits(2)) << "the bound is the option's";
  EXPECT_THAT(with({"--allow-hours", "0"}), Exits(2));
}

TEST_F(Compare, SaysWhatItCannotGive) {
  const std::string needle = write("needle.toml", std::string(kBlock) +
                                                      "[[instrument]]\nkind = \"needle\"\ntip_m = [0.01, 0.01, 0.021]\n"
                                                      "motion = { kind = \"press\", depth_mm = 5 }\n");
  Outcome outcome = run({"compare", needle});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("has [[instrument]]; other models are given a mesh, a tissue"));
  const std::string scene = write("block.toml", kBlock);
  outcome = run({"compare", scene, "--set", "compare.models=[\"magic\"]"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("there is no model \"magic\"; there are spring_mass_volume_rule"));
  outcome = run({"compare", scene, "--set", "compare.finer=3", "--set", "mesh.cells=[40,40,40]"});
  EXPECT_THAT(outcome, Exits(2));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("the reference would have"));
  EXPECT_THAT(run({"compare"}), Exits(2));
  outcome = run({"compare", "--list"});
  EXPECT_THAT(outcome, Exits(0));
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("chain_mail\n  linked volumes"));
}

}  // namespace
}  // namespace glisson::test

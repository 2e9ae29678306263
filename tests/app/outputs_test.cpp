// What `glisson run` leaves behind: the files, their columns and keys, and that they agree with each other.
#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "app/program.h"
#include "glisson/io.h"
#include "scene/every_instrument.h"
#include "support/places.h"

namespace glisson::test {
namespace {

using Outputs = ProgramTest;

// forces.csv has the documented columns in the documented order, and supports after them.
TEST_F(Outputs, ForcesHaveTheDocumentedColumns) {
  const Outcome outcome = run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  const std::string text = read_text(folder_ / "o/main/forces.csv");
  EXPECT_EQ(
      text.substr(0, text.find('\n')),
      "time_s,depth_m,force_x_N,force_y_N,force_z_N,force_N,elastic_N,viscous_N,damping_N,inertial_N,gravity_N,"
      "load_N,energy_elastic_J,energy_kinetic_J,energy_dissipated_J,work_tools_J,work_loads_J,"
      "support_z_min_x_N,support_z_min_y_N,support_z_min_z_N,dissipated_viscous_J,dissipated_maxwell_J,"
      "dissipated_damping_J,dissipated_friction_J,dissipated_contact_J,dissipated_fracture_J,energy_instruments_J,"
      "energy_numerical_J");
}

// Pressing down costs a positive force, which is the sum of its parts and the reverse of the vector's z component;
// written numbers are exact, so these hold to rounding.
TEST_F(Outputs, ForceIsTheSumOfItsPartsAndPositiveWhenPressing) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  auto f = read_csv(folder_ / "o/main/forces.csv");
  ASSERT_GE(f["force_N"].size(), 20u) << "50 ms at 500 Hz";
  for (std::size_t i = 0; i < f["force_N"].size(); ++i) {
    const double parts = f["elastic_N"][i] + f["viscous_N"][i] + f["damping_N"][i] + f["inertial_N"][i] +
                         f["gravity_N"][i] + f["load_N"][i];
    EXPECT_NEAR(f["force_N"][i], parts, 1e-12) << "row " << i;
    EXPECT_EQ(f["force_N"][i], -f["force_z_N"][i]) << "row " << i;
  }
  EXPECT_GT(f["force_N"].back(), 0.01);
  EXPECT_NEAR(f["depth_m"].back(), 1e-3, 1e-4);
}

// summary.json has every documented key, and agrees with forces.csv.
TEST_F(Outputs, SummaryHasTheDocumentedKeys) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  for (const char* key : {"vertices",
                          "tets",
                          "steps",
                          "step_s",
                          "stable_step_s",
                          "wall_s",
                          "ns_per_tet_step",
                          "peak_force_N",
                          "energy_elastic_J",
                          "energy_kinetic_J",
                          "energy_dissipated_J",
                          "work_tools_J",
                          "work_loads_J",
                          "state_hash",
                          "version",
                          "end",
                          "time_s",
                          "variant",
                          "scene",
                          "tissue",
                          "inverted_tets_most",
                          "first_inversion_s",
                          "precision",
                          "threads"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  EXPECT_EQ(summary["vertices"], 27);
  EXPECT_EQ(summary["tets"], 48);
  EXPECT_EQ(summary["end"], "finished");
  EXPECT_EQ(summary["scene"], "s");
  EXPECT_LT(summary["step_s"], summary["stable_step_s"]);
  EXPECT_EQ(summary["state_hash"].get<std::string>().find_first_not_of("0123456789abcdef"), std::string::npos);
  auto f = read_csv(folder_ / "o/main/forces.csv");
  double peak = 0.0;
  for (const double force : f["force_N"]) peak = std::max(peak, std::abs(force));
  EXPECT_DOUBLE_EQ(summary["peak_force_N"], peak);
}

// Every frame that frames.pvd names is there, as many as the scene asks for.
TEST_F(Outputs, FramesAreThereAsTheCollectionSays) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string pvd = read_text(folder_ / "o/main/frames.pvd");
  for (const char* frame : {"frames/frame_0000.vtu", "frames/frame_0001.vtu", "frames/frame_0002.vtu"}) {
    EXPECT_NE(pvd.find(frame), std::string::npos) << frame;
    const std::string vtu = read_text(folder_ / "o/main" / frame);
    for (const char* field : {"displacement_m", "velocity_m_s", "\"q\"", "\"s\"", "von_mises_Pa", "region"}) {
      EXPECT_NE(vtu.find(field), std::string::npos) << frame << ": " << field;
    }
  }
  EXPECT_EQ(pvd.find("frame_0003"), std::string::npos);
}

// Adaptive precision says where the linear law is in force, and how much: an array of the frames, a figure of the summary, and the
// closing table. Without it there is none of them. `glisson check` names the tissues for which it does nothing.
TEST_F(Outputs, AdaptivePrecisionSaysWhereAndHowMuch) {
  const std::string scene = write("s.toml", small_scene());
  ASSERT_THAT(run({"run", scene, "--out", "single", "--set", "tissue.kinematics=corotational"}), Exits(0));
  EXPECT_FALSE(read_json(folder_ / "single/main/summary.json").contains("linear_share_mean"));
  EXPECT_EQ(read_text(folder_ / "single/main/frames/frame_0002.vtu").find("\"linear\""), std::string::npos);
  const Outcome outcome = run({"run", scene, "--out", "o", "--set", "tissue.kinematics=corotational", "--set",
                               "motion.precision=adaptive", "--set", "motion.precision_error=0.5"});
  ASSERT_THAT(outcome, Exits(0));
  const double share = read_json(folder_ / "o/main/summary.json")["linear_share_mean"];
  EXPECT_GT(share, 0.1) << "the linear law comes over 64 steps, of which this run has few";
  EXPECT_LE(share, 1.0);
  const std::string told = std::to_string(static_cast<int>(std::lround(100.0 * share))) + " % of the tets linear";
  EXPECT_NE(outcome.out.find(told), std::string::npos) << outcome.out;
  EXPECT_NE(read_text(folder_ / "o/main/frames/frame_0002.vtu").find("\"linear\""), std::string::npos);
  const Outcome checked = run({"check", scene, "--set", "motion.precision=adaptive"});
  EXPECT_NE(checked.out.find("no linear law stands in for"), std::string::npos) << checked.out;
}

// A frame is as ParaView takes it: points at rest, so that its warp by displacement_m shows the shape once; tensors of nine
// components, xx, xy, xz, yx, …; whole numbers for regions, named or not.
TEST_F(Outputs, FramesAreAsParaViewTakesThem) {
  const std::string half =
      "[[region]]\nname = \"half\"\nbox_m = { min = [0, 0, 0], max = [0.01, 0.02, 0.02] }\n"
      "tissue = { youngs_modulus_Pa = 9000 }\n";
  for (const std::string& more : {std::string(), half}) {
    ASSERT_THAT(run({"run", write("s.toml", small_scene(more)), "--out", "o", "--quiet"}), Exits(0));
    const std::filesystem::path file = folder_ / "o/main/frames/frame_0002.vtu";
    EXPECT_NE(read_text(file).find("type=\"Int32\" Name=\"region\""), std::string::npos);
    const std::vector<std::string> wanted{"displacement_m", "stress_Pa", "strain", "pressure_Pa", "von_mises_Pa"};
    const ReadFrame frame = read_frame(file, wanted);
    const TetMesh box = box_mesh({.cells = {2, 2, 2}, .size = {0.02, 0.02, 0.02}});
    EXPECT_EQ(frame.mesh.vertices, box.vertices);
    EXPECT_EQ(frame.mesh.tets, box.tets);
    ASSERT_EQ(frame.mesh.regions.size(), box.tets.size());
    EXPECT_EQ(*std::ranges::max_element(frame.mesh.regions), more.empty() ? 0 : 1);
    std::map<std::string, Field> fields;
    for (const Field& f : frame.tet_fields) fields[f.name] = f;
    const std::vector<double>&u = frame.vertex_fields.at(0).values, &stress = fields["stress_Pa"].values,
          &strain = fields["strain"].values;
    ASSERT_EQ(stress.size(), 9 * box.tets.size());
    ASSERT_EQ(strain.size(), 9 * box.tets.size());
    EXPECT_NE(read_text(file).find("type=\"Float32\" Name=\"stress_Pa\""), std::string::npos);
    constexpr double kSingle = 1e-7;  // what tets have is kept in single precision
    double sheared = 0.0;
    for (std::size_t t = 0; t < box.tets.size(); ++t) {
      const double* s = &stress[9 * t];
      const double* e = &strain[9 * t];
      const double size = std::abs(s[0]) + std::abs(s[4]) + std::abs(s[8]);
      EXPECT_NEAR(fields["pressure_Pa"].values[t], -(s[0] + s[4] + s[8]) / 3.0, kSingle * size);
      for (const auto& [i, j] : {std::pair{1, 3}, {2, 6}, {5, 7}}) {
        EXPECT_EQ(s[i], s[j]);
        EXPECT_NEAR(e[i], e[j], 1e-15);
        sheared = std::max(sheared, std::abs(s[i]));
      }
      for (int a = 1; a < 4; ++a) {  // Green's strain is half the change of an edge's square
        const std::uint32_t v = box.tets[t][0], w = box.tets[t][static_cast<std::size_t>(a)];
        const Vec3d rest = box.vertices[w] - box.vertices[v];
        const Vec3d now = rest + Vec3d{u[3 * w] - u[3 * v], u[3 * w + 1] - u[3 * v + 1], u[3 * w + 2] - u[3 * v + 2]};
        double change = 0.0;
        for (std::size_t i = 0; i < 9; ++i) change += rest[i / 3] * e[i] * rest[i % 3];
        EXPECT_NEAR(2.0 * change, dot(now, now) - dot(rest, rest), kSingle * dot(rest, rest));
      }
    }
    EXPECT_GT(sheared, 1.0) << "the press shears";
  }
}

constexpr const char* kEveryProbe = R"([[probe]]
name = "tip"
point_m = [0.011, 0.012, 0.013]
[[probe]]
name = "top"
set = "z_max"
[[probe]]
name = "body"
region = "0"
[[probe]]
name = "cut"
plane_m = { point = [0.01, 0.01, 0.007], normal = [0, 0, 1] }
)";

// probes.csv has a line for each of forces.csv, at the same times; the report has its columns, and a chart of the scene may show them.
TEST_F(Outputs, ProbesStandBesideTheForces) {
  const std::string chart = "[[chart]]\ntitle = \"tip\"\nx = \"time_s\"\ny = \"tip_displacement_z_m\"\n";
  ASSERT_THAT(run({"run", write("s.toml", small_scene(std::string(kEveryProbe) + chart)), "--out", "o", "--quiet"}),
              Exits(0));
  auto forces = read_csv(folder_ / "o/main/forces.csv");
  auto probes = read_csv(folder_ / "o/main/probes.csv");
  EXPECT_EQ(probes["time_s"], forces["time_s"]);
  EXPECT_EQ(probes.size(), 1u + 21 + 9 + 21 + 10);
  for (std::size_t i = 0; i < forces["time_s"].size(); ++i) {
    EXPECT_NEAR(probes["top_displacement_z_m"][i], -forces["depth_m"][i], 1e-9) << "the driven face, row " << i;
    const double internal = -(forces["elastic_N"][i] + forces["viscous_N"][i]);
    EXPECT_NEAR(probes["top_force_z_N"][i], internal, 1e-6) << "row " << i;
  }
  const nlohmann::json page = report_data(folder_ / "o/report.html")["scenes"][0];
  EXPECT_EQ(page["variants"][0]["probes"]["columns"].size(), probes.size());
  EXPECT_EQ(page["charts"][0]["y"]["column"], "tip_displacement_z_m");
}

// docs/output.md names every column, array and key that runs write.
TEST_F(Outputs, PageNamesAllThatIsWritten) {
  const std::string page = read_text(test::shipped("docs/output.md"));
  const auto named = [&](const std::string& name) { return page.find("`" + name + "`") != std::string::npos; };
  for (const std::string& scene : {small_scene(kEveryProbe), std::string(kEveryInstrument)}) {
    ASSERT_THAT(run({"run", write("s.toml", scene), "--out", "o", "--quiet", "--set", "motion.max_steps=20"}),
                Exits(0));
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "o/main")) {
      std::string file = entry.path().filename().string();
      if (file.find("tool_") == 0) file = "tool_NAME.pvd";
      if (file != "frames" && file.find("forces_") != 0) {
        EXPECT_NE(page.find(file), std::string::npos) << file;
      }
      if (entry.path().extension() != ".csv") continue;
      std::istringstream head(read_text(entry.path()).substr(0, read_text(entry.path()).find('\n')));
      for (std::string column; std::getline(head, column, ',');) {
        if (file == "probes.csv" && column != "time_s") column = "NAME" + column.substr(column.find('_'));
        if (column.find("support_") != 0) {
          EXPECT_TRUE(named(column)) << file << ": " << column;
        }
      }
    }
    const std::string frame = read_text(folder_ / "o/main/frames/frame_0000.vtu");
    const std::regex array("Name=\"(\\w+)\"");  // set:NAME and region:NAME have a colon
    for (std::sregex_iterator i(frame.begin(), frame.end(), array), end; i != end; ++i) {
      const std::string name = (*i)[1];
      const bool vtk = name == "Points" || name == "connectivity" || name == "offsets" || name == "types";
      EXPECT_TRUE(vtk || named(name)) << name;
    }
    const nlohmann::json summary = nlohmann::json::parse(read_text(folder_ / "o/main/summary.json"));
    for (const auto& [key, value] : summary.items()) {
      const bool account = key.find("energy_") == 0 || key.find("work_") == 0;
      EXPECT_TRUE(account || named(key)) << key;
    }
  }
}

// A frame that is given as a mesh says what it is and what to do.
TEST_F(Outputs, AFrameReadAsAMeshSaysSo) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const Outcome info = run({"info", "o/main/frames/frame_0002.vtu"});
  ASSERT_THAT(info, Exits(0));
  EXPECT_NE(info.out.find("This is a frame of a run, not a mesh: its points are those at rest"), std::string::npos)
      << info.out;
  EXPECT_NE(info.out.find("glisson view"), std::string::npos) << info.out;
  const Outcome check = run({"check", "s.toml", "--mesh", "o/main/frames/frame_0002.vtu"});
  ASSERT_THAT(check, Exits(0));
  EXPECT_NE(check.err.find("warning: This is a frame of a run"), std::string::npos) << check.err;
}

// The report holds the same forces, the surface of the mesh in arrays of the promised lengths, and the scene's text,
// of which nothing can end the data's element.
TEST_F(Outputs, ReportHoldsTheRun) {
  const std::string scene = "description = \"</script><b>not a tag</b>\"\n" + small_scene();
  const Outcome outcome = run({"run", write("s.toml", scene), "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json report = report_data(folder_ / "o/report.html");
  EXPECT_EQ(report["format"], 1);
  const nlohmann::json& s = report["scenes"][0];
  EXPECT_EQ(s["description"], "</script><b>not a tag</b>");
  EXPECT_EQ(s["source"], scene);
  const nlohmann::json& v = s["variants"][0];
  auto f = read_csv(folder_ / "o/main/forces.csv");
  EXPECT_EQ(v["forces"]["columns"][5], "force_N");
  ASSERT_EQ(v["forces"]["data"][5].size(), f["force_N"].size());
  EXPECT_NEAR(v["forces"]["data"][5].back().get<double>(), f["force_N"].back(), 1e-6 * f["force_N"].back());
  const nlohmann::json& body = v["surface"];
  EXPECT_EQ(body["vertices"], 27) << "all of 3 × 3 × 3, the middle one last";
  EXPECT_EQ(body["frames"].size(), 3u);
  EXPECT_EQ(body["rest"].get<std::string>().size(), 27u * 3 * 4 / 3 * 4) << "27 × 3 floats in base64";
  EXPECT_EQ(body["tets"].get<std::string>().size(), 8u * 6 * 16 / 3 * 4) << "six tets a cell, four numbers each";
  EXPECT_FALSE(body.contains("container"));
  const nlohmann::json& fields = body["frames"][2]["fields"];
  for (const char* name : {"pressure", "von_mises"}) {
    EXPECT_EQ(fields[name]["values"].get<std::string>().size(), 36u) << name << ": 27 bytes in base64";
    EXPECT_LE(fields[name]["low"], 0.0);
    EXPECT_GT(fields[name]["high"], 0.0) << name;
  }
  EXPECT_FALSE(fields.contains("contact_pressure")) << "nothing touches it";
  EXPECT_EQ(v["law_curves"][0]["curves"][0]["y"][0], 3600.0);
}

// What `glisson check` says of a variant stands in its summary, in one line each, but for what builds the body again; the report has it
// once for all variants, warnings first.
TEST_F(Outputs, AdviceStandsInSummaryAndReport) {
  const std::string scene = write("s.toml", small_scene("[[variant]]\nname = \"soft\"\n[[variant]]\nname = \"wet\"\n"
                                                        "tissue.poisson_ratio = 0.49\ntissue.law_form = \"secant\"\n"
                                                        "tissue.law = { kind = \"linear\", slope_Pa = 1000 }\n"));
  ASSERT_THAT(run({"run", scene, "--out", "o", "--quiet"}), Exits(0));
  std::string check = run({"check", scene}).out;
  check = std::regex_replace(check, std::regex("\n +"), " ");
  const auto rules = [&](const std::string& variant) {
    std::vector<std::string> names;
    const nlohmann::json summary = read_json(folder_ / "o" / variant / "summary.json");
    for (const nlohmann::json& one : summary["advice"]) {
      names.push_back(one["rule"]);
      const std::string text = one["text"];
      EXPECT_EQ(text.find('\n'), std::string::npos);
      EXPECT_NE(check.find(text), std::string::npos) << text << "\nis not in\n" << check;
    }
    return names;
  };
  EXPECT_EQ(rules("soft"), std::vector<std::string>{"coarse"});
  EXPECT_EQ(rules("wet"), (std::vector<std::string>{"locking", "coarse"}));
  std::vector<std::string> said;
  const nlohmann::json report = report_data(folder_ / "o/report.html")["scenes"][0];
  for (const nlohmann::json& one : report["advice"])
    said.push_back(one["rule"].get<std::string>() + one["variants"].dump());
  EXPECT_EQ(said, (std::vector<std::string>{"coarse[\"soft\",\"wet\"]", "locking[\"wet\"]", "cycle_work[]"}));
  EXPECT_FALSE(report["variants"][1]["summary"].contains("advice"));
}

// Checks of a scene are printed and stand in the report; one that fails ends the program with status 1, and is said with --quiet too.
TEST_F(Outputs, ChecksOfTheSceneAreHeldAgainstItsRun) {
  const std::string checks =
      "[[check]]\nwhat = \"it presses\"\ncolumn = \"force_N\"\nat = \"largest\"\nat_least = 0.01\n"
      "[[check]]\nwhat = \"it goes down\"\ncolumn = \"depth_m\"\nat_least = 0.0009\nat_most = 0.0011\n";
  const Outcome good = run({"run", write("s.toml", small_scene(checks)), "--out", "o"});
  ASSERT_THAT(good, Exits(0));
  EXPECT_NE(good.out.find("ok    it presses\n"), std::string::npos) << good.out;
  EXPECT_NE(good.out.find("(expected: 0.0009 to 0.0011)"), std::string::npos) << good.out;
  const nlohmann::json listed = report_data(folder_ / "o/report.html")["scenes"][0]["checks"];
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_TRUE(listed[0]["pass"].get<bool>() && listed[1]["pass"].get<bool>());
  const Outcome bad = run({"run", "s.toml", "--out", "o2", "--quiet", "--set", "check.1.at_most=0.00095"});
  ASSERT_THAT(bad, Exits(1));
  EXPECT_NE(bad.out.find("FAIL  it goes down\n"), std::string::npos) << bad.out;
  EXPECT_EQ(bad.out.find("it presses"), std::string::npos) << bad.out;
  EXPECT_NE(bad.out.find("o2/report.html"), std::string::npos) << bad.out;
  const Outcome none =
      run({"run", write("n.toml", small_scene("[[check]]\nwhat = \"w\"\ncolumn = \"forse_N\"\nat_least = 0\n")),
           "--out", "o3"});
  ASSERT_THAT(none, Exits(1));
  EXPECT_NE(none.out.find("no column \"forse_N\""), std::string::npos) << none.out;
}

// A palpation of a flat block: a press at each point of the grid to the same depth below the surface, and the report's map has just
// these places, with the largest force of each.
TEST_F(Outputs, PalpationMakesAMap) {
  const std::string scene = R"([mesh]
kind = "box"
cells = [6, 6, 3]
size_m = [0.06, 0.06, 0.03]
[motion]
damping_rate_per_s = 40
[[fixed]]
set = "z_min"
[[instrument]]
kind = "ball"
name = "finger"
tip_m = [0.03, 0.03, 0.035]
radius_mm = 6
motion = { kind = "palpation", columns = 3, rows = 2, spacing_mm = 10, indentation_mm = 2, velocity_mm_s = 100, clearance_mm = 1, move_s = 0.02, hold_s = 0.02 }
[output]
frames = 2
[[chart]]
title = "map"
x = "position_x_m"
y = "position_y_m"
x_scale = 1000
y_scale = 1000
value = "force_N"
)";
  ASSERT_THAT(run({"run", write("s.toml", scene), "--out", "o", "--quiet"}), Exits(0));
  EXPECT_THAT(run({"run", "s.toml", "--out", "o", "--quiet"}), Exits(0))
      << "a second run replaces all files of the first";
  auto f = read_csv(folder_ / "o/main/forces.csv");
  EXPECT_NEAR(*std::min_element(f["position_z_m"].begin(), f["position_z_m"].end()), 0.028, 1e-5);
  const nlohmann::json map = report_data(folder_ / "o/report.html")["scenes"][0]["charts"][0]["map"];
  ASSERT_EQ(map["of"].size(), 1u);
  const std::vector<double> x = map["of"][0]["x"], y = map["of"][0]["y"], value = map["of"][0]["value"];
  ASSERT_EQ(value.size(), 6u);
  EXPECT_THAT(x, testing::Pointwise(testing::DoubleNear(1e-6), {20, 20, 30, 30, 40, 40}));
  EXPECT_THAT(y, testing::Pointwise(testing::DoubleNear(1e-6), {25, 35, 25, 35, 25, 35}));
  EXPECT_NEAR(*std::max_element(value.begin(), value.end()),
              *std::max_element(f["force_N"].begin(), f["force_N"].end()), 1e-12);
  EXPECT_GT(*std::min_element(value.begin(), value.end()), 0.05);
}

// A second tool has a file of its own with the first twelve columns, and the report has its numbers.
TEST_F(Outputs, SecondToolHasItsOwnFile) {
  const std::string scene = write("s.toml", small_scene(R"([[tool]]
name = "side"
set = "edge"
direction = [1, 0, 0]
velocity_mm_s = 20
depth_mm = 1
[sets.edge]
vertices = [9]
)"));
  const Outcome outcome = run({"run", scene, "--out", "o", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  const auto side = read_csv(folder_ / "o/main/forces_side.csv");
  EXPECT_EQ(side.size(), 12u);
  EXPECT_GT(side.at("force_N").back(), 0.0);
  const nlohmann::json tools = report_data(folder_ / "o/report.html")["scenes"][0]["variants"][0]["instruments"];
  ASSERT_EQ(tools.size(), 2u);
  EXPECT_FALSE(tools[0].contains("forces")) << "those of forces.csv";
  EXPECT_EQ(tools[1]["name"], "side");
  EXPECT_EQ(tools[1]["kind"], "none") << "a driven set has no shape";
  EXPECT_EQ(tools[1]["forces"]["columns"][5], "force_N");
  EXPECT_NEAR(tools[1]["forces"]["data"][5].back().get<double>(), side.at("force_N").back(), 1e-6);
}

}  // namespace
}  // namespace glisson::test

// The other subcommands: info, schema, laws, help, and the paper reproduced.
#include <cmath>
#include <regex>

#include "app/program.h"
#include "scene/every_instrument.h"

namespace glisson::test {
namespace {

using Commands = ProgramTest;

// `check` names every instrument, its motion and the vessel by the words that the scene has for them.
TEST_F(Commands, CheckNamesInstrumentsByTheirKind) {
  const Outcome outcome = run({"check", write("s.toml", kEveryInstrument)});
  ASSERT_THAT(outcome, Exits(0));
  const std::regex kind(R"re(kind = "(\w+)")re");
  std::vector<std::string> kinds;  // of the mesh, of each instrument and its motion, of the vessel
  for (std::sregex_iterator k(kEveryInstrument.begin(), kEveryInstrument.end(), kind), end; k != end; ++k) {
    kinds.push_back((*k)[1]);
  }
  ASSERT_GE(kinds.size(), 16U);
  for (std::size_t i = 1; i + 1 < kinds.size(); i += 2) {
    EXPECT_NE(outcome.out.find(", " + kinds[i] + ": " + kinds[i + 1]), std::string::npos) << kinds[i] << outcome.out;
  }
  EXPECT_NE(outcome.out.find("vessel   " + kinds.back() + ", "), std::string::npos) << outcome.out;
}

// Every subcommand explains itself with examples.
TEST_F(Commands, HelpHasExamples) {
  for (const std::string command :
       {"run", "check", "converge", "mesh", "info", "reproduce", "schema", "laws", "tissues", "material"}) {
    const Outcome outcome = run({command, "--help"});
    EXPECT_THAT(outcome, Exits(0)) << command;
    EXPECT_NE(outcome.out.find("Examples:\n  glisson " + command), std::string::npos) << outcome.out;
  }
  EXPECT_THAT(run({"--help"}), Exits(0));
  EXPECT_EQ(run({"--version"}).out.find("glisson "), 0u);
}

// The schema names sections, units and ranges; the laws name their parameters.
TEST_F(Commands, SchemaAndLawsDescribeScenes) {
  const std::string schema = run({"schema"}).out;
  for (const char* key : {"poisson_ratio", "damping_rate_per_s", "velocity_mm_s", "sample_rate_hz"}) {
    EXPECT_NE(schema.find(key), std::string::npos) << key;
  }
  const std::string laws = run({"laws"}).out;
  for (const char* law : {"constant", "step", "linear", "polynomial", "exponential", "table", "threshold"}) {
    EXPECT_NE(laws.find(law), std::string::npos) << law;
  }
}

// material: simple shear of a neo-Hookean tissue is μ γ, in the table, in JSON and in the file; a stress that no stretch carries ends
// with what was computed.
TEST_F(Commands, MaterialGivesTheCurveOfATissue) {
  const std::string tissue = write(
      "tissue.toml", "[tissue]\nhyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 1e5 }\n");
  const std::vector<std::string> shear{"material", tissue, "--test", "simple_shear", "--to", "0.5", "--points", "2"};
  const Outcome text = run(shear);
  EXPECT_THAT(text, Exits(0)) << text.err;
  EXPECT_NE(text.out.find("nominal_stress [Pa]"), std::string::npos) << text.out;
  std::vector<std::string> more = shear;
  more.insert(more.end(), {"--json", "--csv", "curve.csv"});
  const nlohmann::json json = nlohmann::json::parse(run(more).out);
  EXPECT_NEAR(json["columns"]["nominal_stress_Pa"][1].get<double>(), 500.0, 1e-7);
  EXPECT_EQ(read_text(folder_ / "curve.csv").substr(0, 30), "time_s,shear,nominal_stress_Pa");

  const std::string green = write("green.toml", "[tissue]\nyoungs_modulus_Pa = 3600\nkinematics = \"green\"\n");
  const Outcome stopped = run({"material", green, "--stress", "--to=-1200", "--points", "4"});
  EXPECT_THAT(stopped, Exits(1));
  EXPECT_NE(stopped.err.find("no deformation carries the prescribed stress"), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.out.find("-600"), std::string::npos) << stopped.out;

  EXPECT_THAT(run({"material", "nothing"}), Exits(2));
  EXPECT_NE(run({"material", green, "--test", "shear"}).err.find("allowed: uniaxial, equibiaxial"), std::string::npos);
  EXPECT_NE(run({"material", green, "--to=-1"}).err.find("a stretch is above 0"), std::string::npos);
  EXPECT_NE(run({"material", "nothing.toml"}).err.find("there is no such file"), std::string::npos);
}

// material: an indented layer gives Hertz's force within 1 %, and half of it after a hold in which half relaxes.
TEST_F(Commands, MaterialIsIndented) {
  const std::string tissue =
      write("soft.toml",
            "[tissue]\nhyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 1e7 }\n"
            "maxwell = [{ share = 0.5, time_s = 1 }]\n");
  const Outcome pressed = run({"material", tissue, "--test", "indentation", "--radius-mm", "20", "--to", "0.2",
                               "--rate", "200", "--hold", "30", "--points", "4", "--json"});
  ASSERT_THAT(pressed, Exits(0)) << pressed.err;
  const nlohmann::json columns = nlohmann::json::parse(pressed.out)["columns"];
  const double hertz = 4.0 / 3.0 * 4000.0 * std::sqrt(0.02 * 2e-4) * 2e-4;
  EXPECT_NEAR(columns["force_N"][3].get<double>(), hertz, 0.01 * hertz);
  EXPECT_NEAR(columns["force_N"].back().get<double>(), 0.5 * hertz, 0.005 * hertz);
  EXPECT_NE(
      run({"material", tissue, "--test", "indentation", "--indenter", "ball"}).err.find("allowed: sphere, flat, cone"),
      std::string::npos);
  EXPECT_NE(run({"material", tissue, "--test", "indentation", "--thickness-mm", "2", "--to", "3"})
                .err.find("a depth of 3 mm in a layer of 2 mm"),
            std::string::npos);
}

// material: torsion and oscillation give the closed forms of neo-Hooke; what a test does not read is refused, and a page with the curve
// is written.
TEST_F(Commands, MaterialTwistsAndOscillates) {
  const std::string tissue = write(
      "tissue.toml", "[tissue]\nhyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 1e11 }\n");
  const Outcome twisted = run({"material", tissue, "--test", "torsion", "--radius-mm", "20", "--length-mm", "30",
                               "--to", "90", "--points", "2", "--json", "--picture", "torsion.html"});
  ASSERT_THAT(twisted, Exits(0)) << twisted.err;
  const nlohmann::json torsion = nlohmann::json::parse(twisted.out)["columns"];
  const double twist = std::acos(-1.0) / 2.0 / 0.03, torque = 0.5 * std::acos(-1.0) * 1000.0 * twist * 1.6e-7;
  EXPECT_NEAR(torsion["torque_N_m"][1].get<double>(), torque, 1e-6 * torque);
  EXPECT_NEAR(torsion["twist_rad_m"][1].get<double>(), twist, 1e-9 * twist);
  EXPECT_NEAR(torsion["axial_force_N"][1].get<double>(), -0.5 * twist * torque, 1e-6 * twist * torque);
  EXPECT_NE(read_text(folder_ / "torsion.html").find("Torque against angle"), std::string::npos);

  const Outcome text = run({"material", tissue, "--test", "oscillation", "--stretch", "1.2", "--from-hz", "0.1",
                            "--to-hz", "10", "--points", "3", "--csv", "modulus.csv"});
  ASSERT_THAT(text, Exits(0)) << text.err;
  EXPECT_NE(text.out.find("storage_modulus [Pa]"), std::string::npos) << text.out;
  EXPECT_NE(read_text(folder_ / "modulus.csv").find("\n1,14"), std::string::npos) << read_text(folder_ / "modulus.csv");

  const auto refused = [&](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"material", tissue});
    const Outcome outcome = run(more);
    EXPECT_THAT(outcome, Exits(2)) << message;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  };
  refused({"--test", "torsion", "--radius-mm=-3"}, "--radius-mm -3: outside the allowed range, > 0");
  refused({"--radius-mm", "3"},
          "--radius-mm: it belongs to --test torsion, and --test indentation of a sphere or flat punch, and the test "
          "is uniaxial");
  refused({"--test", "oscillation", "--to", "1.1"}, "--to: it belongs to tests over time");
  refused({"--test", "oscillation", "--from-hz", "5", "--to-hz", "1"}, "--to-hz 1: it is below --from-hz 5");
  refused({"--test", "oscillation", "--mode", "bulk"}, "allowed: simple_shear, uniaxial");
  refused({"--picture", "curve.png"}, "ends in .html");
}

// info prints the same figures as text and as JSON; --scale acts on them.
TEST_F(Commands, InfoDescribesAMesh) {
  ASSERT_THAT(run({"run", write("s.toml", small_scene()), "--out", "o", "--quiet"}), Exits(0));
  const std::string frame = (folder_ / "o/main/frames/frame_0000.vtu").string();
  const Outcome text = run({"info", frame});
  EXPECT_THAT(text, Exits(0));
  EXPECT_NE(text.out.find("27"), std::string::npos) << text.out;
  const nlohmann::json json = nlohmann::json::parse(run({"info", frame, "--json"}).out);
  EXPECT_EQ(json["vertices"], 27);
  EXPECT_EQ(json["tets"], 48);
  EXPECT_NEAR(json["volume_m3"].get<double>(), 8e-6, 1e-12);
  EXPECT_EQ(json["vertex_sets"]["z_max"], 9);
  const nlohmann::json scaled = nlohmann::json::parse(run({"info", frame, "--json", "--scale", "10"}).out);
  EXPECT_NEAR(scaled["volume_m3"].get<double>(), 8e-3, 1e-9);
}

// What a tissue is beside its numbers is said where it is not the default.
TEST_F(Commands, CheckSaysWhatTheTissueIs) {
  const std::string scene = write("s.toml", small_scene());
  const Outcome outcome = run({"check", scene, "--set", "tissue.kinematics=corotational", "--set",
                               "tissue.volume_change=nodal", "--set", "tissue.maxwell=[{share=0.4,time_s=2}]"});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_NE(outcome.out.find(", corotational, average nodal volume changes"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("0.4 of the deviator relaxes in 2 s"), std::string::npos) << outcome.out;
  EXPECT_EQ(run({"check", scene}).out.find("corotational"), std::string::npos);
}

// Two values after one --set are an error that says what to write.
TEST_F(Commands, EachValueTakesItsOwnSet) {
  const Outcome outcome =
      run({"check", write("s.toml", small_scene()), "--set", "tissue.poisson_ratio=0.3", "mesh.cells=[3,3,3]"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--set mesh.cells=[3,3,3]"), std::string::npos) << outcome.err;
}

// Where tools hardly move in a step, check says which longer step mass would keep, and takes that itself; it says nothing where steps are
// long enough, and of tools whose way depends on forces.
TEST_F(Commands, CheckTellsWhereMassMakesStepsLonger) {
  const std::string scene = write("s.toml", small_scene());
  const std::vector<std::string> stiff{"check", scene, "--set", "tissue.youngs_modulus_Pa=1e7"};
  const Outcome plain = run(stiff);
  ASSERT_THAT(plain, Exits(0));
  std::smatch found;
  ASSERT_TRUE(std::regex_search(plain.out, found, std::regex(R"(mass_scaling_step_s = ([\d.e-]+) makes\s+steps)")))
      << plain.out;
  std::vector<std::string> longer = stiff;
  longer.insert(longer.end(),
                {"--set", "motion.mass_scaling=variable", "--set", "motion.mass_scaling_step_s=" + found[1].str()});
  const Outcome heavy = run(longer);
  EXPECT_THAT(heavy, Exits(0));
  EXPECT_NE(heavy.out.find(found[1].str() + " s (auto), kept by mass"), std::string::npos) << heavy.out;
  EXPECT_NE(heavy.out.find(" steps at the step asked for, more where that mass has an effect"), std::string::npos);
  EXPECT_EQ(heavy.out.find("  slow  "), std::string::npos) << heavy.out;
  EXPECT_EQ(run({"check", scene}).out.find("  slow  "), std::string::npos) << "steps are long enough";
}

// Where viscosity keeps the step short, check says how many stages of it pay and how long the step then is; it is that, and with them
// nothing is left to say.
TEST_F(Commands, CheckTellsWhereStagesOfViscosityPay) {
  const std::string scene = write("s.toml", small_scene());
  const std::string viscous = "tissue.viscosity_Pa_s=10";
  const auto stable = [](const Outcome& check) {
    std::smatch found;
    return std::regex_search(check.out, found, std::regex(R"(stable below ([\d.e-]+) s)")) ? std::stod(found[1]) : 0.0;
  };
  const Outcome plain = run({"check", scene, "--set", viscous});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(plain.out, found, std::regex(R"(drag_stages = (\d) makes it ([\d.]+) times as long)")))
      << plain.out;
  const Outcome staged = run({"check", scene, "--set", viscous, "--set", "motion.drag_stages=" + found[1].str()});
  EXPECT_NEAR(stable(staged) / stable(plain), std::stod(found[2]), 0.06 * std::stod(found[2]));
  EXPECT_EQ(staged.out.find("drag_stages"), std::string::npos) << staged.out;
  EXPECT_EQ(run({"check", scene}).out.find("drag_stages"), std::string::npos);
}

// A few stiff tets keep the step short: check says how many, which is first and what step mass would give; with that mass
// the scene has the step and the summary the mass. An implicit scene has no such limit, and says so.
TEST_F(Commands, CheckTellsWhichTetsKeepTheStepShort) {
  const std::string scene = write("s.toml", R"([mesh]
kind = "box"
cells = [8, 8, 8]
size_m = [0.04, 0.04, 0.04]
[[region]]
name = "stone"
sphere_m = { center = [0.022, 0.022, 0.022], radius = 0.002 }
tissue = { youngs_modulus_Pa = 3e5 }
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
depth_mm = 0.1
)");
  const Outcome plain = run({"check", scene});
  ASSERT_THAT(plain, Exits(0));
  const std::regex limits(
      R"(limits   (\d+) of the tets, first tet \d+ with altitude ([\d.]+) mm, keep the step short;\s+)"
      R"(mass_scaling_step_s = ([\d.e-]+) adds mass only to these and makes it ([\d.]+) times as long at rest)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(plain.out, found, limits)) << plain.out;
  EXPECT_LE(std::stoi(found[1]), 12);
  EXPECT_NEAR(std::stod(found[2]), 5.0 / std::sqrt(2.0), 0.01);
  const std::string step = "motion.mass_scaling_step_s=" + found[3].str();
  EXPECT_NE(
      run({"check", scene, "--set", step, "--set", "motion.mass_scaling=variable"}).out.find("kept by mass for tets"),
      std::string::npos);
  const Outcome scaled = run({"check", scene, "--set", step});
  EXPECT_NE(scaled.out.find("% of the body's own) added to " + found[1].str() + " tets"), std::string::npos)
      << scaled.out;
  EXPECT_EQ(scaled.out.find("limits"), std::string::npos) << scaled.out;
  ASSERT_THAT(run({"run", scene, "--set", step, "--out", "o", "--quiet"}), Exits(0));
  const nlohmann::json summary = read_json(folder_ / "o/main/summary.json");
  EXPECT_GE(summary["stable_step_s"].get<double>(), std::stod(found[3]));
  ASSERT_THAT(run({"run", scene, "--out", "p", "--quiet"}), Exits(0));
  const double before = read_json(folder_ / "p/main/summary.json")["stable_step_s"].get<double>();
  EXPECT_NEAR(summary["stable_step_s"].get<double>() / before, std::stod(found[4]), 0.06)
      << "the growth is that of the step";
  EXPECT_GT(summary["mass_added_kg"].get<double>(), 0.0);
  const Outcome implicit = run({"check", scene, "--set", "motion.integrator=implicit"});
  EXPECT_NE(implicit.out.find("stable at any step"), std::string::npos) << implicit.out;
  EXPECT_NE(implicit.out.find("double precision"), std::string::npos) << implicit.out;
}

// Bounds of single tets that differ are no hint where mass for the lowest of them would not lengthen the body's step: the hint
// is left out, as on the graded cylinders of the needle scenes.
TEST_F(Commands, CheckSaysNothingOfMassThatWouldNotHelp) {
  const Outcome outcome = run({"check", write("s.toml", R"([mesh]
kind = "cylinder"
radius_m = 0.03
height_m = 0.04
radial_cells = 8
axial_cells = 10
grading = 4
[[fixed]]
set = "bottom"
[[tool]]
set = "top"
depth_mm = 0.1
)")});
  ASSERT_THAT(outcome, Exits(0));
  EXPECT_EQ(outcome.out.find("mass_scaling_step_s"), std::string::npos) << outcome.out;
}

/// An instrument on a cylinder of 7.07 mm.
std::string punched(const std::string& mesh, const std::string& tool) {
  return "[mesh]\nkind = \"cylinder\"\nradius_m = 0.00707\nheight_m = 0.005\n" + mesh + R"(
[[fixed]]
set = "bottom"
[[instrument]]
name = "tip"
tip_m = [0, 0, 0.0051]
motion = { kind = "press", depth_mm = 0.2 }
)" + tool;
}

// Cells that are coarse beside the sharp edge of a punch or block are named with their size, the size that would do and the
// grading for it. Fine ones, a rounded edge and a shape without an edge are not.
TEST_F(Commands, CheckTellsOfCellsTooCoarseForAnEdge) {
  const std::string coarse = "radial_cells = 7\naxial_cells = 4\n", punch = "kind = \"punch\"\nradius_mm = 5\n";
  const auto said = [&](const std::string& mesh, const std::string& tool) {
    const Outcome outcome = run({"check", write("s.toml", punched(mesh, tool))});
    EXPECT_THAT(outcome, Exits(0));
    return outcome.out;
  };
  const std::string text = said(coarse, punch);
  const std::regex edge(
      R"("tip": cells of ([\d.]+) mm across its sharp edge are ([\d.]+) of its (radius|half width) of 5 mm,[^;]*;)"
      R"( cells of 0.2 mm there, 0.04 of it)"),
      grading(R"(radial_cells = (\d+) and axial_cells = (\d+) here)");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found, edge)) << text;
  EXPECT_NEAR(std::stod(found[1]), 1.01, 0.08);  // a triangle of a ring, whose chords bow a little
  EXPECT_NEAR(std::stod(found[2]), 0.2, 0.02);
  EXPECT_EQ(found[3], "radius");
  ASSERT_TRUE(std::regex_search(text, found, grading)) << text;
  EXPECT_NEAR(std::stoi(found[1]), 35, 3);  // 7 rings of 1.01 mm, to be 0.2 mm
  const std::string block = said(coarse, "kind = \"block\"\nsize_mm = [10, 14, 20]\n");
  ASSERT_TRUE(std::regex_search(block, found, edge)) << block;
  EXPECT_EQ(found[3], "half width");
  for (const std::string& fine : {said(coarse, punch + "edge_radius_mm = 1.5\n"), said(coarse, "kind = \"ball\"\n"),
                                  said("radial_cells = 21\naxial_cells = 4\n", punch)}) {
    EXPECT_EQ(fine.find("sharp edge"), std::string::npos) << fine;
  }
}

// What makes a force wrong on linear tets is said before the run, with the keys that mend it; with these, nothing is said.
TEST_F(Commands, CheckTellsOfLockingAndOfFewOrLargeFaces) {
  const auto said = [&](const std::string& tool, const std::string& keys) {
    const Outcome outcome = run({"check", write("s.toml", R"([mesh]
kind = "box"
cells = [8, 8, 6]
size_m = [0.08, 0.08, 0.06]
[sets.finger]
sphere_m = { center = [0.04, 0.04, 0.06], radius = 0.012 }
surface_only = true
[tissue]
poisson_ratio = 0.45
[[fixed]]
set = "z_min"
)" + tool),
                                 "--set", keys});
    EXPECT_THAT(outcome, Exits(0));
    return outcome.out;
  };
  const std::string pad = "[[tool]]\nname = \"pad\"\nset = \"finger\"\n",
                    ball =
                        "[[instrument]]\nname = \"ball\"\nkind = \"ball\"\nradius_mm = 12\ntip_m = [0.04, 0.04, "
                        "0.0601]\nmotion = { kind = \"press\", depth_mm = 1 }\n";
  const std::string text = said(pad, "motion.max_steps=9");
  EXPECT_NE(text.find("ν = 0.45 with volume_change = \"element\""), std::string::npos) << text;
  EXPECT_NE(text.find("tissue.volume_change = \"average_nodal\" mends it"), std::string::npos) << text;
  EXPECT_NE(text.find("\"pad\" acts on 2 faces with edges of 11.4 mm, 1 of its 11.3 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("take mesh.cells = [25, 25, 19]"), std::string::npos) << text;
  EXPECT_NE(said(ball, "motion.max_steps=9").find("\"ball\" acts on "), std::string::npos);
  for (const std::string& tool : {pad, ball}) {
    EXPECT_EQ(said(tool, "mesh.cells=[25,25,19]").find("  coarse "), std::string::npos) << tool;
    EXPECT_EQ(said(tool, "tissue.volume_change=\"nodal\"").find("  locking "), std::string::npos);
  }
  EXPECT_EQ(said(pad, "tissue.poisson_ratio=0.44").find("  locking "), std::string::npos);
}

// Cells of 10 mm are as large as regular tets of 11.2 mm: 3.7 zones of 3 mm. What check then proposes passes.
TEST_F(Commands, CheckTellsOfAMeshThatDoesNotResolveANeedle) {
  const auto said = [&](const std::string& key) {
    const Outcome outcome = run({"check", write("s.toml", R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.04, 0.04, 0.04]
[[fixed]]
set = "z_min"
[[instrument]]
name = "needle"
kind = "needle"
tip_m = [0.021, 0.022, 0.0401]
motion = { kind = "press", depth_mm = 1 }
)"),
                                 "--set", "motion.max_steps=9", "--set", key});
    EXPECT_THAT(outcome, Exits(0));
    return outcome.out;
  };
  const std::string text = said("instrument.needle.zone_mm=3");
  EXPECT_NE(text.find("edges of 11.2 mm around it are 3.7 of its zone of 3 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("zone_mm = 22, or mesh.cells = [30, 30, 30]"), std::string::npos) << text;
  EXPECT_EQ(said("instrument.needle.zone_mm=22").find("  zone  "), std::string::npos);
  EXPECT_EQ(said("mesh.cells=[30,30,30]").find("  zone  "), std::string::npos);
}

// The paper's figures: all scenes in one report, every check computed and passed. The quick form ends figure 3 after
// 0.1 s of motion, runs figure 4 on coarse cells and leaves bovine liver out; the fit of figures 5 and 6 and the checks are the
// same as in the whole. Five curves are fitted; five others at 2 mm/s, five at 6 and five at 10 are only predicted.
TEST_F(Commands, ReproducePassesItsChecks) {  // long
  const Outcome outcome = run({"reproduce", "--quick", "--out", "o"});
  ASSERT_THAT(outcome, Exits(0));
  const nlohmann::json report = report_data(folder_ / "o/report.html");
  ASSERT_EQ(report["scenes"].size(), 6u);
  int checks = 0;
  for (const nlohmann::json& scene : report["scenes"]) {
    for (const nlohmann::json& check : scene["checks"]) {
      ++checks;
      EXPECT_TRUE(check["pass"].get<bool>()) << check.dump();
    }
  }
  EXPECT_GE(checks, 13);
  EXPECT_EQ(report["scenes"][0]["charts"][0]["lines"].size(), 3u) << "figure 2a: three tissues";
  const nlohmann::json& panels = report["scenes"][4]["charts"];
  ASSERT_EQ(panels.size(), 4u) << "figures 5a, 5b, 6a, 6b";
  for (const nlohmann::json& panel : panels) {
    EXPECT_EQ(panel["points"].size(), 5u) << panel["title"];
    EXPECT_EQ(panel["lines"].size(), 1u) << panel["title"];
  }
  EXPECT_EQ(report["scenes"][5]["tables"][0]["rows"].size(), 6u) << "four models of ours, two of the paper";
  EXPECT_NE(outcome.out.find("The report: "), std::string::npos);
  EXPECT_NE(outcome.out.find("What to try next:"), std::string::npos);
  // the first of these commands works as printed
  EXPECT_THAT(run({"check", "o/figure2/scene.toml", "--set", "tissue.poisson_ratio=0.45"}), Exits(0));
}

}  // namespace
}  // namespace glisson::test

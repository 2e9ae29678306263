// What is known of a variant before it runs: each rule speaks where it has cause, in words with the numbers and the way out, and not
// where what it names is mended.
#include "glisson/scene/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "scene/scene_text.h"

namespace glisson {
namespace advice_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TetMesh no_file(const MeshFile&) { throw std::logic_error("no mesh file in these scenes"); }

std::vector<Advice> advice_on(const std::string& scene, const std::vector<Override>& overrides = {}) {
  return advise(test::parse(scene, overrides).variants.front(), no_file);
}

/// What a rule says of a scene; empty: nothing.
std::string said(const std::string& rule, const std::string& scene, const std::vector<Override>& overrides = {}) {
  std::string texts;
  for (const Advice& advice : advice_on(scene, overrides)) {
    if (advice.rule == rule) texts += advice.text + "\n";
  }
  return texts;
}

/// A cube of 20 mm that is pressed at 20 mm/s for 0.05 s; in brackets what more `motion` and `tissue` have.
std::string cube(const std::string& motion = "", const std::string& tissue = "") {
  return "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n"
         "[tissue]\nname = \"gel\"\nyoungs_modulus_Pa = 3600\npoisson_ratio = 0.4\n" +
         tissue + "\n[motion]\n" + motion +
         "\n[[fixed]]\nset = \"z_min\"\n[[tool]]\nname = \"press\"\nset = \"z_max\"\nvelocity_mm_s = 20\ndepth_mm = "
         "1\n";
}

const std::string kStepLaw = "law = { kind = \"step\", threshold = 0.2, above_Pa = 7200 }";

/// A block of 40 × 40 × 20 mm about x = y = 0 on cells of 4 mm, pressed on a set.
std::string pressed_block(const std::string& pad) {
  return "[mesh]\nkind = \"box\"\ncells = [10, 10, 5]\nsize_m = [0.04, 0.04, 0.02]\norigin_m = [-0.02, -0.02, 0]\n"
         "[sets.pad]\n" +
         pad + "\n[[fixed]]\nset = \"z_min\"\n[[tool]]\nset = \"pad\"\ndepth_mm = 1\n";
}
const std::string kPadByBox = "box_m = { min = [-0.008, -0.008, 0.02], max = [0.008, 0.008, 0.02] }";

// What inspection finds is said of generated meshes; the reader of a file has said it.
TEST(Advice, MeshesOfFilesAreSaidByTheirReader) {
  Variant variant = test::parse(cube()).variants.front();
  VariantAtRest rest;
  rest.report.warnings = {"2 vertices are in no tet"};
  const auto of_mesh = [&] {
    std::vector<std::string> texts;
    for (const Advice& advice : advise_on_body(variant, rest)) {
      if (advice.about == Advice::About::mesh) texts.push_back(advice.text);
    }
    return texts;
  };
  variant.tools.clear();
  EXPECT_THAT(of_mesh(), ElementsAre("2 vertices are in no tet"));
  variant.mesh = MeshFile{};
  EXPECT_THAT(of_mesh(), IsEmpty());
}

// A bound on vertices has some of them by its tolerance; one between vertices has none so.
TEST(Advice, RoundingOfSetsAndRegions) {
  EXPECT_THAT(said("rounding", pressed_block(kPadByBox)),
              HasSubstr("\"pad\": 25 vertices, 9 of them outside of its bounds by rounding alone: what lies within "));
  EXPECT_EQ(said("rounding", pressed_block("side = { axis = \"z\", end = \"upper\", depth_m = 0 }")), "");
  const std::string low =
      pressed_block(kPadByBox) + "[[region]]\nname = \"low\"\ntissue.youngs_modulus_Pa = 8000\nbox_m = ";
  EXPECT_THAT(said("rounding", low + "{ min = [-1, -1, 0], max = [-0.014, 1, 1] }"),
              HasSubstr("\"low\": 500 tets, 100 of them outside of its bounds by rounding alone"));
  EXPECT_THAT(said("rounding", low + "{ min = [-1, -1, 0], max = [-0.0135, 1, 1] }"), Not(HasSubstr("\"low\"")));
}

// Five vertices that a bound misses by 1e-5 mm are named; a bound well between vertices misses none.
TEST(Advice, VerticesJustOutside) {
  EXPECT_THAT(
      said("just_outside", pressed_block("box_m = { min = [-0.00799999, -0.008, 0.02], max = [0.008, 0.008, 0.02] }")),
      HasSubstr("\"pad\": 20 vertices; 5 more lie outside of its bounds by 1e-05 mm or less, which is no rounding"));
  EXPECT_EQ(said("just_outside", pressed_block("box_m = { min = [-0.01, -0.01, 0.019], max = [0.01, 0.01, 0.021] }")),
            "");
}

// Tets lock from ν = 0.45 on unless volume changes are averaged; a region of another treatment is told apart.
TEST(Advice, Locking) {
  EXPECT_THAT(
      said("locking", cube(), {{"tissue.poisson_ratio", "0.45"}}),
      AllOf(HasSubstr("ν = 0.45 with volume_change = \"element\": tets that keep their own volumes are too stiff"),
            HasSubstr("\ntissue.volume_change = \"average_nodal\" mends it")));
  EXPECT_EQ(said("locking", cube(), {{"tissue.poisson_ratio", "0.44"}}), "");
  EXPECT_EQ(said("locking", cube("", "volume_change = \"average_nodal\""), {{"tissue.poisson_ratio", "0.45"}}), "");
  const std::string lump = cube("", "volume_change = \"average_nodal\"") +
                           "[[region]]\nname = \"lump\"\nbox_m = { min = [0, 0, 0], max = [0.012, 0.012, 0.012] }\n"
                           "tissue = { poisson_ratio = 0.48, volume_change = \"element\" }\n";
  EXPECT_THAT(said("locking", lump), AllOf(HasSubstr("ν = 0.48"), HasSubstr("its tissue.volume_change")));
}

// Laws in secant form are named once, however many variants have them; those of an energy are not.
TEST(Advice, LawsThatStoreNoEnergy) {
  const std::string two = cube("", kStepLaw) + "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\n";
  const std::vector<Advice> advice = advise_on_laws(test::parse(two).variants);
  ASSERT_EQ(advice.size(), 1u);
  EXPECT_EQ(advice[0].rule, "cycle_work");
  EXPECT_EQ(advice[0].variant, "");
  EXPECT_THAT(advice[0].text, HasSubstr("The stiffness law of \"gel\" is in secant form"));
  EXPECT_THAT(advise_on_laws(test::parse(cube("", kStepLaw + "\nlaw_form = \"energy\"")).variants), IsEmpty());
  EXPECT_THAT(advise_on_laws(test::parse(cube()).variants), IsEmpty());
}

/// A block on cells of 10 mm, touched by what `tool` gives.
std::string touched_block(const std::string& tool) {
  return "[mesh]\nkind = \"box\"\ncells = [8, 8, 6]\nsize_m = [0.08, 0.08, 0.06]\n[motion]\nmax_steps = 9\n"
         "[sets.finger]\nsphere_m = { center = [0.04, 0.04, 0.06], radius = 0.012 }\nsurface_only = true\n"
         "[[fixed]]\nset = \"z_min\"\n" +
         tool;
}

// Two faces under a finger are too few, with the cells that would do; on these nothing is said, of a pad as of a ball.
TEST(Advice, FewOrLargeFaces) {
  const std::string pad = touched_block("[[tool]]\nname = \"pad\"\nset = \"finger\"\n");
  const std::string ball = touched_block(
      "[[instrument]]\nname = \"ball\"\nkind = \"ball\"\nradius_mm = 12\ntip_m = [0.04, 0.04, 0.0601]\n"
      "motion = { kind = \"press\", depth_mm = 1 }\n");
  EXPECT_THAT(said("coarse", pad),
              HasSubstr("\"pad\" acts on 2 faces with edges of 11.4 mm, 1 of its 11.3 mm: its force "
                        "may be far off; 16 or more with edges\nof a third of that or less take "
                        "mesh.cells = [25, 25, 19]"));
  EXPECT_THAT(said("coarse", ball), HasSubstr("\"ball\" acts on "));
  for (const std::string& scene : {pad, ball}) EXPECT_EQ(said("coarse", scene, {{"mesh.cells", "[25,25,19]"}}), "");
}

/// A punch or block on a cylinder of 7.07 mm.
std::string punched(const std::string& mesh, const std::string& tool) {
  return "[mesh]\nkind = \"cylinder\"\nradius_m = 0.00707\nheight_m = 0.005\naxial_cells = 4\n" + mesh +
         "\n[[fixed]]\nset = \"bottom\"\n[[instrument]]\nname = \"tip\"\ntip_m = [0, 0, 0.0051]\n"
         "motion = { kind = \"press\", depth_mm = 0.2 }\n" +
         tool;
}

// Cells of 1 mm are coarse at the sharp edge of a punch of 5 mm, with the grading that would do; fine ones and a rounded edge are not.
TEST(Advice, CellsAtASharpEdge) {
  const std::string punch = "kind = \"punch\"\nradius_mm = 5\n";
  EXPECT_THAT(said("edge", punched("radial_cells = 7", punch)),
              AllOf(HasSubstr("mm across its sharp edge are 0.2 of its radius of 5 mm"),
                    HasSubstr("cells of 0.2 mm there, 0.04 of it, keep it within 2 %"), HasSubstr("radial_cells = 3"),
                    HasSubstr(" million tets), or round the edge by a cell: edge_radius_mm = 1")));
  EXPECT_THAT(said("edge", punched("radial_cells = 7", "kind = \"block\"\nsize_mm = [10, 14, 20]\n")),
              HasSubstr("of its half width of 5 mm"));
  EXPECT_EQ(said("edge", punched("radial_cells = 7", punch + "edge_radius_mm = 1.5\n")), "");
  EXPECT_EQ(said("edge", punched("radial_cells = 21", punch)), "");
}

std::string pierced(const std::string& tip) {
  return "[mesh]\nkind = \"box\"\ncells = [4, 4, 4]\nsize_m = [0.04, 0.04, 0.04]\n[motion]\nmax_steps = 9\n"
         "[[fixed]]\nset = \"z_min\"\n[[instrument]]\nname = \"needle\"\nkind = \"needle\"\nzone_mm = 3\ntip_m = " +
         tip + "\nmotion = { kind = \"press\", depth_mm = 1 }\n";
}

// Cells of 10 mm are as large as regular tets of 11.2 mm: 3.7 zones of 3 mm. What is proposed passes.
TEST(Advice, ZoneOfANeedle) {
  const std::string scene = pierced("[0.021, 0.022, 0.0401]");
  EXPECT_THAT(said("zone", scene), AllOf(HasSubstr("edges of 11.2 mm around it are 3.7 of its zone of 3 mm"),
                                         HasSubstr("zone_mm = 22, or mesh.cells = [30, 30, 30]")));
  EXPECT_EQ(said("zone", scene, {{"instrument.needle.zone_mm", "22"}}), "");
  EXPECT_EQ(said("zone", scene, {{"mesh.cells", "[30,30,30]"}}), "");
}

// A needle that starts 30 mm beside the body passes it at that distance; one above it does not.
TEST(Advice, PathsThatNeverMeetTheBody) {
  EXPECT_THAT(said("misses", pierced("[0.07, 0.022, 0.0401]")),
              HasSubstr("\"needle\" never meets the body at rest: its tip passes 30 mm from it"));
  EXPECT_EQ(said("misses", pierced("[0.021, 0.022, 0.0401]")), "");
}

// Statics takes branches as relaxed unless the scene says what is meant.
TEST(Advice, BranchesThatStaticsForgets) {
  const std::string statics = "integrator = \"quasi_static\"\n", branch = "maxwell = [{ share = 0.4, time_s = 2 }]";
  EXPECT_THAT(said("branches", cube(statics, branch)),
              HasSubstr("quasi_static takes Maxwell branches as relaxed at once here"));
  EXPECT_EQ(said("branches", cube(statics + "branches = \"relaxed\"", branch)), "");
  EXPECT_EQ(said("branches", cube(statics)), "");
}

// Steps of 30 ms pass over the end of a press at 50 ms, those of 25 ms end there.
TEST(Advice, CornersThatStepsPassOver) {
  const std::string implicit = "integrator = \"implicit\"\nstep_s = ";
  EXPECT_THAT(
      said("corners", cube(implicit + "0.03")),
      AllOf(HasSubstr("step_s = 0.03 passes over "), HasSubstr("the first at 0.05 s: a peak there\nis cut off."),
            HasSubstr("\"auto\" ends steps at all of them, and so does step_s = 0.025")));
  EXPECT_EQ(said("corners", cube(implicit + "0.025")), "");
  EXPECT_EQ(said("corners", cube(implicit + "\"auto\"")), "");
}

/// A block of which a few stiff tets keep the step short.
const std::string kStone = R"([mesh]
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
)";

// Stiff tets are counted, with the step that mass gives; with that mass it is named, and nothing is left to say of limits.
TEST(Advice, TetsThatKeepTheStepShortAndMassForThem) {
  const std::string text = said("limits", kStone);
  std::smatch found;
  ASSERT_TRUE(
      std::regex_search(text, found,
                        std::regex(R"((\d+) of the tets, first tet \d+ with altitude 3.54 mm, keep the step short;\n)"
                                   R"(mass_scaling_step_s = ([\d.e-]+) adds mass only to these)")))
      << text;
  EXPECT_EQ(said("mass", kStone), "");
  const std::vector<Override> heavy = {{"motion.mass_scaling_step_s", found[2]}};
  EXPECT_THAT(said("mass", kStone, heavy), HasSubstr("% of the body's own) added to " + found[1].str() + " tets"));
  EXPECT_EQ(said("limits", kStone, heavy), "");
  EXPECT_EQ(said("limits", cube()), "");
}

// Where viscosity keeps the step short and supports act alone, a solve a step takes it if that is longer by more than a solve costs, else
// stages do; beside an instrument stages do. Without viscosity, or where it is taken so already, there is nothing to say.
TEST(Advice, CuresForViscosity) {
  const std::string in_stages = "viscosity keeps the step short; drag_stages = ";
  EXPECT_THAT(said("viscous", cube("", "viscosity_Pa_s = 1000")),
              HasSubstr("viscosity keeps the step short; integrator = \"semi_implicit\" with step_s = "));
  EXPECT_THAT(said("viscous", cube("", "viscosity_Pa_s = 10")), HasSubstr(in_stages));
  const std::string ball =
      "[[instrument]]\nkind = \"ball\"\nradius_mm = 5\ntip_m = [0.01, 0.01, 0.021]\n"
      "[instrument.motion]\nkind = \"press\"\ndepth_mm = 1\nvelocity_mm_s = 10\n";
  EXPECT_THAT(said("viscous", cube("", "viscosity_Pa_s = 1000") + ball), HasSubstr(in_stages));
  EXPECT_EQ(said("viscous", cube()), "");
  EXPECT_EQ(said("viscous", cube("integrator = \"semi_implicit\"", "viscosity_Pa_s = 1000")), "");
  EXPECT_EQ(said("viscous", cube("drag_stages = 3", "viscosity_Pa_s = 10")), "");
}

// The scene can be run in the step that it names, which is as many times as long as it says; what the other integrator refuses, variable
// mass and adaptive precision, is left out of the trial.
TEST(Advice, CuresForViscosityHaveTheStepThatTheyName) {
  const std::string viscous = "viscosity_Pa_s = 1000";
  std::smatch found;
  const std::string text = said("viscous", cube("", viscous));
  const std::regex words(R"(step_s = ([\d.e-]+) makes it ([\d.e+]+) times as long)");
  ASSERT_TRUE(std::regex_search(text, found, words)) << text;
  const auto at_rest = [&](const std::string& motion) {
    const Variant variant = test::parse(cube(motion, viscous)).variants.front();
    return VariantAtRest(variant, build_variant(variant, no_file).simulation);
  };
  const double named = at_rest("integrator = \"semi_implicit\"\nstep_s = " + found[1].str()).step_s;
  EXPECT_NEAR(named / at_rest("").step_s, std::stod(found[2]), 0.06 * std::stod(found[2]));
  const std::string heavy = "mass_scaling = \"variable\"\nmass_scaling_step_s = 1e-4\nprecision = \"adaptive\"";
  EXPECT_THAT(said("viscous", cube(heavy, viscous + "\n" + kStepLaw)), HasSubstr("semi_implicit"));
}

// Trials for which there is no time are left out by name, and nothing is said in their place.
TEST(Advice, TrialsWithoutTimeAreLeftOut) {
  struct NoTime : TrialTime {
    bool has_time(double) const override { return false; }
    void leave_out(const std::string& what) override { left_out.push_back(what); }
    std::vector<std::string> left_out;
  } time;
  const auto look = [&](const std::string& scene) {
    const Variant variant = test::parse(scene).variants.front();
    const VariantAtRest rest(variant, build_variant(variant, no_file).simulation);
    for (const Advice& advice : advise_on_step(variant, rest, no_file, time)) {
      EXPECT_NE(advice.rule, "limits");
      EXPECT_NE(advice.rule, "viscous");
    }
  };
  look(kStone);
  look(cube("", "viscosity_Pa_s = 100"));
  EXPECT_THAT(time.left_out,
              ElementsAre("what mass would give few tets of main", "other treatments of the viscous force in main"));
}

// Where tools hardly move in a step, mass makes steps longer; where steps are long enough, nothing is said.
TEST(Advice, SlowTools) {
  EXPECT_THAT(said("slow", cube(), {{"tissue.youngs_modulus_Pa", "1e7"}}),
              HasSubstr("µm a step at most; mass_scaling = \"variable\" with mass_scaling_step_s = "));
  EXPECT_EQ(said("slow", cube()), "");
}

// 3600 Pa at ν = 0.4 and 1000 kg/m³ have waves of √(7714/1000) = 2.78 m/s: tools of 2.9 m/s hit, those of 2.7 m/s press.
TEST(Advice, ToolsFasterThanWaves) {
  EXPECT_THAT(said("fast", cube("", "density_kg_m3 = 1000"), {{"tool.0.velocity_mm_s", "2900"}}),
              HasSubstr("\"press\" moves at up to 2.9e+03 mm/s, where waves in the tissue have 2.78e+03 mm/s"));
  EXPECT_EQ(said("fast", cube("", "density_kg_m3 = 1000"), {{"tool.0.velocity_mm_s", "2700"}}), "");
}

// A linear tissue has no other linear law to go by; one of a step law has.
TEST(Advice, AdaptivePrecisionOfLinearTissue) {
  EXPECT_THAT(said("adaptive", cube("precision = \"adaptive\"")), HasSubstr("no linear law stands in for \"gel\""));
  EXPECT_EQ(said("adaptive", cube("precision = \"adaptive\"", kStepLaw)), "");
}

// Advice on the body comes before that on its steps; each piece has the variant, what it is about and its place in the variant's list.
TEST(Advice, HasAnOrderAndAPlace) {
  const std::vector<Advice> all =
      advice_on(cube("precision = \"adaptive\"", "viscosity_Pa_s = 100"), {{"tissue.poisson_ratio", "0.49"}});
  std::vector<std::string> rules;
  for (const Advice& advice : all) {
    rules.push_back(advice.rule);
    EXPECT_EQ(advice.variant, "main");
  }
  ASSERT_GE(rules.size(), 3u);
  EXPECT_EQ(rules[0], "locking");
  EXPECT_EQ(rules[1], "coarse");
  EXPECT_EQ(rules.back(), "adaptive");
  EXPECT_EQ(all[0].name, "gel");
  EXPECT_EQ(all[1].name, "press");
  EXPECT_EQ(all[1].kind, Advice::Kind::warning);
  EXPECT_EQ(all.back().about, Advice::About::step);
  EXPECT_EQ(all.back().kind, Advice::Kind::remark);
}

// A variant that is about to run is told the same but for what needs its body again, and no body is built: there is no mesh to be had.
TEST(Advice, OfAVariantAtRestBuildsNone) {
  const auto in_words = [](const std::vector<Advice>& advice, bool all) {
    std::vector<std::string> list;
    for (const Advice& one : advice) {
      if (all || (one.rule != "limits" && one.rule != "viscous")) list.push_back(one.rule + ": " + one.text);
    }
    return list;
  };
  std::size_t said = 0, left_out = 0;
  for (const std::string& scene : {kStone, cube("", "viscosity_Pa_s = 100"), cube("precision = \"adaptive\"")}) {
    const Variant variant = test::parse(scene).variants.front();
    const std::vector<Advice> trying = advise(variant, no_file);
    const std::vector<Advice> at_rest = advise_at_rest(variant, build_variant(variant, no_file).simulation);
    EXPECT_EQ(in_words(at_rest, true), in_words(trying, false));
    said += at_rest.size(), left_out += trying.size() - at_rest.size();
  }
  EXPECT_GE(said, 1u);
  EXPECT_GE(left_out, 2u) << "limits of the first, viscosity of the second";
}

}  // namespace advice_test
}  // namespace glisson

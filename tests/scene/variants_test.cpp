// variants_test.cpp — variants and --set are laid over a scene by the documented rules.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::complaint;
using test::kSmallScene;
using test::parse;
using ::testing::ElementsAre;

Variant only(const std::string& text, const std::vector<Override>& overrides = {}) {
  return parse(text, overrides).variants.at(0);
}

// Tables are joined key by key: what a variant does not mention stays as the scene has it.
TEST(Variants, KeepWhatTheyDoNotMention) {
  const Scene scene = parse(kSmallScene +
                            "[tissue]\nyoungs_modulus_Pa = 5000\ndensity_kg_m3 = 1100\n[[variant]]\nname = \"a\"\n"
                            "[[variant]]\nname = \"b\"\nlabel = \"denser\"\ntissue.density_kg_m3 = 1200\n");
  ASSERT_EQ(scene.variants.size(), 2u);
  EXPECT_EQ(scene.variants[0].tissue.density, 1100.0);
  EXPECT_EQ(scene.variants[1].tissue.density, 1200.0);
  EXPECT_EQ(scene.variants[1].tissue.youngs_modulus, 5000.0);
  EXPECT_EQ(scene.variants[0].label, "a");
  EXPECT_EQ(scene.variants[1].label, "denser");
}

// So are the tables that only one kind of a table has: friction, rupture and tip of a needle.
TEST(Variants, KeepWhatTheyDoNotMentionOfAKind) {
  const std::string needle =
      "[[instrument]]\nkind = \"needle\"\nname = \"needle\"\ntip_m = [0.005, 0.005, 0.021]\n"
      "rupture = { force_N = 0.2 }\nfriction = { static_in_N_m = 18, dynamic_in_N_m = 11, viscous_in_N_s_m2 = 212 }\n"
      "[instrument.motion]\nkind = \"press\"\nvelocity_mm_s = 5\ndepth_mm = 2\n";
  const auto friction = [](const Variant& v) { return std::get<NeedleOptions>(v.instruments.at(0).what).friction; };
  const ShaftFriction by_variant = friction(
      only(kSmallScene + needle + "[[variant]]\nname = \"a\"\ninstrument.needle.friction.viscous_in_N_s_m2 = 7\n"));
  const ShaftFriction by_set =
      friction(only(kSmallScene + needle, {{"instrument.needle.friction.viscous_in_N_s_m2", "7"}}));
  for (const ShaftFriction& f : {by_variant, by_set}) {
    EXPECT_EQ(f.viscous_in, 7.0);
    EXPECT_EQ(f.static_in, 18.0);
    EXPECT_EQ(f.dynamic_in, 11.0);
  }
}

// Another kind of law replaces the law; the same kind changes single parameters of it.
TEST(Variants, ReplaceALawOfAnotherKindOnly) {
  const std::string law =
      "[tissue.law]\nkind = \"step\"\nthreshold = 0.1\nabove_Pa = 9000\n[[variant]]\nname = \"a\"\n";
  EXPECT_EQ(std::get<StepLaw>(only(kSmallScene + law + "tissue.law.threshold = 0.2\n").tissue.law),
            (StepLaw{0.2, 9000, 0}));
  const Variant other = only(kSmallScene + law + "tissue.law = { kind = \"linear\", slope_Pa = 7 }\n");
  EXPECT_EQ(std::get<LinearLaw>(other.tissue.law).slope, 7.0);
  EXPECT_NE(complaint(kSmallScene + law + "tissue.law.kind = \"linear\"\n").find("missing key `slope_Pa`"),
            std::string::npos);
}

// A key of a variant takes the place of the keys that it excludes.
TEST(Variants, RemoveWhatTheyExclude) {
  const std::string base =
      "[tissue]\nyoungs_modulus_Pa = 5000\nlaw = { kind = \"linear\", slope_Pa = 1 }\n[[variant]]\nname = \"a\"\n";
  const Variant v = only(kSmallScene + base +
                         "tissue.lambda_Pa = 6000\ntissue.mu_Pa = 2000\n"
                         "tissue.mu_law = { kind = \"linear\", slope_Pa = 2 }\n"
                         "sets.top.nearest_m = { point = [0, 0, 0] }\n");
  EXPECT_NEAR(v.tissue.lame().mu, 2000.0, 1e-9);
  EXPECT_TRUE(std::holds_alternative<ConstantLaw>(v.tissue.law));
  EXPECT_TRUE(v.tissue.mu_law.has_value());
  EXPECT_TRUE(std::holds_alternative<Selection::Nearest>(v.sets.at("top").where));
}

// A list of tables is replaced by a list; a table changes the elements it names, by name, set or number.
TEST(Variants, ReplaceListsAndChangeElements) {
  const std::string variant = "[[variant]]\nname = \"a\"\n";
  const Variant replaced = only(kSmallScene + variant + "[[variant.tool]]\nset = \"x_max\"\ndepth_mm = 2\n");
  ASSERT_EQ(replaced.tools.size(), 1u);
  EXPECT_EQ(replaced.tools[0].name, "tool");
  EXPECT_EQ(replaced.tools[0].set, "x_max");
  const Variant named = only(kSmallScene + variant + "tool.press.velocity_mm_s = 3\nfixed.z_min.axes = \"z\"\n");
  EXPECT_EQ(named.tools.at(0).motion.velocity, 0.003);
  EXPECT_EQ(named.tools[0].motion.depth, 0.001);
  EXPECT_FALSE(named.fixed.at(0).axes.x);
  EXPECT_EQ(only(kSmallScene + variant + "tool.0.velocity_mm_s = 4\n").tools.at(0).motion.velocity, 0.004);
  EXPECT_TRUE(only(kSmallScene + variant + "fixed = []\n").fixed.empty());
}

// Another kind of mesh brings its own vertex sets, and those of the old one are gone.
TEST(Variants, CanHaveAnotherMesh) {
  const std::string mesh = "[[variant]]\nname = \"round\"\n[variant.mesh]\nkind = \"cylinder\"\nradius_m = 0.01\n";
  EXPECT_TRUE(
      std::holds_alternative<CylinderOptions>(only(kSmallScene + mesh + "[[variant.fixed]]\nset = \"bottom\"\n").mesh));
  EXPECT_NE(complaint(kSmallScene + mesh).find("no vertex set \"z_min\"; the sets are: bottom, top, wall, axis, top"),
            std::string::npos)
      << complaint(kSmallScene + mesh);
}

// A region inherits the tissue of its variant, not that of the scene.
TEST(Variants, RegionsInheritFromTheirVariant) {
  const Variant v =
      only(kSmallScene +
           "[tissue]\ndensity_kg_m3 = 1000\n[[region]]\nname = \"r\"\nbox_m = { min = [0, 0, 0], max = [1, 1, 1] }\n"
           "tissue.youngs_modulus_Pa = 9\n[[variant]]\nname = \"a\"\ntissue.density_kg_m3 = 1500\n");
  EXPECT_EQ(v.regions.at(0).tissue.density, 1500.0);
  EXPECT_EQ(v.regions[0].tissue.youngs_modulus, 9.0);
  EXPECT_EQ(v.tissue.youngs_modulus, Tissue{}.youngs_modulus);
}

// A key that is wrong in the scene is said even where every variant replaces its table.
TEST(Variants, DoNotHideMistakesOfTheScene) {
  EXPECT_EQ(complaint(kSmallScene + "[tissue.law]\nkind = \"linear\"\nslop_Pa = 3\n[[variant]]\nname = \"a\"\n"
                                    "tissue.law = { kind = \"constant\" }\n"),
            "s.toml:18:1: tissue.law.slop_Pa: unknown key; did you mean `slope_Pa`?");
}

const std::string kTwo =
    kSmallScene + "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"v1.5\"\ntissue.density_kg_m3 = 900\n";

// An override reaches every variant, and wins over what the variant says.
TEST(Overrides, ReachEveryVariant) {
  const Scene scene = parse(kTwo, {{"tissue.density_kg_m3", "1060"}, {"tool.press.depth_mm", "2"}, {"title", "Other"}});
  for (const Variant& v : scene.variants) {
    EXPECT_EQ(v.tissue.density, 1060.0) << v.name;
    EXPECT_EQ(v.tools.at(0).motion.depth, 0.002) << v.name;
  }
  EXPECT_EQ(scene.title, "Other");
}

// An override for one variant leaves the others alone; quotes protect a dot in its name.
TEST(Overrides, CanMeanOneVariant) {
  const Scene scene = parse(kTwo, {{"variant.\"v1.5\".tissue.density_kg_m3", "700"}});
  EXPECT_EQ(scene.variants[0].tissue.density, 1000.0);
  EXPECT_EQ(scene.variants[1].tissue.density, 700.0);
}

// Values are TOML: numbers, lists, tables, texts; a bare word is text. The last override of a key wins.
TEST(Overrides, AreToml) {
  const Variant v = only(kSmallScene, {{"mesh.cells", "[1, 2, 3]"},
                                       {"motion.precision", "double"},
                                       {"tissue.name", "\"in quotes\""},
                                       {"tissue.law", "{ kind = \"linear\", slope_Pa = 1e3 }"},
                                       {"tool.0.returns", "true"},
                                       {"motion.step_s", "1e-5"},
                                       {"motion.step_s", "auto"}});
  EXPECT_THAT(std::get<BoxOptions>(v.mesh).cells, ElementsAre(1, 2, 3));
  EXPECT_EQ(v.simulation.precision, Precision::double_precision);
  EXPECT_EQ(v.tissue.name, "in quotes");
  EXPECT_EQ(std::get<LinearLaw>(v.tissue.law).slope, 1000.0);
  EXPECT_TRUE(v.tools.at(0).motion.returns);
  EXPECT_FALSE(v.simulation.step);
}

// The pieces of a law can be given one by one.
TEST(Overrides, BuildALawKeyByKey) {
  const Variant v =
      only(kSmallScene, {{"tissue.law.kind", "step"}, {"tissue.law.threshold", "0.1"}, {"tissue.law.above_Pa", "5e3"}});
  EXPECT_EQ(std::get<StepLaw>(v.tissue.law), (StepLaw{0.1, 5000, 0}));
}

// Another mesh by --set replaces the old one, keys and all.
TEST(Overrides, CanChangeTheMesh) {
  const Variant v = only(kSmallScene, {{"mesh.kind", "file"}, {"mesh.path", "/data/liver.vtu"}});
  EXPECT_EQ(std::get<MeshFile>(v.mesh).path, "/data/liver.vtu");
}

// A mistake in an override names the option in place of a line, and the key where they differ.
TEST(Overrides, SayWhichOneIsWrong) {
  EXPECT_EQ(complaint(kSmallScene, {{"tissue.density", "3"}}),
            "s.toml: --set tissue.density: unknown key; did you mean `density_kg_m3`?");
  EXPECT_EQ(complaint(kSmallScene, {{"tool.press.depth_mm", "-1"}}),
            "s.toml: --set tool.press.depth_mm: tool.0.depth_mm: -1 mm is out of range; allowed: > 0 and ≤ 1e+07 mm");
  EXPECT_EQ(complaint(kSmallScene, {{"tool.needle.depth_mm", "1"}}),
            "s.toml: --set tool.needle.depth_mm: tool.needle: no such tool; known: 0 (press)");
  EXPECT_EQ(complaint(kSmallScene, {{"load.0.ramp_s", "1"}}),
            "s.toml: --set load.0.ramp_s: load.0: no such load; the scene has none");
  EXPECT_EQ(complaint(kSmallScene, {{"tissue.law", "{ kind = \"linear\" }"}}),
            "s.toml: --set tissue.law: missing key `slope_Pa`: a number [Pa]; growth of the modulus per unit of the "
            "argument");
  EXPECT_EQ(complaint(kTwo, {{"variant.b.tissue.density_kg_m3", "1"}}),
            "s.toml: --set variant.b.tissue.density_kg_m3: no variant \"b\"; the scene has: a, v1.5");
  for (const char* key : {"", ".", "a..b", "variant.a", "a.\"b", "tissue."}) {
    EXPECT_NE(complaint(kSmallScene, {{key, "1"}}).find("not a key; write --set"), std::string::npos) << key;
  }
}

// Keys that exclude each other are contradictory where one source gives both, also by --set.
TEST(Overrides, ReplaceWhatTheyExclude) {
  const std::string base = kSmallScene + "[tissue]\nyoungs_modulus_Pa = 5000\n";
  EXPECT_NEAR(only(base, {{"tissue.lambda_Pa", "6000"}, {"tissue.mu_Pa", "2000"}}).tissue.lame().lambda, 6000.0, 1e-9);
  EXPECT_EQ(complaint(base, {{"tissue.mu_Pa", "2000"}}), "s.toml: --set tissue.mu_Pa: needs `lambda_Pa` with it");
}

}  // namespace
}  // namespace glisson

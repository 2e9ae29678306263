// malformed_test.cpp — what a scene with a mistake is told: exactly, with line, key, value, range and way out.
#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "scene/scene_text.h"

namespace glisson {
namespace {

using test::complaint;
using test::kSmallScene;

/// A change to the small scene, and what is said about it.
struct Mistake {
  std::string name;
  std::string find, replace;  ///< in kSmallScene; an empty `find` appends
  std::string message;
};

void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

std::string with(const Mistake& m) {
  std::string text = kSmallScene;
  if (m.find.empty()) return text + m.replace;
  const std::size_t at = text.find(m.find);
  if (at == std::string::npos) throw std::logic_error(m.name + ": nothing to replace");
  return text.replace(at, m.find.size(), m.replace);
}

/// The words for the laws of stiffness, as a message lists them.
template <class... Laws>
std::string words_of(std::type_identity<std::variant<Laws...>>) {
  std::string words;
  for (const std::string_view name : {Laws::kName...})
    words += (words.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return words;
}

// kSmallScene has 14 lines: [mesh] is 1, [sets.top] 6, [[fixed]] 9, [[tool]] 12.
const std::vector<Mistake> kMistakes{
    {"MisspeltKey", "cells", "cels", "s.toml:3:1: mesh.cels: unknown key; did you mean `cells`?"},
    {"KeyWithoutItsUnit", "size_m", "size", "s.toml:4:1: mesh.size: unknown key; did you mean `size_m`?"},
    {"KeyWithAnotherUnit", "depth_mm", "depth_cm",
     "s.toml:15:1: tool.0.depth_cm: unknown key; did you mean `depth_mm`?"},
    {"MisspeltSection", "", "[tisue]\n", "s.toml:16:2: tisue: unknown key; did you mean `tissue`?"},
    {"KeyOfAnotherSection", "", "[tissue]\nstep_s = 0.1\n",
     "s.toml:17:1: tissue.step_s: unknown key here; it belongs in [motion]"},
    {"KeyOfAnotherKind", "cells = [2, 2, 2]", "radius_m = 1",
     "s.toml:3:1: mesh.radius_m: unknown key here; it belongs in [mesh] of kind \"cylinder\""},
    {"KeyLikeNoOther", "", "[output]\nwhatever = 1\n",
     "s.toml:17:1: output.whatever: unknown key; known here: sample_rate_hz, frames, stored_energy"},
    {"MisspeltKeyAtTheTop", "[mesh]", "titel = \"x\"\n[mesh]", "s.toml:1:1: titel: unknown key; did you mean `title`?"},
    {"TextForNumber", "", "[tissue]\ndensity_kg_m3 = \"heavy\"\n",
     "s.toml:17:17: tissue.density_kg_m3: expected a number [kg/m³], got text \"heavy\""},
    {"BrokenForWholeNumber", "", "[output]\nframes = 2.5\n",
     "s.toml:17:10: output.frames: expected a whole number, got 2.5"},
    {"NumberForText", "set = \"z_min\"", "set = 3", "s.toml:10:7: fixed.0.set: expected text in quotes, got 3"},
    {"NumberForTrueOrFalse", "", "returns = 1\n", "s.toml:16:11: tool.0.returns: expected true or false, got 1"},
    {"NumberForList", "size_m = [0.02, 0.02, 0.02]", "size_m = 0.02",
     "s.toml:4:10: mesh.size_m: expected a list of three numbers [m], got 0.02"},
    {"TooShortList", "[2, 2, 2]", "[2, 2]",
     "s.toml:3:9: mesh.cells: expected a list of three whole numbers, got a list of 2"},
    {"WrongElement", "[0.02, 0.02, 0.02]", "[0.02, \"wide\", 0.02]",
     "s.toml:4:17: mesh.size_m.1: expected a number [m], got text \"wide\""},
    {"TableForList", "[[fixed]]", "[fixed]",
     "s.toml:9:1: fixed: expected a list of tables, each headed [[fixed]], got a table"},
    {"ListForTable", "", "[[tissue]]\nname = \"a\"\n", "s.toml:16:1: tissue: expected a table, got a list of 1"},
    {"NumberForTable", "[mesh]", "tissue = 5\n[mesh]", "s.toml:1:10: tissue: expected a table, got 5"},
    {"KindForTable", "", "[tissue]\nlaw = \"linear\"\n",
     "s.toml:17:7: tissue.law: expected a table, got text \"linear\"; write { kind = \"linear\" }"},
    {"Date", "", "start_s = 2024-01-01\n", "s.toml:16:11: tool.0.start_s: expected a number [s], got a date or time"},
    {"NotFinite", "", "[motion]\ngravity_m_s2 = [0, 0, -inf]\n",
     "s.toml:17:23: motion.gravity_m_s2.2: -inf m/s² is out of range; allowed: -1000000 to 1000000 m/s²"},
    {"NegativeDensity", "", "[tissue]\ndensity_kg_m3 = -5\n",
     "s.toml:17:17: tissue.density_kg_m3: -5 kg/m³ is out of range; allowed: 0.001 to 1e+09 kg/m³"},
    {"PoissonRatioOfRubber", "", "[tissue]\npoisson_ratio = 0.5\n",
     "s.toml:17:17: tissue.poisson_ratio: 0.5 is out of range; allowed: > -1 and < 0.5; 0.45 to 0.49 is nearly "
     "incompressible"},
    {"NoCells", "[2, 2, 2]", "[2, 0, 2]", "s.toml:3:13: mesh.cells.1: 0 is out of range; allowed: 1 to 10000"},
    {"StepZero", "", "[motion]\nstep_s = 0\n",
     "s.toml:17:10: motion.step_s: 0 s is out of range; allowed: > 0 and ≤ 1e+09 s; \"auto\" chooses the largest "
     "safe step"},
    {"StepInAnotherWord", "", "[motion]\nstep_s = \"automatic\"\n",
     "s.toml:17:10: motion.step_s: expected a number [s] or \"auto\", got text \"automatic\""},
    {"UnknownWord", "", "[motion]\nprecision = \"singel\"\n",
     "s.toml:17:13: motion.precision: expected one of \"single\", \"double\", \"adaptive\", got \"singel\"; did you "
     "mean "
     "\"single\"?"},
    {"UnknownKind", "\"box\"", "\"ball\"",
     "s.toml:2:8: mesh.kind: expected one of \"box\", \"cylinder\", \"implicit\", \"liver\", \"image\", \"file\", got "
     "\"ball\""},
    {"UnknownLaw", "", "[tissue.law]\nkind = \"stepp\"\n",
     "s.toml:17:8: tissue.law.kind: expected one of " + words_of(std::type_identity<StiffnessLaw>()) +
         ", got \"stepp\"; did you mean \"step\"?"},
    {"NoKind", "kind = \"box\"\n", "",
     "s.toml:1:1: mesh: missing key `kind`: one of \"box\", \"cylinder\", \"implicit\", \"liver\", \"image\", "
     "\"file\""},
    {"NoMesh", "[mesh]\nkind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n", "",
     "s.toml:1:1: missing key `mesh`: a table; the body's mesh"},
    {"NoSet", "set = \"z_min\"\n", "", "s.toml:9:1: fixed.0: missing key `set`: text in quotes; name of a vertex set"},
    {"NoPath", "kind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n", "kind = \"file\"\n",
     "s.toml:1:1: mesh: missing key `path`: text in quotes; the file, relative to the scene"},
    {"EmptyPath", "kind = \"box\"\ncells = [2, 2, 2]\nsize_m = [0.02, 0.02, 0.02]\n", "kind = \"file\"\npath = \"\"\n",
     "s.toml:3:8: mesh.path: is empty; name a .vtu, .vtk, .msh or .inp file"},
    {"NoRadius", "side = { axis = \"z\", end = \"upper\", depth_m = 0 }", "sphere_m = { center = [0, 0, 0] }",
     "s.toml:7:12: sets.top.sphere_m: missing key `radius`: a number [m] > 0; radius"},
    {"YoungAndLame", "", "[tissue]\nyoungs_modulus_Pa = 3600\nlambda_Pa = 1\nmu_Pa = 1\n",
     "s.toml:18:1: tissue.lambda_Pa: contradicts `youngs_modulus_Pa` (line 17); give one of the two"},
    {"LameAlone", "", "[tissue]\nlambda_Pa = 1\n", "s.toml:17:13: tissue.lambda_Pa: needs `mu_Pa` with it"},
    {"LameWithoutBulk", "", "[tissue]\nlambda_Pa = -3\nmu_Pa = 3\n",
     "s.toml:17:13: tissue.lambda_Pa: -3 Pa is out of range; allowed: > -2/3 mu_Pa = -2 Pa, so that the body resists "
     "compression"},
    {"LameBeyondIncompressible", "", "[tissue]\nlambda_Pa = 1e12\nmu_Pa = 1e-6\n",
     "s.toml:17:13: tissue.lambda_Pa: 1e+12 Pa with mu_Pa = 1e-06 gives E = 3e-06 Pa and ν = 0.5; allowed: E finite, ν "
     "> -1 "
     "and "
     "< 0.5; bring the two closer together"},
    {"TwoLaws", "", "[tissue.mu_law]\nkind = \"constant\"\n[tissue.law]\nkind = \"constant\"\n",
     "s.toml:18:9: tissue.law: contradicts `mu_law` (line 16); give one of the two"},
    {"TwoWaysToPick", "[[fixed]]", "vertices = [1]\n[[fixed]]",
     "s.toml:9:1: sets.top.vertices: contradicts `side` (line 7); give one of the two"},
    {"NoWayToPick", "side = { axis = \"z\", end = \"upper\", depth_m = 0 }", "",
     "s.toml:6:1: sets.top: give one of `box_m`, `sphere_m`, `nearest_m`, `side`, `facing`, `vertices`"},
    {"NoVertices", "side = { axis = \"z\", end = \"upper\", depth_m = 0 }", "vertices = []",
     "s.toml:7:12: sets.top.vertices: is empty; name at least one vertex"},
    {"BoxInsideOut", "side = { axis = \"z\", end = \"upper\", depth_m = 0 }",
     "box_m = { min = [0, 1, 0], max = [1, 0, 1] }",
     "s.toml:7:34: sets.top.box_m.max: y of `max` (0 m) is below that of `min` (1 m); exchange them"},
    {"UnknownSet", "set = \"top\"", "set = \"topp\"",
     "s.toml:14:7: tool.0.set: no vertex set \"topp\"; did you mean \"top\"? the sets are: x_min, x_max, y_min, y_max, "
     "z_min, z_max, top"},
    {"SetOfAnotherMesh", "set = \"z_min\"", "set = \"bottom\"",
     "s.toml:10:7: fixed.0.set: no vertex set \"bottom\"; the sets are: x_min, x_max, y_min, y_max, z_min, z_max, top"},
    {"NoDirection", "", "direction = [0, 0, 0]\n",
     "s.toml:16:13: tool.0.direction: [0, 0, 0] has no direction; give a vector that is not zero, such as [0, 0, -1]"},
    {"FreeSidewaysAcross", "", "direction = [1, 0, 1]\nsideways = \"free\"\n",
     "s.toml:16:13: tool.0.direction: [1, 0, 1] is not along an axis, which `sideways = \"free\"` needs; use "
     "sideways = \"blocked\" or turn the mesh"},
    {"TwoToolsOfOneName", "", "[[tool]]\nname = \"Press\"\nset = \"x_max\"\n",
     "s.toml:17:8: tool.1.name: \"Press\" is taken (upper and lower case count as the same); names must differ"},
    {"NoEnd", "[[tool]]\nname = \"press\"\nset = \"top\"\ndepth_mm = 1\n", "",
     "s.toml:1:1: motion: nothing says when the run ends: give `duration_s` or `max_steps`, or a [[tool]] or "
     "[[instrument]] whose motion "
     "ends it, or a [[fixed]] set with a record"},
    {"TwoVariantsOfOneName", "", "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"A\"\n",
     "s.toml:19:8: variant.1.name: \"A\" is taken (upper and lower case count as the same); names must differ"},
    {"VariantWithoutName", "", "[[variant]]\nlabel = \"a\"\n",
     "s.toml:16:1: variant: missing key `name`: text in quotes; its results go to OUT/NAME/"},
    {"VariantThatIsNoFolder", "", "[[variant]]\nname = \"../up\"\n",
     "s.toml:17:8: name: \"../up\" cannot be a folder; use letters, digits, `_`, `-` and `.`, a letter or digit first"},
    {"VariantNamedLikeTheReport", "", "[[variant]]\nname = \"report.html\"\n",
     "s.toml:17:8: name: \"report.html\" is the name of a file or folder that glisson itself writes; choose another"},
    {"VariantNamedLikeTheScene", "", "[[variant]]\nname = \"Scene.TOML\"\n",
     "s.toml:17:8: name: \"Scene.TOML\" is the name of a file or folder that glisson itself writes; choose another"},
    {"VariantThatEndsWithADot", "", "[[variant]]\nname = \"a.\"\n",
     "s.toml:17:8: name: \"a.\" ends with a dot, which some file systems drop; choose another"},
    {"ToolNamedLikeATable", "name = \"press\"", "name = \"forces.csv\"",
     "s.toml:13:8: tool.0.name: \"forces.csv\" is the name of a file or folder that glisson itself writes; choose "
     "another"},
    {"ToolThatIsAPath", "name = \"press\"", "name = \"../../press\"",
     "s.toml:13:8: tool.0.name: \"../../press\" cannot be part of a file's name and of a row of events.csv; leave out "
     "/ \\ : * ? \" < > | ,"},
    {"ToolWithALineEnd", "name = \"press\"", "name = \"a\\nb\"",
     "s.toml:13:8: tool.0.name: holds a control character, and it becomes part of a file's name; use letters, digits, "
     "blanks, `_`, `-`"},
    {"ToolWithoutAName", "name = \"press\"", "name = \"\"", "s.toml:13:8: tool.0.name: is empty"},
    {"VariantWithASceneKey", "", "[[variant]]\nname = \"a\"\ndescription = \"b\"\n",
     "s.toml:18:1: description: unknown key here; it belongs in the top of the file"},
    {"MisspeltKeyOfVariant", "", "[[variant]]\nname = \"a\"\ntool.press.velocity = 1\n",
     "s.toml:18:12: tool.0.velocity: unknown key; did you mean `velocity_mm_s`?"},
    {"VariantChangesAToolThatIsNot", "", "[[variant]]\nname = \"a\"\ntool.punch.depth_mm = 1\n",
     "s.toml:18:6: tool.punch: no such tool; known: 0 (press)"},
    {"ChartOfNoVariant", "", "[[chart]]\ntitle = \"a\"\nx = \"time_s\"\ny = \"force_N\"\nvariants = [\"b\"]\n",
     "s.toml:20:13: chart.0.variants: no variant \"b\"; the scene has: main"},
    {"LoadOfNothing", "", "[[load]]\nset = \"top\"\nramp_s = 1\n",
     "s.toml:16:1: load.0: nothing acts; give at least one of `force_N`, `traction_Pa`, `pressure_Pa`, `moment_N_m`, "
     "`spring_N_m`, `spring_Pa_m`, `dashpot_N_s_m`, `dashpot_Pa_s_m`"},
    {"ForceThatFollows", "", "[[load]]\nset = \"top\"\nforce_N = [0, 0, 1]\nfollows = true\n",
     "s.toml:19:11: load.0.follows: = true is for traction, pressure and moment, none of which is given; a force keeps "
     "its direction, springs and dashpots theirs"},
    {"NegativeSpring", "", "[[load]]\nset = \"top\"\nspring_N_m = [0, 0, -1]\n",
     "s.toml:18:21: load.0.spring_N_m.2: -1 N/m is out of range; allowed: 0 to 1e+12 N/m"},
    {"FactorsWithoutTimes", "", "[[load]]\nset = \"top\"\npressure_Pa = 1\nfactors = [1, 2]\n",
     "s.toml:19:11: load.0.factors: needs `times_s`, as many times as factors"},
    {"FewerFactorsThanTimes", "", "[[load]]\nset = \"top\"\npressure_Pa = 1\ntimes_s = [0, 1]\nfactors = [1]\n",
     "s.toml:19:11: load.0.times_s: 2 times and 1 `factors`; give as many of both, one or more"},
    {"TimesThatTurnBack", "", "[[load]]\nset = \"top\"\npressure_Pa = 1\ntimes_s = [0, 1, 1]\nfactors = [1, 2, 3]\n",
     "s.toml:19:11: load.0.times_s: number 3 is not later than the one before it"},
    {"RotationWithoutAxis", "depth_mm = 1\n", "rotation = { angle_deg = 30 }\n",
     "s.toml:15:12: tool.0.rotation: missing key `axis`: a list of three numbers; direction of the axis, of any "
     "length; "
     "positive by the right hand"},
    {"RotationAboutNothing", "depth_mm = 1\n", "rotation = { axis = [0, 0, 0] }\n",
     "s.toml:15:21: tool.0.rotation.axis: [0, 0, 0] has no direction; give a vector that is not zero, such as [0, 0, "
     "-1]"},
    {"RotationFreeAlongASlantedAxis", "depth_mm = 1\n", "rotation = { axis = [1, 1, 0] }\naxial = \"free\"\n",
     "s.toml:16:9: tool.0.axial: \"free\" needs an axis along x, y or z, not [1, 1, 0]; use axial = \"held\" or turn "
     "the mesh"},
    {"RotationBySpeedAndTable", "depth_mm = 1\n",
     "rotation = { axis = [0, 0, 1], times_s = [0, 1], angles_deg = [0, 9], rate_deg_s = 3 }\n",
     "s.toml:15:71: tool.0.rotation.rate_deg_s: contradicts `times_s` (line 15); give one of the two"},
    {"RotationOfANeedle", "",
     "[[instrument]]\nkind = \"needle\"\ntip_m = [0, 0, 1]\nmotion = { kind = \"rotation\", axis = [0, 0, 1] }\n",
     "s.toml:19:10: instrument.0.motion: a needle keeps its direction and cannot turn; use kind = \"strokes\" or "
     "\"record\", or another kind of instrument"},
    {"FactorThatIsNoNumber", "", "[[load]]\nset = \"top\"\npressure_Pa = 1\ntimes_s = [0, 1]\nfactors = [0, nan]\n",
     "s.toml:20:15: load.0.factors.1: nan is out of range; allowed: -1e+12 to 1e+12"},
    {"PressureThatIsNoNumber", "", "[[load]]\nset = \"top\"\npressure_Pa = inf\n",
     "s.toml:18:15: load.0.pressure_Pa: inf Pa is out of range; allowed: -1e+12 to 1e+12 Pa"},
    {"SetThatIsNot", "", "[[load]]\nset = \"topp\"\npressure_Pa = 1\n",
     "s.toml:17:7: load.0.set: no vertex set \"topp\"; did you mean \"top\"? the sets are: x_min, x_max, y_min, y_max, "
     "z_min, z_max, top"},
    {"PosesAndRotation", "depth_mm = 1\n", "poses = { path = \"none.csv\" }\nrotation = { axis = [0, 0, 1] }\n",
     "s.toml:16:1: tool.0.rotation: contradicts `poses` (line 15); give one of the two"},
    {"PosesWithoutAFile", "depth_mm = 1\n", "poses = { path = \"none.csv\" }\n",
     "s.toml:12:1: tool.0.poses: /scenes/none.csv: cannot be read; check the path and that you may read it"},
    {"NamelessRegion", "", "[[region]]\nsphere_m = { center = [0, 0, 0], radius = 1 }\n",
     "s.toml:16:1: region.0: missing key `name`: text in quotes; name; without `box_m` and `sphere_m`, that of a "
     "region of "
     "the mesh, or its number"},
};

class Malformed : public ::testing::TestWithParam<Mistake> {};

// A mistake is answered by one line that says where it is, what is wrong and what is allowed.
TEST_P(Malformed, SaysExactly) { EXPECT_EQ(complaint(with(GetParam())), GetParam().message); }

INSTANTIATE_TEST_SUITE_P(Scenes, Malformed, ::testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

// What is no TOML is said with its place; the words after it are the parser's.
TEST(MalformedScene, SaysWhereItIsNoToml) {
  const auto starts = [](const std::string& said, const std::string& with) {
    return said.compare(0, with.size(), with) == 0;
  };
  const std::string word = complaint("[mesh]\nkind = box\n");
  EXPECT_TRUE(starts(word, "s.toml:2:8: not valid TOML: ")) << word;
  const std::string twice = complaint("[mesh]\nkind = \"box\"\nkind = \"file\"\n");
  EXPECT_TRUE(starts(twice, "s.toml:3:")) << twice;
  EXPECT_NE(twice.find("not valid TOML: "), std::string::npos) << twice;
}

// The scene the mistakes are made in has none itself, so each message is due to its mistake.
TEST(MalformedTable, StartsFromASoundScene) { EXPECT_EQ(complaint(kSmallScene), ""); }

// All mistakes of a scene are said at once, in the order of the file, and one that variants inherit is said once.
TEST(MalformedScene, SaysEverythingOnceAndInOrder) {
  const std::string text =
      kSmallScene +
      "[tissue]\ndensity_kg_m3 = 0\nviscosity_Pa_s = -1\n[[variant]]\nname = \"a\"\n[[variant]]\nname = \"b\"\n"
      "motion.precision = 3\n[[region]]\nname = \"r\"\n";
  EXPECT_EQ(complaint(text),
            "s.toml:17:17: tissue.density_kg_m3: 0 kg/m³ is out of range; allowed: 0.001 to 1e+09 kg/m³\n"
            "s.toml:18:18: tissue.viscosity_Pa_s: -1 Pa·s is out of range; allowed: 0 to 1e+12 Pa·s\n"
            "s.toml:23:20: motion.precision: expected one of \"single\", \"double\", \"adaptive\", got 3");
}

// A scene with hundreds of mistakes shows the first twenty and counts the rest.
TEST(MalformedScene, DoesNotFloodTheTerminal) {
  std::string text = kSmallScene;
  for (int i = 0; i < 300; ++i) text += "wrong_key_" + std::to_string(i) + " = 1\n";
  const std::string said = complaint(text);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 20);
  EXPECT_NE(said.find("… and 280 more"), std::string::npos) << said;
}

// Text that would exhaust the parser's stack is refused before it is parsed.
TEST(MalformedScene, CannotNestWithoutEnd) {
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  EXPECT_EQ(complaint(dotted + " = 1\n").find("s.toml:1:402: more than 200 dots in one key or line of text"), 0u);
  const std::string said = complaint(std::string(100000, '[') + "\n");
  EXPECT_EQ(said.find("s.toml:1:"), 0u) << said;
  std::string tables = "x = 1\n[" + dotted.substr(0, 2 * 60 + 1) + "]\n";
  EXPECT_NE(complaint(tables).find("nested deeper than 32 levels"), std::string::npos) << complaint(tables);
}

// A scene that cannot be opened says so with its name.
TEST(MalformedScene, SaysWhenItCannotBeRead) {
  const auto said = [](const std::string& path) {
    try {
      load_scene(path);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said("/no/such.toml"), "/no/such.toml: cannot be read; check the path and that you may read it");
  EXPECT_EQ(said("/"), "/: is a folder; name a .toml file");
}

}  // namespace
}  // namespace glisson

// The way from files to a verdict: known parameters come back within their 95 % intervals as often as they should, what a
// test cannot tell is called so, and a fit that is stopped goes on to the same end.
#include "fit/run_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "support/folder.h"

namespace glisson::fit {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

class RunFit : public test::InFolder {
 protected:
  FitSpec spec(const std::string& text) const { return parse_fit(text, (folder_ / "fit.toml").string()); }
};

const std::string kSpecimen = R"(
[specimen]
kind = "block"
width_mm = 20
depth_mm = 20
height_mm = 20
)";
constexpr double kArea = 4e-4, kHeight = 0.02;

/// P = 2/α μ … of one Ogden term that keeps its volume: the closed form the fit does not use.
double ogden_stress(double mu, double alpha, double stretch) {
  return 2.0 * mu / alpha * (std::pow(stretch, alpha - 1.0) - std::pow(stretch, -0.5 * alpha - 1.0));
}

std::string ogden_csv(double mu, double alpha, double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, noise);
  std::string text = "time (s);displacement (mm);force (N)\n";
  for (int i = 1; i <= 60; ++i) {
    const double strain = 0.5 * i / 60.0;
    const double force = -kArea * ogden_stress(mu, alpha, 1.0 - strain) + normal(random);
    text += std::to_string(i) + ";" + std::to_string(1e3 * strain * kHeight) + ";" + std::to_string(force) + "\n";
  }
  return text;
}

const std::string kOgdenFit = kSpecimen + R"(
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [1000], alpha = [-3], bulk_modulus_Pa = 1e8 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 100
high = 1e5
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = -20
high = -0.5
scale = "linear"
[[data]]
files = ["a.csv", "b.csv"]
resample.over = "none"
[search]
starts = 2
[proof]
bootstrap = 0
)";

// With noise of 2 % of the largest force the truth is inside the 95 % intervals in at least 90 of 100 seeds. Of 100 draws
// with probability 0.95 fewer than 90 come once in 90 times; the seeds are fixed.
TEST_F(RunFit, HoldsTheTruthWithinItsIntervals) {  // long
  constexpr double kMu = 2500.0, kAlpha = -6.0;
  const FitSpec fit = spec(kOgdenFit);
  const double noise = 0.02 * kArea * std::abs(ogden_stress(kMu, kAlpha, 0.5));
  int held_mu = 0, held_alpha = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(seed);
    write("a.csv", ogden_csv(kMu, kAlpha, noise, random));
    write("b.csv", ogden_csv(kMu, kAlpha, noise, random));
    const FitResult result = run_fit(fit, {});
    ASSERT_EQ(result.parameters.size(), 2u);
    held_mu += result.parameters[0].ci95()->holds(kMu) ? 1 : 0;
    held_alpha += result.parameters[1].ci95()->holds(kAlpha) ? 1 : 0;
    if (seed == 1) {
      EXPECT_EQ(result.parameters[0].verdict, "identified");
      EXPECT_NEAR(result.rms_fit, noise, 0.3 * noise);
    }
  }
  EXPECT_GE(held_mu, 90);
  EXPECT_GE(held_alpha, 90);
}

// `auto` takes contact as recorded where files agree so, and finds it where they do not: two tests of one material, of which
// the second begins 1 mm before the plate touches in the second case.
TEST_F(RunFit, ChoosesTheContactThatLeavesRepetitionsNearer) {
  const auto pressed = [](double before_mm) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, 1e-4);
    std::string text = "time (s);displacement (mm);force (N)\n";
    for (int i = 0; i <= 400; ++i) {
      const double way = 10.0 * i / 400.0, strain = std::max(0.0, way - before_mm) * 1e-3 / kHeight;
      text += std::to_string(i) + ";" + std::to_string(way) + ";" +
              std::to_string(-kArea * ogden_stress(2500.0, -6.0, 1.0 - strain) + normal(random)) + "\n";
    }
    return text;
  };
  FitSpec fit = spec(kOgdenFit);
  fit.data[0].contact.kind = ContactKind::automatic;
  write("a.csv", pressed(1.0)), write("b.csv", pressed(1.0));
  EXPECT_THAT(run_fit(fit, {}).accounts[0], HasSubstr("the others' mean errs by"));
  write("b.csv", pressed(2.0));
  const FitResult found = run_fit(fit, {});
  EXPECT_THAT(found.accounts[0], HasSubstr("contact detected (the others' mean errs by"));
  EXPECT_NEAR(found.parameters[0].value, 2500.0, 25.0);
}

// Curves without noise give back the parameters to the accuracy of the specimen's bulk modulus: κ/μ = 4e4.
TEST_F(RunFit, FindsExactParametersFromEveryStart) {
  std::mt19937_64 random(1);
  write("a.csv", ogden_csv(2500.0, -6.0, 1e-9, random));
  write("b.csv", ogden_csv(2500.0, -6.0, 1e-9, random));
  FitSpec fit = spec(kOgdenFit);
  fit.search.starts = 20;
  const FitResult result = run_fit(fit, {});
  ASSERT_EQ(result.basins.size(), 1u);
  EXPECT_EQ(result.basins[0].found, 20);
  EXPECT_NEAR(result.parameters[0].value, 2500.0, 2.5);
  EXPECT_NEAR(result.parameters[1].value, -6.0, 0.006);
}

const std::string kHookeFit = kSpecimen + R"(
[tissue]
youngs_modulus_Pa = 3000
[[parameter]]
key = "tissue.youngs_modulus_Pa"
name = "E"
low = 100
high = 1e5
[[parameter]]
key = "tissue.poisson_ratio"
name = "nu"
low = 0.05
high = 0.49
scale = "linear"
[[data]]
files = ["a.csv"]
resample.over = "none"
[search]
starts = 6
[proof]
bootstrap = 0
)";

// The force between smooth plates is E A ε whatever ν is: E is known, ν is not, and the result says so.
TEST_F(RunFit, SaysWhatOneUniaxialCurveCannotTell) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.001);
  std::string text = "time (s),displacement (mm),force (N)\n";
  for (int i = 1; i <= 50; ++i) {
    const double d = 0.02 * i;
    text += std::to_string(i) + "," + std::to_string(d) + "," +
            std::to_string(4200.0 * kArea * 1e-3 * d / kHeight + normal(random)) + "\n";
  }
  write("a.csv", text);
  const FitResult result = run_fit(spec(kHookeFit), {});
  ASSERT_EQ(result.parameters.size(), 2u);
  EXPECT_EQ(result.parameters[0].verdict, "identified");
  EXPECT_NEAR(result.parameters[0].value, 4200.0, 42.0);
  EXPECT_EQ(result.parameters[1].verdict, "not identifiable");
  EXPECT_THAT(result.conclusions, Contains(HasSubstr("nu: not identifiable")));
  EXPECT_THAT(result.parameters[1].words, HasSubstr("fits these curves"));
  ASSERT_EQ(result.basins.size(), 1u) << "a flat valley is one optimum, not many";
}

// A fit that is stopped after the first starts and goes on from what it remembers ends where one ends that was not.
TEST_F(RunFit, GoesOnWhereItWasStopped) {
  std::mt19937_64 random(2);
  write("a.csv", ogden_csv(2500.0, -6.0, 0.01, random));
  write("b.csv", ogden_csv(2500.0, -6.0, 0.01, random));
  FitSpec fit = spec(kOgdenFit);
  fit.search.starts = 12;
  const FitResult whole = run_fit(fit, {});
  std::atomic<bool> stop{false};
  FitRun options;
  options.stop = &stop;
  FitMemory memory;
  options.remember = [&](const FitMemory& known) {
    memory = known;
    stop = true;
  };
  const FitResult cut = run_fit(fit, options);
  EXPECT_FALSE(cut.complete);
  EXPECT_LT(cut.starts.size(), 12u);
  FitRun again;
  again.memory = memory;
  const FitResult resumed = run_fit(fit, again);
  EXPECT_TRUE(resumed.complete);
  EXPECT_LT(resumed.forward_runs, whole.forward_runs);
  ASSERT_EQ(resumed.parameters.size(), whole.parameters.size());
  for (std::size_t p = 0; p < whole.parameters.size(); ++p)
    EXPECT_EQ(resumed.parameters[p].value, whole.parameters[p].value);
}

const std::string kPressedBlock = R"([mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[tissue]
youngs_modulus_Pa = 3000
[motion]
integrator = "implicit"
step_s = 0.005
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
depth_mm = 1
velocity_mm_s = 0.4
)";
const std::string kSceneFit = R"(scene = "s.toml"
[[parameter]]
key = "tissue.youngs_modulus_Pa"
low = 1000
high = 20000
[[data]]
files = ["a.csv"]
[search]
starts = 8
[proof]
bootstrap = 0
profiles = false
next = false
)";

// What the clock chose is chosen once: a resumed fit takes the forward model of the run that was stopped, and says the same
// of it. Of the result only its own runs and times may differ.
TEST_F(RunFit, SaysTheSameOfItsForwardModelWhenItGoesOn) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 0.001);
  std::string text = "time (s),displacement (mm),force (N)\n";
  for (int i = 0; i <= 50; ++i) {
    const double force = 4200.0 * kArea * 2e-5 * i / kHeight + normal(random);
    text += std::to_string(0.05 * i) + "," + std::to_string(0.02 * i) + "," + std::to_string(force) + "\n";
  }
  write("a.csv", text);
  write("s.toml", kPressedBlock);
  FitSpec fit = spec(kSceneFit);
  FitRun options;
  std::atomic<bool> stop{false};
  options.stop = &stop;
  FitMemory memory;
  options.remember = [&](const FitMemory& known) {
    memory = known;
    stop = true;
  };
  EXPECT_FALSE(run_fit(fit, options).complete);
  ASSERT_EQ(memory.size(), 1u);
  LawMemory& law = memory.begin()->second;
  ASSERT_NE(law.forward, "the scene") << "one of the cheaper models serves";
  law.speedup = 1234.0;  // no clock of this machine says that by itself
  FitRun again;
  again.memory = memory;
  const FitResult resumed = run_fit(fit, again);
  EXPECT_THAT(resumed.forward, HasSubstr("Forward model: " + law.forward + ", 1234 times as fast"));
  law.forward = "implicit, 17 steps";
  again.memory = memory;
  EXPECT_THROW(run_fit(fit, again), std::invalid_argument);
}

// A start with another number of parameters than the law has is refused, whoever wrote it.
TEST_F(RunFit, RefusesStartsOfAnotherLaw) {
  std::mt19937_64 random(2);
  write("a.csv", ogden_csv(2500.0, -6.0, 0.01, random));
  write("b.csv", ogden_csv(2500.0, -6.0, 0.01, random));
  FitRun options;
  options.remember = [&](const FitMemory& known) { options.memory = known; };
  const FitSpec fit = spec(kOgdenFit);
  run_fit(fit, options);
  ASSERT_FALSE(options.memory.empty());
  StartRecord& first = options.memory.begin()->second.starts.front();
  for (const std::vector<double>& list :
       {std::vector<double>{}, std::vector<double>{0.5}, std::vector<double>(3, 0.5)}) {
    first.optimum.scaled = list;
    EXPECT_THROW(run_fit(fit, options), std::invalid_argument) << list.size();
  }
}

// Laws that are asked for bring their own parameters: the description needs none. Without either, nothing is free.
TEST_F(RunFit, LawsByNameNeedNoParameters) {
  std::mt19937_64 random(2);
  write("a.csv", ogden_csv(2500.0, -6.0, 0.01, random));
  FitSpec fit = spec(kSpecimen +
                     "[[data]]\nfiles = [\"a.csv\"]\nresample.over = \"none\"\n[search]\nstarts = 2\n"
                     "[proof]\nbootstrap = 0\nprofiles = false\nnext = false\n");
  FitRun options;
  options.laws = {"constant", "neo_hookean"};
  EXPECT_EQ(run_fit(fit, options).laws.size(), 2u);
  try {
    run_fit(fit, {});
    FAIL() << "nothing is free";
  } catch (const SceneError& error) {
    EXPECT_THAT(error.what(), HasSubstr("fit.toml: nothing is free; give one or more [[parameter]]"));
    EXPECT_THAT(error.what(), HasSubstr("--laws"));
  }
}

// The law that made the curves is chosen on curves held out, and no richer one.
TEST_F(RunFit, ChoosesTheLawTheCurvesSupport) {
  for (const char* name : {"a.csv", "b.csv", "c.csv", "d.csv", "e.csv"}) {
    std::mt19937_64 random(static_cast<unsigned>(name[0]));
    write(name, ogden_csv(2500.0, -6.0, 0.05, random));
  }
  FitSpec fit =
      spec(kOgdenFit + "[[data]]\nname = \"held\"\nfiles = [\"c.csv\", \"d.csv\", \"e.csv\"]\nuse = \"test\"\n");
  fit.search.starts = 8;
  FitRun options;
  options.laws = {"constant", "neo_hookean", "ogden", "ogden2"};
  const FitResult result = run_fit(fit, options);
  EXPECT_EQ(result.law, "ogden");
  EXPECT_THAT(result.conclusions, Contains(HasSubstr("The data support 2 parameters")));
  options.laws = {"ogden", "ogden"};
  EXPECT_THROW(run_fit(fit, options), std::invalid_argument);
  options.laws = {"ogdne"};
  try {
    run_fit(fit, options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"ogden\"?"));
  }
}

/// Force of the block pressed to the stretch l under W(I₁, I₂) with its volume kept: 2 (l − l⁻²) (W₁ + W₂/l).
template <class Slopes>
double invariant_force(Slopes slopes, double l) {
  const auto [first, second] = slopes(l * l + 2.0 / l - 3.0, 2.0 * l + 1.0 / (l * l) - 3.0);
  return -kArea * 2.0 * (l - 1.0 / (l * l)) * (first + second / l);
}
template <class Slopes>
std::string invariant_csv(Slopes slopes) {
  std::string text = "time (s);displacement (mm);force (N)\n";
  for (int i = 1; i <= 60; ++i) {
    const double strain = 0.5 * i / 60.0;
    text += std::to_string(i) + ";" + std::to_string(1e3 * strain * kHeight) + ";" +
            std::to_string(invariant_force(slopes, 1.0 - strain)) + "\n";
  }
  return text;
}

// Laws by name of both invariants find the two numbers that made a curve: 1 % is what six decimals of a force, and the volume
// that a specimen's κ of 1000 E lets go, leave. Five moduli match it to 1e-3 of its largest force; what they are, a single curve
// does not tell.
TEST_F(RunFit, LawsOfBothInvariantsByNameFindTheirNumbers) {
  using Pair = std::pair<double, double>;
  const FitSpec fit = spec(kSpecimen +
                           "[[data]]\nfiles = [\"a.csv\"]\nresample.over = \"none\"\n[search]\nstarts = 8\n"
                           "[proof]\nbootstrap = 0\nprofiles = false\nnext = false\n");
  const auto expect = [&](const char* law, auto slopes, double first, double second) {
    write("a.csv", invariant_csv(slopes));
    FitRun options;
    options.laws = {law};
    const FitResult result = run_fit(fit, options);
    ASSERT_GE(result.parameters.size(), 2u) << law;
    EXPECT_LT(result.rms_fit, 1e-3 * invariant_force(slopes, 0.5)) << law;
    if (result.parameters.size() > 2) return;
    EXPECT_NEAR(result.parameters[0].value, first, 1e-2 * first) << law;
    EXPECT_NEAR(result.parameters[1].value, second, 1e-2 * second) << law;
  };
  expect(
      "gent",
      [](double x, double) {
        return Pair{0.5 * 900.0 / (1.0 - x / 3.0), 0.0};
      },
      900.0, 3.0);
  expect(
      "fung_i2",
      [](double, double y) {
        return Pair{0.0, 0.5 * 900.0 * std::exp(0.5 * y)};
      },
      900.0, 0.5);
  expect(
      "square_i2",
      [](double, double y) {
        return Pair{0.0, 400.0 + 2.0 * 150.0 * y};
      },
      400.0, 150.0);
  expect(
      "rivlin",
      [](double x, double y) {
        return Pair{200.0 + 2.0 * 50.0 * x + 30.0 * y, 150.0 + 30.0 * x + 2.0 * 60.0 * y};
      },
      0.0, 0.0);
}

// A law whose run ends early, its body of 2 mm being pressed through itself, does not end the fit of the others; alone it does.
TEST_F(RunFit, LeavesOutALawThatDoesNotRun) {
  std::mt19937_64 random(4);
  write("a.csv", ogden_csv(2500.0, -2.0, 0.01, random));
  write("block.toml", R"(
[mesh]
kind = "box"
cells = [1, 1, 1]
size_m = [0.02, 0.02, 0.02]
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 1000, bulk_modulus_Pa = 1e5 }
[motion]
integrator = "quasi_static"
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
)");
  const auto law = [](const std::string& name, const std::string& range) {
    return "[[law]]\nname = \"" + name + "\"\n[[law.parameter]]\nkey = \"tissue.hyperelastic.mu_Pa\"\n" + range;
  };
  const std::string head =
      "scene = \"block.toml\"\n[forward]\nkind = \"scene\"\n[[data]]\nfiles = [\"a.csv\"]\n"
      "[search]\nstarts = 1\n[proof]\nbootstrap = 0\nprofiles = false\nnext = false\n";
  const std::string tame = law("tame", "low = 100\nhigh = 1e4\n"),
                    wild = law("wild", "low = 100\nhigh = 1e4\n") +
                           "[law.set]\n\"mesh.size_m\" = [0.02, 0.02, 0.002]\n\"motion.on_inversion\" = \"stop\"\n";
  const FitResult result = run_fit(spec(head + wild + tame), {});
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.law, "tame");
  EXPECT_THAT(result.conclusions, Contains(HasSubstr("The law wild is left out")));
  EXPECT_THROW(run_fit(spec(head + wild), {}), std::runtime_error);
}

// tissue.toml is a tissue that scenes take, with the fitted numbers.
TEST_F(RunFit, WritesATissueForScenes) {
  std::mt19937_64 random(3);
  write("a.csv", ogden_csv(2500.0, -6.0, 0.001, random));
  write("b.csv", ogden_csv(2500.0, -6.0, 0.001, random));
  const FitResult result = run_fit(spec(kOgdenFit), {});
  write("tissue.toml", result.tissue);
  const Scene scene = parse_scene(
      "[mesh]\nkind = \"box\"\n[tissue]\nfile = \"tissue.toml\"\n[motion]\nduration_s = 1\n", "scene.toml", folder_);
  const Tissue& tissue = scene.variants.at(0).tissue;
  ASSERT_TRUE(tissue.hyperelastic);
  EXPECT_DOUBLE_EQ(tissue.lame().mu, result.parameters[0].value);
  EXPECT_THAT(result.tissue, HasSubstr("# Fitted by `glisson fit fit.toml`"));
  EXPECT_EQ(tissue.volume_change, VolumeChange::average_nodal) << "at ν = 0.49999 tets with volumes of their own lock";
  const std::string bulk = "bulk_modulus_Pa = 1e8", soft = "bulk_modulus_Pa = 1e4",
                    own = "volume_change = \"element\"\n";
  std::string compressible = kOgdenFit, told = kOgdenFit;
  compressible.replace(compressible.find(bulk), bulk.size(), soft);
  told.insert(told.find("hyperelastic"), own);
  EXPECT_THAT(run_fit(spec(compressible), {}).tissue, Not(HasSubstr("volume_change")));
  EXPECT_THAT(run_fit(spec(told), {}).tissue, AllOf(HasSubstr(own), Not(HasSubstr("average_nodal"))));
}

// How many rows were skipped is among the sentences that terminal, report and fit.json have.
TEST_F(RunFit, SaysHowManyRowsItSkipped) {
  std::mt19937_64 random(3);
  std::string text = ogden_csv(2500.0, -6.0, 0.001, random);
  text.insert(text.find("\n20;") + 1, "19.5;ERR;ERR\n");
  write("a.csv", text);
  write("b.csv", ogden_csv(2500.0, -6.0, 0.001, random));
  std::string skipping = kOgdenFit;
  skipping.insert(skipping.find("resample."), "skip_bad_rows = true\n");
  EXPECT_THAT(run_fit(spec(skipping), {}).conclusions,
              Contains(HasSubstr("1 of 61 rows of a have no number in a column that is needed and were skipped")));
}

TEST_F(RunFit, TellsWhatIsWrongWithTheFile) {
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      spec(text);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint(kOgdenFit + "found_again = 3\n"),
              HasSubstr("proof.found_again: unknown key here; it belongs in [search]"));
  EXPECT_THAT(complaint(kOgdenFit + "[serach]\nstarts = 3\n"), HasSubstr("did you mean `search`?"));
  EXPECT_THAT(complaint("scene = \"x.toml\"\n" + kOgdenFit), HasSubstr("contradicts"));
  EXPECT_THAT(complaint(kSpecimen), HasSubstr("missing key `data`"));
  const std::string parameter =
      kSpecimen + "[[data]]\nfiles = [\"a.csv\"]\n[[parameter]]\nkey = \"tissue.poisson_ratio\"\n";
  EXPECT_THAT(complaint(parameter + "low = 0.4\nhigh = 0.1\n"), HasSubstr("not above `low`"));
  EXPECT_THAT(complaint(parameter + "low = -0.2\nhigh = 0.1\n"), HasSubstr("set scale = \"linear\""));
  EXPECT_THAT(complaint(parameter + "low = 0.1\nhigh = 0.4\nstart = 0.45\n"), HasSubstr("allowed: 0.1 to 0.4"));
}

// A key that no scene has is told before anything runs.
TEST_F(RunFit, TellsAKeyThatIsNone) {
  std::mt19937_64 random(3);
  write("a.csv", ogden_csv(2500.0, -6.0, 0.001, random));
  FitSpec fit = spec(kHookeFit);
  fit.parameters[0].key = "tissue.young_Pa";
  EXPECT_THAT([&] { run_fit(fit, {}); }, ::testing::ThrowsMessage<std::exception>(HasSubstr("young_Pa")));
}

}  // namespace
}  // namespace glisson::fit

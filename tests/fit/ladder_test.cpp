// ladder_test.cpp — the cheapest model is taken that the noise cannot tell from the scene, and no other.
#include "fit/forward/ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scene/parse/document.h"
#include "scene/parse/problems.h"

namespace glisson::fit {
namespace {

using ::testing::HasSubstr;

/// A press to a share of the height, measured with noise of that size; forces are those of the first simulation.
Curve press(double height, double strain, double velocity, double noise) {
  Curve c;
  c.name = "press", c.velocity = velocity, c.noise = noise;
  for (int i = 0; i <= 60; ++i) {
    c.time.push_back(strain * height / velocity * i / 60);
    c.displacement.push_back(velocity * c.time.back());
  }
  c.force.assign(c.size(), 0.0);
  return c;
}

ForwardProblem specimen_problem(const std::string& tissue, Parameter parameter, const Curve& curve) {
  ForwardProblem p;
  SpecimenSpec spec;
  spec.diameter = 0.05, spec.height = 0.03, spec.cells = {1, 1, 2};
  p.scene = {.text = specimen_scene(spec) + "\n[tissue]\n" + tissue,
             .name = "specimen",
             .base = {},
             .overrides = {},
             .variant = {}};
  p.parameters = {std::move(parameter)};
  p.curves = {curve};
  p.spec.points = 1;
  return p;
}

const std::string kOgden =
    "hyperelastic = { kind = \"ogden\", mu_Pa = [3000], alpha = [4], bulk_modulus_Pa = 150000 }\n";

// A specimen of Ogden's tissue between smooth plates needs no mesh: that is the cheapest by far, and is within a tenth of
// the noise of 5 mN, also where the tissue is at the ends of its bounds.
TEST(Ladder, TakesTheSpecimenForASpecimen) {
  const ForwardProblem p = specimen_problem(kOgden, {"tissue.hyperelastic.alpha[0]", "", 1, 8, Scale::linear, 4},
                                            press(0.03, 0.5, 0.01 / 60, 0.005));
  const Ladder ladder = choose_forward(p);
  EXPECT_EQ(ladder.taken().name, "specimen") << describe(ladder);
  EXPECT_LT(ladder.taken().share, 0.1 / 0.3);
  EXPECT_LT(check_forward(ladder, p, std::vector{7.0}), 0.1 / 0.3);
  EXPECT_THAT(describe(ladder), HasSubstr("◀ taken"));
}

// With viscosity the static steps are not among the candidates. At 1 mm/s inertia is nothing: its stress ρ v² is 1 mPa.
TEST(Ladder, KeepsThePastOfViscousTissue) {
  const ForwardProblem p =
      specimen_problem("viscosity_Pa_s = 500\n", {"tissue.viscosity_Pa_s", "Pa s", 100, 1000, Scale::logarithmic, 500},
                       press(0.03, 0.3, 0.001, 0.02));
  const Ladder ladder = choose_forward(p);
  EXPECT_EQ(ladder.taken().name, "specimen") << describe(ladder);
  for (const Rung& r : ladder.rungs) EXPECT_EQ(r.name.find("static"), std::string::npos);
}

// Plates that hold the faces: no homogeneous specimen; what is taken is off by less than is allowed, and what was passed
// over was either dearer or off by more.
TEST(Ladder, TakesWhatTheNoiseAllows) {
  ForwardProblem p = specimen_problem("law = { kind = \"linear\", slope_Pa = 20000 }\n",
                                      {"tissue.youngs_modulus_Pa", "Pa", 1000, 10000, Scale::logarithmic, 3600},
                                      press(0.03, 0.3, 0.01 / 60, 0.02));
  p.scene.overrides = {{"fixed", "[{ set = \"z_min\" }]"}, {"tool.plate.sideways", "blocked"}};
  const Ladder ladder = choose_forward(p);
  for (const Rung& r : ladder.rungs) {
    EXPECT_NE(r.name, "specimen");
    EXPECT_TRUE(&r == &ladder.taken() || &r == &ladder.rungs[0] || !r.serves() || r.cost >= ladder.taken().cost)
        << describe(ladder);
  }
  EXPECT_LT(ladder.taken().share, 1.0);
  // a tolerance that nothing meets leaves the scene itself, or what has its bytes: the same 400 steps
  p.spec.tolerance = 1e-12;
  EXPECT_EQ(choose_forward(p).taken().share, 0.0);
  p.spec.kind = ForwardKind::uniaxial;
  EXPECT_THROW(choose_forward(p), std::invalid_argument);
}

// [forward] and [specimen] are read with their units; what is wrong is told at its line.
TEST(Ladder, ReadsItsSections) {
  const auto read = [](const scene::SectionSpec& section, const std::string& text, void* target) {
    scene::Problems problems("FIT.toml");
    const scene::Node root = scene::parse_document(text, "FIT.toml");
    scene::read_section(section, root, target, {problems, "x", {}});
    try {
      problems.throw_if_any();
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ForwardSpec f;
  EXPECT_EQ(
      read(forward_section(),
           "kind = \"scene\"\nintegrator = \"quasi_static\"\ntolerance = 0.5\napproach_mm = 1.5\nforce = \"bottom\"\n",
           &f),
      "");
  EXPECT_EQ(f.kind, ForwardKind::scene);
  EXPECT_EQ(f.integrator, Integrator::quasi_static);
  EXPECT_DOUBLE_EQ(f.approach, 0.0015);
  EXPECT_EQ(f.force, "bottom");
  EXPECT_THAT(read(forward_section(), "tolerance = 0\n", &f), HasSubstr("FIT.toml:1:13: x.tolerance: 0"));
  SpecimenSpec s;
  EXPECT_EQ(read(specimen_section(), "kind = \"block\"\nwidth_mm = 10\ndepth_mm = 20\nheight_mm = 30\n", &s), "");
  EXPECT_DOUBLE_EQ(specimen_of(s).area, 2e-4);
  EXPECT_EQ(read(specimen_section(), "kind = \"cylinder\"\ndiameter_mm = 50\nheight_mm = 30\n", &s), "");
  EXPECT_NEAR(specimen_of(s).area, 1.9635e-3, 1e-7);
  EXPECT_THAT(read(specimen_section(), "kind = \"cylinder\"\ndiameter_mm = 50\n", &s),
              HasSubstr("missing key `height_mm`"));
  EXPECT_FALSE(plates_of(s));
  const std::string rubs =
      "kind = \"cylinder\"\ndiameter_mm = 50\nheight_mm = 30\nfaces = \"friction\"\nfriction = 0.2\n";
  EXPECT_EQ(read(specimen_section(), rubs, &s), "");
  ASSERT_TRUE(plates_of(s));
  EXPECT_EQ(plates_of(s)->faces, lab::Faces::friction);
  EXPECT_DOUBLE_EQ(plates_of(s)->grip.friction, 0.2);
  EXPECT_DOUBLE_EQ(plates_of(s)->radius, 0.025);
}

}  // namespace
}  // namespace glisson::fit

// parametric_variant_test.cpp — setting numbers in a scene read once is as reading it anew with --set.
#include "scene/build/parametric_variant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson {
namespace {

using scene::ParametricVariant;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kText = R"([mesh]
kind = "box"
[tissue]
youngs_modulus_Pa = 5000
maxwell = [{ share = 0.3, time_s = 2 }, { share = 0.2, time_s = 50 }]
[[region]]
name = "stone"
sphere_m = { center = [0.02, 0.02, 0.04], radius = 0.01 }
tissue.density_kg_m3 = 1200
[[fixed]]
set = "z_min"
[[tool]]
name = "press"
set = "z_max"
[[variant]]
name = "a"
[[variant]]
name = "b"
tissue.law = { kind = "polynomial", coefficients_Pa = [1, 2, 3] }
)";

ParametricVariant made(const std::string& variant, std::vector<std::string> keys) {
  return {kText, "s.toml", "/scenes", std::vector<Override>{{"tissue.density_kg_m3", "1060"}}, variant, keys};
}

// A key of the tissue reaches the body and the regions that inherit it; an element of a list leaves the others.
TEST(ParametricVariant, SetsAsOverridesDo) {
  const ParametricVariant p = made("b", {"tissue.youngs_modulus_Pa", "tissue.law.coefficients_Pa[1]",
                                         "tissue.maxwell[1].time_s", "tool.press.depth_mm"});
  EXPECT_FALSE(p.only_tissue());
  const Variant v = p.with(std::vector<double>{7000, 22, 40, 3});
  EXPECT_EQ(v.tissue.youngs_modulus, 7000);
  EXPECT_EQ(v.regions.at(0).tissue.youngs_modulus, 7000);
  EXPECT_EQ(v.tissue.density, 1060);
  EXPECT_EQ(v.regions[0].tissue.density, 1200);
  EXPECT_THAT(std::get<PolynomialLaw>(v.tissue.law).coefficients, ElementsAre(1, 22, 3));
  EXPECT_EQ(v.regions[0].tissue.law, v.tissue.law);
  EXPECT_EQ(v.tissue.maxwell.at(0).time, 2);
  EXPECT_EQ(v.tissue.maxwell.at(1).time, 40);
  EXPECT_DOUBLE_EQ(v.tools.at(0).motion.depth, 0.003);
  EXPECT_EQ(p.with(std::vector<double>{8000, 22, 40, 3}).tissue.youngs_modulus, 8000) << "nothing is left of the last";
}

// The tissue alone is that of the whole experiment.
TEST(ParametricVariant, ReadsTheTissueAlone) {
  const ParametricVariant p = made("a", {"tissue.poisson_ratio"});
  EXPECT_TRUE(p.only_tissue() == false) << "the region has it, too";
  const Tissue tissue = p.tissue_with(std::vector<double>{0.3});
  EXPECT_EQ(tissue.poisson_ratio, 0.3);
  EXPECT_EQ(tissue.density, 1060);
  EXPECT_EQ(tissue.maxwell.size(), 2u);
}

std::string refused(const std::string& variant, std::vector<std::string> keys, std::vector<double> values = {}) {
  try {
    const ParametricVariant p = made(variant, std::move(keys));
    if (!values.empty()) p.with(values);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

// What cannot be used is told with its key, and a value with the range that its key allows.
TEST(ParametricVariant, RefusesWhatCannotBeUsed) {
  EXPECT_THAT(refused("", {"tissue.poisson_ratio"}), HasSubstr("several variants; name one with `variant`: a, b"));
  EXPECT_THAT(refused("c", {"tissue.poisson_ratio"}), HasSubstr("no variant \"c\""));
  EXPECT_THAT(refused("b", {"tissue.law.coefficients_Pa[3]"}), HasSubstr("the list has 3 elements"));
  EXPECT_THAT(refused("a", {"tissue.law.coefficients_Pa[0]"}), HasSubstr("no list of numbers"));
  EXPECT_THAT(refused("a", {"tissue.law[x]"}), HasSubstr("an element of a list is written [0]"));
  EXPECT_THAT(refused("a", {"tissue.poison_ratio"}, {0.3}), HasSubstr("did you mean `poisson_ratio`?"));
  EXPECT_THAT(refused("a", {"tissue.poisson_ratio"}, {0.7}), HasSubstr("0.7 is out of range; allowed: > -1 and < 0.5"));
}

}  // namespace
}  // namespace glisson

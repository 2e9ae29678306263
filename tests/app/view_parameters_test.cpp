// Every number that a page may change is in the tissue, has its unit and a range, and changes that tissue alone.
#include <cmath>

#include "app/program.h"
#include "view/engine/live_body.h"
#include "view/engine/live_parameters.h"

namespace glisson::view::view_parameters_test {
namespace {

Variant variant_of(const std::string& tissue, const std::string& more = "") {
  std::string text = test::small_scene(more);
  const std::size_t at = text.find("youngs_modulus_Pa"), end = text.find("[motion]");
  return parse_scene(text.replace(at, end - at, tissue + "\n"), "view.toml", ".").variants.front();
}

std::vector<std::string> labels_of(const Variant& variant) {
  std::vector<std::string> labels;
  for (const TissueParameter& x : tissue_parameters(variant)) labels.push_back(x.info.label + " [" + x.info.unit + "]");
  return labels;
}

const std::vector<std::string> kTissues{
    "youngs_modulus_Pa = 3600\npoisson_ratio = 0.4",
    "law = { kind = \"step\", threshold = 0.1, above_Pa = 7200 }",
    "law = { kind = \"linear\", slope_Pa = 20000 }",
    "law = { kind = \"polynomial\", coefficients_Pa = [1000, -20, 3e5] }",
    "law = { kind = \"exponential\", amplitude_Pa = 300, rate = 12 }",
    "law = { kind = \"table\", arguments = [0, 0.1, 0.3], moduli_Pa = [3600, 4000, 9000] }",
    "lambda_law = { kind = \"linear\", slope_Pa = 100 }\nmu_law = { kind = \"linear\", slope_Pa = 50 }",
    "hyperelastic = { kind = \"neo_hookean\", mu_Pa = 1000, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"mooney_rivlin\", c10_Pa = 300, c01_Pa = 200, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"yeoh\", c1_Pa = 300, c2_Pa = 200, c3_Pa = 10, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"fung\", mu_Pa = 1000, b = 4, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"veronda_westmann\", c_Pa = 300, b = 3, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"ogden\", mu_Pa = [600, 400], alpha = [3, -2], bulk_modulus_Pa = 20000 }",
    "fibres = { stiffness_Pa = 500 }",
    "maxwell = [{ share = 0.3, time_s = 0.1 }, { share = 0.2, time_s = 2 }]",
    "hyperelastic = { kind = \"gent\", mu_Pa = 1000, limit = 3, bulk_modulus_Pa = 20000 }",
    "hyperelastic = { kind = \"invariants\", c10_Pa = 300, c02_Pa = -20, a2_Pa = 500, bulk_modulus_Pa = 20000 }"};

// The numbers of a tissue stand within their ranges, and each of them written is the one that is read.
TEST(LiveParameters, AreThoseOfTheTissue) {
  for (const std::string& tissue : kTissues) {
    const Variant variant = variant_of(tissue);
    const std::vector<TissueParameter> all = tissue_parameters(variant);
    ASSERT_FALSE(all.empty()) << tissue;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ParameterInfo& info = all[i].info;
      EXPECT_FALSE(info.label.empty() || info.unit.empty() || info.group.empty()) << tissue;
      EXPECT_TRUE(std::isfinite(info.least) && std::isfinite(info.most)) << info.label;
      EXPECT_LT(info.least, info.most) << info.label;
      EXPECT_TRUE(info.value >= info.least && info.value <= info.most) << info.label;
      EXPECT_TRUE(!info.log || info.least > 0.0) << info.label;
      Variant changed = variant;
      const double wanted = info.log ? std::sqrt(info.value * info.most) : 0.5 * (info.value + info.most);
      EXPECT_EQ(set_parameter(changed, all[i], wanted), wanted);
      const std::vector<TissueParameter> now = tissue_parameters(changed);
      ASSERT_EQ(now.size(), all.size());
      for (std::size_t k = 0; k < all.size(); ++k)
        EXPECT_EQ(now[k].info.value, k == i ? wanted : all[k].info.value) << info.label << " and " << now[k].info.label;
      EXPECT_EQ(set_parameter(changed, all[i], 1e30), info.most);
    }
  }
}

// What each law describes has a slider under a name that can be read.
TEST(LiveParameters, NameWhatLawsDescribe) {
  EXPECT_THAT(labels_of(variant_of(kTissues[0])),
              testing::ElementsAre("Young's modulus E [Pa]", "Poisson's ratio ν [–]", "Viscosity η [Pa·s]"));
  EXPECT_THAT(labels_of(variant_of(kTissues[1])), testing::IsSupersetOf({"Threshold [–]", "Above [Pa]", "Width [–]"}));
  EXPECT_THAT(labels_of(variant_of(kTissues[5])), testing::IsSupersetOf({"Modulus M₁ [Pa]", "Modulus M₃ [Pa]"}));
  EXPECT_THAT(labels_of(variant_of(kTissues[12])), testing::ElementsAre("μ₁ [Pa]", "μ₂ [Pa]", "α₁ [–]", "α₂ [–]",
                                                                        "Bulk modulus κ [Pa]", "Viscosity η [Pa·s]"));
  EXPECT_THAT(labels_of(variant_of(kTissues[14])), testing::IsSupersetOf({"Share g₂ [–]", "Time τ₂ [s]"}));
}

// A change goes into the moving body at once and only into its own region; one that cannot be changes nothing.
TEST(LiveParameters, ChangeTheMovingBody) {
  const Variant variant =
      variant_of("youngs_modulus_Pa = 3600\npoisson_ratio = 0.4",
                 "[[region]]\nname = \"core\"\nbox_m = { min = [0, 0, 0], max = [0.01, 0.02, 0.02] }\n"
                 "tissue.youngs_modulus_Pa = 9000\n");
  LiveBody body(variant, {});
  Variant changed = variant;
  const std::vector<TissueParameter> all = tissue_parameters(variant);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[3].info.tissue, "core");
  set_parameter(changed, all[3], 12000.0);
  const std::uint64_t before = body.built().simulation.state_hash();
  body.set_tissues(changed);
  EXPECT_EQ(body.built().simulation.state_hash(), before);
  std::vector<double> moduli;
  for (const auto& [region, tissue] : *body.tissues()) {
    moduli.push_back(tissue.youngs_modulus);
    EXPECT_EQ(body.built().simulation.tissue(region).youngs_modulus, tissue.youngs_modulus);
  }
  EXPECT_THAT(moduli, testing::UnorderedElementsAre(3600.0, 12000.0));
  changed.tissue.poisson_ratio = 0.7;
  EXPECT_THROW(body.set_tissues(changed), std::invalid_argument);
  EXPECT_EQ(body.tissues()->begin()->second.poisson_ratio, 0.4);
}

}  // namespace
}  // namespace glisson::view::view_parameters_test

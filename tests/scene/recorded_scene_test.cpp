// A scene written with the tissues of a moment reads back to those tissues, whatever their law.
#include "glisson/scene/recorded_scene.h"

#include <gtest/gtest.h>

namespace glisson::scene {
namespace {

const std::string kScene = "[mesh]\nkind = \"box\"\n[motion]\nduration_s = 1\n";

/// The tissue of a scene, every number of it changed by a part.
Tissue changed(Tissue t) {
  const auto move = [](auto& laws) {
    std::visit(
        [](auto& law) {
          using Law = std::decay_t<decltype(law)>;
          each_field<Law>([&]<class T>(const FieldOf<Law, T>& x) {
            if constexpr (std::is_same_v<T, double>) {
              law.*x.member *= 1.1;
            } else {
              for (double& value : law.*x.member) value *= 1.1;
            }
          });
        },
        laws);
  };
  t.viscosity += 3.0;
  if (!t.hyperelastic) {  // such a law says E and ν itself
    t.youngs_modulus *= 1.1, t.poisson_ratio *= 1.1;
    move(t.law);
  }
  if (t.lambda_law) move(*t.lambda_law);
  if (t.mu_law) move(*t.mu_law);
  if (t.hyperelastic) move(*t.hyperelastic);
  if (t.fibres) t.fibres->stiffness *= 1.1;
  for (MaxwellBranch& b : t.maxwell) b.share *= 1.1, b.time *= 1.1;
  return t;
}

class RecordedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedScene, KeepsTheTissueOfTheMoment) {
  const std::string text = kScene + "[tissue]\n" + GetParam();
  Variant now = parse_scene(text, "s.toml", ".").variants.front();
  const Tissue given = now.tissue;
  now.tissue = changed(given);
  ASSERT_FALSE(now.tissue == given);
  const std::string written = recorded_scene(text, "s.toml", ".", {}, now, {.head = "", .files = {}, .duration = 1.0});
  EXPECT_EQ(parse_scene(written, "w.toml", ".").variants.front().tissue, now.tissue) << written;
}

INSTANTIATE_TEST_SUITE_P(
    Laws, RecordedScene,
    ::testing::Values(
        "", "law = { kind = \"exponential\", amplitude_Pa = 600, rate = 8 }\n",
        "law = { kind = \"polynomial\", coefficients_Pa = [100, 200, 300] }\n",
        "lambda_Pa = 5000\nmu_Pa = 1200\nmu_law = { kind = \"linear\", slope_Pa = 900 }\n",
        "hyperelastic = { kind = \"ogden\", mu_Pa = [842, 30], alpha = [-4.7, 2], bulk_modulus_Pa = 6000 }\n",
        "hyperelastic = { kind = \"veronda_westmann\", c_Pa = 900, b = 2, bulk_modulus_Pa = 6000 }\n",
        "hyperelastic = { kind = \"invariants\", c10_Pa = -20, a2_Pa = 500, b2 = 3, bulk_modulus_Pa = 6000 }\n",
        "kinematics = \"green\"\nfibres = { direction = [1, 0, 0], stiffness_Pa = 4000 }\n",
        "[[tissue.maxwell]]\nshare = 0.3\ntime_s = 1.86\n[[tissue.maxwell]]\nshare = 0.2\ntime_s = 51.3\n",
        "[[tissue.maxwell]]\nshare = 0.3\ntime_s = 1.86\ntime_law = { kind = \"exponential\", rate = 4, most = 20 "
        "}\n"));

// Keys of a preset give way to the numbers of the moment.
TEST(RecordedSceneOfAPreset, KeepsTheTissueOfTheMoment) {
  const std::string text = kScene + "[tissue]\npreset = \"phantom_ef10_100t\"\n";
  Variant now = parse_scene(text, "s.toml", ".").variants.front();
  now.tissue = changed(now.tissue);
  const std::string written = recorded_scene(text, "s.toml", ".", {}, now, {.head = "", .files = {}, .duration = 1.0});
  EXPECT_EQ(parse_scene(written, "w.toml", ".").variants.front().tissue, now.tissue) << written;
}

}  // namespace
}  // namespace glisson::scene

// The fits that ship can be read, and the needle's follows the points measured before the puncture more closely than the
// parabola of reference does.
#include <gtest/gtest.h>

#include <filesystem>

#include "fit/run_fit.h"
#include "support/places.h"

namespace glisson::fit {
namespace {

namespace fs = std::filesystem;
const fs::path kFits = test::shipped("scenes/fit");

TEST(ShippedFits, CanBeRead) {
  for (const char* name :
       {"phantom_mean.toml", "phantom_ef10_100t.toml", "phantom_ef10_75t.toml", "phantom_friction.toml",
        "liver_velocity.toml", "bovine_needle.toml", "bovine_membranes.toml", "brain_cortex.toml", "muscle_hold.toml",
        "indentation.toml", "agar_probe.toml"}) {
    const FitSpec fit = load_fit(kFits / name);
    EXPECT_FALSE(fit.title.empty()) << name;
    EXPECT_FALSE(fit.description.empty()) << name;
    EXPECT_EQ(fit.parameters.empty(), fit.insertion.has_value()) << name;
    if (fit.scene.empty()) continue;
    EXPECT_NO_THROW(load_scene(fit.scene)) << name;
  }
}

// A parameter has the unit that its key ends with, wherever the key has indices: of a branch's time as of a modulus in a list.
TEST(ParameterUnits, AreThoseOfTheKeysEnd) {
  const std::pair<const char*, const char*> kUnits[]{{"tissue.maxwell[0].time_s", "s"},
                                                     {"tissue.hyperelastic.mu_Pa[1]", "Pa"},
                                                     {"tissue.maxwell[1].share", ""},
                                                     {"tissue.maxwell[0].time_law.exponent", ""},
                                                     {"tissue.viscosity_Pa_s", "Pa·s"},
                                                     {"tissue.density_kg_m3", "kg/m³"},
                                                     {"curve.contact_mm", "mm"},
                                                     {"curve.force_offset_N", "N"},
                                                     {"instrument[0].friction_N_s_m", "N·s/m"},
                                                     {"instrument[0].membranes[2].toughness_J_m2", "J/m²"},
                                                     {"loads[0].spring_Pa_m", "Pa/m"},
                                                     {"motion.speed_mm_s", "mm/s"}};
  for (const auto& [key, unit] : kUnits) EXPECT_EQ(unit_of_key(key), unit) << key;
}

// F = 0.0158 N/mm² d² leaves 0.049 N rms on these points. Three steps of one start are enough to be below it.
TEST(ShippedFits, NeedleMeetsThePointsBeforeThePuncture) {  // long
  FitSpec fit = load_fit(kFits / "bovine_needle.toml");
  fit.search.starts = 1;
  fit.search.most_iterations = 3;
  fit.forward.kind = ForwardKind::scene;
  const FitResult result = run_fit(fit, {});
  ASSERT_EQ(result.curves.size(), 1u);
  EXPECT_EQ(result.curves[0].curve.size(), 9u);
  EXPECT_LT(result.rms_fit, 0.049);
}

}  // namespace
}  // namespace glisson::fit

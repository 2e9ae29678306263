// Another word for the same enumerator is read like the first, and messages name the first alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_text.h"

namespace glisson::words_test {
namespace {

using ::testing::HasSubstr;

Variant with(const std::string& motion, const std::string& tissue) {
  return test::parse("[mesh]\nkind = \"box\"\n[motion]\nmax_steps = 1\n" + motion + "[tissue]\n" + tissue)
      .variants.at(0);
}

TEST(Words, AliasesAreRead) {
  EXPECT_EQ(with("integrator = \"static\"\n", "").simulation.integrator, Integrator::quasi_static);
  EXPECT_EQ(with("integrator = \"explicit\"\n", "").simulation.integrator, Integrator::central_difference);
  EXPECT_EQ(with("", "volume_change = \"nodal\"\n").tissue.volume_change, VolumeChange::average_nodal);
  EXPECT_EQ(with("", "volume_change = \"own\"\n").tissue.volume_change, VolumeChange::element);
  EXPECT_EQ(with("", "measure = \"intensity\"\n").tissue.measure, DeformationMeasure::equivalent_shear_strain);
}

TEST(Words, AliasesAreNotNamedInMessages) {
  const std::string message = test::complaint("[mesh]\nkind = \"box\"\n[motion]\nintegrator = \"statics\"\n");
  const std::string known = message.substr(0, message.find("got"));
  for (const Word<Integrator>& w : kWords<Integrator>) {
    EXPECT_EQ(known.find("\"" + std::string(w.word) + "\"") == std::string::npos, is_alias(w)) << w.word;
  }
}

TEST(Words, ReferenceNamesAliases) {
  EXPECT_THAT(scene_reference_markdown(),
              HasSubstr("`\"quasi_static\"` equilibrium without inertia; time orders motions and loads, "
                        "`branches` says what relaxes and resists (also `\"static\"`)"));
}

}  // namespace
}  // namespace glisson::words_test

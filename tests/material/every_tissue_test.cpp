// The list that all property tests run over leaves no law out.
#include "material/every_tissue.h"

#include <gtest/gtest.h>

#include <set>

namespace glisson {
namespace {

// Each law is used, with each kinematics and form, and none would be refused at the door.
TEST(EveryTissue, UsesEachLawWithEachKinematics) {
  std::set<std::tuple<Kinematics, LawForm, std::size_t>> stiffness;
  std::set<std::size_t> hyperelastic;
  std::set<std::string> names;
  for (const Tissue& t : test::every_tissue()) {
    EXPECT_NO_THROW(require_valid(t)) << t.name;
    names.insert(t.name);
    if (t.hyperelastic) {
      hyperelastic.insert(t.hyperelastic->index());
    } else {
      stiffness.emplace(t.kinematics, t.law_form, t.law.index());
    }
  }
  EXPECT_EQ(stiffness.size(), 3 * 2 * std::variant_size_v<StiffnessLaw>);
  EXPECT_EQ(hyperelastic.size(), std::variant_size_v<HyperelasticLaw>);
}

}  // namespace
}  // namespace glisson
